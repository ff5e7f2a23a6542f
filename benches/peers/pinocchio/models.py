"""Robot files of this crate as Pinocchio models."""

import math
import tomllib
from pathlib import Path

import numpy as np
import pinocchio as pin

ROOT = Path(__file__).resolve().parents[3]
ROBOTS = {
    "six": ROOT / "src/arm/robot/catalogue/irb1600_10_145.toml",
    "skew": ROOT / "fixtures/dynamics/skew.toml",
    "seven": ROOT / "fixtures/dynamics/seven.toml",
}
PRIMES = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61, 67, 71, 73]
# Largest angle (rad), velocity (rad/s) and acceleration (rad/s2).
REACH = [3.0, 4.0, 20.0]


def joints(robot):
    """Placement in the parent and axis of each joint."""
    kinematics = robot.get("kinematics", {})
    if "opw" not in kinematics:
        for joint in robot["joint"]:
            turn = pin.rpy.rpyToMatrix(*joint.get("rpy", [0.0, 0.0, 0.0]))
            axis = np.array(joint["axis"])
            yield pin.SE3(turn, np.array(joint["origin"])), axis / np.linalg.norm(axis)
        return
    opw = kinematics["opw"]
    steps = [
        ([0, 0, 0], [0, 0, 1]),
        ([opw["a1"], opw["b"], opw["c1"]], [0, 1, 0]),
        ([0, 0, opw["c2"]], [0, 1, 0]),
        ([opw["a2"], 0, opw["c3"]], [0, 0, 1]),
        ([0, 0, 0], [0, 1, 0]),
        ([0, 0, 0], [0, 0, 1]),
    ]
    turned = np.eye(3)
    for (step, axis), sign, offset in zip(steps, opw["signs"], opw["offsets"]):
        step, axis = np.array(step, float), np.array(axis, float)
        yield pin.SE3(np.eye(3), turned @ step), turned @ axis * sign
        turned = turned @ pin.AngleAxis(-offset, axis).matrix()


def load(name):
    """The model, with rotors as armature."""
    robot = tomllib.loads(ROBOTS[name].read_text())
    model = pin.Model()
    model.gravity.linear = np.array([0.0, 0.0, -9.81])
    parent = 0
    for index, ((place, axis), link) in enumerate(zip(joints(robot), robot["link"])):
        joint = pin.JointModelRevoluteUnaligned(axis)
        parent = model.addJoint(parent, joint, place, f"j{index + 1}")
        xx, yy, zz, xy, xz, yz = link["inertia"]
        about = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        body = pin.Inertia(link["mass"], np.array(link["com"]), about)
        model.appendBodyToJoint(parent, body, pin.SE3.Identity())
    motors = robot.get("motors")
    if motors:
        pairs = zip(motors["ratio"], motors["rotor_inertia"])
        model.armature = np.array([ratio**2 * inertia for ratio, inertia in pairs])
    return model


def state(dof, index):
    """Position, velocity and acceleration; the tests compute the same ones."""

    def spread(channel):
        return 2.0 * math.fmod((index + 1) * math.sqrt(PRIMES[channel]), 1.0) - 1.0

    return [
        np.array([REACH[kind] * spread(7 * kind + joint) for joint in range(dof)])
        for kind in range(3)
    ]
