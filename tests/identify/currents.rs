//! Phase currents with all wirings and scales.

use std::f64::consts::TAU;

use joulepath::arm::dynamics::{Load, parameters};
use joulepath::arm::robot::Model;
use joulepath::learn::identify::{
    Free, Hints, Settings, Source, Weighting, identify, prepare, synchronised, torques,
};
use joulepath::learn::log::{Aligned, Channel, Log};

use crate::excited::{irb1600, normal, series};
use crate::simulated::{With, log};

/// Share of a torque that is noise.
const NOISE: f64 = 0.01;
/// Relative tolerance of the recovered torque.
const RIGHT: f64 = 0.05;

/// The currents of a recorder instead of the torques.
fn phases(model: &Model, log: &Log, scale: f64, random: &mut fastrand::Rng) -> Log {
    let motors = model.motors.as_ref().unwrap();
    let constants = motors.torque_constant.as_ref().unwrap();
    let mut wired = log.clone();
    for joint in 0..6 {
        let tau = log.column(Channel::Torque(joint)).unwrap();
        let q = log.column(Channel::Position(joint)).unwrap();
        let pairs = f64::from(random.u32(2..6));
        let zero = TAU * random.f64();
        let sign = if random.bool() { 1.0 } else { -1.0 };
        let per_ampere = constants[joint] * motors.ratio[joint];
        let mut columns = [Vec::new(), Vec::new(), Vec::new()];
        for (tau, q) in tau.iter().zip(q) {
            let amplitude = sign * scale * 2.0_f64.sqrt() * tau / per_ampere;
            let angle = pairs * motors.ratio[joint] * q + zero;
            for (k, column) in columns.iter_mut().enumerate() {
                let clean = amplitude * (angle - k as f64 * TAU / 3.0).cos();
                column.push(clean + NOISE * normal(random));
            }
        }
        let mut order = [0, 1, 2];
        random.shuffle(&mut order);
        for (phase, column) in columns.into_iter().enumerate() {
            wired.channels.push(Channel::PhaseCurrent(joint, order[phase]));
            wired.values.push(column);
        }
    }
    let kept: Vec<usize> = (0..wired.channels.len())
        .filter(|i| !matches!(wired.channels[*i], Channel::Torque(_)))
        .collect();
    wired.values = kept.iter().map(|i| wired.values[*i].clone()).collect();
    wired.channels = kept.iter().map(|i| wired.channels[*i]).collect();
    wired
}

/// The chain of the paper: from seven periods of phase currents to the parameters of table 2.
#[test]
fn parameters_are_recovered_from_phase_currents() {
    let model = irb1600();
    let mut random = fastrand::Rng::with_seed(12);
    let truth = log(&model, &series(12), [70.0, 0.005], With::Positions, [0.0, 0.0], &mut random);
    let log = phases(&model, &truth, 1.5, &mut random);
    let torque = torques(&model, &log).unwrap();
    let samples = prepare(&log, &torque.tau, Hints::default()).unwrap();
    assert!(matches!(samples.source, Source::Periodic { periods: 7 | 6, .. }));
    let settings =
        Settings { free: Free::All, weighting: Weighting::Joint, source: "a test".into() };
    let found = identify(&model, &samples, &[], &settings).unwrap();
    // The cross-validation error is that of one repetition, the fit's that of a mean.
    assert!(found.fit.over_repetitions);
    for (one, mean) in found.fit.cross_rms.iter().zip(&found.fit.rms) {
        assert!((1.8..3.6).contains(&(one / mean)), "{one} {mean}");
    }
    let all = parameters(&model, &Load::none());
    let expected = found.base.of_parameters(&all);
    let deviations: Vec<f64> = found
        .fit
        .solution
        .determined
        .iter()
        .enumerate()
        .map(|(k, column)| {
            let off = found.fit.solution.beta[*column] - expected[*column];
            off.abs() / found.fit.covariance[(k, k)].sqrt()
        })
        .collect();
    assert_eq!(deviations.len(), 58);
    // One in 370 values exceeds three standard deviations.
    let far = deviations.iter().filter(|d| **d > 3.0).count();
    let largest = deviations.iter().fold(0.0, |m: f64, d| m.max(*d));
    eprintln!("58 parameters from phase currents: the furthest is {largest:.2} sd away");
    assert!(far <= 1 && largest < 4.0, "{deviations:?}");
}

#[test]
fn sign_and_scale_are_right_in_two_hundred_random_cases() {
    let model = irb1600();
    let mut random = fastrand::Rng::with_seed(11);
    let mut wrong = Vec::new();
    for case in 0..200 {
        let scale = [1.0, 2.0 / 3.0, 1.5, 1.5_f64.sqrt()][case % 4];
        let motion = series(1000 + case as u64);
        let truth = log(&model, &motion, [10.0, 0.01], With::Positions, [0.0, 0.0], &mut random);
        let found = torques(&model, &phases(&model, &truth, scale, &mut random)).unwrap();
        for joint in 0..6 {
            let expected = truth.column(Channel::Torque(joint)).unwrap();
            let (mut off, mut all) = (0.0, 0.0);
            for (found, expected) in found.tau[joint].iter().zip(expected) {
                off += (found - expected).powi(2);
                all += expected * expected;
            }
            if (off / all).sqrt() > RIGHT {
                wrong.push(format!(
                    "{case}.{}: {:.3} {:?}",
                    joint + 1,
                    (off / all).sqrt(),
                    found.notes.last()
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{} of 1,200 joints: {}", wrong.len(), wrong.join("\n"));
}

/// The marks of a logger are late by half an interval; the motor field determines the shift.
#[test]
fn the_motor_field_synchronises_two_clocks() {
    const LATE: f64 = 0.002;
    const CLOSE: f64 = 1e-4;
    let model = irb1600();
    let mut random = fastrand::Rng::with_seed(15);
    let truth = log(&model, &series(15), [20.0, 0.001], With::Positions, [0.0, 0.0], &mut random);
    let both = phases(&model, &truth, 1.0, &mut random);
    // The positions lag by two milliseconds.
    let mut late = both.clone();
    for (channel, values) in late.channels.iter().zip(&mut late.values) {
        if matches!(channel, Channel::Position(_)) {
            let first = values[0];
            values.rotate_right(2);
            values[..2].fill(first);
        }
    }
    let aligned = Aligned { log: late, marks: 4, worst: 0.0, step: 2.0 * LATE };
    let (found, note) = synchronised(&model, aligned);
    assert!(note.contains("2.00 ms later"), "{note}");
    let q = |log: &Log| log.column(Channel::Position(0)).unwrap().to_vec();
    let (found_q, both_q) = (q(&found), q(&both));
    for (row, x) in found.rows.iter().zip(&found_q).skip(10).step_by(50) {
        let place = both.rows.iter().position(|known| known == row).unwrap();
        assert!((x - both_q[place]).abs() < CLOSE * 5.0, "{row}");
    }
}
