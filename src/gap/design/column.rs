//! What may explain a difference: columns of torques, in pieces that belong together.

use crate::arm::effects::{Acts, Coordinate, Effect, Role, Scope};

use crate::gap::data::{Record, RecordKind};

/// Half of the distance between tried values of a shape is one deviation of the tangent.
const TANGENT: f64 = 0.5;
/// Relative step of differences over a shape.
const STEP: f64 = 1e-3;

/// Joints that something reaches, with their series \[Nm\].
pub(super) type Reached = Vec<(usize, Vec<f64>)>;

/// A column: torques, and what is known of its factor before the measurement.
pub(in crate::gap) struct Column {
    /// By record, the joints that it reaches with their series \[Nm\].
    pub series: Vec<Vec<(usize, Vec<f64>)>>,
    /// Expected factor.
    pub mean: f64,
    /// Its standard deviation; 0 where it is what it is.
    pub sd: f64,
}

/// Columns of one effect at one joint, for one choice of its shape.
pub(in crate::gap) struct Piece {
    /// Joint, from 0; `None` of the robot.
    pub joint: Option<usize>,
    /// Values of all coordinates: 1 for a linear one stands for its usual size.
    pub shape: Vec<f64>,
    /// Number of shapes that are tried at the joint.
    pub choices: usize,
    /// Its columns.
    pub columns: Vec<Column>,
}

/// What an effect adds to a record.
fn added(
    effect: &Effect,
    record: &Record<'_>,
    joint: usize,
    values: &[f64],
) -> Vec<(usize, Vec<f64>)> {
    match (record.kind, effect.acts == Acts::OverTime) {
        (RecordKind::Mean, false) => return effect.added(&record.motion, joint, values),
        (RecordKind::Drift, false) | (RecordKind::Before, _) => return Vec::new(),
        (RecordKind::Mean | RecordKind::Drift, true) => {}
    }
    let mut moved = record.motion.clone();
    let mut sum: Vec<(usize, Vec<f64>)> = Vec::new();
    for (later, weight) in &record.times {
        for (to, from) in moved.t.iter_mut().zip(&record.motion.t) {
            *to = from + later;
        }
        for (number, (joint, series)) in effect.added(&moved, joint, values).into_iter().enumerate()
        {
            if number == sum.len() {
                sum.push((joint, vec![0.0; series.len()]));
            }
            sum[number].1.iter_mut().zip(&series).for_each(|(sum, x)| *sum += weight * x);
        }
    }
    sum
}

/// All pieces of an effect at a joint, in records of one robot.
#[must_use]
pub(super) fn pieces(effect: &'static Effect, records: &[Record<'_>], joint: usize) -> Vec<Piece> {
    let Some(first) = records.first() else { return Vec::new() };
    let scale = first.motion.scale(joint);
    let tried: Vec<Vec<f64>> = effect
        .coordinates
        .iter()
        .map(|coordinate| match coordinate.role {
            Role::Linear => vec![(coordinate.usual)(&scale)],
            Role::Shape(values) | Role::Choice(values) => values(&scale),
            Role::OnlyJoint => (0..=first.motion.model.dof).map(|joint| joint as f64).collect(),
            Role::Rise { .. } | Role::Waves { .. } => Vec::new(),
        })
        .collect();
    let mut shapes = vec![Vec::new()];
    for values in &tried {
        shapes = shapes
            .iter()
            .flat_map(|shape| {
                values.iter().map(move |value| {
                    let mut longer: Vec<f64> = shape.clone();
                    longer.push(*value);
                    longer
                })
            })
            .collect();
    }
    let of = match effect.scope {
        Scope::Joint => Some(joint),
        Scope::Robot => None,
    };
    let piece = |shape: Vec<f64>| Piece {
        joint: of,
        columns: columns(effect, records, joint, &shape, Some(&tried)),
        choices: 0,
        shape,
    };
    let mut pieces: Vec<Piece> =
        shapes.into_iter().map(piece).filter(|piece| !piece.columns.is_empty()).collect();
    let choices = pieces.len();
    for piece in &mut pieces {
        piece.choices = choices;
    }
    pieces
}

