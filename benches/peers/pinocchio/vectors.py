"""Writes fixtures/dynamics/*.csv: torques of 1,000 states by Pinocchio, and for the
first 100 its derivatives (by q, by qd, mass matrix), each times a fixed vector."""

import numpy as np
import pinocchio as pin

import models

STATES = 1000
WITH_DERIVATIVES = 100

for name in models.ROBOTS:
    model = models.load(name)
    data = model.createData()
    n = model.nv
    across = np.array([1.0 / (joint + 1) for joint in range(n)])
    lines = []
    for index in range(STATES):
        q, v, a = models.state(n, index)
        row = list(pin.rnea(model, data, q, v, a))
        if index < WITH_DERIVATIVES:
            by_q, by_v, mass = pin.computeRNEADerivatives(model, data, q, v, a)
            mass = np.triu(mass) + np.triu(mass, 1).T
            row += [*(by_q @ across), *(by_v @ across), *(mass @ across)]
        lines.append(",".join(f"{x:.13g}" for x in row))
    path = models.ROOT / "fixtures" / "dynamics" / f"{name}.csv"
    path.write_text("\n".join(lines) + "\n")
    print(path)
