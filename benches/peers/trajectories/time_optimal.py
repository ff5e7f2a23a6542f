"""toppra on the paths of the example `peer_paths`: time-optimal with limits on velocity,
acceleration and torque. It gets the torques along the path for nothing, without viscous friction,
which it has no place for."""

import json
import logging
import statistics
import sys
import time

import numpy as np
import toppra
from toppra import algorithm, constraint

REPEATS = 5


class Torque(constraint.LinearConstraint):
    """|m u + c x + g| at most the limit, with coefficients at the nodes."""

    def __init__(self, grid, limit):
        super().__init__()
        self.identical = True
        self.set_discretization_type(constraint.DiscretizationType.Collocation)
        self.dof = 6
        self.grid = [np.array(grid[name]) for name in "mcg"]
        self.matrix = np.vstack([np.eye(6), -np.eye(6)])
        self.bound = np.hstack([limit, limit])

    def compute_constraint_params(self, path, gridpoints):
        m, c, g = self.grid
        return m, c, g, self.matrix, self.bound, None, None


def solve(grid, robot):
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
        Torque(grid, limits["torque"]),
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
    ratios, energies = {}, []
    print("path, nodes: toppra ms, joulepath ms, ratio; durations s")
    for path in data["paths"]:
        for size, label in zip(path["sizes"], (100, 1000)):
            results = [solve(size["grid"], data["robot"]) for _ in range(REPEATS)]
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
