//! From the nearest of the tried shapes to the best one, with deviations.

use nalgebra::{DMatrix, DVector};

use crate::effects::{Effect, Role};

use super::channel::Channel;
use super::column::{Owner, Piece, columns_at, more_of};
use super::record::Record;
use super::search::Search;
use super::table::{Placed, Table};

/// Rounds of new tangents.
const ROUNDS: usize = 6;
/// Relative change of a shape in one round at most.
const STEP: f64 = 0.5;
/// A shape may be this many times beyond the tried values.
const BEYOND: f64 = 2.0;
/// Step over which parameters are differentiated, in deviations.
const DIFFERENCE: f64 = 1e-3;

/// An effect at a joint, with its parameters.
#[derive(Clone)]
pub struct Fitted {
    /// The effect.
    pub effect: &'static Effect,
    /// Joint, from 0; `None` of the robot.
    pub joint: Option<usize>,
    /// Its coordinates.
    pub coordinates: Vec<f64>,
    /// Its parameters, as they are written.
    pub parameters: Vec<f64>,
    /// Their standard deviations.
    pub deviations: Vec<f64>,
    /// The largest of its linear coordinates over their deviation; infinite where the effect
    /// has none.
    pub significance: f64,
}

/// All effects that were found, and the parameters of the model with them.
pub struct Polished {
    /// Effects joint by joint.
    pub effects: Vec<Fitted>,
    /// The pieces at their best shapes, in the order in which they were given.
    pub pieces: Vec<Piece>,
    /// Functions of one thing that were found: id and joint.
    pub generic: Vec<(&'static str, Option<usize>)>,
    /// What all torques go through.
    pub channel: Channel,
    /// Changes of the model's parameters, in deviations.
    pub parameters: DVector<f64>,
    /// What is left, 1 where it is noise.
    pub misfit: f64,
}

/// Improves shapes by new tangents until they stay.
#[must_use]
pub fn polish(search: &Search<'_, '_>, pieces: &[usize]) -> Option<Polished> {
    let Search { records, error, ref channel, ref nuisances, .. } = *search;
    let first: Vec<&Placed> = pieces.iter().map(|number| &search.table.pieces[*number]).collect();
    let mut shapes: Vec<Vec<f64>> = first.iter().map(|placed| placed.shape.clone()).collect();
    // Delay and lag act on all that is computed.
    let mut channel = *channel;
    for (placed, shape) in first.iter().zip(&shapes) {
        if let Owner::Effect(effect) = placed.owner
            && let Some(value) = channel.of(effect)
            && *value == 0.0
        {
            *value = shape[0];
        }
    }
    let mut result = None;
    for round in 0..ROUNDS {
        let made: Vec<Piece> = first
            .iter()
            .zip(&shapes)
            .map(|(placed, shape)| remade(placed, records, shape))
            .collect();
        let mut table = Table::of(records, made, nuisances);
        table.through(&channel);
        let evidence = table.evidence(error);
        let all: Vec<usize> = table.pieces.iter().flat_map(|piece| piece.columns.clone()).collect();
        let estimate = evidence.estimate(&all)?;
        let mut fitted = Vec::new();
        for (placed, shape) in table.pieces.iter().zip(&mut shapes) {
            let Owner::Effect(effect) = placed.owner else { continue };
            let at = placed.columns.clone();
            let mean = estimate.mean.rows(at.start, at.len()).into_owned();
            let covariance =
                estimate.covariance.view((at.start, at.start), (at.len(), at.len())).into_owned();
            if let Some(value) = channel.of(effect) {
                let spread = DMatrix::from_element(1, 1, covariance[(1, 1)]);
                let next = *value + mean[1];
                fitted.push(of(effect, placed.joint, &[next], &spread));
                // The last round only reads.
                if round + 1 < ROUNDS {
                    *value = next;
                }
                shape[0] = *value;
                continue;
            }
            let (coordinates, jacobian) = coordinates_of(effect, shape, &mean);
            let spread = &jacobian * &covariance * jacobian.transpose();
            fitted.push(of(effect, placed.joint, &coordinates, &spread));
            for (k, coordinate) in effect.coordinates.iter().enumerate() {
                if matches!(coordinate.role, Role::Shape(_)) {
                    let most = STEP * shape[k].abs();
                    shape[k] += (coordinates[k] - shape[k]).clamp(-most, most);
                    if let Some([low, high]) = range(effect, records, placed.joint, k) {
                        shape[k] = shape[k].clamp(low, high);
                    }
                }
            }
        }
        if round + 1 == ROUNDS {
            let generic = table.pieces.iter().filter_map(|piece| match piece.owner {
                Owner::Generic(id) => Some((id, piece.joint)),
                Owner::Effect(_) => None,
            });
            let gained = evidence.gain(&all);
            result = Some(Polished {
                effects: fitted,
                channel,
                pieces: first
                    .iter()
                    .zip(&shapes)
                    .map(|(placed, shape)| remade(placed, records, shape))
                    .collect(),
                generic: generic.collect(),
                parameters: evidence.parameters(&all, &estimate.mean),
                misfit: evidence.misfit - 2.0 * gained / evidence.rows.max(1) as f64,
            });
        }
    }
    result
}

/// What lies within the tried values of a shape, and a little beyond.
fn range(
    effect: &Effect,
    records: &[Record<'_>],
    joint: Option<usize>,
    k: usize,
) -> Option<[f64; 2]> {
    let scale = records.first()?.motion.scale(joint.unwrap_or(0));
    let Role::Shape(tried) = effect.coordinates[k].role else { return None };
    let tried = tried(&scale);
    let (low, high) = (tried.first()?, tried.last()?);
    let beyond = |x: f64, factor: f64| if x > 0.0 { x * factor } else { x / factor };
    Some([beyond(*low, 1.0 / BEYOND), beyond(*high, BEYOND)])
}

/// The piece at another shape.
fn remade(placed: &Placed, records: &[Record<'_>], shape: &[f64]) -> Piece {
    let columns = match placed.owner {
        Owner::Effect(effect) if Channel::default().of(effect).is_some() => {
            more_of(effect, records)
        }
        Owner::Effect(effect) => columns_at(
            effect,
            records,
            placed.joint.unwrap_or_else(|| of_robot(effect, records)),
            shape,
        ),
        Owner::Generic(id) => super::generic::named(id, records, placed.joint.unwrap_or(0)),
    };
    Piece {
        owner: placed.owner,
        joint: placed.joint,
        shape: shape.to_vec(),
        choices: placed.choices,
        columns,
    }
}

/// The joint that stands for the robot.
fn of_robot(effect: &Effect, records: &[Record<'_>]) -> usize {
    let dof = records.first().map_or(0, |record| record.motion.model.dof);
    (effect.joints)(dof).first().copied().unwrap_or(0)
}

/// Coordinates of the columns' factors, and how they change with these.
fn coordinates_of(
    effect: &Effect,
    shape: &[f64],
    factors: &DVector<f64>,
) -> (Vec<f64>, DMatrix<f64>) {
    let count = effect.coordinates.len();
    let of = |factors: &DVector<f64>| -> Vec<f64> {
        let mut coordinates = shape.to_vec();
        let shapes: Vec<usize> =
            (0..count).filter(|k| matches!(effect.coordinates[*k].role, Role::Shape(_))).collect();
        let linear: Vec<usize> =
            (0..count).filter(|k| matches!(effect.coordinates[*k].role, Role::Linear)).collect();
        let width = 1 + shapes.len();
        // What the shape does by itself comes first, where it does.
        let blocks = factors.len() / width;
        let alone = blocks - linear.len();
        // It tells the shape, else the largest of the linear coordinates.
        let strongest = if alone > 0 {
            0
        } else {
            (0..blocks)
                .max_by(|a, b| factors[a * width].abs().total_cmp(&factors[b * width].abs()))
                .unwrap_or(0)
        };
        for (place, k) in linear.iter().enumerate() {
            coordinates[*k] = shape[*k] * factors[(alone + place) * width];
        }
        for (place, k) in shapes.iter().enumerate() {
            let amplitude = factors[strongest * width];
            let tangent = factors[strongest * width + 1 + place];
            if amplitude != 0.0 {
                coordinates[*k] = shape[*k] + tangent / amplitude;
            }
        }
        coordinates
    };
    let here = of(factors);
    let mut jacobian = DMatrix::zeros(count, factors.len());
    for column in 0..factors.len() {
        let mut next = factors.clone();
        let step = DIFFERENCE * next[column].abs().max(DIFFERENCE);
        next[column] += step;
        for (row, (a, b)) in of(&next).iter().zip(&here).enumerate() {
            jacobian[(row, column)] = (a - b) / step;
        }
    }
    (here, jacobian)
}

/// Parameters of coordinates with their deviations.
fn of(
    effect: &'static Effect,
    joint: Option<usize>,
    coordinates: &[f64],
    spread: &DMatrix<f64>,
) -> Fitted {
    let parameters = effect.parameters_of(coordinates);
    let mut jacobian = DMatrix::zeros(parameters.len(), coordinates.len());
    for column in 0..coordinates.len() {
        let mut next = coordinates.to_vec();
        let step = (DIFFERENCE * spread[(column, column)].sqrt()).max(1e-12);
        next[column] += step;
        for (row, (a, b)) in effect.parameters_of(&next).iter().zip(&parameters).enumerate() {
            jacobian[(row, column)] = (a - b) / step;
        }
    }
    let covariance = &jacobian * spread * jacobian.transpose();
    let significance = effect
        .coordinates
        .iter()
        .enumerate()
        .filter(|(_, coordinate)| matches!(coordinate.role, Role::Linear))
        .map(|(k, _)| coordinates[k].abs() / spread[(k, k)].sqrt().max(1e-300))
        .fold(None, |most: Option<f64>, x| Some(most.map_or(x, |most| most.max(x))))
        .unwrap_or(f64::INFINITY);
    Fitted {
        effect,
        joint,
        coordinates: coordinates.to_vec(),
        parameters,
        deviations: covariance.diagonal().iter().map(|x| x.max(0.0).sqrt()).collect(),
        significance,
    }
}
