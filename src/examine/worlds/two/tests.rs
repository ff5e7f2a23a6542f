//! Checks of the dynamics, of determinism and of the booking of faults; files for a comparison of torques.

use std::fmt::Write as _;

use crate::api::{HeldOut, Kind};
use crate::model_file;
use crate::rigid::MAX;
use crate::rng::Rng;
use crate::robot;
use crate::torque_case;
use crate::truth;

/// Writes rows and own torques beside robot files, to be compared with another program.
#[test]
fn files_for_comparison() {
    let Ok(folder) = std::env::var("WORLD_TWO_COMPARE") else { return };
    for number in 0..10 {
        let mut rng = Rng::new(7, number, "compare");
        let model = robot::draw(false, &mut rng);
        let n = model.arm.n();
        let (mut log, mut own) = (String::from("t"), String::new());
        for name in ["q", "qd", "qdd"] {
            for i in 1..=n {
                let _ = write!(log, ",{name}{i}");
            }
        }
        log.push('\n');
        for row in 0..50 {
            let (mut q, mut v, mut a) = ([0.0; MAX], [0.0; MAX], [0.0; MAX]);
            for i in 0..n {
                q[i] = rng.range(model.low[i], model.high[i]);
                v[i] = model.speed[i] * rng.range(0.05, 1.0) * rng.sign();
                a[i] = model.acceleration[i] * rng.range(-1.0, 1.0);
            }
            let _ = write!(log, "{}", f64::from(row) * 0.01);
            for x in [&q, &v, &a] {
                for value in x.iter().take(n) {
                    let _ = write!(log, ",{value:?}");
                }
            }
            log.push('\n');
            for rotor in [model.arm.rotor, [0.0; MAX]] {
                let tau = truth::model(&model, &rotor, &q, &v, &a);
                let mut power = 0.0;
                for i in 0..n {
                    power += tau[i] * v[i] + model.loss[i] * tau[i] * tau[i];
                    let _ = write!(own, "{:?},", tau[i]);
                }
                let shown = if power < 0.0 { power * model.regeneration } else { power };
                let _ = write!(own, "{:?};", shown + model.base_w);
            }
            own.push('\n');
        }
        let write = |name: &str, text: &str| {
            assert!(std::fs::write(format!("{folder}/{number}-{name}"), text).is_ok());
        };
        write("m.toml", &model_file::toml(&model, "m"));
        write("m.urdf", &model_file::urdf(&model, "m"));
        write("log.csv", &log);
        write("own.csv", &own);
    }
}

/// The mass matrix and the inverse dynamics are two ways to the same torques.
#[test]
fn mass_matrix_and_inverse_dynamics_agree() {
    let mut rng = Rng::new(3, 1, "mass");
    for _ in 0..20 {
        let model = robot::draw(false, &mut rng);
        let (mut q, mut v) = ([0.0; MAX], [0.0; MAX]);
        for i in 0..model.arm.n() {
            q[i] = rng.normal();
            v[i] = rng.normal();
        }
        let pose = model.arm.pose(&q);
        let mass = pose.mass_matrix();
        let bias = model.arm.inverse(&pose, &v, &[0.0; MAX]);
        for j in 0..model.arm.n() {
            let mut a = [0.0; MAX];
            a[j] = 1.0;
            let tau = model.arm.inverse(&pose, &v, &a);
            for i in 0..model.arm.n() {
                let gap = tau[i] - bias[i] - mass[(i, j)];
                assert!(gap.abs() < 1e-9 * (1.0 + mass[(i, i)] + tau[i].abs()), "{gap}");
            }
        }
    }
}

/// Bodies are bodies: the principal moments satisfy the triangle inequality.
#[test]
fn inertias_are_physical() {
    let mut rng = Rng::new(3, 1, "inertia");
    for _ in 0..50 {
        let model = robot::draw(false, &mut rng);
        let real = robot::perturbed(&model, &robot::CAD, &mut rng);
        for body in model.arm.bodies.iter().chain(&real.arm.bodies) {
            let moments = body.inertia.symmetric_eigenvalues();
            let most = moments.max();
            assert!(moments.min() > 0.0 && body.inertia.trace() - most >= most * (1.0 - 1e-9));
        }
    }
}

/// The same arguments give the same bytes.
#[test]
fn cases_are_deterministic() {
    for number in [1, 2, 3] {
        assert_eq!(crate::case(5, number), crate::case(5, number));
    }
}

/// Every effect gives finite torques and changes something; prints sizes with `--nocapture`.
#[test]
fn every_effect_changes_torques() {
    let rounds = std::env::var("WORLD_TWO_ROUNDS").ok().and_then(|x| x.parse().ok()).unwrap_or(1);
    for id in torque_case::ids() {
        for number in 0..rounds {
            let case = torque_case::case(11, number, Kind::One, Some(id));
            let most = |f: &dyn Fn(&HeldOut) -> f64| case.heldout.iter().map(f).fold(0.0, f64::max);
            let (size, left) = (most(&|h| h.effects / h.torque), most(&|h| h.effects / h.left));
            for effect in &case.effects {
                println!(
                    "{id:18} {size:8.4} {left:8.2} {:10.1} {:?} {}",
                    effect.nats, effect.joints, effect.form
                );
                assert!(effect.nats.is_finite() && effect.nats > 0.0 && size.is_finite());
            }
        }
    }
}

/// What is left beside the faults is the everyday error of the healthy robot: the contributions of
/// the faults are booked completely. Prints the largest ratio with `--nocapture`.
#[test]
fn what_is_left_is_everyday() {
    let rounds = std::env::var("WORLD_TWO_ROUNDS").ok().and_then(|x| x.parse().ok()).unwrap_or(1);
    for number in 0..rounds {
        let healthy = torque_case::case(11, number, Kind::Healthy, None);
        for id in torque_case::ids() {
            let case = torque_case::case(11, number, Kind::One, Some(id));
            let ratios: Vec<f64> =
                case.heldout.iter().zip(&healthy.heldout).map(|(a, b)| a.left / b.left).collect();
            let (low, high) = ratios.iter().fold((9.0_f64, 0.0_f64), |(l, h), x| (l.min(*x), h.max(*x)));
            println!("{number} {id:18} {low:6.2} {high:6.2}");
            assert!(low > 0.2 && high < 5.0, "{id} {low} {high}");
        }
    }
}
