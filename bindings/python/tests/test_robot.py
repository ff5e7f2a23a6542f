"""Robots on arrays: shapes, layouts, types, and agreement of the parts with each other."""

import pickle

import numpy as np
import pytest

import joulepath

NAME = "IRB1600-10/1.45"
RNG = np.random.default_rng(7)


@pytest.fixture(scope="module")
def robot() -> joulepath.Robot:
    return joulepath.Robot(NAME)


def states(*batch: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return tuple(RNG.uniform(-1.0, 1.0, (*batch, 6)) for _ in range(3))


def test_a_batch_is_its_states_one_by_one(robot: joulepath.Robot) -> None:
    q, qd, qdd = states(4, 3)
    tau = robot.rnea(q, qd, qdd)
    assert tau.shape == (4, 3, 6)
    one = robot.rnea(q[2, 1], qd[2, 1], qdd[2, 1])
    assert np.array_equal(tau[2, 1], one)


@pytest.mark.parametrize(
    "form",
    [
        np.asfortranarray,
        lambda x: x.astype(np.float32),
        lambda x: x.tolist(),
        lambda x: np.repeat(x, 2, axis=0)[::2],
    ],
    ids=["fortran", "float32", "list", "strided"],
)
def test_layout_and_type_do_not_matter(robot: joulepath.Robot, form) -> None:
    q, qd, qdd = states(5)
    expected = robot.rnea(q, qd, qdd)
    found = robot.rnea(form(q), form(qd), form(qdd))
    assert np.allclose(found, expected, rtol=1e-5, atol=1e-4)


def test_read_only_arrays_are_read(robot: joulepath.Robot) -> None:
    q, qd, qdd = states(5)
    for array in (q, qd, qdd):
        array.flags.writeable = False
    assert robot.rnea(q, qd, qdd).shape == (5, 6)


def test_nan_stays_in_its_row(robot: joulepath.Robot) -> None:
    q, qd, qdd = states(3)
    expected = robot.rnea(q, qd, qdd)
    q[1, 2] = np.nan
    tau = robot.rnea(q, qd, qdd)
    assert np.isnan(tau[1]).any()
    assert np.array_equal(tau[[0, 2]], expected[[0, 2]])


@pytest.mark.parametrize("shape", [(5,), (3, 7), ()])
def test_a_wrong_shape_is_named(robot: joulepath.Robot, shape: tuple[int, ...]) -> None:
    wrong = np.zeros(shape)
    with pytest.raises(joulepath.JoulepathError, match="q has the shape"):
        robot.rnea(wrong, wrong, wrong)
    with pytest.raises(ValueError, match="qd has the shape"):
        robot.rnea(np.zeros((2, 6)), np.zeros((3, 6)), np.zeros((2, 6)))


def test_the_regressor_gives_the_torque_differences_of_a_load(robot: joulepath.Robot) -> None:
    q, qd, qdd = states(20)
    regressor = robot.regressor(q, qd, qdd)
    assert regressor.shape == (20, 6, 60)
    mass, com = 4.0, np.array([0.05, -0.02, 0.1])
    with_load = robot.rnea(q, qd, qdd, load=joulepath.Load(mass, com))
    more = with_load - robot.rnea(q, qd, qdd)
    # A point mass in the frame of the last link, which is that of the flange turned and shifted.
    solution, *_ = np.linalg.lstsq(
        regressor[..., 50:].reshape(-1, 10), more.reshape(-1), rcond=None
    )
    left = regressor[..., 50:].reshape(-1, 10) @ solution - more.reshape(-1)
    assert np.abs(left).max() < 1e-8
    assert solution[0] == pytest.approx(mass, abs=1e-6)


def test_inverse_kinematics_agrees_with_forward(robot: joulepath.Robot) -> None:
    for q in RNG.uniform(-0.8, 0.8, (20, 6)):
        pose = robot.fk(q)
        assert pose.shape == (4, 4)
        found = robot.ik(pose, near=q)
        assert np.allclose(found[0], q, atol=1e-9)
        assert np.allclose(robot.fk(found), pose, atol=1e-9)


def test_robots_can_be_pickled_and_are_named() -> None:
    robot = pickle.loads(pickle.dumps(joulepath.Robot(NAME)))
    assert repr(robot) == f"Robot('{NAME}')"
    assert NAME in joulepath.robots()
    with pytest.raises(joulepath.RobotError, match="IRB9999"):
        joulepath.Robot("IRB9999")
