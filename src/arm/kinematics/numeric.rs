//! Inverse kinematics of six joints without a closed form, such as an arm without a spherical
//! wrist: damped least squares from many starts.
//!
//! Levenberg–Marquardt steps in the form of Y. Nakamura, H. Hanafusa, "Inverse kinematic solutions
//! with singularity robustness for robot manipulator control", J. Dyn. Sys., Meas., Control 108
//! (1986). All branches are found with high probability, but not certainly.

use std::f64::consts::{PI, TAU};

use nalgebra::{Isometry3, Matrix6, Vector6};

use crate::arm::robot::Model;

use super::closed_form::wrap;
use super::fk::fk;
use super::jacobian::jacobian;
use super::radical_inverse::radical_inverse;

/// Number of starts in the search for all solutions.
const STARTS: u32 = 160;
/// Largest number of steps per start.
const STEPS: usize = 80;
/// Pose error at convergence \[m\] and \[rad\].
const CONVERGED: f64 = 1e-11;
/// Accepted pose error after stagnation, at singular poses.
const ACCEPTED: f64 = 1e-9;
/// Angle difference below which two solutions are equal \[rad\].
const SAME: f64 = 1e-5;

/// The solution of the pose reached from `start`, if the steps converge.
pub(super) fn refine(model: &Model, pose: &Isometry3<f64>, start: &[f64; 6]) -> Option<[f64; 6]> {
    let mut q = *start;
    let mut error = pose_error(model, pose, &q);
    let mut damping = 1e-3;
    for _ in 0..STEPS {
        if error.norm() < CONVERGED {
            break;
        }
        let j = jacobian(model, &q, &Isometry3::identity());
        let normal = j * j.transpose() + Matrix6::identity() * (damping * error.norm().min(1.0));
        let step = j.transpose() * normal.cholesky()?.solve(&error);
        let next: [f64; 6] = std::array::from_fn(|i| q[i] + step[i].clamp(-0.5, 0.5));
        let left = pose_error(model, pose, &next);
        if left.norm() < error.norm() {
            (q, error) = (next, left);
            damping = (damping * 0.3).max(1e-9);
        } else {
            damping *= 4.0;
            if damping > 1e3 {
                break;
            }
        }
    }
    (error.norm() < ACCEPTED).then_some(q)
}

/// The found solutions of the pose, each angle in (−π, π].
pub(super) fn solutions(model: &Model, pose: &Isometry3<f64>) -> Vec<[f64; 6]> {
    const BASES: [u32; 6] = [2, 3, 5, 7, 11, 13];
    let mut found: Vec<[f64; 6]> = Vec::new();
    for n in 1..=STARTS {
        let start = BASES.map(|base| PI * (2.0 * radical_inverse(n, base) - 1.0));
        if let Some(q) = refine(model, pose, &start) {
            add_if_new(&mut found, &q);
        }
    }
    found
}

/// Adds a new solution.
pub(super) fn add_if_new(found: &mut Vec<[f64; 6]>, q: &[f64; 6]) {
    let same = |known: &[f64; 6]| {
        known.iter().zip(q).all(|(a, b)| {
            let d = (a - b).rem_euclid(TAU);
            d.min(TAU - d) < SAME
        })
    };
    if !found.iter().any(same) {
        found.push(q.map(wrap));
    }
}

/// Error of the pose at `q`: displacement \[m\] over rotation vector \[rad\], in the base frame.
fn pose_error(model: &Model, pose: &Isometry3<f64>, q: &[f64; 6]) -> Vector6<f64> {
    let now = fk(model, q);
    let linear = pose.translation.vector - now.translation.vector;
    let angular = (pose.rotation * now.rotation.inverse()).scaled_axis();
    Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
}
