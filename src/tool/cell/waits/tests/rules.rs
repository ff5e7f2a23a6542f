//! Each rule on a cell that shows it.

use super::recorder::{Chance, Recorder};
use crate::tool::cell::waits::{Kind, Level, Reason, Reference, Shift, Verdict, WaitKind, samples};

/// A cell: after an operator (line 10) the robot grips (20), unloads a machine (30), clamps (40).
struct Cell {
    cycles: usize,
    /// Spread of the operator, s.
    operator: f64,
    /// The machine's door in cycle i after the start in the cycle before and the robot's coming.
    door: fn(&mut Chance, usize, f64, f64) -> f64,
    hears: bool,
    /// Whether the robot asks the door to open.
    asks: bool,
}

type Found = (u32, Verdict, Option<Reference>);

fn run(cell: &Cell) -> Vec<Found> {
    let mut chance = Chance::new(7);
    let mut log = Recorder::new(0.001);
    log.hears = cell.hears;
    let mut started = 0.0;
    for i in 0..cell.cycles {
        log.cycle();
        log.travel(5, 4.0 + chance.normal(0.01));
        let at = log.t + 2.0 + chance.normal(1.0).abs() * cell.operator;
        log.wait(10, "diPart", at);
        log.travel(15, 3.0 + chance.normal(0.01));
        log.output(19, "doGrip");
        let at = log.t + 0.3 + chance.normal(0.02);
        log.wait(20, "diGripped", at);
        log.travel(25, 5.0 + chance.normal(0.01));
        if cell.asks {
            log.output(29, "doOpen");
        }
        let at = (cell.door)(&mut chance, i, started, log.t);
        log.wait(30, "diDoor", at);
        log.travel(35, 6.0 + chance.normal(0.01));
        log.output(39, "doClamp");
        let at = log.t + 1.2 + chance.normal(0.05);
        log.wait(40, "diClamped", at);
        started = log.output(45, "doStart");
        log.travel(50, 4.0);
    }
    log.verdicts()
}

fn kind(verdicts: &[Found], line: u32) -> (WaitKind, Reason) {
    let verdict = &verdicts.iter().find(|(of, ..)| *of == line).expect("a wait").1;
    (verdict.kind, verdict.reason)
}

const SLACK: (WaitKind, Reason) = (WaitKind::Slack, Reason::CountsFrom);
const PROCESS: (WaitKind, Reason) = (WaitKind::Process, Reason::Answers);

fn machine(chance: &mut Chance, _: usize, started: f64, _: f64) -> f64 {
    started + 35.0 + chance.normal(0.4)
}

#[test]
fn a_machine_that_was_started_in_the_cycle_before_is_slack() {
    for hears in [false, true] {
        let verdicts = run(&Cell { cycles: 150, operator: 4.0, door: machine, hears, asks: false });
        assert_eq!(kind(&verdicts, 30), SLACK, "{verdicts:#?}");
        let after = verdicts[2].2.as_ref().expect("a reference");
        assert_eq!(after.kind, Kind::Output("doStart".to_owned(), Level(1.0)));
        assert!(after.before);
        assert_eq!(kind(&verdicts, 20), PROCESS, "{verdicts:#?}");
        assert_eq!(kind(&verdicts, 40), PROCESS, "{verdicts:#?}");
    }
}

#[test]
fn a_door_that_answers_the_robot_is_process() {
    let door = |chance: &mut Chance, _, _, came| came + 3.0 + chance.normal(0.3);
    let verdicts = run(&Cell { cycles: 150, operator: 4.0, door, hears: false, asks: true });
    assert_eq!(kind(&verdicts, 30), PROCESS, "{verdicts:#?}");
}

#[test]
fn a_door_that_is_open_already_at_times_is_process() {
    let door = |chance: &mut Chance, _, _, came| {
        if chance.is(0.34) { came - 5.0 } else { came + 3.0 + chance.normal(0.3) }
    };
    let verdicts = run(&Cell { cycles: 150, operator: 4.0, door, hears: false, asks: true });
    assert_eq!(kind(&verdicts, 30), PROCESS, "{verdicts:#?}");
}

#[test]
fn a_machine_that_answers_by_half_is_coupled() {
    let door = |chance: &mut Chance, _, started, came| {
        let travel: f64 = came - started;
        started + 35.0 + 0.5 * (travel - 24.0) + chance.normal(0.3)
    };
    let verdicts = run(&Cell { cycles: 150, operator: 4.0, door, hears: false, asks: false });
    assert_eq!(kind(&verdicts, 30), (WaitKind::Unknown, Reason::Coupled), "{verdicts:#?}");
    let slope = verdicts[2].1.slope.expect("a slope");
    assert!(slope.low > 0.3 && slope.high < 0.7, "{slope:?}");
}

