//! How often verdicts are right on made-up lines.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::line::{Line, Station, Wide};
use crate::tool::cell::waits::{Reason, Shift, WaitKind, find, samples, verdict};

/// The numbers with which the method was developed.
const DEVELOPED: Wide = Wide {
    spread: [0.003, 0.03],
    jitter: [0.003, 0.05],
    cycles: [120.0, 400.0],
    drift: 0.03,
    stops: 0.002,
};
/// Wider ones.
const WIDER: Wide = Wide {
    spread: [0.001, 0.06],
    jitter: [0.001, 0.2],
    cycles: [60.0, 600.0],
    drift: 0.08,
    stops: 0.006,
};

/// Counts of verdicts that are right, unknown and wrong.
type Counts = [usize; 3];

fn outcome(kind: WaitKind, truth: Station) -> usize {
    match (kind, truth) {
        (WaitKind::Unknown, Station::Press) => 0,
        (WaitKind::Unknown, _) => 1,
        (_, Station::Press) => 2,
        (kind, _) => 2 * usize::from((kind == WaitKind::Slack) != truth.is_slack()),
    }
}

/// Outcomes by station: of the first recording, and with the experiments that it proposes.
fn rates(seeds: std::ops::Range<u64>, wide: Wide) -> BTreeMap<Station, [Counts; 2]> {
    let all: Vec<Vec<(Station, [usize; 2])>> =
        seeds.into_par_iter().map(|seed| outcomes(seed, wide)).collect();
    let mut counts: BTreeMap<Station, [Counts; 2]> = BTreeMap::new();
    for (station, outcome) in all.into_iter().flatten() {
        let of = counts.entry(station).or_default();
        of[0][outcome[0]] += 1;
        of[1][outcome[1]] += 1;
    }
    counts
}

fn outcomes(seed: u64, wide: Wide) -> Vec<(Station, [usize; 2])> {
    let line = Line::new(seed, wide);
    let truths = line.truths();
    let first = line.record(seed, line.cycles, None).log("first.csv");
    let found = find(std::slice::from_ref(&first), None).expect("waits");
    let mut outcomes = Vec::new();
    for wait in &found.waits {
        let at = wait.samples.key.place.line;
        let truth = truths[&at];
        // What is always there is neither.
        if matches!(wait.verdict.reason, Reason::AlwaysThere) {
            continue;
        }
        let mut kind = wait.verdict.kind;
        let before = outcome(kind, truth);
        if let Some(experiment) = &wait.experiment {
            let late = Some((at, experiment.late_s));
            let more = line.record(seed + 1_000_000, experiment.cycles, late).log("late.csv");
            let both = Shift::new(&[first.clone(), more], None).expect("cycles");
            let all = samples(&both);
            let of = all.iter().find(|of| of.key == wait.samples.key).expect("the wait");
            let told = verdict(&both, of);
            kind = told.kind;
        }
        outcomes.push((truth, [before, outcome(kind, truth)]));
    }
    outcomes
}

/// Sums over the stations that are slack or process.
fn totals(found: &BTreeMap<Station, [Counts; 2]>) -> [Counts; 2] {
    let told = found.iter().filter(|(station, _)| **station != Station::Press);
    told.fold([[0; 3]; 2], |mut sum, (_, of)| {
        for (sums, counts) in sum.iter_mut().zip(of) {
            for (sum, count) in sums.iter_mut().zip(counts) {
                *sum += count;
            }
        }
        sum
    })
}

/// Number of lines that each test draws: few, or as many as the variable `JOULEPATH_LINES` says, as for the
/// rates of `docs/cell.md`.
fn lines() -> u64 {
    option_env!("JOULEPATH_LINES").and_then(|text| text.parse().ok()).unwrap_or(16)
}

#[expect(clippy::print_stdout, reason = "the rates of the page, shown with --nocapture")]
fn check(seeds: std::ops::Range<u64>, wide: Wide) {
    let found = rates(seeds, wide);
    let [first, second] = totals(&found);
    let sum = |of: Counts| of.iter().sum::<usize>() as f64;
    let shown = format!("{found:#?} {first:?} {second:?}");
    println!("right, unknown, wrong: {first:?}, with the experiments {second:?}\n{found:?}");
    assert!(first[2] as f64 <= 0.01 * sum(first) + 1.0, "{shown}");
    assert!(second[2] as f64 <= 0.01 * sum(second) + 1.0, "{shown}");
    assert!(first[0] as f64 >= 0.7 * sum(first), "{shown}");
    assert!(second[0] as f64 >= 0.85 * sum(second), "{shown}");
    // A machine that answers in part is never used as slack.
    let pressed = found.get(&Station::Press).copied().unwrap_or_default();
    assert!(pressed[0][2] + pressed[1][2] <= 2, "{shown}");
}

#[test]
fn rates_on_lines_like_those_of_the_development() {
    check(0..lines(), DEVELOPED);
}

/// Seed of lines that nobody has looked at.
const FRESH: u64 = 50_000;

#[test]
fn rates_on_other_and_wider_lines() {
    check(FRESH..FRESH + lines(), WIDER);
}
