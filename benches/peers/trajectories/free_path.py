"""CasADi and IPOPT on the free streams of the example `peer_paths`: the points of the same spline,
the same energy and limits, from the same start. Both results are judged by the same function."""

import json
import statistics
import sys
import time

import casadi as ca
import numpy as np

# Widths of the smoothing of dry friction (rad/s) and of braking (W).
ROUND_SPEED = 1e-3
ROUND_POWER = 5.0
SIMPSON = [(0.0, 1 / 6), (0.5, 4 / 6), (1.0, 1 / 6)]
DENSE = 8
# Number of paths: IPOPT needs up to minutes for one.
PATHS = 6


def rotation(axis, angle):
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + ca.sin(angle) * cross + (1 - ca.cos(angle)) * (cross @ cross)


def inverse_dynamics(robot):
    """Newton and Euler, with rotors and viscous friction, as a CasADi function."""
    q, qd, qdd = (ca.SX.sym(name, 6) for name in ("q", "qd", "qdd"))
    w, wd, a = ca.SX.zeros(3), ca.SX.zeros(3), ca.SX([0, 0, 9.81])
    forces, turns = [], []
    for i, joint in enumerate(robot["joints"]):
        p, axis = np.array(joint["origin"]), np.array(joint["axis"])
        turn = np.array(joint["rotation"]).reshape(3, 3) @ rotation(axis, q[i])
        a = turn.T @ (a + ca.cross(wd, p) + ca.cross(w, ca.cross(w, p)))
        w_parent = turn.T @ w
        wd = turn.T @ wd + axis * qdd[i] + ca.cross(w_parent, axis * qd[i])
        w = w_parent + axis * qd[i]
        com, inertia = np.array(joint["com"]), np.array(joint["inertia"]).reshape(3, 3)
        force = joint["mass"] * (a + ca.cross(wd, com) + ca.cross(w, ca.cross(w, com)))
        moment = inertia @ wd + ca.cross(w, inertia @ w) + ca.cross(com, force)
        forces.append((force, moment))
        turns.append((turn, p, axis))
    tau = [None] * 6
    force, moment = ca.SX.zeros(3), ca.SX.zeros(3)
    for i in reversed(range(6)):
        force, moment = force + forces[i][0], moment + forces[i][1]
        turn, p, axis = turns[i]
        tau[i] = ca.dot(moment, axis)
        force = turn @ force
        moment = turn @ moment + ca.cross(p, force)
    tau = ca.vertcat(*tau) + ca.DM(robot["rotor"]) * qdd + ca.DM(robot["viscous"]) * qd
    return ca.Function("tau", [q, qd, qdd], [tau])


def spline(points, start, duration):
    """Pieces (length, q, qd, qdd at the begin) of the motion, and its knots' mean lengths."""
    n = len(points)
    d = duration / n
    times = [0.0, 2 / 3 * d] + [(i + 0.5) * d for i in range(1, n - 1)]
    times += [duration - 2 / 3 * d, duration]
    control = [start, *points]
    mean = [0.5 * (times[i + 1] - times[i - 1]) for i in range(1, n + 1)]
    speeds = [0 * start] + [(control[i + 1] - control[i]) / mean[i] for i in range(n)] + [0 * start]
    pieces, q = [], start
    for i in range(n + 1):
        h = times[i + 1] - times[i]
        pieces.append((h, q, speeds[i], (speeds[i + 1] - speeds[i]) / h))
        q = q + 0.5 * h * (speeds[i] + speeds[i + 1])
    return pieces, mean


