//! All that the logs of a program say about its waits.

use rayon::prelude::*;

use super::error::WaitsError;
use super::experiment::Experiment;
use super::populations::{Population, populations};
use super::reference::AT_ONCE_S;
use super::samples::{Samples, samples};
use super::shift::{Log, Shift};
use super::signals::{SignalTime, signals};
use super::spread::{quantile, sorted};
use super::trend::{Trend, trend};
use super::verdict::{Reason, Verdict, verdict};

/// The shares of which the quantiles are told.
pub const SHARES: [f64; 5] = [0.05, 0.25, 0.5, 0.75, 0.95];

/// A wait.
#[derive(Clone, Debug)]
pub struct Wait {
    /// Its visits.
    pub samples: Samples,
    /// Its kind.
    pub verdict: Verdict,
    /// Quantiles of its length at [`SHARES`], s.
    pub quantiles_s: [f64; 5],
    /// Share of the visits that find everything ready.
    pub at_once: f64,
    /// How its length changes.
    pub trend: Option<Trend>,
    /// Its populations.
    pub populations: Vec<Population>,
    /// What would tell its kind.
    pub experiment: Option<Experiment>,
}

/// What the logs of a program say.
#[derive(Clone, Debug)]
pub struct Found {
    /// The cycles.
    pub shift: Shift,
    /// The waits, in the order of the program's text.
    pub waits: Vec<Wait>,
    /// The signals.
    pub signals: Vec<SignalTime>,
}

/// What logs say about the waits of their program. `program` is the hash of the program that is given.
///
/// # Errors
/// Logs of several programs or of another one; one recording twice; no complete cycle.
pub fn find(logs: &[Log], program: Option<&str>) -> Result<Found, WaitsError> {
    let shift = Shift::new(logs, program)?;
    let waits = samples(&shift).into_par_iter().map(|samples| wait(&shift, samples)).collect();
    let signals = signals(&shift);
    Ok(Found { shift, waits, signals })
}

fn wait(shift: &Shift, samples: Samples) -> Wait {
    let verdict = verdict(shift, &samples);
    let lengths = samples.lengths();
    let hours: Vec<f64> = samples.samples.iter().map(|sample| shift.hours(sample.cycle)).collect();
    let ready = lengths.iter().filter(|length| **length <= AT_ONCE_S).count();
    let can_tell = matches!(verdict.reason, Reason::CannotTell | Reason::TooFew);
    let in_order = sorted(lengths.iter().copied());
    Wait {
        quantiles_s: SHARES.map(|share| quantile(&in_order, share)),
        at_once: ready as f64 / lengths.len().max(1) as f64,
        trend: trend(&hours, &lengths),
        populations: populations(&lengths),
        experiment: (can_tell && !lengths.is_empty()).then(|| Experiment::of(&samples)),
        samples,
        verdict,
    }
}
