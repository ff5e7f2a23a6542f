//! Forward and inverse kinematics compared with each other, with finite differences and with an
//! independent solver.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod arms;

use arms::{pose_distance, same_angles};
use insta::assert_snapshot;
use joulepath::arm::kinematics::{
    Conf, IkError, Tcp, conf_of, fk, ik_all, ik_conf, ik_near, jacobian, limits_ok,
    radical_inverse, singularity,
};
use joulepath::arm::robot::{Coupling, Model, find, from_toml};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use proptest::prelude::*;

/// Tolerance of angles \[rad\].
const SAME_ANGLE: f64 = 1e-8;
/// Tolerance of poses \[m\] and \[rad\].
const SAME_POSE: f64 = 1e-10;

/// Serial arms with and without an elbow offset, and one with rods.
fn robots() -> [Model; 3] {
    let rods = "extends = \"IRB6640-180/2.55\"\nname = \"rods\"\n\
                [kinematics]\ncoupling = \"parallelogram\"\n";
    [irb1600(), find("IRB6640-180/2.55").unwrap(), from_toml("rods.toml", rods).unwrap()]
}

fn irb1600() -> Model {
    find("IRB1600-10/1.45").unwrap()
}

fn tool() -> Isometry3<f64> {
    Isometry3::from_parts(
        Translation3::new(0.075, -0.02, 0.493),
        UnitQuaternion::from_euler_angles(0.3, 0.5, -0.2),
    )
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
    #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

    #[test]
    fn inverse_kinematics_contain_the_original_angles(shares in shares(), which in 0usize..3) {
        let model = &robots()[which];
        let q = inside(model, shares);
        let pose = fk(model, &q);
        let all = ik_all(model, &pose).unwrap();
        for solution in &all {
            prop_assert!(pose_distance(&fk(model, solution), &pose) < SAME_POSE);
        }
        let hit = all.iter().any(|solution| same_angles(solution, &q, SAME_ANGLE));
        prop_assert!(hit, "{q:?} not in {all:?}");
    }

    #[test]
    fn the_configuration_selects_the_original_angles(shares in shares(), which in 0usize..2) {
        let model = &robots()[which];
        let q = inside(model, shares);
        let found = ik_conf(model, &fk(model, &q), conf_of(model, &q)).unwrap();
        for (a, b) in found.iter().zip(&q) {
            prop_assert!((a - b).abs() < SAME_ANGLE, "{found:?} {q:?}");
        }
    }

    #[test]
    fn branches_have_different_cfx(shares in shares(), which in 0usize..2) {
        let model = &robots()[which];
        let all = ik_all(model, &fk(model, &inside(model, shares))).unwrap();
        let mut cfx: Vec<i32> = all.iter().map(|q| conf_of(model, q).cfx).collect();
        cfx.sort_unstable();
        cfx.dedup();
        prop_assert_eq!(cfx.len(), all.len());
        prop_assert!(cfx.iter().all(|cfx| (0..8).contains(cfx)));
    }

    #[test]
    fn nearest_solution_stays_on_its_branch(shares in shares(), step in prop::array::uniform6(-1e-3..1e-3)) {
        let model = irb1600();
        let q = inside(&model, shares).map(|angle| 0.99 * angle);
        let near: [f64; 6] = std::array::from_fn(|i| q[i] + step[i]);
        // Within a step of a singularity another branch may be the nearest one.
        let apart = singularity(&model, &q).unwrap();
        let least = apart.wrist.min(apart.elbow).min(apart.shoulder);
        prop_assume!(least > 0.05 && limits_ok(&model, &q).is_ok());
        let found = ik_near(&model, &fk(&model, &q), &near).unwrap();
        for (a, b) in found.iter().zip(&q) {
            prop_assert!((a - b).abs() < SAME_ANGLE, "{found:?} {q:?}");
        }
    }

    #[test]
    fn jacobian_is_the_derivative_of_the_pose(shares in shares(), which in 0usize..3) {
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
    fn jacobian_dot_is_the_derivative_of_the_jacobian(
        shares in shares(),
        qd in prop::array::uniform6(-3.0..3.0),
        which in 0usize..3,
    ) {
        let model = &robots()[which];
        let q = inside(model, shares);
        let h = 1e-6;
        let at = |t: f64| jacobian(model, &std::array::from_fn(|i| q[i] + t * qd[i]), &tool());
        let expected = (at(h) - at(-h)) / (2.0 * h);
        let found = Tcp::Held(tool()).jacobian_dot(model, &q, &qd);
        prop_assert!((found - expected).amax() < 1e-7, "{found} {expected}");
    }
}

#[test]
fn the_irb1600_has_the_known_home_pose() {
    let model = irb1600();
    let q = [0.0, 0.0, 0.0, 0.0, 30f64.to_radians(), 0.0];
    let pose = fk(&model, &q);
    // ABB's own home target: [806.29, 0, 1154], [0.5, 0, 0.866025, 0].
    let expected = Vector3::new(0.80629, 0.0, 1.154);
    assert!((pose.translation.vector - expected).norm() < 1e-5, "{pose}");
    assert!((pose.rotation.w - 0.5).abs() < 1e-6 && (pose.rotation.j - 0.866_025).abs() < 1e-6);
}

fn deg(degrees: [f64; 6]) -> [f64; 6] {
    degrees.map(f64::to_radians)
}

/// The wrist centre of the IRB1600 is above axis 1 \[deg\].
fn shoulder_singular() -> [f64; 6] {
    let q2 = -(0.15_f64 / 0.7).asin().to_degrees();
    [10.0, q2, -90.0 - q2, 10.0, 20.0, 30.0]
}

/// At poses with coinciding solutions, each solution gives the pose.
#[test]
fn solutions_of_singular_poses_give_the_pose() {
    let shoulder = shoulder_singular();
    for degrees in [
        [0.0; 6],
        [10.0, 20.0, 30.0, 40.0, 0.0, 50.0],
        [10.0, 30.0, -90.0, 40.0, 30.0, 50.0],
        [10.0, 30.0, -90.0, 40.0, 0.0, 50.0],
        shoulder,
    ] {
        for model in robots() {
            let pose = fk(&model, &deg(degrees));
            for q in ik_all(&model, &pose).unwrap() {
                assert!(pose_distance(&fk(&model, &q), &pose) < 1e-7, "{}: {q:?}", model.name);
            }
        }
    }
}

/// Random arms of the whole catalogue in one, two or three singularities at once, and at the limit
/// of their reach.
#[test]
fn angles_in_singularities_are_finite_for_every_robot() {
    for name in joulepath::arm::robot::names() {
        let model = find(name).unwrap();
        if model.dof != 6 {
            continue;
        }
        for n in 1..=24 {
            let turn = |base: u32| 6.0 * radical_inverse(n, base) - 3.0;
            let mut q = [turn(2), turn(3), turn(5), turn(7), turn(11), turn(13)];
            if n % 2 == 0 {
                q[4] = 0.0;
            }
            if n % 3 == 0 {
                // Extended: the forearm continues the upper arm.
                let bend = model
                    .kinematics
                    .opw
                    .as_ref()
                    .map_or(0.0, |opw| -opw.a2.atan2(opw.c3) + opw.signs[2] * opw.offsets[2]);
                q[2] = bend + if model.kinematics.coupling == Coupling::None { 0.0 } else { q[1] };
            }
            if n % 5 == 0 {
                q[1] = 0.0;
            }
            let pose = fk(&model, &q);
            for found in ik_all(&model, &pose).unwrap_or_default() {
                assert!(found.iter().all(|x| x.is_finite()), "{name} {q:?}: {found:?}");
                assert!(
                    pose_distance(&fk(&model, &found), &pose) < 1e-6,
                    "{name} {q:?}: {found:?}"
                );
            }
            let near = ik_near(&model, &pose, &q);
            assert!(
                near.is_ok_and(|found| found.iter().all(|x| x.is_finite()))
                    || limits_ok(&model, &q).is_err(),
                "{name} {q:?}"
            );
            // With the wrist centre on axis 1, the other quarter turns depend on its angle.
            let on_axis = singularity(&model, &q).is_some_and(|found| found.shoulder < 1e-6);
            match ik_conf(&model, &pose, conf_of(&model, &q)) {
                Ok(found) => assert!(found.iter().all(|x| x.is_finite()), "{name} {q:?}"),
                Err(why) => {
                    assert!(on_axis || limits_ok(&model, &q).is_err(), "{name} {q:?}: {why}");
                }
            }
            if let Some(measures) = singularity(&model, &q) {
                let all = [measures.wrist, measures.elbow, measures.shoulder];
                assert!(all.iter().all(|x| x.is_finite()), "{name} {q:?}");
            }
        }
    }
}

#[test]
fn a_wrist_singularity_keeps_joint_4() {
    let model = irb1600();
    let q = deg([10.0, 20.0, 30.0, 70.0, 0.0, 50.0]);
    let found = ik_near(&model, &fk(&model, &q), &q).unwrap();
    assert!(found.iter().zip(&q).all(|(a, b)| (a - b).abs() < SAME_ANGLE), "{found:?}");
    // The configuration requires joint 4 in its second quarter turn.
    let conf = Conf { cf1: 0, cf4: 1, cf6: 0, cfx: 0 };
    let found = ik_conf(&model, &fk(&model, &q), conf).unwrap();
    assert!((found[3].to_degrees() - 90.0).abs() < 1e-6, "{found:?}");
    assert!(pose_distance(&fk(&model, &found), &fk(&model, &q)) < 1e-8);
}

#[test]
fn configurations_count_whole_turns() {
    let model = irb1600();
    for degrees in [
        [-134.0, 48.0, -36.0, 190.0, 75.0, -333.0],
        [134.0, -48.0, -200.0, -195.0, -75.0, 395.0],
        [0.5, 10.0, 20.0, 91.0, 30.0, 179.0],
    ] {
        let q = deg(degrees);
        let found = ik_conf(&model, &fk(&model, &q), conf_of(&model, &q)).unwrap();
        assert!(found.iter().zip(&q).all(|(a, b)| (a - b).abs() < SAME_ANGLE), "{found:?}");
    }
}

#[test]
fn angles_at_an_edge_belong_to_both_quarter_turns() {
    let model = irb1600();
    let q = deg([0.0, 10.0, 20.0, 0.0, 30.0, 90.0]);
    let pose = fk(&model, &q);
    for (cf1, cf4, cf6) in [(0, 0, 1), (-1, 0, 1), (0, -1, 1), (0, 0, 0), (-1, -1, 0)] {
        let found = ik_conf(&model, &pose, Conf { cf1, cf4, cf6, cfx: 0 }).unwrap();
        assert!(found.iter().zip(&q).all(|(a, b)| (a - b).abs() < SAME_ANGLE), "{found:?}");
    }
}

#[test]
fn poses_without_a_solution_have_a_reason() {
    let model = irb1600();
    let pose = |x: f64, y: f64, z: f64| {
        Isometry3::from_parts(
            Translation3::new(x, y, z),
            UnitQuaternion::from_euler_angles(0.0, std::f64::consts::PI, 0.0),
        )
    };
    let conf = Conf { cf1: 0, cf4: 0, cf6: 0, cfx: 0 };
    let why = |pose: Isometry3<f64>, conf| ik_conf(&model, &pose, conf).unwrap_err().to_string();
    let low = deg([100.0, 130.0, -120.0, 10.0, 20.0, 30.0]);
    let messages = [
        why(pose(1.6, 0.3, 0.5), conf),
        why(fk(&model, &low), conf_of(&model, &low)),
        why(pose(1.0, 0.3, 0.5), Conf { cf6: 3, ..conf }),
        why(pose(-0.3, 0.1, 0.2), Conf { cf1: 1, cfx: 2, ..conf }),
        why(pose(f64::NAN, 0.3, 0.5), conf),
    ];
    assert_snapshot!(messages.join(
        "
"
    ));

    let chain = "name = \"chain\"\n[[joint]]\norigin = [0, 0, 0]\naxis = [0, 0, 1]\n\
                 [limits]\nposition = [[-1, 1]]\n";
    let chain = from_toml("chain.toml", chain).unwrap();
    assert_eq!(
        ik_all(&chain, &Isometry3::identity()),
        Err(IkError::NoInverse { robot: "chain".into() })
    );
}

#[test]
fn nearest_solution_follows_a_line_through_half_a_turn() {
    let model = irb1600();
    let start = deg([0.0, 20.0, 10.0, 170.0, 60.0, 350.0]);
    let pose = fk(&model, &start);
    let mut q = start;
    for step in 1..=200 {
        // 0.4 m to the side during a quarter turn of the tool.
        let share = f64::from(step) / 200.0;
        let shift = Translation3::new(0.0, 0.4 * share, 0.0);
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -1.5 * share);
        let goal = Isometry3::from_parts(
            Translation3::from(shift.vector + pose.translation.vector),
            pose.rotation * turn,
        );
        let next = ik_near(&model, &goal, &q).unwrap();
        assert!(pose_distance(&fk(&model, &next), &goal) < SAME_POSE);
        assert!(next.iter().zip(&q).all(|(a, b)| (a - b).abs() < 0.05), "{next:?} {q:?}");
        q = next;
    }
}

#[test]
fn singularity_measures_vanish_in_their_singularity() {
    let model = irb1600();
    let at = |degrees| singularity(&model, &deg(degrees)).unwrap();
    assert!(at([10.0, 20.0, 30.0, 40.0, 0.0, 50.0]).wrist < 1e-12);
    assert!(at([10.0, 20.0, -90.0, 40.0, 10.0, 50.0]).elbow < 1e-12);
    assert!(at(shoulder_singular()).shoulder < 1e-12);
    let general = at([10.0, 20.0, 30.0, 40.0, 30.0, 50.0]);
    assert!((general.wrist - 0.5).abs() < 1e-12 && general.elbow > 0.5 && general.shoulder > 0.5);
}
