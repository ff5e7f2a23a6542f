//! Checks of sizes that no other test sees.

use super::build::nominal;
use super::everyday::Everyday;
use super::motion::{Style, track};
use super::spatial::second_moments;
use crate::examine::worlds::model::CAD;
use crate::examine::worlds::random::Rng;

/// The smooth error alone, share of the joint's torque: between 0.1 and 4 %, its median below 1.5 %.
#[test]
fn smooth_errors_are_small() {
    let mut shares = Vec::new();
    for number in 1..=40 {
        let mut rng = Rng::stream(5, number, "smooth");
        let arm = nominal(&mut rng, number, false);
        let everyday = Everyday::new(&arm, &mut rng);
        let track = track(Style::Fourier, &arm, 8.0, &mut rng);
        for (i, habit) in everyday.joints.iter().enumerate() {
            let (mut error, mut torque) = (0.0, 0.0);
            for at in track.points.iter().step_by(20) {
                error += habit.smooth(i, at, &arm, arm.rigid(at)[i]).powi(2);
                torque += arm.model(at, true)[i].powi(2);
            }
            shares.push(f64::sqrt(error / torque));
        }
    }
    shares.sort_by(f64::total_cmp);
    let at = |share: f64| shares[(share * shares.len() as f64) as usize];
    assert!(at(0.5) < 0.015 && at(0.05) > 0.001 && at(0.95) < 0.04, "{} {}", at(0.05), at(0.95));
}

/// Bodies that are off can still exist.
#[test]
fn inertias_are_physical() {
    for number in 1..=20 {
        let mut rng = Rng::stream(7, number, "bodies");
        let real = nominal(&mut rng, number, false).real(&CAD, &mut rng);
        assert!(
            real.bodies.iter().all(|body| second_moments(body).symmetric_eigenvalues().min() > 0.0)
        );
    }
}
