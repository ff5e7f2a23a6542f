//! The logs have the documented form and agree with the truth.

use std::collections::BTreeMap;

use super::super::{Conditions, Disturbance, Kind, Meter, Plant, Run};
use super::{cell, events, one_wait};

const EVENTS: [&str; 9] =
    ["cycle", "start", "arrive", "wait", "end", "signal", "output", "load", "flush"];
/// Latest row of an interrupt \[s\].
const LATE_S: f64 = 0.45;

/// The rows of each session.
fn sessions(events: &str) -> Vec<Vec<Vec<&str>>> {
    let mut sessions = Vec::new();
    for line in events.lines() {
        if line.starts_with("# session") {
            sessions.push(Vec::new());
        } else if !line.starts_with('#') && !line.starts_with("t,") {
            sessions.last_mut().unwrap().push(line.split(',').collect());
        }
    }
    sessions
}

/// Runs with and without faults; at least one of them restarts.
fn runs() -> Vec<Run> {
    let script = cell();
    (0..8).map(|seed| events(&Plant::draw(seed, &script), &script, 200, seed)).collect()
}

#[test]
fn rows_of_events_are_in_order_and_complete() {
    let runs = runs();
    assert!(runs.iter().any(|run| run.sessions.len() > 1));
    for run in &runs {
        let sessions = sessions(&run.events);
        assert_eq!(sessions.len(), run.sessions.len());
        for rows in &sessions {
            let (mut latest, mut number, mut open) = (0.0_f64, 0, None);
            for row in rows {
                assert_eq!(row.len(), 8, "{row:?}");
                let t: f64 = row[0].parse().unwrap();
                let cycle: usize = row[1].parse().unwrap();
                assert!(EVENTS.contains(&row[5]), "{row:?}");
                let late = if row[5] == "signal" { LATE_S } else { 0.0 };
                assert!(t >= latest - late, "{row:?} after {latest}");
                let placed = matches!(row[5], "cycle" | "signal" | "flush");
                assert_eq!(row[3].is_empty() && row[4].is_empty(), placed, "{row:?}");
                if row[5] != "signal" {
                    latest = t;
                }
                match row[5] {
                    "cycle" => {
                        number += 1;
                        assert_eq!(cycle, number);
                    }
                    // Nothing but signals happens within a wait.
                    "wait" => open = Some((row[4], row[7])),
                    "end" => assert_eq!(open.take(), Some((row[4], row[7]))),
                    "signal" => {}
                    _ => assert_eq!(open, None, "{row:?}"),
                }
            }
        }
    }
}

#[test]
fn signals_alternate_and_come_when_the_truth_says() {
    let script = one_wait();
    for kind in [Kind::Answer, Kind::Machine, Kind::Queue, Kind::Shared] {
        let run = Plant::draw_with(5, &script, &[("diReady", kind)]).calm().run(&script, 100, 1);
        let rows = sessions(&run.events).remove(0);
        let mut signals: Vec<(f64, &str)> = rows
            .iter()
            .filter(|row| row[5] == "signal")
            .map(|row| (row[0].parse().unwrap(), row[6]))
            .collect();
        signals.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert!(signals.windows(2).all(|two| two[0].1 != two[1].1), "{kind:?}");
        let ups: Vec<f64> = signals.iter().filter(|of| of.1 == "1").map(|of| of.0).collect();
        let mut came: Vec<f64> =
            run.cycles.iter().flat_map(|cycle| &cycle.visits).filter_map(|of| of.came_s).collect();
        came.dedup();
        assert!(came.len() > 50, "{kind:?}");
        for (came, up) in came.iter().zip(&ups) {
            assert!((0.0..0.0135).contains(&(up - came)), "{kind:?}: {came} at {up}");
        }
    }
}

#[test]
fn a_restart_begins_a_session_and_may_leave_a_wait_without_end() {
    let (mut restarts, mut left) = (0, 0);
    for run in runs() {
        let truth = run.cycles.iter().filter(|of| of.disturbance == Disturbance::Restart).count();
        assert_eq!(run.sessions.len(), truth + 1);
        assert_eq!(run.events.matches("# session 2026-03-02 ").count(), truth + 1);
        assert!(run.events.contains("# session 2026-03-02 06:00:00\n"));
        restarts += truth;
        let rows: Vec<Vec<&str>> = sessions(&run.events).concat();
        let count = |event: &str| rows.iter().filter(|row| row[5] == event).count();
        left += count("wait") - count("end");
        let numbers = run.cycles.windows(2).map(|two| (two[0].disturbance, two[1].number));
        let mut after = numbers.filter(|(before, _)| *before == Disturbance::Restart);
        assert!(after.all(|(_, number)| number == 1));
    }
    assert!(restarts > 3 && left > 0 && left < restarts, "{restarts} restarts, {left} waits left");
}

