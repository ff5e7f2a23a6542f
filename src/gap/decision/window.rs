//! Effects that act for a part of each repetition, or of a log.
//!
//! What acts in a window is the sum of what acts in its parts. Where windows begin and end is looked for
//! at low frequencies, too: they see no single row.

use super::shape::{Move, climbed, lowest};
use crate::arm::effects::Effect;
use crate::gap::data::Record;
use crate::gap::design::{Clock, Design, PieceRows, Times, Whole};
use crate::gap::posterior::Gains;

/// Parts of a repetition at which windows begin and end, and their lengths in parts.
const PARTS: usize = 20;
const LENGTHS: [usize; 5] = [1, 2, 3, 5, 8];
/// Windows from which the best one is looked for.
const STARTS: usize = 2;
/// Least gain of a window that is looked at further \[nats\].
const LEAST: f64 = 4.0;

/// An effect that acts in windows, at a joint.
pub(super) struct Windows {
    whole: Whole,
    /// Duration of a part \[s\].
    part: f64,
    /// By clock, what acts in each part.
    parts: Vec<(Times, PieceRows)>,
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
        let part = first.duration() / PARTS as f64;
        let period = if first.motion.closed { first.duration() } else { 0.0 };
        // Both clocks are the same where all logs begin at the same part of the period.
        let phase = |record: &Record<'_>| {
            let begins = record.times.first().map_or(0.0, |(begins, _)| *begins);
            if period > 0.0 { begins.rem_euclid(period) } else { begins }
        };
        let begins = phase(first);
        let is_same = |record: &Record<'_>| (phase(record) - begins).abs() < 0.1 * part;
        let clocks: &[Clock] = if records.iter().all(is_same) && begins < 0.1 * part {
            &[Clock::Absolute]
        } else {
            &[Clock::Absolute, Clock::Log]
        };
        let choices = PARTS * LENGTHS.len() * clocks.len();
        let of_clock = |clock: &Clock| {
            let times = Times { period, clock: *clock, choices };
            (times, whole.parts(design, records, (part, PARTS), &times))
        };
        let parts = clocks.iter().map(of_clock).collect();
        Some(Windows { whole, part, parts })
    }

    /// The best windows beside a fit.
    pub(super) fn best(
        &self,
        records: &[Record<'_>],
        design: &Design,
        gains: &Gains<'_>,
    ) -> Vec<PieceRows> {
        let limits = [lowest(records), f64::INFINITY];
        let mut best: Vec<PieceRows> = Vec::new();
        for below in limits {
            for (times, window) in self.starts(gains, below) {
                let within = |shape: &[f64]| {
                    let mut shape = shape.to_vec();
                    let n = shape.len();
                    shape[n - 2] = shape[n - 2].max(shape[n - 3]);
                    if let Some((k, most)) = self.whole.rise() {
                        shape[k] = shape[k].clamp(0.0, most);
                    }
                    self.whole.within(design, records, shape, &times)
                };
                let piece = within(&self.whole.shape(window, &times));
                let n = piece.shape.len();
                let by = |coordinate, step| Move { coordinate, step, is_factor: false };
                let mut moves = vec![by(n - 3, 0.5 * self.part), by(n - 2, 0.5 * self.part)];
                let climb = |from: &PieceRows, moves: &[Move]| {
                    climbed(gains, from, moves, below, &|_, shape| within(shape))
                };
                let at_once = climb(&piece, &moves);
                if let Some((k, most)) = self.whole.rise() {
                    moves.push(by(k, 0.5 * most));
                    best.push(climb(&at_once, &moves));
                }
                best.push(at_once);
            }
        }
        best
    }

    /// Windows that begin and end with parts and explain most, apart from each other.
    fn starts(&self, gains: &Gains<'_>, below: f64) -> Vec<(Times, [f64; 2])> {
        let mut all: Vec<(f64, Times, [usize; 2])> = Vec::new();
        for (times, parts) in &self.parts {
            let windows: Vec<[usize; 2]> = LENGTHS
                .iter()
                .flat_map(|length| (0..PARTS).map(move |begin| [begin, begin + length]))
                .filter(|[_, end]| times.period > 0.0 || *end <= PARTS)
                .collect();
            let of_windows = gains.of_sums(parts, PARTS, &windows, below);
            all.extend(of_windows.into_iter().zip(windows).map(|(gain, of)| (gain, *times, of)));
        }
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut best: Vec<(Times, [usize; 2])> = Vec::new();
        for (gain, times, [a, b]) in all {
            if best.len() == STARTS || gain < LEAST + (times.choices as f64).ln() {
                break;
            }
            let is_apart = |(_, [c, d]): &(Times, [usize; 2])| {
                2 * b.min(*d).saturating_sub(a.max(*c)) <= (b - a).min(d - c)
            };
            if best.iter().all(is_apart) {
                best.push((times, [a, b]));
            }
        }
        let of = |k: usize| self.part * k as f64;
        best.into_iter().map(|(times, window)| (times, window.map(of))).collect()
    }
}