def judged(points, path, robot, tau):
    """Energy with exact signs, J, and the largest share of a torque limit."""
    pieces, _ = spline(list(np.array(points)), np.array(path["start"]), path["duration_s"])
    coulomb, loss = np.array(robot["coulomb"]), np.array(robot["loss"])
    energy, share = 0.0, 0.0
    for h, q, qd, qdd in pieces:
        for k in range(DENSE + 1):
            x = k / DENSE * h
            weight = (1 if k in (0, DENSE) else 2 + 2 * (k % 2)) * h / DENSE / 3
            v = qd + x * qdd
            v = np.where(abs(v) < 1e-9, 0.0, v)
            torque = np.array(tau(q + x * qd + 0.5 * x * x * qdd, v, qdd)).ravel()
            torque = torque + coulomb * np.sign(v)
            power = torque @ v
            energy += weight * (max(power, 0.0) + loss @ torque**2)
            share = max(share, np.max(abs(torque) / np.array(robot["torque"])))
    return energy, share


def problem(path, robot, tau):
    n, duration = len(path["points"]), path["duration_s"]
    inner = ca.SX.sym("p", 6, n - 1)
    start, end = np.array(path["start"]), np.array(path["points"][-1])
    points = [inner[:, i] for i in range(n - 1)] + [ca.SX(end)]
    pieces, mean = spline(points, ca.SX(start), duration)
    coulomb, loss = ca.DM(robot["coulomb"]), ca.DM(robot["loss"])
    limit = {name: ca.DM(robot[name]) for name in ("velocity", "acceleration", "jerk", "torque")}
    cost, rows = 0, []
    for i, (h, q, qd, qdd) in enumerate(pieces):
        rows.append(qdd / limit["acceleration"])
        if i > 0:
            rows.append(qd / limit["velocity"])
            rows.append((qdd - pieces[i - 1][3]) / mean[i - 1] / limit["jerk"])
        for share, weight in SIMPSON:
            x = share * h
            v = qd + x * qdd
            torque = tau(q + x * qd + 0.5 * x * x * qdd, v, qdd)
            torque = torque + coulomb * v / ca.sqrt(v * v + ROUND_SPEED**2)
            power = ca.dot(torque, v)
            drawn = 0.5 * (power + ca.sqrt(power * power + ROUND_POWER**2))
            cost += weight * h * (drawn + ca.dot(loss, torque * torque))
            rows.append(torque / limit["torque"])
    rows.append(pieces[0][3] / pieces[0][0] / limit["jerk"])
    rows.append(pieces[-1][3] / pieces[-1][0] / limit["jerk"])
    options = {"ipopt.print_level": 0, "print_time": False, "ipopt.tol": 1e-5}
    nlp = {"x": ca.vec(inner), "f": cost, "g": ca.vertcat(*rows)}
    return ca.nlpsol("nlp", "ipopt", nlp, options)


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        data = json.load(file)
    robot = data["robot"]
    tau = inverse_dynamics(robot)
    shares, excess = [], []
    print("path: IPOPT s and J, joulepath s and J (its own figure), first J; worst torque shares")
    for path in data["paths"][:PATHS]:
        free = path["free"]
        if free is None:
            print(f"{path['name']}: no first stream")
            continue
        solver = problem(free, robot, tau)
        first = np.array(free["first"])[:-1].ravel()
        begin = time.perf_counter()
        result = solver(x0=first, lbg=-1.0, ubg=1.0)
        seconds = time.perf_counter() - begin
        ok = solver.stats()["success"]
        best = np.vstack([np.array(result["x"]).reshape(-1, 6), free["points"][-1]])
        peer, peer_share = judged(best, free, robot, tau)
        own, own_share = judged(free["points"], free, robot, tau)
        if ok:
            shares.append(free["seconds"] / seconds)
            excess.append(own / peer - 1.0)
        print(
            f"{path['name']}: {seconds:.2f} {peer:.2f}{'' if ok else ' (failed)'}, "
            f"{free['seconds']:.3f} {own:.2f} ({free['energy_j']:.2f}), "
            f"{free['first_energy_j']:.2f}; {peer_share:.3f} {own_share:.3f}"
        )
    print(
        f"joulepath takes {statistics.median(shares):.3f} of IPOPT's time in the median, "
        f"{max(shares):.3f} at most; energy {100 * statistics.median(excess):+.2f} % in the "
        f"median, {100 * max(excess):+.2f} % at most"
    )


if __name__ == "__main__":
    main()
