//! Identification compared with simulated robots, other solvers and statistics.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]
#![expect(clippy::print_stderr, reason = "tests report figures")]

mod currents;
#[path = "../support/excited.rs"]
mod excited;
mod simulated;

use joulepath::arm::dynamics::{
    BaseParameters, Load, Regressor, base_parameters, parameters, write_rows,
};
use joulepath::arm::effects::from_toml;
use joulepath::arm::robot::{Model, to_toml};
use joulepath::learn::identify::{
    Equations, Fit, Free, Hints, IdentifyError, Known, Samples, Settings, Source, Weighting, fit,
    identify, prepare, torques,
};
use joulepath::learn::log::{Channel, Log};
use nalgebra::{DMatrix, DVector};

use excited::{irb1600, series};
use simulated::{With, log};

/// Relative tolerance for noiseless data and for two solvers.
const EXACT: f64 = 1e-8;
/// Standard deviations that one of 58 estimates exceeds with a probability of 1/5,000.
const SD_OF_ALL: f64 = 4.5;
/// Accepted coverage of the 95 % intervals.
const COVERED: std::ops::RangeInclusive<f64> = 0.93..=0.97;

fn samples(log: &Log, model: &Model) -> Samples {
    let tau = torques(model, log).unwrap();
    prepare(log, &tau.tau, Hints::default()).unwrap()
}

fn settings(free: Free, weighting: Weighting) -> Settings {
    Settings { free, weighting, source: "a test".into() }
}

fn truth(model: &Model, base: &BaseParameters) -> Vec<f64> {
    base.of_parameters(&parameters(model, &Load::none()))
}

fn fitted(model: &Model, base: &BaseParameters, samples: &Samples, weighting: Weighting) -> Fit {
    fit(&Equations { model, base, known: Known::Nothing }, samples, weighting).unwrap()
}

#[test]
fn noiseless_data_give_the_exact_parameters() {
    let model = irb1600();
    let base = base_parameters(&model);
    let mut random = fastrand::Rng::with_seed(1);
    let log = log(&model, &series(1), [10.0, 0.01], With::Rates, [0.0, 0.0], &mut random);
    let found = fitted(&model, &base, &samples(&log, &model), Weighting::Joint);
    assert_eq!(found.solution.determined.len(), 58);
    let scale = truth(&model, &base).iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    for (found, truth) in found.solution.beta.iter().zip(truth(&model, &base)) {
        assert!((found - truth).abs() < EXACT * scale, "{found} {truth}");
    }
}

#[test]
fn arrays_that_do_not_fit_are_refused() {
    let model = irb1600();
    let mut random = fastrand::Rng::with_seed(1);
    let log = log(&model, &series(1), [10.0, 0.01], With::Rates, [0.0, 0.0], &mut random);
    let tau = torques(&model, &log).unwrap().tau;
    let short: Vec<Vec<f64>> = tau.iter().map(|tau| tau[..3].to_vec()).collect();
    let mut not_finite = tau.clone();
    not_finite[2][7] = f64::NAN;
    for (wrong, expected) in [
        (&[][..], IdentifyError::Torques { joints: 0, logged: 6 }),
        (&tau[..5], IdentifyError::Torques { joints: 5, logged: 6 }),
        (&short, IdentifyError::TorqueRows { joint: 1, rows: 3, logged: log.time().len() }),
        (&not_finite, IdentifyError::NotFinite { joint: 3, row: 8 }),
    ] {
        assert_eq!(prepare(&log, wrong, Hints::default()).err(), Some(expected));
    }
    let mut other = prepare(&log, &tau, Hints::default()).unwrap();
    other.rest.pop();
    let refused = identify(&model, &other, &[], &settings(Free::All, Weighting::Joint)).err();
    assert_eq!(refused, Some(IdentifyError::OtherRobot { logged: 5, dof: 6 }));
}

