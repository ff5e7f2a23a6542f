//! The motion channel: runs of a program by a small planner, against a baseline.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

#[path = "../command/mod.rs"]
mod command;
mod command_line;
mod planner;

use joulepath::gap::{RunFound, diagnose_runs};

use planner::{BEFORE, HEALTHY, HELD, NOW, Recorder, Robot};

/// What is found of a robot that was healthy.
fn found(now: &Robot) -> RunFound {
    found_with(now, &|_| true)
}

fn found_with(now: &Robot, may: &dyn Fn(&str) -> bool) -> RunFound {
    diagnose_runs(&[HEALTHY.log(BEFORE)], &[now.log(NOW)], &[now.log(HELD)], may).unwrap()
}

/// The only effect: its id, class, value and movement.
fn only(found: &RunFound) -> (&'static str, Vec<&'static str>, f64, Option<usize>) {
    assert!(!found.is_unknown);
    let ids: Vec<_> = found.effects.iter().map(|of| of.effect.id).collect();
    assert_eq!(ids.len(), 1, "{ids:?}");
    let of = &found.effects[0];
    (of.effect.id, of.class.clone(), of.parameters[0].value, of.movement)
}

#[test]
fn a_robot_that_repeats_its_baseline_has_no_gap() {
    for seed in 2..8 {
        let now = HEALTHY.log(Recorder { seed, ..NOW });
        let found = diagnose_runs(&[HEALTHY.log(BEFORE)], &[now], &[], &|_| true).unwrap();
        assert!(found.effects.is_empty() && !found.is_unknown, "seed {seed}");
    }
}

#[test]
fn a_lag_is_found_with_its_size() {
    let (id, class, lag, _) = only(&found(&Robot { lag: 0.012, ..HEALTHY }));
    assert_eq!((id, class), ("tracking_lag", vec!["tracking_lag"]));
    assert!((lag - 0.012).abs() < 0.0015, "{lag}");
}

#[test]
fn a_wait_is_found_with_its_movement() {
    let mut waits = [0.0; 8];
    waits[4] = 0.07;
    let now = Robot { waits, ..HEALTHY };
    let found = found(&now);
    let (id, _, wait, movement) = only(&found);
    assert_eq!((id, movement), ("program_wait", Some(5)));
    assert!((wait - 0.07).abs() < 0.008, "{wait}");
    // What the logs show is also there in the held-out one.
    let [_, before, after] = found.gap;
    assert!(before > 0.015 && after < 0.2 * before, "{before} {after}");
}

#[test]
fn a_limit_of_the_acceleration_is_found_with_its_size() {
    for factor in [0.7, 1.3] {
        let now = Robot { acceleration: factor * HEALTHY.acceleration, ..HEALTHY };
        let (id, class, value, _) = only(&found(&now));
        assert_eq!((id, class), ("acceleration_limit", vec!["acceleration_limit"]));
        assert!((value / factor - 1.0).abs() < 0.06, "{value}");
    }
}

#[test]
fn a_limit_of_the_speed_is_found_with_its_size() {
    let now = Robot { speed: HEALTHY.speed.map(|speed| 0.8 * speed), ..HEALTHY };
    let (id, _, value, _) = only(&found(&now));
    assert_eq!(id, "speed_limit");
    assert!((value - 0.8).abs() < 0.03, "{value}");
    // A cap reaches fast movements only.
    let now = Robot { speed: HEALTHY.speed.map(|speed| speed.min(1.3)), ..HEALTHY };
    assert_eq!(only(&found(&now)).0, "speed_limit");
}

#[test]
fn corners_that_are_cut_less_or_more_are_found() {
    for overlap in [0.2, 0.9] {
        let (id, _, factor, _) = only(&found(&Robot { overlap, ..HEALTHY }));
        assert_eq!(id, "zone_blending");
        assert_eq!(factor < 1.0, overlap < HEALTHY.overlap, "{factor}");
    }
}

#[test]
fn movements_that_change_by_no_law_are_unknown() {
    let factors = [0.85, 1.2, 0.9, 1.15, 0.8, 1.25, 0.75, 1.1];
    let mut speed = HEALTHY.speed;
    speed.iter_mut().zip(factors).for_each(|(speed, factor)| *speed *= factor);
    let found = found(&Robot { speed, ..HEALTHY });
    assert!(found.is_unknown && found.effects.is_empty());
}

#[test]
fn what_may_not_be_named_is_not() {
    let now = Robot { acceleration: 0.6 * HEALTHY.acceleration, ..HEALTHY };
    let found = found_with(&now, &|id| id == "tracking_lag" || id == "program_wait");
    assert!(found.is_unknown && found.effects.is_empty());
}

#[test]
fn a_wait_beside_a_lag_is_found_with_it() {
    let mut waits = [0.0; 8];
    waits[0] = 0.3;
    let found = found(&Robot { waits, lag: 0.02, ..HEALTHY });
    let mut ids: Vec<_> = found.effects.iter().map(|of| of.effect.id).collect();
    ids.sort_unstable();
    assert_eq!(ids, ["program_wait", "tracking_lag"]);
}

/// Movements without a plateau that all take longer by the same factor are as slow by either limit.
#[test]
fn time_that_is_stretched_is_told_as_a_class() {
    let mut run = Robot { speed: [9.0; 8], overlap: 0.0, ..HEALTHY }.log(BEFORE);
    let before = run.clone();
    run.t.iter_mut().for_each(|t| *t *= 1.12);
    let found = diagnose_runs(&[before], &[run], &[], &|_| true).unwrap();
    let mut class = only(&found).1;
    class.sort_unstable();
    assert_eq!(class, ["acceleration_limit", "speed_limit"]);
    assert!(found.is_ambiguous());
}

#[test]
fn runs_of_another_program_are_not_compared() {
    let mut other = HEALTHY.log(NOW);
    other.command.iter_mut().filter(|number| **number > 0).for_each(|number| *number += 50);
    assert!(diagnose_runs(&[HEALTHY.log(BEFORE)], &[other], &[], &|_| true).is_none());
}
