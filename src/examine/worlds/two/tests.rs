//! Checks of the dynamics and of the booking of faults.

use super::rigid::Arm;
use super::{robot, torque_case};
use crate::examine::worlds::api::{HeldOut, Kind, single};
use crate::examine::worlds::model::{CAD, MAX};
use crate::examine::worlds::random::Rng;

/// The mass matrix and the inverse dynamics are two ways to the same torques.
#[test]
fn mass_matrix_and_inverse_dynamics_agree() {
    let mut rng = Rng::stream(3, 1, "mass");
    for _ in 0..20 {
        let arm: Arm = robot::draw(false, &mut rng).arm;
        let q = [0.0; MAX].map(|_| rng.normal());
        let v = [0.0; MAX].map(|_| rng.normal());
        let pose = arm.pose(&q);
        let mass = pose.mass_matrix();
        let bias = arm.inverse(&pose, &v, &[0.0; MAX]);
        for j in 0..arm.n() {
            let tau = arm.inverse(&pose, &v, &single(j, 1.0));
            for i in 0..arm.n() {
                let gap = tau[i] - bias[i] - mass[(i, j)];
                assert!(gap.abs() < 1e-9 * (1.0 + mass[(i, i)] + tau[i].abs()), "{gap}");
            }
        }
    }
}

/// Bodies are bodies: the principal moments satisfy the triangle inequality.
#[test]
fn inertias_are_physical() {
    let mut rng = Rng::stream(3, 1, "inertia");
    for _ in 0..50 {
        let model = robot::draw(false, &mut rng);
        let real = robot::perturbed(&model, &CAD, &mut rng);
        for body in model.arm.bodies.iter().chain(&real.arm.bodies) {
            let moments = body.inertia.symmetric_eigenvalues();
            let most = moments.max();
            assert!(moments.min() > 0.0 && body.inertia.trace() - most >= most * (1.0 - 1e-9));
        }
    }
}

/// Effects of which each acts in its own place of the equations.
const EFFECTS: [&str; 5] = ["stribeck", "payload", "elasticity", "presliding", "time_delay"];

/// An effect changes something, and what is left beside it is the everyday error of the healthy
/// robot: the contributions of the faults are booked completely.
#[test]
fn effects_are_booked_completely() {
    let healthy = torque_case::case(11, 0, Kind::Healthy, None);
    for id in EFFECTS {
        let case = torque_case::case(11, 0, Kind::One, Some(id));
        let most = |f: &dyn Fn(&HeldOut) -> f64| case.heldout.iter().map(f).fold(0.0, f64::max);
        let size = most(&|h| h.effects / h.torque);
        assert!(size > 0.0 && case.effects[0].nats > 0.0, "{id} {size} {:?}", case.effects[0]);
        for (with, without) in case.heldout.iter().zip(&healthy.heldout) {
            let ratio = with.left / without.left;
            assert!((0.2..5.0).contains(&ratio), "{id} {ratio}");
        }
    }
}