/// Ordinary least squares of all rows, by a singular value decomposition.
#[test]
fn ordinary_least_squares_agree_with_a_dense_solver() {
    let model = irb1600();
    let base = base_parameters(&model);
    let mut random = fastrand::Rng::with_seed(2);
    let log = log(&model, &series(2), [10.0, 0.05], With::Rates, [5.0, 0.0], &mut random);
    let found = fitted(&model, &base, &samples(&log, &model), Weighting::Ordinary);
    let count = log.time().len();
    let mut all = DMatrix::zeros(6 * count, 84);
    let mut right = DVector::zeros(6 * count);
    let mut scratch = Regressor::new();
    for row in 0..count {
        let at = |channel: fn(usize) -> Channel| -> Vec<f64> {
            log.of_joints(channel).unwrap().iter().map(|x| x[row]).collect()
        };
        let (q, qd, qdd) =
            (at(Channel::Position), at(Channel::Velocity), at(Channel::Acceleration));
        write_rows(&model, &mut scratch, [&q, &qd, &qdd], &mut all, 6 * row);
        right.rows_mut(6 * row, 6).copy_from_slice(&at(Channel::Torque));
    }
    let dense = all.select_columns(&base.independent);
    let expected = dense.svd(true, true).solve(&right, 1e-12).unwrap();
    for (found, expected) in found.solution.beta.iter().zip(expected.iter()) {
        assert!((found - expected).abs() < EXACT * expected.abs().max(1.0), "{found} {expected}");
    }
}

/// Coverage of the intervals in many simulated runs.
fn coverage(runs: u64, simulate: impl Fn(&mut fastrand::Rng) -> Samples) -> (f64, f64) {
    let model = irb1600();
    let base = base_parameters(&model);
    let truth = truth(&model, &base);
    let mut held = vec![0_u64; truth.len()];
    for run in 0..runs {
        let samples = simulate(&mut fastrand::Rng::with_seed(100 + run));
        let found = fitted(&model, &base, &samples, Weighting::Joint);
        for (k, column) in found.solution.determined.iter().enumerate() {
            let sd = found.covariance[(k, k)].sqrt();
            let off = (found.solution.beta[*column] - truth[*column]).abs();
            held[*column] += u64::from(off <= 1.959_964 * sd);
        }
    }
    let share = |held: u64| held as f64 / runs as f64;
    let worst = held.iter().map(|h| share(*h)).fold(1.0, f64::min);
    (held.iter().map(|h| share(*h)).sum::<f64>() / held.len() as f64, worst)
}

#[test]
fn intervals_contain_the_truth_with_white_noise() {
    let model = irb1600();
    let motion = series(3);
    let (mean, worst) = coverage(500, |random| {
        samples(&log(&model, &motion, [10.0, 0.04], With::Rates, [3.0, 0.0], random), &model)
    });
    eprintln!("500 runs, white noise: {mean:.4} of the intervals hold, {worst:.3} of the worst");
    assert!(COVERED.contains(&mean), "{mean}");
}

#[test]
fn intervals_contain_the_truth_with_coloured_noise_and_repetitions() {
    let model = irb1600();
    let motion = series(4);
    let (mean, worst) = coverage(200, |random| {
        let log = log(&model, &motion, [40.0, 0.02], With::Positions, [3.0, 0.7], random);
        let samples = samples(&log, &model);
        assert!(matches!(samples.source, Source::Periodic { periods: 4, .. }));
        samples
    });
    eprintln!("200 runs, repetitions: {mean:.4} of the intervals hold, {worst:.3} of the worst");
    assert!(COVERED.contains(&mean), "{mean}");
}

#[test]
fn intervals_contain_the_truth_with_coloured_noise_of_one_run() {
    let model = irb1600();
    let motion = series(5);
    let (mean, worst) = coverage(200, |random| {
        samples(&log(&model, &motion, [20.0, 0.02], With::Rates, [3.0, 0.7], random), &model)
    });
    eprintln!("200 runs, coloured noise: {mean:.4} of the intervals hold, {worst:.3} of the worst");
    assert!(COVERED.contains(&mean), "{mean}");
}

