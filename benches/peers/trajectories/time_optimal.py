"""toppra on the paths of the example `peer_paths`: time-optimal with limits on velocity,
acceleration and torque, the torques by Pinocchio. Viscous friction is left out: it has no place
for that."""

import json
import logging
import statistics
import sys
import time

import numpy as np
import pinocchio as pin
import toppra
from toppra import algorithm, constraint

REPEATS = 5


def inverse_dynamics(robot):
    """The robot as a function of Pinocchio."""
    model, parent = pin.Model(), 0
    model.gravity.linear = np.array([0.0, 0.0, -9.81])
    for index, joint in enumerate(robot["joints"]):
        place = pin.SE3(np.array(joint["rotation"]).reshape(3, 3), np.array(joint["origin"]))
        axis = pin.JointModelRevoluteUnaligned(np.array(joint["axis"]))
        parent = model.addJoint(parent, axis, place, f"j{index + 1}")
        about = np.array(joint["inertia"]).reshape(3, 3)
        body = pin.Inertia(joint["mass"], np.array(joint["com"]), about)
        model.appendBodyToJoint(parent, body, pin.SE3.Identity())
    model.armature = np.array(robot["rotor"])
    data = model.createData()
    return lambda q, qd, qdd: pin.rnea(model, data, q, qd, qdd)


def solve(grid, robot, torque):
    """Duration and the time that it takes to find it, s."""
    nodes, q = np.array(grid["s"]), np.array(grid["q"])
    limits = {
        name: np.array(robot[name]) for name in ("velocity", "acceleration", "torque")
    }
    begin = time.perf_counter()
    path = toppra.SplineInterpolator(nodes, q)
    rows = [
        constraint.JointVelocityConstraint(np.c_[-limits["velocity"], limits["velocity"]]),
        constraint.JointAccelerationConstraint(
            np.c_[-limits["acceleration"], limits["acceleration"]]
        ),
        constraint.JointTorqueConstraint(
            torque, np.c_[-limits["torque"], limits["torque"]], np.array(robot["coulomb"])
        ),
    ]
    instance = algorithm.TOPPRA(rows, path, gridpoints=nodes, solver_wrapper="seidel")
    _, speed, _ = instance.compute_parameterization(0.0, 0.0)
    seconds = time.perf_counter() - begin
    if speed is None:
        return float("nan"), seconds
    return float(np.sum(2.0 * np.diff(nodes) / (speed[1:] + speed[:-1]))), seconds


def main():
    logging.getLogger("toppra").setLevel(logging.ERROR)
    with open(sys.argv[1], encoding="utf-8") as file:
        data = json.load(file)
    torque = inverse_dynamics(data["robot"])
    ratios, energies = {}, []
    print("path, nodes: toppra ms, joulepath ms, ratio; durations s")
    for path in data["paths"]:
        for size, label in zip(path["sizes"], (100, 1000)):
            results = [solve(size["grid"], data["robot"], torque) for _ in range(REPEATS)]
            peer = min(seconds for _, seconds in results)
            own = size["time_optimal_s"]
            ratios.setdefault(label, []).append(peer / own)
            if size["energy_s"]:
                energies.append(size["energy_s"] / peer)
            print(
                f"{path['name']}, {len(size['grid']['s'])}: {1e3 * peer:.2f}, {1e3 * own:.3f}, "
                f"{peer / own:.1f}; {results[0][0]:.4f} {size['duration_s']:.4f}"
            )
    for label, values in ratios.items():
        print(
            f"N = {label}: {statistics.median(values):.1f} times as fast as toppra in the median, "
            f"{min(values):.1f} at least"
        )
    print(
        f"whole energy result at N = 100: {statistics.median(energies):.2f} times toppra's "
        f"time-optimal solve in the median, {max(energies):.2f} at most"
    )


if __name__ == "__main__":
    main()
