//! Numerical inverse kinematics of arms without a closed solution: random joint angles are among
//! the solutions of their pose, and every solution has the pose.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod arms;

use arms::{pose_distance, same_angles};
use joulepath::arm::kinematics::{fk, ik_all, radical_inverse};
use joulepath::arm::robot::{Model, find, from_toml};

/// Tolerance of angles \[rad\].
const SAME_ANGLE: f64 = 1e-5;
/// Tolerance of poses \[m\] and \[rad\].
const SAME_POSE: f64 = 1e-8;
const BASES: [u32; 6] = [2, 3, 5, 7, 11, 13];

/// A collaborative arm with three parallel axes and no wrist centre.
const THREE_PARALLEL: &str = "name = \"three parallel\"\n\
    [[joint]]\norigin = [0, 0, 0.128]\naxis = [0, 0, 1]\n\
    [[joint]]\norigin = [0, 0.176, 0]\naxis = [0, 1, 0]\n\
    [[joint]]\norigin = [0, -0.128, 0.6127]\naxis = [0, 1, 0]\n\
    [[joint]]\norigin = [0, 0, 0.5716]\naxis = [0, 1, 0]\n\
    [[joint]]\norigin = [0, 0.1157, 0]\naxis = [0, 0, 1]\n\
    [[joint]]\norigin = [0, 0, 0.1157]\naxis = [0, 1, 0]\n\
    [kinematics.flange]\norigin = [0, 0.0922, 0]\nrpy = [-1.5707963267948966, 0, 0]\n\
    [limits]\nposition = [[-3,3],[-3,3],[-3,3],[-3,3],[-3,3],[-3,3]]\n";

/// The `n`-th joint angles of an even distribution in the ranges.
fn joints(model: &Model, n: u32) -> [f64; 6] {
    std::array::from_fn(|i| {
        let [low, high] = model.limits.position[i];
        low + radical_inverse(n, BASES[i]) * (high - low)
    })
}

/// Number of joint angles that are not among the solutions of their pose.
fn missed(model: &Model, count: u32) -> usize {
    let mut missed = 0;
    for n in 1..=count {
        let q = joints(model, n);
        let pose = fk(model, &q);
        let found = ik_all(model, &pose).unwrap_or_default();
        for (i, solution) in found.iter().enumerate() {
            assert!(pose_distance(&fk(model, solution), &pose) < SAME_POSE, "{solution:?}");
            assert!(
                !found[..i].iter().any(|other| same_angles(other, solution, SAME_ANGLE)),
                "{found:?}"
            );
        }
        missed += usize::from(!found.iter().any(|solution| same_angles(solution, &q, SAME_ANGLE)));
    }
    missed
}

#[test]
fn every_branch_of_an_offset_wrist_is_found() {
    for name in ["CRB15000-5/0.95", "CRB15000-10/1.52", "CRB15000-12/1.27"] {
        let model = find(name).unwrap();
        assert!(model.kinematics.offset_wrist.is_some());
        let missed = missed(&model, 1000);
        assert!(missed <= 1, "{name}: {missed} of 1000");
    }
}

#[test]
fn branches_without_a_wrist_centre_are_found() {
    let model = from_toml("test.toml", THREE_PARALLEL).unwrap();
    assert!(model.kinematics.offset_wrist.is_none() && model.kinematics.opw.is_none());
    assert_eq!(missed(&model, 300), 0);
}
