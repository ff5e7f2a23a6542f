//! The experiment that tells slack from process where the log cannot.

use super::samples::Samples;
use super::spread::{deviation, median};
use crate::tool::cell::events::Place;

/// Delays that are tried, s: the shortest that tells in a reasonable number of cycles.
const DELAYS_S: [f64; 4] = [0.5, 1.0, 2.0, 5.0];
/// Number of cycles that is reasonable, fewest and most: half of them come later.
const REASONABLE: f64 = 120.0;
const FEWEST: f64 = 40.0;
const MOST: f64 = 400.0;
/// ln of the odds that are aimed at: twice what a verdict asks for among forty references, so that nine
/// of ten experiments decide.
const AIM: f64 = 21.0;

/// A recording in which every second cycle comes later.
#[derive(Clone, Debug, PartialEq)]
pub struct Experiment {
    /// The wait before which the robot stands still.
    pub place: Place,
    /// How much later, s.
    pub late_s: f64,
    /// Number of cycles, with and without the delay.
    pub cycles: usize,
}

impl Experiment {
    /// The experiment for a wait.
    ///
    /// With the delay d in every second cycle and a spread σ, one cycle is worth d²/(8 σ²) nats. A slack
    /// that is shorter than the delay shows its own length only.
    #[must_use]
    pub fn of(samples: &Samples) -> Experiment {
        let waited: Vec<f64> = samples
            .samples
            .iter()
            .filter(|sample| !sample.at_once())
            .map(|sample| sample.length)
            .collect();
        let steps: Vec<f64> = waited.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let spread = (deviation(&steps) / f64::sqrt(2.0)).max(0.01);
        let length = median(waited.iter().copied()).max(0.1);
        let needed = |late: f64| {
            let shown = late.min(length);
            let cycles = AIM * 8.0 * (spread / shown).powi(2);
            if cycles.is_finite() { cycles.clamp(FEWEST, MOST) } else { FEWEST }
        };
        let shortest = DELAYS_S.into_iter().find(|late| needed(*late) <= REASONABLE);
        let fewest = || DELAYS_S.into_iter().min_by(|a, b| needed(*a).total_cmp(&needed(*b)));
        let late_s = shortest.or_else(fewest).unwrap_or(DELAYS_S[0]);
        // In tens of cycles.
        let cycles = 10 * (needed(late_s) / 10.0).ceil() as usize;
        Experiment { place: samples.key.place.clone(), late_s, cycles }
    }

    /// The command that writes the program for it: robot and folder are to be filled in.
    #[must_use]
    pub fn command(&self, program: &str) -> String {
        let Experiment { place, late_s, .. } = self;
        format!("joulepath instrument {program} --robot ROBOT --out DIR --late {place}={late_s}")
    }
}
