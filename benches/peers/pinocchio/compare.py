"""Times of this crate's benches beside Pinocchio's, of one run on one machine."""

import json
import subprocess
import sys
from pathlib import Path

import models

CRITERION = models.ROOT / "target" / "criterion"
# The state of benches/dynamics.rs.
STATE = [
    [0.3, 0.5, -0.4, 0.8, 0.9, -0.2],
    [1.0, -0.5, 0.7, 2.0, -1.0, 3.0],
    [5.0, 4.0, -6.0, 10.0, 20.0, -30.0],
]
BENCHES = ["rnea", "rnea derivatives", "crba", "regressor"]


def described(model):
    """The model as `peer.cpp` reads it."""
    numbers = [model.nv]
    for joint in range(1, model.njoints):
        place, body = model.jointPlacements[joint], model.inertias[joint]
        axis = model.joints[joint].extract().axis
        numbers += [*place.rotation.flatten(), *place.translation, *axis]
        numbers += [body.mass, *body.lever, *body.inertia.flatten(), model.armature[joint - 1]]
    return " ".join(repr(float(x)) if i else str(x) for i, x in enumerate(numbers + sum(STATE, [])))


def ours():
    subprocess.run(
        ["cargo", "bench", "--bench", "dynamics", "--", "^(rnea|rnea derivatives|crba|regressor)$"],
        cwd=models.ROOT, check=True, stdout=subprocess.DEVNULL,
    )
    def median(name):
        estimates = CRITERION / name / "new" / "estimates.json"
        return json.loads(estimates.read_text())["median"]["point_estimate"]
    return {name: median(name) for name in BENCHES}


def peers(programs):
    robot = described(models.load("six"))
    times = [
        json.loads(subprocess.run([p], input=robot, capture_output=True, text=True, check=True).stdout)
        for p in programs
    ]
    return {name: min(time[name] for time in times) for name in BENCHES}


def main():
    programs = [Path(p) for p in sys.argv[1:]]
    # Before and after, to detect a change of the machine's speed.
    before, own, after = peers(programs), ours(), peers(programs)
    print(f"{'':18}{'joulepath':>12}{'pinocchio':>20}{'ratio':>8}")
    for name in BENCHES:
        theirs = min(before[name], after[name])
        span = f"{before[name]:.0f}, {after[name]:.0f} ns"
        print(f"{name:18}{own[name]:>9.0f} ns{span:>20}{own[name] / theirs:>8.2f}")
    print(f"regressor / rnea: {own['regressor'] / own['rnea']:.2f}")


main()
