//! Power of simulated robots.

use joulepath::arm::robot::Model;
use joulepath::gap::{PowerFound, Powers, diagnose_power};

use crate::excited::{irb1600, normal};

/// Rows of a log.
const ROWS: usize = 800;
/// Time from row to row \[s\].
const STEP: f64 = 0.01;
/// Largest deviation of a value, in standard deviations.
const WITHIN: f64 = 4.0;
/// Rate below which a joint rests \[rad/s\].
const RESTS: f64 = 0.02;
/// Joints move by turns: rows of a turn, number of turns after which they come again, those at rest.
const TURN: usize = 50;
const TURNS: usize = 5;
const AT_REST: usize = 2;

/// Power of a motion; half of the braking power is given back, and the meter has no lag.
fn log(seed: u64, more: &dyn Fn(&Powers, usize, f64) -> f64) -> Powers {
    log_of(seed, [robot().drive.regeneration, 0.0], more)
}

/// Power of a motion: base, mechanical power and losses by joint, noise, and the additional term `more` by
/// row; with the share that is given back and the time constant of the meter \[s\].
fn log_of(
    seed: u64,
    [given_back, lag]: [f64; 2],
    more: &dyn Fn(&Powers, usize, f64) -> f64,
) -> Powers {
    let mut random = fastrand::Rng::with_seed(seed);
    let wave = |size: f64, random: &mut fastrand::Rng| -> Vec<f64> {
        let terms: Vec<[f64; 3]> =
            (1..6).map(|k| [k.into(), normal(random), normal(random)]).collect();
        let at = |t: f64| -> f64 {
            let harmonic = |[k, a, b]: &[f64; 3]| a * (k * t).sin() + b * (k * t).cos();
            size * terms.iter().map(harmonic).sum::<f64>()
        };
        (0..ROWS).map(|row| at(std::f64::consts::TAU * row as f64 / ROWS as f64)).collect()
    };
    let sizes = [60.0, 80.0, 40.0, 6.0, 6.0, 3.0];
    let mut qd: Vec<Vec<f64>> = sizes.iter().map(|_| wave(0.5, &mut random)).collect();
    for (joint, of) in qd.iter_mut().enumerate() {
        let rests = |row: usize| (row / TURN + 2 * joint) % TURNS < AT_REST;
        (0..ROWS).filter(|row| rests(*row)).for_each(|row| of[row] = 0.0);
    }
    let tau: Vec<Vec<f64>> = sizes.iter().map(|size| wave(*size, &mut random)).collect();
    let mut log = Powers { step: STEP, closed: true, qd, tau, power: Vec::new() };
    // The second time, the meter shows what it does of a motion that repeats.
    let mut shown = 0.0;
    for row in (0..ROWS).chain(0..ROWS) {
        let of_joint = |j: usize| log.tau[j][row] * log.qd[j][row] + LOSS * log.tau[j][row].powi(2);
        let sum: f64 = (0..sizes.len()).map(of_joint).sum();
        let share = if sum < 0.0 { given_back } else { 1.0 };
        let power = 150.0 + share * sum + more(&log, row, share);
        shown = power + (shown - power) * (-STEP / lag).exp();
        log.power.push(shown + 0.2 * normal(&mut random));
    }
    log.power.drain(..ROWS);
    log
}

/// Loss of each joint \[W/(Nm)²\].
const LOSS: f64 = 2e-3;

fn robot() -> Model {
    let mut model = irb1600();
    model.drive.regeneration = 0.5;
    model
}

/// The diagnosis of a robot with additional power.
fn found(more: &dyn Fn(&Powers, usize, f64) -> f64) -> PowerFound {
    let before = [log(1, &|_, _, _| 0.0), log(2, &|_, _, _| 0.0)];
    let after = [log(3, more), log(4, more)];
    let held = [log(5, more)];
    diagnose_power(&robot(), &before, &after, &held, &|_| true).unwrap()
}

fn named(found: &PowerFound) -> Vec<(&'static str, Option<usize>)> {
    found.effects.iter().map(|of| (of.effect.id, of.joint)).collect()
}

#[test]
fn unchanged_power_has_no_effect() {
    let found = found(&|_, _, _| 0.0);
    assert!(named(&found).is_empty() && !found.is_unknown);
}

#[test]
fn losses_are_found_with_their_size() {
    let loss = 4e-3;
    let found = found(&|log, row, share| share * loss * log.tau[1][row].powi(2));
    assert_eq!(named(&found), [("copper_loss", Some(1))]);
    let estimate = &found.effects[0].parameters[0];
    assert!((estimate.value - loss).abs() < WITHIN * estimate.sd, "{estimate:?}");
    assert!(found.gap[2] < 0.1 * found.gap[1], "{:?}", found.gap);
}

