//! When signals come, after what.

use std::collections::BTreeMap;

use super::reference::{AT_ONCE_S, Kind, Level, Moment, Reference, moments};
use super::samples::{Sample, candidates};
use super::shift::Shift;
use super::spread::{deviation, median};
use crate::tool::cell::events::Place;

/// Fewest changes of a signal.
const MIN_CHANGES: usize = 12;
/// An output is named if it tells the time nearly as well as the best other event.
const NEARLY: f64 = 1.25;

/// When a signal comes.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalTime {
    /// Its name.
    pub signal: String,
    /// Its new level; `None` if only ends of waits for it are known.
    pub level: Option<f64>,
    /// Number of changes.
    pub n: usize,
    /// The event after which its time repeats best.
    pub after: Reference,
    /// Where the program does it.
    pub place: Option<Place>,
    /// Median and spread of the time after it, s.
    pub median_s: f64,
    /// See `median_s`.
    pub deviation_s: f64,
}

/// Cycles and times of the changes of signals to levels.
type Changes = BTreeMap<(String, Option<Level>), Vec<(usize, f64)>>;

/// The signals of a shift that are recorded or waited for.
#[must_use]
pub(super) fn signals(shift: &Shift) -> Vec<SignalTime> {
    let all: Vec<Vec<Moment>> = moments(&shift.cycles);
    let mut changes = Changes::new();
    for (cycle, moments) in all.iter().enumerate() {
        for moment in moments {
            if let Kind::Signal(name, level) = &moment.kind {
                changes.entry((name.clone(), Some(*level))).or_default().push((cycle, moment.t));
            }
        }
    }
    let recorded: Vec<String> = changes.keys().map(|(name, _)| name.clone()).collect();
    for (cycle, visits) in shift.cycles.iter().map(|cycle| &cycle.visits).enumerate() {
        for visit in visits {
            let Some(signal) = visit.signal.as_ref().filter(|name| !recorded.contains(name)) else {
                continue;
            };
            let length = visit.length().filter(|length| *length > AT_ONCE_S && !visit.by_limit);
            if let Some(length) = length {
                let of = changes.entry((signal.clone(), None)).or_default();
                of.push((cycle, visit.came + length));
            }
        }
    }
    let found = changes.into_iter().filter(|(_, times)| times.len() >= MIN_CHANGES);
    found.filter_map(|((name, level), times)| of_signal(shift, &all, name, level, &times)).collect()
}

fn of_signal(
    shift: &Shift,
    all: &[Vec<Moment>],
    signal: String,
    level: Option<Level>,
    times: &[(usize, f64)],
) -> Option<SignalTime> {
    let sample = |(cycle, t): &(usize, f64)| Sample {
        cycle: *cycle,
        occurrence: 0,
        came: *t,
        length: f64::INFINITY,
        heard: None,
    };
    let samples: Vec<Sample> = times.iter().map(sample).collect();
    let own = level.map(|level| Kind::Signal(signal.clone(), level));
    let candidates = candidates(shift, all, &samples, own.as_ref());
    let after = |times: &[Option<f64>]| -> Vec<f64> {
        samples.iter().zip(times).filter_map(|(sample, t)| Some(sample.came - (*t)?)).collect()
    };
    let spreads = candidates.iter().map(|candidate| {
        let after = after(&candidate.times);
        let is_output = matches!(candidate.reference.kind, Kind::Output(..));
        // The end of a wait for the signal is the signal; a spread of 0 is no better than the clock's.
        let spread = deviation(&after).max(shift.step_s) / if is_output { NEARLY } else { 1.0 };
        let is_same = median(after.iter().copied()) < AT_ONCE_S && !is_output;
        (if is_same { f64::INFINITY } else { spread }, candidate)
    });
    let (spread, best) = spreads.min_by(|a, b| a.0.total_cmp(&b.0))?;
    if !spread.is_finite() {
        return None;
    }
    let after = after(&best.times);
    Some(SignalTime {
        signal,
        level: level.map(|level| level.0),
        n: times.len(),
        after: best.reference.clone(),
        place: best.place.clone(),
        median_s: median(after.iter().copied()),
        deviation_s: deviation(&after),
    })
}
