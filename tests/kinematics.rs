//! Forward and inverse kinematics against each other, against finite
//! differences and against an independent solver.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use joulepath::kinematics::{
    conf_of, fk, ik_all, ik_conf, ik_near, jacobian, jacobian_dot, limits_ok,
};
use joulepath::robot::{Model, find};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use proptest::prelude::*;

/// Largest difference of angles that count as one \[rad\].
const SAME_ANGLE: f64 = 1e-8;
/// Largest difference of poses that count as one \[m\] and \[rad\].
const SAME_POSE: f64 = 1e-10;

fn robots() -> Vec<Model> {
    joulepath::robot::names().map(|name| find(name).unwrap()).collect()
}

fn tool() -> Isometry3<f64> {
    Isometry3::from_parts(
        Translation3::new(0.075, -0.02, 0.493),
        UnitQuaternion::from_euler_angles(0.3, 0.5, -0.2),
    )
}

fn same_angle(a: f64, b: f64) -> bool {
    let d = (a - b).rem_euclid(std::f64::consts::TAU);
    d.min(std::f64::consts::TAU - d) < SAME_ANGLE
}

fn distance(a: &Isometry3<f64>, b: &Isometry3<f64>) -> f64 {
    (a.translation.vector - b.translation.vector).norm().max(a.rotation.angle_to(&b.rotation))
}

/// Joint angles at shares 0 to 1 of the position ranges.
fn inside(model: &Model, shares: [f64; 6]) -> [f64; 6] {
    std::array::from_fn(|i| {
        let [low, high] = model.limits.position[i];
        low + shares[i] * (high - low)
    })
}

fn shares() -> impl Strategy<Value = [f64; 6]> {
    prop::array::uniform6(0.0..1.0)
}

proptest! {
    #[test]
    fn inverse_contains_the_angles(shares in shares(), which in 0usize..2) {
        let model = &robots()[which];
        let q = inside(model, shares);
        let pose = fk(model, &q);
        let all = ik_all(model, &pose).unwrap();
        for solution in &all {
            prop_assert!(distance(&fk(model, solution), &pose) < SAME_POSE);
        }
        let hit = all.iter().any(|s| s.iter().zip(&q).all(|(a, b)| same_angle(*a, *b)));
        prop_assert!(hit, "{q:?} not in {all:?}");
    }

    #[test]
    fn configuration_leads_back(shares in shares(), which in 0usize..2) {
        let model = &robots()[which];
        let q = inside(model, shares);
        let found = ik_conf(model, &fk(model, &q), conf_of(model, &q)).unwrap();
        for (a, b) in found.iter().zip(&q) {
            prop_assert!((a - b).abs() < SAME_ANGLE, "{found:?} {q:?}");
        }
    }

    #[test]
    fn nearest_solution_stays_on_its_branch(shares in shares(), step in prop::array::uniform6(-1e-3..1e-3)) {
        let model = find("IRB1600-10/1.45").unwrap();
        let q = inside(&model, shares).map(|angle| 0.99 * angle);
        let near: [f64; 6] = std::array::from_fn(|i| q[i] + step[i]);
        prop_assume!(q[4].sin().abs() > 0.05 && limits_ok(&model, &q).is_ok());
        let found = ik_near(&model, &fk(&model, &q), &near).unwrap();
        for (a, b) in found.iter().zip(&q) {
            prop_assert!((a - b).abs() < SAME_ANGLE, "{found:?} {q:?}");
        }
    }

    #[test]
    fn jacobian_is_the_change_of_pose(shares in shares(), which in 0usize..2) {
        let model = &robots()[which];
        let q = inside(model, shares);
        let tool = tool();
        let j = jacobian(model, &q, &tool);
        let h = 1e-6;
        for joint in 0..6 {
            let moved = |by: f64| {
                let mut q = q;
                q[joint] += by;
                fk(model, &q) * tool
            };
            let (ahead, behind) = (moved(h), moved(-h));
            let linear = (ahead.translation.vector - behind.translation.vector) / (2.0 * h);
            let angular = (ahead.rotation * behind.rotation.inverse()).scaled_axis() / (2.0 * h);
            for row in 0..3 {
                prop_assert!((j[(row, joint)] - linear[row]).abs() < 1e-8);
                prop_assert!((j[(row + 3, joint)] - angular[row]).abs() < 1e-8);
            }
        }
    }

    #[test]
    fn jacobian_dot_is_the_change_of_the_jacobian(
        shares in shares(),
        qd in prop::array::uniform6(-3.0..3.0),
        which in 0usize..2,
    ) {
        let model = &robots()[which];
        let q = inside(model, shares);
        let h = 1e-6;
        let at = |t: f64| jacobian(model, &std::array::from_fn(|i| q[i] + t * qd[i]), &tool());
        let expected = (at(h) - at(-h)) / (2.0 * h);
        let found = jacobian_dot(model, &q, &qd, &tool());
        prop_assert!((found - expected).amax() < 1e-7, "{found} {expected}");
    }
}

#[test]
fn home_pose_of_the_irb1600() {
    let model = find("IRB1600-10/1.45").unwrap();
    let q = [0.0, 0.0, 0.0, 0.0, 30f64.to_radians(), 0.0];
    let pose = fk(&model, &q);
    // ABB's own home target: [806.29, 0, 1154], [0.5, 0, 0.866025, 0].
    let expected = Vector3::new(0.80629, 0.0, 1.154);
    assert!((pose.translation.vector - expected).norm() < 1e-5, "{pose}");
    assert!((pose.rotation.w - 0.5).abs() < 1e-6 && (pose.rotation.j - 0.866_025).abs() < 1e-6);
}
