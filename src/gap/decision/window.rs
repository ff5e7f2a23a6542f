//! Effects that act for a part of each repetition, or of a log.
//!
//! Where windows begin and end is looked for at low frequencies first: they see no single row.

use super::shape::{Move, lowest, refined};
use crate::gap::data::Record;
use crate::gap::design::{Clock, Design, PieceRows, Whole};
use crate::gap::posterior::Gains;

/// Parts of a repetition at which windows begin and end, and their lengths in parts.
const PARTS: usize = 20;
const LENGTHS: [usize; 5] = [1, 2, 3, 5, 8];
/// Frequencies that are looked at first, in bins.
const LOWEST: usize = 24;
/// Windows from which the best one is looked for.
const STARTS: usize = 2;
/// Least gain of a window that is looked at further \[nats\].
const LEAST: f64 = 4.0;

/// The best windows of an effect at a joint beside a fit.
#[must_use]
pub(in crate::gap) fn windows(
    records: &[Record<'_>],
    design: &Design,
    gains: &Gains<'_>,
    whole: &Whole,
) -> Vec<PieceRows> {
    let Some(first) = records.first() else { return Vec::new() };
    let lasts = first.motion.step() * first.motion.rows() as f64;
    let part = lasts / PARTS as f64;
    let period = if first.motion.closed { lasts } else { 0.0 };
    let choices = PARTS * LENGTHS.len();
    let mut pieces = Vec::new();
    let begins = |record: &Record<'_>| record.times.first().map_or(0.0, |(begins, _)| *begins);
    // Both clocks are the same where all logs begin at the same part of the period.
    let phase = |record: &Record<'_>| {
        let begins = begins(record);
        if period > 0.0 { begins.rem_euclid(period) } else { begins }
    };
    let first_phase = phase(first);
    let are_same = records.iter().all(|record| (phase(record) - first_phase).abs() < 0.1 * part);
    let clocks: &[Clock] = if are_same && first_phase < 0.1 * part {
        &[Clock::Absolute]
    } else {
        &[Clock::Absolute, Clock::Log]
    };
    let choices = choices * clocks.len();
    for clock in clocks {
        for length in LENGTHS {
            for begin in 0..PARTS {
                if period == 0.0 && begin + length > PARTS {
                    continue;
                }
                let window = [part * begin as f64, part * (begin + length) as f64];
                pieces.push(whole.within(design, records, window, period, *clock, choices));
            }
        }
    }
    let ends = |piece: &PieceRows| {
        let n = piece.shape.len();
        [piece.shape[n - 3], piece.shape[n - 2]]
    };
    let mut best: Vec<&PieceRows> = Vec::new();
    for below in [LOWEST as f64 / lasts, f64::INFINITY] {
        let by_window: Vec<f64> = gains.of_all(&pieces, below).iter().map(|of| of[0]).collect();
        let mut order: Vec<usize> = (0..pieces.len()).collect();
        order.sort_by(|a, b| by_window[*b].total_cmp(&by_window[*a]));
        let mut left = STARTS;
        for k in order {
            if left == 0 || by_window[k] < LEAST + (choices as f64).ln() {
                break;
            }
            let [a, b] = ends(&pieces[k]);
            let is_apart = best.iter().all(|other| {
                let [c, d] = ends(other);
                b.min(d) - a.max(c) <= 0.5 * (b - a).min(d - c)
            });
            if is_apart {
                best.push(&pieces[k]);
                left -= 1;
            }
        }
    }
    best.into_iter()
        .map(|piece| {
            let n = piece.shape.len();
            let moves = [n - 3, n - 2].map(|coordinate| Move {
                coordinate,
                step: 0.5 * part,
                is_factor: false,
            });
            let reshape = |of: &PieceRows, shape: &[f64]| {
                let window = [shape[n - 3], shape[n - 2].max(shape[n - 3])];
                whole.within(design, records, window, period, of.clock, choices)
            };
            refined(gains, piece, &moves, lowest(records), &reshape)
        })
        .collect()
}
