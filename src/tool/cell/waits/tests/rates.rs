//! How often verdicts are right on made-up lines.

use std::collections::BTreeMap;

use super::line::{Station, Wide, line};
use crate::tool::cell::waits::{Reason, WaitKind};

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

/// Right, unknown and wrong verdicts by station.
fn rates(seeds: std::ops::Range<u64>, wide: Wide, shows: bool) -> BTreeMap<Station, [usize; 3]> {
    let mut counts: BTreeMap<Station, [usize; 3]> = BTreeMap::new();
    for seed in seeds {
        let (log, truths) = line(seed, wide);
        for (line, verdict, after) in log.verdicts() {
            let truth = truths[&line];
            let outcome = match (verdict.kind, truth) {
                (WaitKind::Unknown, Station::Press) => 0,
                (WaitKind::Unknown, _) if verdict.reason == Reason::AlwaysThere => continue,
                (WaitKind::Unknown, _) => 1,
                (_, Station::Press) => 2,
                (kind, _) => 2 * usize::from((kind == WaitKind::Slack) != truth.is_slack()),
            };
            counts.entry(truth).or_default()[outcome] += 1;
            if shows && outcome > 0 {
                let after = after.map_or(String::new(), |after| after.to_string());
                let said = format!("{:?} {:?} {:.1}", verdict.kind, verdict.reason, verdict.log_odds);
                println!("{seed} {line} {truth:?}: {said} {:?} {after}", verdict.slope);
            }
        }
    }
    counts
}

#[test]
fn show() {
    for (wide, seeds) in [(DEVELOPED, 0..60), (WIDER, 5000..5060)] {
        let found = rates(seeds, wide, true);
        for (station, counts) in &found {
            println!("{station:?} {counts:?}");
        }
        let sum = |k: usize| found.values().map(|of| of[k]).sum::<usize>();
        println!("all {:?}", [sum(0), sum(1), sum(2)]);
    }
}