/// The predictions of a model do not change when it is written and read.
#[test]
fn an_identified_model_is_unchanged_after_writing_and_reading() {
    let model = irb1600();
    let mut random = fastrand::Rng::with_seed(6);
    let log = log(&model, &series(6), [10.0, 0.02], With::Rates, [1.0, 0.0], &mut random);
    let samples = samples(&log, &model);
    let found = identify(&model, &samples, &[], &settings(Free::All, Weighting::Joint)).unwrap();
    assert!(found.physically_consistent);
    let read = from_toml("identified.toml", &to_toml(&found.model)).unwrap();
    let values = |model: &Model| parameters(model, &Load::none());
    for (a, b) in values(&read).iter().zip(values(&found.model)) {
        assert!((a - b).abs() < 1e-12, "{a} {b}");
    }
    assert_eq!(read.sensors, found.model.sensors);
    let ratio = found.training.rms.iter().zip(&found.fit.rms).map(|(a, b)| a / b);
    assert!(ratio.fold(0.0, f64::max) < 1.02);
}

#[test]
fn parameters_of_a_resting_joint_are_not_determined() {
    let model = irb1600();
    let mut motion = series(7);
    for pair in &mut motion.amplitude[3] {
        *pair = [0.0; 2];
    }
    let mut random = fastrand::Rng::with_seed(7);
    let mut log = log(&model, &motion, [10.0, 0.02], With::Rates, [1.0, 0.0], &mut random);
    // Encoder noise is not a motion.
    for value in &mut log.values[4] {
        *value += 1e-5 * crate::excited::normal(&mut random);
    }
    let samples = samples(&log, &model);
    assert_eq!(samples.resting, [3]);
    let found = identify(&model, &samples, &[], &settings(Free::All, Weighting::Joint)).unwrap();
    let undetermined = found.fit.solution.dependent.iter();
    let names: Vec<String> = undetermined.map(|(row, _)| found.base.name(*row)).collect();
    for name in ["fv4", "fc4", "offset4"] {
        assert!(names.contains(&name.to_owned()), "{names:?}");
    }
    // Unidentified values do not change.
    assert_eq!(found.model.friction.viscous[3], model.friction.viscous[3]);
    assert_eq!(found.model.friction.coulomb[3], model.friction.coulomb[3]);
}

/// With the arm at rest, wrist inertias and rotors cannot be separated: the values are sums, and
/// their names state it.
#[test]
fn names_of_combined_parameters_state_their_sum() {
    let model = irb1600();
    let mut motion = series(7);
    for joint in &mut motion.amplitude[..4] {
        joint.fill([0.0; 2]);
    }
    let mut random = fastrand::Rng::with_seed(10);
    let log = log(&model, &motion, [20.0, 0.01], With::Rates, [0.1, 0.0], &mut random);
    let samples = samples(&log, &model);
    let found = identify(&model, &samples, &[], &settings(Free::All, Weighting::Joint)).unwrap();
    let (solution, truth) = (&found.fit.solution, truth(&model, &found.base));
    let mut sums = 0;
    for (k, row) in solution.determined.iter().enumerate() {
        let mut expected = truth[*row];
        for (column, parts) in &solution.dependent {
            for (_, factor) in parts.iter().filter(|(of, _)| of == row) {
                expected += factor * truth[*column];
            }
        }
        let sd = found.fit.covariance[(k, k)].sqrt();
        let off = (solution.beta[*row] - expected) / sd;
        assert!(off.abs() < SD_OF_ALL, "{}: {off}", found.name(*row));
        let alone = (solution.beta[*row] - truth[*row]) / sd;
        if alone.abs() > SD_OF_ALL {
            assert_ne!(found.name(*row), found.base.name(*row));
            sums += 1;
        }
    }
    assert!(sums > 0);
}