/// Columns of an effect at a shape of its own, with how they change with the shape or without.
pub(super) fn columns_at(
    effect: &'static Effect,
    records: &[Record<'_>],
    joint: usize,
    shape: &[f64],
    with_tangents: bool,
) -> Vec<Column> {
    if !with_tangents {
        return columns(effect, records, joint, shape, None);
    }
    let scale = records.first().map(|record| record.motion.scale(joint));
    let tried: Vec<Vec<f64>> = effect
        .coordinates
        .iter()
        .map(|coordinate| match (coordinate.role, &scale) {
            (Role::Shape(values) | Role::Choice(values), Some(scale)) => values(scale),
            _ => Vec::new(),
        })
        .collect();
    columns(effect, records, joint, shape, Some(&tried))
}

/// Columns at one shape: what it does by itself, where it does, then what each linear coordinate
/// adds; behind each of these how it changes with the shape, in steps of the `tried` values.
fn columns(
    effect: &'static Effect,
    records: &[Record<'_>],
    joint: usize,
    shape: &[f64],
    tried: Option<&[Vec<f64>]>,
) -> Vec<Column> {
    let with = |values: &[f64]| -> Vec<Reached> {
        records.iter().map(|record| added(effect, record, joint, values)).collect()
    };
    let is_linear = |k: &usize| matches!(effect.coordinates[*k].role, Role::Linear);
    let only = |kept: Option<usize>, shape: &[f64]| -> Vec<f64> {
        let value = |k: usize| if is_linear(&k) && Some(k) != kept { 0.0 } else { shape[k] };
        (0..shape.len()).map(value).collect()
    };
    // Of all, not of what is more than the shape's own: that has its own tangent.
    let tangents = |base: &[f64], from: &[Reached]| -> Vec<Column> {
        let Some(tried) = tried else { return Vec::new() };
        let tangent = |(k, coordinate): (usize, &Coordinate)| {
            let Role::Shape(_) = coordinate.role else { return None };
            let mut next = base.to_vec();
            let step = STEP * next[k].abs().max(1e-12);
            next[k] += step;
            let series = difference(&with(&next), from, 1.0 / step);
            let sd = TANGENT * nearest_spacing(&tried[k], shape[k]);
            Some(Column { series, mean: 0.0, sd })
        };
        effect.coordinates.iter().enumerate().filter_map(tangent).collect()
    };
    let mut columns = Vec::new();
    let base = only(None, shape);
    let alone = with(&base);
    let acts = alone.iter().flatten().any(|(_, series)| series.iter().any(|x| *x != 0.0));
    if acts {
        columns.push(Column { series: alone.clone(), mean: 1.0, sd: 0.0 });
        columns.extend(tangents(&base, &alone));
    }
    for k in (0..shape.len()).filter(is_linear) {
        let base = only(Some(k), shape);
        let all = with(&base);
        let series = if acts { difference(&all, &alone, 1.0) } else { all.clone() };
        columns.push(Column { series, mean: 0.0, sd: 1.0 });
        columns.extend(tangents(&base, &all));
    }
    columns
}

/// Half the distance to the neighbours of a tried value.
fn nearest_spacing(tried: &[f64], value: f64) -> f64 {
    let apart = tried.iter().map(|x| (x - value).abs());
    // A shape between the tried ones has no nearer neighbour than half of their distance.
    let apart = apart.filter(|x| *x > 1e-3 * value.abs());
    let nearest = apart.fold(f64::INFINITY, f64::min);
    if nearest.is_finite() { nearest } else { 0.5 * value.abs() }
}

/// (a − b) · factor.
fn difference(a: &[Reached], b: &[Reached], factor: f64) -> Vec<Reached> {
    a.iter()
        .zip(b)
        .map(|(a, b)| {
            a.iter()
                .zip(b)
                .map(|((joint, a), (_, b))| {
                    (*joint, a.iter().zip(b).map(|(a, b)| factor * (a - b)).collect())
                })
                .collect()
        })
        .collect()
}