/// An inverter with resistance.
#[test]
fn one_kind_of_loss_is_reported_for_a_joint() {
    let more = |log: &Powers, row: usize, share: f64| {
        let tau = log.tau[1][row].abs();
        share * (0.6 * tau + 2e-4 * tau * tau)
    };
    assert_eq!(named(&found(&more)), [("inverter_loss", Some(1))]);
}

#[test]
fn two_losses_are_found() {
    let more = |log: &Powers, row: usize, share: f64| 30.0 + share * 60.0 * log.qd[2][row].powi(2);
    let mut reported = named(&found(&more));
    reported.sort_unstable();
    assert_eq!(reported, [("base_load", None), ("iron_loss", Some(2))]);
}

/// A few watts beside a large loss may be its form.
#[test]
fn what_the_form_of_a_loss_may_do_is_no_second_effect() {
    let more = |log: &Powers, row: usize, share: f64| 8.0 + share * 60.0 * log.qd[2][row].powi(2);
    assert_eq!(named(&found(&more)), [("iron_loss", Some(2))]);
}

/// A load on the DC link consumes a part of the regenerated energy.
#[test]
fn a_load_on_the_dc_link_is_reported_as_base_load() {
    let found = found(&|_, _, share| 60.0 * share);
    assert_eq!(named(&found), [("base_load", None)]);
    assert_eq!(found.effects[0].class, ["base_load", "brake_power"]);
    let estimate = &found.effects[0].parameters[0];
    assert!((estimate.value - 60.0).abs() < WITHIN * estimate.sd, "{estimate:?}");
}

/// A fan that runs no more.
#[test]
fn power_that_is_gone_is_found() {
    let found = found(&|_, _, _| -60.0);
    assert_eq!(named(&found), [("base_load", None)]);
    let estimate = &found.effects[0].parameters[0];
    assert!((estimate.value + 60.0).abs() < WITHIN * estimate.sd, "{estimate:?}");
}

/// Coils of the brakes of single axes are on while these move.
#[test]
fn brakes_of_moving_axes_are_told_from_a_base_load() {
    let share = |log: &Powers, row: usize| {
        let moving = log.qd.iter().filter(|qd| qd[row].abs() > RESTS).count();
        moving as f64 / log.qd.len() as f64
    };
    let found = found(&|log, row, _| 50.0 * share(log, row));
    assert_eq!(named(&found), [("brake_power", None)]);
    assert_eq!(found.effects[0].class, ["brake_power"]);
}

/// They close some time after an axis has come to rest.
#[test]
fn brakes_close_after_a_time() {
    const TIMEOUT: usize = 45;
    let released = |log: &Powers, row: usize| {
        let moved =
            |qd: &&Vec<f64>| (0..TIMEOUT).any(|k| qd[(row + ROWS - k) % ROWS].abs() > RESTS);
        log.qd.iter().filter(moved).count() as f64 / log.qd.len() as f64
    };
    let found = found(&|log, row, _| 50.0 * released(log, row));
    assert_eq!(named(&found), [("brake_power", None)]);
    let estimate = &found.effects[0].parameters[0];
    assert!((estimate.value - 50.0).abs() < 0.1 * 50.0, "{estimate:?}");
}

/// A model of a drawing says neither what is given back nor how fast the meter is.
#[test]
fn what_is_given_back_and_the_meter_are_learnt_from_the_baseline() {
    let meter = [0.75, 0.03];
    let before = [log_of(1, meter, &|_, _, _| 0.0), log_of(2, meter, &|_, _, _| 0.0)];
    let after = [log_of(3, meter, &|_, _, _| -8.0)];
    let mut model = robot();
    model.drive.regeneration = 0.0;
    let found = diagnose_power(&model, &before, &after, &after, &|_| true).unwrap();
    assert_eq!(named(&found), [("base_load", None)]);
    let estimate = &found.effects[0].parameters[0];
    assert!((estimate.value + 8.0).abs() < WITHIN * estimate.sd, "{estimate:?}");
}

/// With two kinds of losses the reference is accurate to half a percent only.
#[test]
fn a_small_change_of_power_is_not_reported() {
    let found = found(&|log, row, share| share * 2e-5 * log.tau[1][row].powi(2));
    assert!(named(&found).is_empty() && !found.is_unknown, "{:?}", found.gap);
}

/// Power that no loss explains has no name.
#[test]
fn unexplained_power_is_unknown() {
    let more = |_: &Powers, row: usize, _: f64| if row % 200 < 60 { 80.0 } else { 0.0 };
    let found = found(&more);
    assert!(named(&found).is_empty() && found.is_unknown);
}
