//! Phase currents in every way in which they are wired and scaled.

use std::f64::consts::TAU;

use joulepath::identify::torques;
use joulepath::log::{Channel, Log};
use joulepath::robot::Model;

use crate::simulated::{With, irb1600, log, normal, series};

/// Share of a torque that is noise.
const NOISE: f64 = 0.01;
/// How well sign and scale give the torque back, relative.
const RIGHT: f64 = 0.05;

/// The currents that a recorder would have, instead of the torques.
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

#[test]
fn sign_and_scale_are_right_in_two_hundred_random_cases() {
    let model = irb1600();
    let mut random = fastrand::Rng::with_seed(11);
    let mut wrong = Vec::new();
    for case in 0..200 {
        let scale = [1.0, 2.0 / 3.0, 1.5, 1.5_f64.sqrt()][case % 4];
        let motion = series(1000 + case as u64);
        let truth =
            log(&model, &motion, [10.0, 0.01], With::Positions, [0.0, 0.0], &mut random);
        let found = torques(&model, &phases(&model, &truth, scale, &mut random)).unwrap();
        for joint in 0..6 {
            let expected = truth.column(Channel::Torque(joint)).unwrap();
            let (mut off, mut all) = (0.0, 0.0);
            for (found, expected) in found.tau[joint].iter().zip(expected) {
                off += (found - expected).powi(2);
                all += expected * expected;
            }
            if (off / all).sqrt() > RIGHT {
                wrong.push(format!("{case}.{}: {:.3} {:?}", joint + 1, (off / all).sqrt(), found.notes.last()));
            }
        }
    }
    assert!(wrong.is_empty(), "{} of 1,200 joints: {}", wrong.len(), wrong.join("\n"));
}