#[test]
fn a_machine_with_a_long_tail_is_slack() {
    let door = |chance: &mut Chance, _, started, _| started + 32.0 + chance.normal(0.9).exp();
    let verdicts = run(&Cell { cycles: 200, operator: 4.0, door, hears: false, asks: false });
    assert_eq!(kind(&verdicts, 30), SLACK, "{verdicts:#?}");
}

#[test]
fn without_other_times_of_coming_the_log_cannot_tell() {
    let verdicts =
        run(&Cell { cycles: 150, operator: 0.0, door: machine, hears: false, asks: false });
    assert_eq!(kind(&verdicts, 30), (WaitKind::Unknown, Reason::CannotTell), "{verdicts:#?}");
    let verdicts =
        run(&Cell { cycles: 8, operator: 4.0, door: machine, hears: false, asks: false });
    assert_eq!(kind(&verdicts, 30), (WaitKind::Unknown, Reason::TooFew));
}

#[test]
fn what_drifts_together_tells_nothing() {
    // The machine slows down over the shift, and so does the operator: lengths do not change.
    let mut chance = Chance::new(3);
    let mut log = Recorder::new(0.001);
    let mut started = 0.0;
    for i in 0..300 {
        let drift = 8.0 * f64::from(i) / 300.0;
        log.cycle();
        log.travel(5, 20.0 + drift + chance.normal(0.01));
        let at = started + 30.0 + drift + chance.normal(0.3);
        log.wait(30, "diDoor", at);
        log.travel(35, 6.0);
        started = log.output(45, "doStart");
        log.travel(50, 4.0);
    }
    let verdicts = log.verdicts();
    assert_eq!(kind(&verdicts, 30), (WaitKind::Unknown, Reason::CannotTell), "{verdicts:#?}");
}

#[test]
fn a_sensor_in_a_loop_is_process_by_all_its_executions() {
    let mut chance = Chance::new(5);
    let mut log = Recorder::new(0.001);
    for _ in 0..40 {
        log.cycle();
        for part in 0..12 {
            log.travel(11, 1.5 + 0.2 * f64::from(part));
            log.output(12, "doGrip");
            let at = log.t + 0.35 + chance.normal(0.03);
            log.wait(13, "diGripped", at);
        }
    }
    let verdicts = log.verdicts();
    assert_eq!(kind(&verdicts, 13), PROCESS, "{verdicts:#?}");
}

#[test]
fn a_line_that_gives_a_part_by_its_own_clock_is_slack() {
    let mut chance = Chance::new(9);
    let mut log = Recorder::new(0.001);
    let mut next = 30.0;
    for _ in 0..150 {
        log.cycle();
        log.travel(5, 12.0);
        let at = log.t + 3.0 + chance.normal(2.0).abs();
        log.wait(10, "diChecked", at);
        log.travel(15, 5.0);
        log.wait(20, "diPart", next + chance.normal(0.05));
        next += 30.0;
    }
    let verdicts = log.verdicts();
    assert_eq!(kind(&verdicts, 20), SLACK, "{verdicts:#?}");
}

#[test]
fn stated_times_and_what_is_always_there_are_named() {
    let mut log = Recorder::new(0.001);
    for _ in 0..30 {
        log.cycle();
        log.travel(5, 2.0);
        let at = log.t + 0.5;
        log.wait(6, "", at);
        log.wait(7, "diAir", 0.0);
    }
    let verdicts = log.verdicts();
    assert_eq!(kind(&verdicts, 6), (WaitKind::Process, Reason::Stated));
    assert_eq!(kind(&verdicts, 7), (WaitKind::Unknown, Reason::AlwaysThere));
}

#[test]
fn a_measured_value_is_no_reference() {
    let mut log = Recorder::new(0.001);
    for i in 0..40 {
        log.cycle();
        for k in 0..30 {
            log.value("aiForce", f64::from(i * 30 + k));
        }
        log.travel(5, 2.0);
        let at = log.t + 1.0 + 0.05 * f64::from(i % 7);
        log.wait(7, "diAir", at);
    }
    let log = log.log("a.csv");
    let shift = Shift::new(&[log], None).expect("cycles");
    let all = samples(&shift);
    assert!(all[0].candidates.len() < 10, "{}", all[0].candidates.len());
}
