//! Slack does not see when the robot comes, processes do, and the rest does in part.

use std::collections::BTreeSet;

use super::super::{After, Event, Kind, LATER_S, Plant, Run, Truth, Visit};
use super::{cell, events, one_wait, place};

const CYCLES: usize = 300;
const SLACK: [Kind; 4] = [Kind::Machine, Kind::Operator, Kind::Takt, Kind::Queue];
const COUPLED: [Kind; 4] = [Kind::OnRequest, Kind::OtherJob, Kind::WarmUp, Kind::Shared];

fn plant(kind: Kind, seed: u64) -> Plant {
    Plant::draw_with(seed, &one_wait(), &[("diReady", kind)]).calm()
}

fn visits(run: &Run) -> impl Iterator<Item = &Visit> {
    run.cycles.iter().flat_map(|cycle| &cycle.visits)
}

/// The robot comes half a second later in each cycle: the program before and after.
fn both(kind: Kind, seed: u64) -> (Run, Run) {
    let plant = plant(kind, seed);
    let later = one_wait().slowed(&place(2), LATER_S);
    (events(&plant, &one_wait(), CYCLES, 7), events(&plant, &later, CYCLES, 7))
}

/// From when the robot last went on, or the robot came, to when the signal came.
fn times(run: &Run, from: impl Fn(&Visit, &Visit) -> f64) -> Vec<Option<f64>> {
    let visits: Vec<&Visit> = visits(run).collect();
    visits.windows(2).map(|two| two[1].came_s.map(|came| came - from(two[0], two[1]))).collect()
}

fn differences(a: &[Option<f64>], b: &[Option<f64>]) -> Vec<f64> {
    a.iter().zip(b).filter_map(|(a, b)| Some((*b)? - (*a)?)).collect()
}

#[test]
fn started_machines_and_operators_count_from_the_departure() {
    for kind in [Kind::Machine, Kind::Operator] {
        for seed in 0..20 {
            let Truth::Slack { after: After::Event(Event::Departure { place: from }) } =
                &plant(kind, seed).truth(&one_wait())[&place(3)]
            else {
                panic!("{kind:?} starts when the robot leaves");
            };
            // Line 4 does not stop: the robot moves on through line 2.
            assert_eq!(*from, place(4));
            let (a, b) = both(kind, seed);
            let since_end = |before: &Visit, _: &Visit| before.ended_s;
            let (a, b) = (times(&a, since_end), times(&b, since_end));
            // Where the signal has stayed since an earlier cycle, it is from before that end.
            let fresh = |of: &Option<f64>| of.is_some_and(|of| of > 0.0);
            let (a, b): (Vec<_>, Vec<_>) =
                a.into_iter().zip(b).filter(|(a, b)| fresh(a) && fresh(b)).unzip();
            let differences = differences(&a, &b);
            assert!(differences.len() > CYCLES / 2, "{kind:?} {seed}: {}", differences.len());
            assert!(differences.iter().all(|d| d.abs() < 1e-6), "{kind:?} {seed}");
        }
    }
}

#[test]
fn a_takt_does_not_move() {
    let mut kept = 0;
    for seed in 0..20 {
        let (a, b) = both(Kind::Takt, seed);
        // The robot is in time for the same ticks in both runs, or the runs part.
        let pairs = visits(&a).zip(visits(&b)).take(20);
        let same = |(a, b): (&Visit, &Visit)| (a.came_s.unwrap() - b.came_s.unwrap()).abs() < 1e-9;
        kept += usize::from({ pairs }.all(same));
    }
    assert!(kept > 10, "{kept}");
}

#[test]
fn processes_move_with_the_robot() {
    for seed in 0..20 {
        let (a, b) = both(Kind::Answer, seed);
        let since_arrival = |_: &Visit, now: &Visit| now.arrived_s;
        let differences = differences(&times(&a, since_arrival), &times(&b, since_arrival));
        assert_eq!(differences.len(), CYCLES - 1);
        assert!(differences.iter().all(|d| d.abs() < 1e-6), "{seed}");
    }
}

#[test]
fn what_a_delay_of_one_visit_does_is_what_the_truth_says() {
    for kind in [&SLACK[..], &COUPLED[..], &[Kind::Answer]].concat() {
        let mut moved = Vec::new();
        for seed in 0..20 {
            let plant = plant(kind, seed);
            let truth = plant.truth(&one_wait()).remove(&place(3)).unwrap();
            assert_eq!(matches!(truth, Truth::Slack { .. }), SLACK.contains(&kind), "{kind:?}");
            assert_eq!(truth == Truth::Coupled, COUPLED.contains(&kind), "{kind:?}");
            moved
                .extend(visits(&events(&plant, &one_wait(), CYCLES, 3)).map(|visit| visit.later_s));
        }
        let share = |of: fn(f64) -> bool| {
            moved.iter().filter(|later| of(**later)).count() as f64 / moved.len() as f64
        };
        let (none, all) =
            (share(|later| later == 0.0), share(|later| (later - LATER_S).abs() < 1e-6));
        match kind {
            Kind::Answer => assert!(all > 0.999, "{kind:?}: {all}"),
            _ if SLACK.contains(&kind) => assert_eq!(none, 1.0, "{kind:?}"),
            // In part of the visits, and not in all.
            _ => assert!(none > 0.05 && none < 0.95, "{kind:?}: {none}"),
        }
    }
}

#[test]
fn some_signals_stay_in_part_of_the_cycles() {
    let stayed = |seed: u64| {
        let run = events(&plant(Kind::Machine, seed), &one_wait(), CYCLES, 2);
        let since_end = times(&run, |before, _| before.ended_s);
        since_end.iter().filter(|of| of.is_some_and(|of| of < 0.0)).count()
    };
    let counts: Vec<usize> = (0..40).map(stayed).collect();
    let with = counts.iter().filter(|count| **count > 0).count();
    assert!((3..20).contains(&with), "{counts:?}");
    assert!(counts.iter().all(|count| *count < CYCLES * 2 / 3), "{counts:?}");
}

#[test]
fn drawn_cells_have_all_truths_and_the_robot_waits_in_them() {
    let script = cell();
    let mut seen = BTreeSet::new();
    let (mut slack, mut waited) = (0_u32, 0_u32);
    for seed in 0..120 {
        let plant = Plant::draw(seed, &script);
        let truth = plant.truth(&script);
        seen.extend(truth.iter().map(|(at, of)| match of {
            Truth::Process => (at.line, "process"),
            Truth::Slack { after: After::Event(Event::Output { .. }) } => (at.line, "output"),
            Truth::Slack { after: After::Event(Event::Departure { .. }) } => (at.line, "departure"),
            Truth::Slack { after: After::Clock } => (at.line, "clock"),
            Truth::Coupled => (at.line, "coupled"),
        }));
        let run = events(&plant, &script, 60, seed);
        for visit in visits(&run).filter(|of| matches!(truth[&of.place], Truth::Slack { .. })) {
            slack += 1;
            waited += u32::from(visit.came_s.is_some_and(|came| came > visit.arrived_s));
        }
    }
    for line in [12, 18, 28] {
        for what in ["process", "output", "departure", "clock", "coupled"] {
            assert!(seen.contains(&(line, what)), "line {line} is never {what}");
        }
    }
    let share = f64::from(waited) / f64::from(slack);
    assert!((0.4..0.95).contains(&share), "the robot waits in {share} of the slack waits");
}