#[test]
fn friction_alone_and_a_payload_are_found() {
    let model = irb1600();
    let mut other = model.clone();
    other.friction.viscous.iter_mut().for_each(|v| *v *= 1.3);
    other.friction.coulomb.iter_mut().for_each(|c| *c *= 0.8);
    let mut random = fastrand::Rng::with_seed(8);
    let noisy = [0.5, 0.0];
    let log_of = |robot: &Model, random: &mut fastrand::Rng| {
        log(robot, &series(8), [10.0, 0.01], With::Rates, noisy, random)
    };
    let worn = samples(&log_of(&other, &mut random), &model);
    let found = identify(&model, &worn, &[], &settings(Free::Friction, Weighting::Joint)).unwrap();
    for joint in 0..6 {
        let (a, b) = (found.model.friction.viscous[joint], other.friction.viscous[joint]);
        assert!((a / b - 1.0).abs() < 0.03, "{a} {b}");
    }
    assert_eq!(found.model.links, model.links);

    let text = to_toml(&model) + "\n[effects.payload]\nmass = 4.0\ncom_z = 0.12\n";
    let loaded = from_toml("loaded.toml", &text).unwrap();
    let carried = samples(&log_of(&loaded, &mut random), &model);
    let found =
        identify(&model, &carried, &[], &settings(Free::Payload, Weighting::Joint)).unwrap();
    let load = found.payload.unwrap();
    assert!((load.mass - 4.0).abs() < 0.1, "{load:?}");
    assert!((load.com.z - 0.12).abs() < 0.01 && load.com.xy().norm() < 0.01, "{load:?}");
}

#[test]
fn a_wrist_coupling_is_found_only_where_there_is_one() {
    let model = irb1600();
    let mut coupled = model.clone();
    coupled.wrist.coupling = 0.8;
    let mut random = fastrand::Rng::with_seed(9);
    for (robot, expected) in [(&coupled, Some(0.8)), (&model, None)] {
        let log = log(robot, &series(9), [10.0, 0.01], With::Rates, [1.0, 0.0], &mut random);
        let samples = samples(&log, &model);
        let found =
            identify(&model, &samples, &[], &settings(Free::All, Weighting::Joint)).unwrap();
        match (found.coupling, expected) {
            (Some(found), Some(expected)) => assert!((found - expected).abs() < 0.02, "{found}"),
            (found, expected) => assert_eq!(found, expected),
        }
    }
}

/// A saturated drive records its limit, which biases the estimate.
#[test]
fn torques_at_a_limit_are_left_out() {
    let model = irb1600();
    for (seed, with, duration) in [(8, With::Rates, 10.0), (9, With::Positions, 30.0)] {
        let mut random = fastrand::Rng::with_seed(seed);
        let mut log = log(&model, &series(seed), [duration, 0.005], with, [1.0, 0.0], &mut random);
        let tau = log.channels.iter().position(|c| *c == Channel::Torque(1)).unwrap();
        let highest = log.values[tau].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let limit = 0.7 * highest;
        log.values[tau].iter_mut().for_each(|x| *x = x.clamp(-limit, limit));
        let samples = samples(&log, &model);
        let shares = samples.share_at_limits();
        assert!(shares[1] > 0.01 && shares[0] == 0.0, "{shares:?}");
        let found =
            identify(&model, &samples, &[], &settings(Free::All, Weighting::Joint)).unwrap();
        let solution = &found.fit.solution;
        let truth = truth(&model, &found.base);
        for (row, column) in solution.determined.iter().enumerate() {
            let sd = found.fit.covariance[(row, row)].sqrt();
            let off = (solution.beta[*column] - truth[*column]) / sd;
            assert!(off.abs() < SD_OF_ALL, "{}: {off}", found.base.name(*column));
        }
    }
}
