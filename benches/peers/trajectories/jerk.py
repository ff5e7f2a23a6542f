"""The fastest motion along a path with the limit on jerk that streams have, by CasADi and IPOPT:
path speed with a constant third derivative in each of many steps of equal time. It judges how much
time the streams of the example `peer_paths` lose."""

import json
import statistics
import sys

import casadi as ca
import numpy as np
from free_path import inverse_dynamics
from scipy.interpolate import make_interp_spline

STEPS = 160
# Least duration of a compared move, s.
SHORTEST = 0.2


def function(name, spline):
    """A spline as a CasADi function."""
    values = spline.c[: len(spline.t) - spline.k - 1]
    columns = values.shape[1] if values.ndim > 1 else 1
    return ca.Function.bspline(
        name, [spline.t.tolist()], values.reshape(-1).tolist(), [spline.k], columns
    )


def least_time(path, robot, tau):
    """Least time along a path, s; none where IPOPT finds none."""
    nodes = np.array(path["s"])
    length = float(nodes[-1])
    nodes = nodes / length
    place = function("q", make_interp_spline(nodes, np.array(path["q"]), k=3))
    first = make_interp_spline(nodes, np.array(path["q1"]) * length, k=3)
    orders = [function(f"q{n + 1}", first.derivative(n) if n else first) for n in range(3)]
    bound = np.log(np.array(path["v_max"]) / length)
    speed = function("v", make_interp_spline(nodes, bound, k=1))
    # State at each step: position, speed, acceleration along the path; then its jerk.
    time = ca.MX.sym("T")
    state = ca.MX.sym("x", 3, STEPS + 1)
    jerk = ca.MX.sym("u", 1, STEPS)
    h = time / STEPS
    x, u = state[:, :-1], jerk
    after = ca.vertcat(
        x[0, :] + h * x[1, :] + h**2 / 2 * x[2, :] + h**3 / 6 * u,
        x[1, :] + h * x[2, :] + h**2 / 2 * u,
        x[2, :] + h * u,
    )
    one = ca.MX.sym("one", 4)
    s, v, a, j = (one[i] for i in range(4))
    d1, d2, d3 = (order(s) for order in orders)
    qd, qdd = d1 * v, d2 * v**2 + d1 * a
    torque = tau(place(s), qd, qdd)
    limits = {k: ca.DM(robot[k]) for k in ("acceleration", "torque", "jerk", "coulomb")}
    # Dry friction has a constant direction: a motion along a path never reverses.
    dry = limits["coulomb"] * ca.tanh(d1 / 1e-3)
    rows = ca.vertcat(
        v / ca.exp(speed(s)),
        qdd / limits["acceleration"],
        (torque + dry) / limits["torque"],
        (d3 * v**3 + 3 * d2 * v * a + d1 * j) / limits["jerk"],
    )
    shares = ca.Function("shares", [one], [rows])
    begin = shares.map(STEPS)(ca.vertcat(x, u))
    end = shares.map(STEPS)(ca.vertcat(state[:, 1:], u))
    constraints = ca.vertcat(
        ca.vec(state[:, 1:] - after),
        state[:, 0],
        state[:, -1] - ca.DM([1, 0, 0]),
        ca.vec(begin),
        ca.vec(end),
    )
    equal = 3 * STEPS + 6
    count = constraints.shape[0]
    lower = np.r_[np.zeros(equal), -np.ones(count - equal)]
    upper = np.r_[np.zeros(equal), np.ones(count - equal)]
    # A smooth, slow initial solution.
    t = np.linspace(0, 1, STEPS + 1)
    guess = 2 * path["stream_s"]
    places = 35 * t**4 - 84 * t**5 + 70 * t**6 - 20 * t**7
    rates = np.gradient(places, t) / guess
    turns = np.gradient(rates, t) / guess
    jerks = np.diff(turns) / (guess / STEPS)
    start = np.r_[guess, np.vstack([places, rates, turns]).T.reshape(-1), jerks]
    low = np.r_[1e-3, np.tile([0, 0, -np.inf], STEPS + 1), np.full(STEPS, -np.inf)]
    high = np.r_[np.inf, np.tile([1, np.inf, np.inf], STEPS + 1), np.full(STEPS, np.inf)]
    solver = ca.nlpsol(
        "solver",
        "ipopt",
        {"x": ca.vertcat(time, ca.vec(state), ca.vec(jerk)), "f": time, "g": constraints},
        {"ipopt.print_level": 0, "print_time": False, "ipopt.max_iter": 500, "ipopt.sb": "yes"},
    )
    found = solver(x0=start, lbx=low, ubx=high, lbg=lower, ubg=upper)
    return float(found["f"]) if solver.stats()["success"] else None


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        data = json.load(file)
    tau = inverse_dynamics(data["robot"])
    kinds = {}
    print("path: least time with the jerk, stream, ratio")
    for path in data["jerk"]:
        least = least_time(path, data["robot"], tau)
        if least is None or least < SHORTEST:
            print(f"{path['name']}: {'no result' if least is None else 'short'}")
            continue
        ratio = path["stream_s"] / least
        kinds.setdefault(path["name"].split()[0], []).append(ratio)
        print(f"{path['name']}: {least:.4f} {path['stream_s']:.4f} {ratio:.4f}", flush=True)
    every = [ratio for ratios in kinds.values() for ratio in ratios]
    for name, ratios in [*sorted(kinds.items()), ("all", every)]:
        print(
            f"{name}: {len(ratios)} moves, {statistics.median(ratios):.4f} in the median, "
            f"{min(ratios):.4f} to {max(ratios):.4f}"
        )


if __name__ == "__main__":
    main()
