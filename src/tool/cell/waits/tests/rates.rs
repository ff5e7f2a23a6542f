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

#[test]
fn look() {
    let seed: u64 = std::env::var("SEED").unwrap().parse().unwrap();
    let at: u32 = std::env::var("LINE").unwrap().parse().unwrap();
    let wide = if seed < 5000 { DEVELOPED } else { WIDER };
    let (log, truths) = line(seed, wide);
    println!("{truths:?}");
    let text = log.text();
    println!("{}", text.lines().skip(900).take(100).collect::<Vec<_>>().join("\n"));
    let recording = crate::tool::cell::events::read(text.as_bytes()).expect("a log");
    let shift = crate::tool::cell::waits::Shift::new(&[crate::tool::cell::waits::Log { name: "a.csv".to_owned(), recording }], None).expect("cycles");
    println!("ways {:?}", shift.frequencies());
    for of in crate::tool::cell::waits::samples(&shift) {
        if of.key.place.line == at {
            crate::tool::cell::waits::verdict::show(&shift, &of);
        }
    }
}
