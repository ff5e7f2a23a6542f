//! The best shape of a piece: a pattern search from coarse to fine, low frequencies first.
//!
//! The evidence of a jump has a narrow peak, as high frequencies know every row that is on the wrong
//! side of it; low frequencies lead there.

use std::f64::consts::PI;

use crate::arm::effects::{Effect, Role};
use crate::gap::data::Record;
use crate::gap::design::PieceRows;
use crate::gap::posterior::Gains;

/// Levels: each halves the steps and doubles the frequencies.
const LEVELS: i32 = 6;
/// The lowest limit, in bins.
const LOWEST: usize = 24;
/// Rounds at one level.
const ROUNDS: usize = 4;
/// Gain of a step that counts \[nats\].
const LEAST: f64 = 0.02;

/// How a coordinate is moved.
#[derive(Clone, Copy, Debug)]
pub(in crate::gap) struct Move {
    /// Number of the coordinate.
    pub coordinate: usize,
    /// First step: a factor less 1 or a difference.
    pub step: f64,
    /// Whether it is a factor.
    pub is_factor: bool,
}

/// The moves of an effect's shape coordinates.
#[must_use]
pub(in crate::gap) fn moves(
    effect: &Effect,
    records: &[Record<'_>],
    piece: &PieceRows,
) -> Vec<Move> {
    let Some(first) = records.first() else { return Vec::new() };
    let scale = first.motion.scale(piece.joint.unwrap_or(0));
    let mut all = Vec::new();
    for (k, coordinate) in effect.coordinates.iter().enumerate() {
        if let (Role::Waves { .. }, Some(joint)) = (coordinate.role, piece.joint) {
            all.push(Move {
                coordinate: k,
                step: 0.5 * resolution(records, joint),
                is_factor: false,
            });
            continue;
        }
        let (Role::Shape(values) | Role::Choice(values)) = coordinate.role else { continue };
        let tried = values(&scale);
        let value = piece.shape[k];
        let apart = |x: &f64| (x - value).abs();
        let nearest = tried.iter().map(apart).filter(|x| *x > 1e-9).fold(f64::INFINITY, f64::min);
        if tried.len() < 2 || value == 0.0 || !nearest.is_finite() {
            continue;
        }
        let is_factor = tried.iter().all(|x| *x >= 0.0);
        let step = if is_factor { 0.5 * nearest / value } else { 0.5 * nearest };
        all.push(Move {
            coordinate: k,
            step: if is_factor { step.min(0.6) } else { step },
            is_factor,
        });
    }
    all
}

/// Orders of waves over the position of a joint that are told apart \[1/rad\].
#[must_use]
pub(super) fn resolution(records: &[Record<'_>], joint: usize) -> f64 {
    let all = || records.iter().flat_map(|of| &of.motion.q[joint]).copied();
    let range = all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min);
    PI / range.max(1e-6)
}

/// The lowest limit of frequencies \[Hz\].
#[must_use]
pub(in crate::gap) fn lowest(records: &[Record<'_>]) -> f64 {
    let lasts = records.first().map_or(1.0, |r| r.motion.step() * r.motion.rows() as f64);
    LOWEST as f64 / lasts
}

/// The piece at the best shape that the moves reach: low frequencies first, or all at once. Tangents
/// would make up for a shape that is off: `reshape` makes pieces without them.
#[must_use]
pub(in crate::gap) fn refined(
    gains: &Gains<'_>,
    piece: &PieceRows,
    moves: &[Move],
    lowest: f64,
    reshape: &dyn Fn(&PieceRows, &[f64]) -> PieceRows,
) -> PieceRows {
    let [low, all] =
        [lowest, f64::INFINITY].map(|below| climbed(gains, piece, moves, below, reshape));
    if gains.of(&low, f64::INFINITY) > gains.of(&all, f64::INFINITY) { low } else { all }
}

/// The same by one search, which begins with the frequencies `below` \[Hz\].
#[must_use]
pub(super) fn climbed(
    gains: &Gains<'_>,
    piece: &PieceRows,
    moves: &[Move],
    below: f64,
    reshape: &dyn Fn(&PieceRows, &[f64]) -> PieceRows,
) -> PieceRows {
    if moves.is_empty() {
        return piece.clone();
    }
    Climb { gains, moves, reshape }.from(&reshape(piece, &piece.shape), below)
}

/// A pattern search.
struct Climb<'a> {
    gains: &'a Gains<'a>,
    moves: &'a [Move],
    reshape: &'a dyn Fn(&PieceRows, &[f64]) -> PieceRows,
}

impl Climb<'_> {
    /// The best shape near a piece; the first level has the frequencies `below` \[Hz\].
    fn from(&self, piece: &PieceRows, mut below: f64) -> PieceRows {
        let mut best = piece.clone();
        for level in 0..LEVELS {
            let mut most = self.gains.of(&best, below);
            for _ in 0..ROUNDS {
                let step = self.step(&best, below, most, 0.5_f64.powi(level));
                let Some((gain, better)) = step else { break };
                (most, best) = (gain, better);
            }
            below *= 2.0;
        }
        best
    }

    /// The piece after the moves that gain more than `most`, made smaller by `shrink`.
    fn step(
        &self,
        piece: &PieceRows,
        below: f64,
        mut most: f64,
        shrink: f64,
    ) -> Option<(f64, PieceRows)> {
        let mut best: Option<PieceRows> = None;
        for of in self.moves {
            for sign in [-1.0, 1.0] {
                let from = best.as_ref().unwrap_or(piece);
                let mut shape = from.shape.clone();
                let x = &mut shape[of.coordinate];
                *x = if of.is_factor {
                    *x * (1.0 + of.step * shrink).powf(sign)
                } else {
                    *x + sign * of.step * shrink
                };
                let tried = (self.reshape)(from, &shape);
                if tried.own == 0 || tried.rows.is_empty() {
                    continue;
                }
                let gain = self.gains.of(&tried, below);
                if gain > most + LEAST {
                    (most, best) = (gain, Some(tried));
                    break;
                }
            }
        }
        best.map(|best| (most, best))
    }
}
