//! Coordinates that a fit holds as they are, as they have no tangents: windows, orders of waves, couplings.

use nalgebra::{DMatrix, DVector};

use super::found::Found;
use super::search::Search;
use super::shape::resolution;
use crate::arm::effects::{Acts, Role};
use crate::gap::data::Record;
use crate::gap::design::{Design, PieceRows};
use crate::gap::posterior::{Fit, Gains};

/// Step of a difference over an order, of the orders that are told apart.
const OF_ORDER: f64 = 0.05;
/// The same over a value that may be any, of the value, and over a share.
const OF_VALUE: f64 = 0.01;

/// Times that coordinates are moved, and deviations by which one has to be off.
const POLISHED: usize = 3;
const OFF: f64 = 0.3;

/// The set with orders and couplings at their most probable values: they were found alone, without the
/// forms of the laws. Windows have fitted ends.
#[must_use]
pub(in crate::gap) fn polished(search: &Search<'_>, none: &Found, mut found: Found) -> Found {
    for _ in 0..POLISHED {
        let gains = Gains::new(search.design, &found.fit);
        let mut effects = found.effects.clone();
        let mut is_moved = false;
        for (number, piece) in effects.iter_mut().flat_map(|of| &mut of.pieces).enumerate() {
            if piece.effect.acts == Acts::InWindow {
                continue;
            }
            let records = search.logs(piece.in_baseline);
            let all = held((search.design, records), (&found.fit, &gains), number).into_iter();
            let mut shape = piece.shape.clone();
            for Held { coordinate, off, .. } in all.filter(|of| of.off.abs() > OFF * of.sd) {
                shape[coordinate] += off;
                *piece = piece.reshaped(search.design, records, &shape, true);
                is_moved = true;
            }
        }
        match is_moved.then(|| search.with(none, effects)).flatten() {
            Some(better) if better.score > found.score => found = better,
            _ => break,
        }
    }
    found
}

/// A coordinate that is held as it is in a fit.
pub(super) struct Held {
    /// Its place.
    pub coordinate: usize,
    /// By how much it is off, by a step of Gauss and Newton.
    pub off: f64,
    /// Its standard deviation.
    pub sd: f64,
}

/// The coordinates of a member without tangents: how its torque changes with each, everything that is
/// fitted marginalised.
#[must_use]
pub(super) fn held(
    (design, records): (&Design, &[Record<'_>]),
    (fit, gains): (&Fit, &Gains<'_>),
    number: usize,
) -> Vec<Held> {
    let piece = &fit.hypothesis.members[number].piece;
    let factors = fit.factors_of(number);
    let one = |coordinate: usize| {
        let step = step(records, piece, coordinate)?;
        let at = |by: f64| {
            let mut shape = piece.shape.clone();
            shape[coordinate] += by;
            piece.reshaped(design, records, &shape, true)
        };
        let slope = slope([&at(step), &at(-step)], &factors, 2.0 * step);
        let [off, sd] = gains.factor(&slope)?;
        Some(Held { coordinate, off, sd })
    };
    (0..piece.shape.len()).filter_map(one).collect()
}

/// Half of the difference over which a coordinate is looked at; `None` for one with tangents.
fn step(records: &[Record<'_>], piece: &PieceRows, k: usize) -> Option<f64> {
    let value = piece.shape[k].abs();
    match piece.effect.coordinates[k].role {
        Role::Waves { .. } => Some(OF_ORDER * resolution(records, piece.joint?)),
        Role::Rise { .. } => Some(OF_VALUE),
        // The last coordinate of a window is its period, which is known.
        Role::Choice(_) if piece.effect.acts == Acts::InWindow => {
            (k + 1 < piece.shape.len()).then_some(records.first()?.motion.step())
        }
        Role::Choice(_) => (value > 0.0).then_some(OF_VALUE * value),
        Role::Linear | Role::Shape(_) | Role::OnlyJoint => None,
    }
}

/// How the torque changes between two shapes, as a column.
fn slope([next, last]: [&PieceRows; 2], factors: &DVector<f64>, step: f64) -> PieceRows {
    let torque = |piece: &PieceRows, joint: usize| {
        let rows = piece.rows.iter().find(|(of, _)| *of == joint);
        rows.filter(|(_, rows)| rows.ncols() == factors.len()).map(|(_, rows)| rows * factors)
    };
    let column = |joint: usize| {
        let difference = (torque(next, joint)? - torque(last, joint)?) / step;
        Some((joint, DMatrix::from_columns(&[difference])))
    };
    PieceRows {
        own: 1,
        prior: vec![(0.0, 1.0)],
        rows: next.rows.iter().filter_map(|(joint, _)| column(*joint)).collect(),
        brought: Vec::new(),
        ..next.clone().without_rows()
    }
}
