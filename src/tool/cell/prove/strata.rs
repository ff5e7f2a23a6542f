//! Strata: cycles that made the same in the same way. Only they are compared.

use std::collections::BTreeMap;

use super::error::ProveError;
use super::unit::{Kind, LeftOut, Period, Unit};

/// Least number of cycles of a stratum on each side.
const LEAST: usize = 2;

/// What both sides made.
#[derive(Clone, Debug, PartialEq)]
pub struct Stratum {
    /// Its name.
    pub name: String,
    /// Cycles before and after.
    pub cycles: [usize; 2],
    /// Mean energy of a cycle before and after, as measured, J.
    pub energy_j: [f64; 2],
    /// Its share in the result.
    pub weight: f64,
}

/// The sides with what they have in common.
pub(super) struct Common {
    /// Names of the strata.
    pub(super) names: Vec<String>,
    /// The units of each side with their strata, in the order of time.
    pub(super) sides: [Vec<(usize, Unit)>; 2],
    pub(super) left_out: Vec<LeftOut>,
    pub(super) notes: Vec<String>,
}

/// Compares what the sides made.
pub(super) fn common(sides: [Vec<Unit>; 2]) -> Result<Common, ProveError> {
    let mut notes = Vec::new();
    let mut sides = sides;
    compare(&mut sides, &mut notes, "part", |kind| kind.part.is_some(), |kind| kind.part = None);
    compare(
        &mut sides,
        &mut notes,
        "payload",
        |kind| kind.payload.is_some(),
        |kind| kind.payload = None,
    );
    compare(&mut sides, &mut notes, "way", |kind| kind.way.is_some(), |kind| kind.way = None);
    let mut counts: BTreeMap<Kind, [usize; 2]> = BTreeMap::new();
    for (side, units) in sides.iter().enumerate() {
        for unit in units {
            counts.entry(unit.kind.clone()).or_default()[side] += 1;
        }
    }
    // Few cycles of one kind are too few, no other product.
    let is_enough = counts.values().any(|count| count.iter().all(|n| *n >= LEAST));
    let least = if is_enough { LEAST } else { 1 };
    let ways: Vec<String> = counts.keys().filter_map(|kind| kind.way.clone()).collect();
    let mut names = Vec::new();
    let mut strata: BTreeMap<Kind, usize> = BTreeMap::new();
    let mut only: [Vec<String>; 2] = [Vec::new(), Vec::new()];
    let mut left_out = Vec::new();
    for (kind, count) in &counts {
        let name = name(kind, &ways);
        if count.iter().all(|n| *n >= least) {
            strata.insert(kind.clone(), names.len());
            names.push(name);
            continue;
        }
        for (side, period) in [Period::Before, Period::After].into_iter().enumerate() {
            if count[side] > 0 {
                let other = if count[1 - side] == 0 { "not at all" } else { "too seldom" };
                let why = format!("{name}: made {other} on the other side");
                left_out.push(LeftOut { period, count: count[side], why });
                only[side].push(name.clone());
            }
        }
    }
    if names.is_empty() {
        let [before, after] = only.map(|names| names.join("; "));
        return Err(ProveError::NoCommon { before, after });
    }
    let sides = sides.map(|units| {
        let found = units.into_iter().filter_map(|unit| Some((*strata.get(&unit.kind)?, unit)));
        found.collect()
    });
    Ok(Common { names, sides, left_out, notes })
}

/// Drops a property that one side does not have throughout.
fn compare(
    sides: &mut [Vec<Unit>; 2],
    notes: &mut Vec<String>,
    what: &str,
    has: fn(&Kind) -> bool,
    drop: fn(&mut Kind),
) {
    let known = [0, 1].map(|side| sides[side].iter().all(|unit| has(&unit.kind)));
    if known == [true, true] {
        return;
    }
    let some = sides.iter().any(|units| units.iter().any(|unit| has(&unit.kind)));
    if some {
        let side = if known[0] { Period::After } else { Period::Before };
        notes.push(format!(
            "cycles are not paired by {what}: not every cycle of {} has it",
            side.option()
        ));
    }
    for unit in sides.iter_mut().flatten() {
        drop(&mut unit.kind);
    }
}

fn name(kind: &Kind, ways: &[String]) -> String {
    let part = kind.part.as_ref().map(|part| format!("part {part}"));
    let payload = kind.payload.map(|steps| format!("payload {:.1} kg", 0.1 * steps as f64));
    let way = kind.way.as_ref().filter(|_| ways.len() > 1).map(|way| {
        let number = ways.iter().position(|known| known == way).unwrap_or(0);
        format!("way {} ({})", number + 1, shortened(way))
    });
    let parts: Vec<String> = part.into_iter().chain(payload).chain(way).collect();
    if parts.is_empty() { "all cycles".to_owned() } else { parts.join(", ") }
}

/// The first steps of a way.
fn shortened(way: &str) -> String {
    const MOST: usize = 60;
    if way.is_empty() {
        return "no wait".to_owned();
    }
    if way.chars().count() <= MOST {
        return way.to_owned();
    }
    way.chars().take(MOST).collect::<String>() + "…"
}
