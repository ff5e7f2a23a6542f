//! Effects that act for a part of each repetition, or of a log.
//!
//! What acts in a window is the sum of what acts in its parts: the products of the parts tell what each
//! window would gain. The best ones are moved until their ends fit.

use super::shape::{Move, climbed, lowest};
use crate::arm::effects::Effect;
use crate::gap::data::Record;
use crate::gap::design::{Design, PieceRows, Times, Whole};
use crate::gap::posterior::Gains;

/// Parts of a repetition at which windows begin and end, and their lengths in parts.
const PARTS: usize = 96;
const LENGTHS: [usize; 11] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 40];
/// Windows from which the best one is looked for.
const STARTS: usize = 2;
/// Least gain of a window that is looked at further \[nats\].
const LEAST: f64 = 4.0;

/// An effect that acts in windows, at a joint.
pub(super) struct Windows {
    whole: Whole,
    /// Duration of a part \[s\].
    part: f64,
    times: Times,
    /// What acts in each part.
    parts: PieceRows,
}

impl Windows {
    /// Windows of an effect.
    pub(super) fn new(
        design: &Design,
        records: &[Record<'_>],
        effect: &'static Effect,
        joint: usize,
    ) -> Option<Windows> {
        let first = records.first()?;
        let whole = Whole::new(records, effect, joint)?;
        let closed = first.motion.closed;
        let [begins, ends] = if closed { [0.0, first.duration()] } else { range(records) };
        let part = (ends - begins) / PARTS as f64;
        let period = if closed { ends } else { 0.0 };
        let times = Times { begins, period, choices: PARTS * LENGTHS.len() };
        let parts = whole.parts(design, records, (part, PARTS), &times);
        Some(Windows { whole, part, times, parts })
    }

    /// The best windows beside a fit.
    pub(super) fn best(
        &self,
        records: &[Record<'_>],
        design: &Design,
        gains: &Gains<'_>,
    ) -> Vec<PieceRows> {
        let within = |_: &PieceRows, shape: &[f64]| {
            let mut shape = shape.to_vec();
            let n = shape.len();
            shape[n - 2] = shape[n - 2].max(shape[n - 3]);
            if let Some((k, most)) = self.whole.rise() {
                shape[k] = shape[k].clamp(0.0, most);
            }
            self.whole.within(design, records, shape, &self.times)
        };
        let by = |coordinate, step| Move { coordinate, step, is_factor: false };
        let climb = |window: [f64; 2]| {
            let shape = self.whole.shape(window, &self.times);
            let start = self.whole.within(design, records, shape, &self.times);
            let n = start.shape.len();
            let ends = [by(n - 3, 0.5 * self.part), by(n - 2, 0.5 * self.part)];
            climbed(gains, &start, &ends, f64::INFINITY, &within)
        };
        let mut all: Vec<PieceRows> =
            self.starts(gains, lowest(records)).into_iter().map(climb).collect();
        // What is slow to rise begins at the best window of what is there at once.
        let gain = |piece: &PieceRows| gains.of(piece, f64::INFINITY);
        let best = all.iter().max_by(|a, b| gain(a).total_cmp(&gain(b)));
        if let (Some(best), Some((k, most))) = (best, self.whole.rise()) {
            let n = best.shape.len();
            let moves = [by(n - 3, self.part), by(n - 2, self.part), by(k, 0.5 * most)];
            all.push(climbed(gains, best, &moves, lowest(records), &within));
        }
        all
    }

    /// Windows that begin and end with parts and explain most, apart from each other: of those that the
    /// low frequencies tell and of those that all do.
    fn starts(&self, gains: &Gains<'_>, lowest: f64) -> Vec<[f64; 2]> {
        let windows: Vec<[usize; 2]> = LENGTHS
            .iter()
            .flat_map(|length| (0..PARTS).map(move |begin| [begin, begin + length]))
            .filter(|[_, end]| self.times.period > 0.0 || *end <= PARTS)
            .collect();
        let least = LEAST + (self.times.choices as f64).ln();
        let mut best: Vec<[usize; 2]> = Vec::new();
        for below in [lowest, f64::INFINITY] {
            let of_windows = gains.of_windows(&self.parts, PARTS, &windows, below);
            let mut all: Vec<(f64, [usize; 2])> =
                of_windows.into_iter().zip(windows.iter().copied()).collect();
            all.sort_by(|a, b| b.0.total_cmp(&a.0));
            let mut count = 0;
            for (_, [a, b]) in all.into_iter().take_while(|(gain, _)| *gain > least) {
                let is_apart = |[c, d]: &[usize; 2]| {
                    2 * b.min(*d).saturating_sub(a.max(*c)) <= (b - a).min(d - c)
                };
                if count < STARTS && best.iter().all(is_apart) {
                    best.push([a, b]);
                    count += 1;
                }
            }
        }
        best.into_iter()
            .map(|window| window.map(|k| self.times.begins + self.part * k as f64))
            .collect()
    }
}

/// The first and the last time of records \[s\].
fn range(records: &[Record<'_>]) -> [f64; 2] {
    let times = || records.iter().flat_map(|record| &record.motion.t).copied();
    [times().fold(f64::INFINITY, f64::min), times().fold(f64::NEG_INFINITY, f64::max)]
}
