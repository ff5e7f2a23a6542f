//! Stated probabilities are those with which effects were there in development cases.
//!
//! The evidence knows the laws of its library alone, so that its own probabilities are too high. The
//! counts stand in `calibration.json`, which `blind calibrate` writes.

use std::fmt::Write as _;
use std::sync::OnceLock;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::gap::tunables::Tunables;

/// The counts that are used.
const COUNTS: &str = include_str!("calibration.json");
/// Lower ends of the bins of the evidence's own probability.
const EDGES: [f64; 4] = [0.0, 0.5, 0.9, 0.99];
/// Share of the effects that are there where nothing was counted, of what is asserted and of what is
/// only considered; it weighs as much as so many cases.
const EXPECTED: [f64; 2] = [0.95, 0.3];
const WEIGHT: f64 = 2.0;
/// Version of the file.
const VERSION: u32 = 1;

/// How often effects were there that had a probability by the evidence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Counted {
    /// Lower end of the evidence's probability.
    pub from: f64,
    /// Effects.
    pub of: usize,
    /// Those that were there.
    pub there: usize,
}

/// The counts of development cases.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    /// Version of the format.
    version: u32,
    /// Hash of the settings with which the cases were diagnosed.
    settings: String,
    /// Where the cases come from.
    origin: String,
    /// Number of the cases.
    cases: usize,
    /// Effects that were asserted.
    asserted: Vec<Counted>,
    /// Effects that were only considered.
    considered: Vec<Counted>,
}

impl Calibration {
    /// Counts pairs of the evidence's probability and whether the effect was there, of what was asserted
    /// and of what was only considered.
    #[must_use]
    pub fn counted(
        origin: String,
        cases: usize,
        [asserted, considered]: [&[(f64, bool)]; 2],
    ) -> Calibration {
        let settings = settings_hash();
        let [asserted, considered] = [asserted, considered].map(bins);
        Calibration { version: VERSION, settings, origin, cases, asserted, considered }
    }

    /// The one that is used; without one, nothing was counted.
    #[must_use]
    pub fn used() -> &'static Calibration {
        static USED: OnceLock<Calibration> = OnceLock::new();
        let nothing = || Calibration::counted(String::new(), 0, [&[], &[]]);
        USED.get_or_init(|| serde_json::from_str(COUNTS).unwrap_or_else(|_| nothing()))
    }

    /// Whether it was made with the settings of this program.
    #[cfg(feature = "internals")]
    #[must_use]
    pub fn is_fresh(&self) -> bool {
        self.version == VERSION && self.settings == settings_hash()
    }

    /// The count for a probability of the evidence.
    #[must_use]
    pub fn count(&self, inclusion: f64, is_asserted: bool) -> Option<Counted> {
        let of = if is_asserted { &self.asserted } else { &self.considered };
        of.iter().rev().find(|bin| inclusion >= bin.from).copied()
    }

    /// The probability that is stated for one of the evidence: not more than for stronger evidence, of which
    /// more cases may have been counted.
    #[must_use]
    pub fn stated(&self, inclusion: f64, is_asserted: bool) -> f64 {
        let (all, expected) = if is_asserted {
            (&self.asserted, EXPECTED[0])
        } else {
            (&self.considered, EXPECTED[1])
        };
        let from = self.count(inclusion, is_asserted).map_or(0.0, |bin| bin.from);
        all.iter()
            .filter(|bin| bin.from >= from)
            .map(|bin| (bin.there as f64 + WEIGHT * expected) / (bin.of as f64 + WEIGHT))
            .fold(1.0, f64::min)
    }
}

fn bins(all: &[(f64, bool)]) -> Vec<Counted> {
    let upper = |k: usize| EDGES.get(k + 1).copied().unwrap_or(f64::INFINITY);
    let bin = |(k, from): (usize, &f64)| {
        let within = || all.iter().filter(|(p, _)| (*from..upper(k)).contains(p));
        Counted {
            from: *from,
            of: within().count(),
            there: within().filter(|(_, there)| *there).count(),
        }
    };
    EDGES.iter().enumerate().map(bin).collect()
}

/// Hash of all chosen numbers.
fn settings_hash() -> String {
    let mut all = Tunables::DEFAULT;
    let mut text = String::new();
    for of in Tunables::ALL {
        let _ = write!(text, "{}={:?};", of.name, (of.of)(&mut all));
    }
    format!("{:x}", Sha256::digest(text.as_bytes()))
}

/// The evidence's probability of an effect of another channel, by the logarithm of its odds.
pub(in crate::gap) fn of_odds(nats: f64) -> f64 {
    1.0 / (1.0 + (-nats).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stated_probabilities_are_counts() {
        let asserted: Vec<(f64, bool)> = (0..20).map(|k| (0.995, k > 1)).collect();
        let of = Calibration::counted("test".to_owned(), 20, [&asserted, &[]]);
        assert!(of.is_fresh());
        assert!((of.stated(0.999, true) - (18.0 + 1.9) / 22.0).abs() < 1e-12);
        // Nothing was counted for 0.6, but stronger evidence was right less often than expected.
        assert!((of.stated(0.6, true) - (18.0 + 1.9) / 22.0).abs() < 1e-12);
        assert!((of.stated(0.999, false) - 0.3).abs() < 1e-12);
        let nothing = Calibration::counted(String::new(), 0, [&[], &[]]);
        assert!((nothing.stated(0.6, true) - 0.95).abs() < 1e-12);
        // One right case of weak evidence makes it no more probable than strong evidence.
        let one = Calibration::counted(
            String::new(),
            21,
            [&[&asserted[..], &[(0.1, true)]].concat(), &[]],
        );
        assert!(one.stated(0.1, true) <= one.stated(0.999, true));
    }
}