#[test]
fn energies_add_up() {
    let script = cell();
    let meter = Meter { noise_w: 0.0, step_w: 0.0, rate_hz: 50.0, ..Meter::default() };
    for seed in 0..4 {
        let plant = Plant::draw(seed, &script);
        let conditions = Conditions { meter: meter.clone(), ..Conditions::usual(80, seed) };
        let run = plant.run_in(&script, &conditions);
        let mut by_cycle: BTreeMap<(&str, usize), f64> = BTreeMap::new();
        let (mut session, mut before, mut sum_j) = (0, 1, 0.0);
        for line in run.power.lines().skip(1) {
            let row: Vec<&str> = line.split(',').collect();
            let (power, cycle): (f64, usize) = (row[1].parse().unwrap(), row[2].parse().unwrap());
            session += usize::from(cycle < before);
            before = cycle;
            sum_j += power / meter.rate_hz;
            if session == 0 {
                *by_cycle.entry((row[3], cycle)).or_default() += power / meter.rate_hz;
            }
        }
        assert!((sum_j / run.energy_j() - 1.0).abs() < 1e-3, "{sum_j} J of {}", run.energy_j());
        for cycle in run.cycles.iter().filter(|cycle| cycle.session == 0) {
            let metered = by_cycle[&(cycle.part.as_str(), cycle.number)];
            // A row belongs to two cycles at each end.
            assert!((metered - cycle.energy_j).abs() < 20.0, "{metered} of {}", cycle.energy_j);
            let least = cycle.motion_j + plant.power.base_w * cycle.duration_s;
            assert!(cycle.energy_j >= least - 1e-6);
            let most = least + plant.power.hold_w * cycle.duration_s;
            assert!(cycle.energy_j <= most + 1e-6);
        }
        let sum: f64 = run.cycles.iter().map(|cycle| cycle.duration_s).sum();
        let last = run.cycles.last().unwrap();
        assert!((last.start_s + last.duration_s - sum).abs() < 1e-6);
    }
}

#[test]
fn brakes_end_the_power_of_holding() {
    let script = cell();
    let energy = |hold_w, brakes_after_s| {
        let mut plant = Plant::draw(2, &script);
        (plant.power.hold_w, plant.power.brakes_after_s) = (hold_w, brakes_after_s);
        events(&plant, &script, 50, 1).energy_j()
    };
    let (free, held, braked) = (energy(0.0, 1e9), energy(100.0, 1e9), energy(100.0, 2.0));
    assert!(free < braked && braked < held, "{free}, {braked}, {held} J");
    assert!((energy(100.0, 0.0) - free).abs() < 1e-6);
}

#[test]
fn lost_rows_are_counted() {
    let script = cell();
    let plant = Plant::draw(3, &script).calm();
    let whole = plant.run(&script, 100, 3);
    let lost = plant.run_in(&script, &Conditions { lost: 0.002, ..Conditions::usual(100, 3) });
    let rows = |run: &Run| {
        let rows = sessions(&run.events).concat().into_iter().map(|row| row.join(","));
        rows.filter(|row| !row.contains(",flush,")).collect::<Vec<String>>()
    };
    let (whole, rest) = (rows(&whole), rows(&lost));
    let (notes, rest): (Vec<String>, Vec<String>) =
        rest.into_iter().partition(|row| row.contains(",lost,"));
    let count = |row: &String| row.split(',').nth(6).unwrap().parse::<usize>().unwrap();
    let gone: usize = notes.iter().map(count).sum();
    assert!(gone > 0);
    // What is lost at the very end is not counted.
    let missing = whole.len() - rest.len() - gone;
    assert!(missing < 60, "{missing} rows are missing");
}

#[test]
fn equal_seeds_have_equal_bytes() {
    let script = cell();
    let run = |plant, seed| Plant::draw(plant, &script).run(&script, 30, seed);
    assert_eq!(run(1, 2), run(1, 2));
    assert_ne!(run(1, 2).events, run(1, 3).events);
    assert_ne!(run(1, 2).events, run(2, 2).events);
}
