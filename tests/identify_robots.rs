//! Identification of real robots from published logs. The logs are not part of the crate; without
//! them these tests print a note, and fail in CI.
#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]
#![expect(clippy::print_stderr, reason = "tests report figures and what they skip")]

#[path = "support/measurements.rs"]
mod measurements;
#[path = "support/real_logs.rs"]
mod real_logs;

use joulepath::arm::effects::from_toml;
use joulepath::arm::robot::{import_urdf, to_toml};
use joulepath::learn::identify::{Free, Identified, Settings, Weighting, identify};
use measurements::shared;
use real_logs::{PANDA, RealRobot, TX40, UR10, log, split};

/// Training shares of the time; the rest is predicted. The first is compared with known results.
const TRAINED: [[f64; 2]; 3] = [[0.0, 0.7], [0.3, 1.0], [0.0, 0.5]];
/// Largest ratio of residuals, written model to unconstrained fit, over all joints.
const CONSISTENT: f64 = 1.02;

fn identified(robot: &RealRobot) -> Option<Identified> {
    let (urdf, csv) = (shared(robot.urdf)?, shared(robot.csv)?);
    let model = from_toml(robot.urdf, &import_urdf(robot.urdf, &urdf).unwrap()).unwrap();
    let log = log(&model, &csv, robot);
    let count = log.time().len();
    let mut first = None;
    for share in TRAINED {
        let [from, to] = share.map(|share| (share * count as f64) as usize);
        let rest = if from == 0 { to..count } else { 0..from };
        let [training, held_out] = split(&model, &log, [from..to, rest]);
        let settings =
            Settings { free: Free::All, weighting: Weighting::Joint, source: "a test".into() };
        let found = identify(&model, &training, &[held_out], &settings).unwrap();
        assert!(found.physically_consistent);
        assert_eq!(found.quality.late, None);
        assert_close_to_the_unconstrained_fit(robot.urdf, &found);
        // The written model is read without a change.
        let again = from_toml("written", &to_toml(&found.model)).unwrap();
        assert_eq!(again.sensors, found.model.sensors);
        first.get_or_insert(found);
    }
    first
}

/// The written model compared with the unconstrained fit, on held-out time.
fn assert_close_to_the_unconstrained_fit(name: &str, found: &Identified) {
    let free = &found.unconstrained_validation.as_ref().unwrap().rms;
    let written = &found.validation.as_ref().unwrap().rms;
    let ratios: Vec<f64> = written.iter().zip(free).map(|(a, b)| a / b).collect();
    let all = (ratios.iter().map(|r| r * r).sum::<f64>() / ratios.len() as f64).sqrt();
    let sensors = &found.model.sensors;
    eprintln!(
        "{name}: {all:.3} times the free fit's, by joint {ratios:.3?}; apparent inertia {:.3?}, viscous \
         {:.3?}; {}; white {:?}",
        sensors.apparent_inertia,
        sensors.apparent_viscous,
        found.quality.sentence(),
        found.fit.whiteness.iter().flatten().map(|of| of.outside).collect::<Vec<_>>()
    );
    assert!(all < CONSISTENT, "{name}: {all}");
}

/// Held-out errors compared with those known for ordinary least squares.
fn compare(name: &str, found: &Identified, known: &[f64]) {
    let free = &found.unconstrained_validation.as_ref().unwrap().rms;
    let written = &found.validation.as_ref().unwrap().rms;
    eprintln!("{name}: held out {free:.2?}, of the written model {written:.2?}, known {known:?}");
    for (joint, (rms, known)) in free.iter().zip(known).enumerate() {
        assert!(rms <= known, "{name}, joint {}: {rms} {known}", joint + 1);
    }
}

#[test]
fn staubli_tx40_has_the_published_friction_and_a_coupled_wrist() {
    let Some(found) = identified(&TX40) else { return };
    compare("TX40", &found, &[2.6, 3.0, 1.5, 0.70, 1.33, 0.70]);
    assert_eq!(found.fit.solution.determined.len(), 58);
    let coupling = found.coupling.unwrap();
    let beta = |name: &str| {
        let all = &found.fit.solution.determined;
        let row = all.iter().find(|row| found.base.name(**row) == name).unwrap();
        found.fit.solution.beta[*row]
    };
    // Axis 5 also carries the friction of motor 6.
    let fifth = beta("fv5") + coupling * coupling * beta("fv6");
    let viscous = [beta("fv1"), beta("fv2"), beta("fv3"), beta("fv4"), fifth, beta("fv6")];
    for (found, known) in viscous.into_iter().zip([8.05, 5.53, 1.97, 1.11, 1.86, 0.65]) {
        assert!((found / known - 1.0).abs() < 0.10, "{found} {known}");
    }
    let fifth = beta("ia5") + coupling * coupling * beta("ia6");
    for (found, known) in [
        (beta("fc1"), 7.14),
        (beta("fc2"), 8.26),
        (beta("fc3"), 6.34),
        (beta("fc4"), 2.48),
        (beta("fc5"), 3.03),
        (beta("ia3"), 0.0988),
        (beta("ia4"), 0.0313),
        (fifth, 0.0468),
        (beta("ia6"), 0.0105),
        (coupling * beta("fv6"), 0.605),
        (beta("fc6"), 2.03),
        (coupling * beta("ia6"), 0.00865),
    ] {
        assert!((found / known - 1.0).abs() < 0.30, "{found} {known}");
    }
}

#[test]
fn a_ur10_is_predicted_within_the_known_errors() {
    let Some(found) = identified(&UR10) else { return };
    assert_eq!(found.coupling, None);
    // For joint 4, 0.56 is known from another part of the time.
    compare("UR10", &found, &[3.2, 3.5, 2.0, 0.85, 0.60, 2.0]);
}

#[test]
fn a_panda_is_predicted_within_the_known_errors() {
    let Some(found) = identified(&PANDA) else { return };
    // For joint 4, 0.17 is known from another part of the time.
    compare("Panda", &found, &[0.28, 0.18, 0.23, 0.19, 0.15, 0.11, 0.08]);
}
