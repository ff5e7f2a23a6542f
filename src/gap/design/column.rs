//! What may explain a difference: columns of torques, in pieces that belong together.

use crate::arm::effects::{Acts, Effect, Role, Scope};

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
        columns: columns(effect, records, joint, &shape, &tried),
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

/// Columns of an effect at a shape of its own.
pub(super) fn columns_at(
    effect: &'static Effect,
    records: &[Record<'_>],
    joint: usize,
    shape: &[f64],
) -> Vec<Column> {
    let scale = records.first().map(|record| record.motion.scale(joint));
    let tried: Vec<Vec<f64>> = effect
        .coordinates
        .iter()
        .map(|coordinate| match (coordinate.role, &scale) {
            (Role::Shape(values) | Role::Choice(values), Some(scale)) => values(scale),
            _ => Vec::new(),
        })
        .collect();
    columns(effect, records, joint, shape, &tried)
}

/// Columns at one shape: what it does by itself, where it does, then what each linear coordinate
/// adds; behind each of these how it changes with the shape.
fn columns(
    effect: &'static Effect,
    records: &[Record<'_>],
    joint: usize,
    shape: &[f64],
    tried: &[Vec<f64>],
) -> Vec<Column> {
    let with = |values: &[f64]| -> Vec<Reached> {
        records.iter().map(|record| added(effect, record, joint, values)).collect()
    };
    let is_linear = |k: &usize| matches!(effect.coordinates[*k].role, Role::Linear);
    let only = |kept: Option<usize>, shape: &[f64]| -> Vec<f64> {
        let value = |k: usize| if is_linear(&k) && Some(k) != kept { 0.0 } else { shape[k] };
        (0..shape.len()).map(value).collect()
    };
    // What the shape does by itself, and how each torque changes with it.
    let block = |kept: Option<usize>, less: Option<&[Reached]>| -> Vec<Column> {
        let relative = |values: &[f64]| match less {
            Some(less) => difference(&with(values), less, 1.0),
            None => with(values),
        };
        let base = only(kept, shape);
        let here = relative(&base);
        let tangents = effect.coordinates.iter().enumerate().filter_map(|(k, coordinate)| {
            let Role::Shape(_) = coordinate.role else { return None };
            let mut next = base.clone();
            let step = STEP * next[k].abs().max(1e-12);
            next[k] += step;
            let spacing = nearest_spacing(&tried[k], shape[k]);
            // Of all, not of what is more than the shape's own: that has its own tangent.
            let from = if kept.is_some() { with(&base) } else { here.clone() };
            let series = difference(&with(&next), &from, 1.0 / step);
            Some(Column { series, mean: 0.0, sd: TANGENT * spacing })
        });
        let tangents: Vec<Column> = tangents.collect();
        let (mean, sd) = if kept.is_some() { (0.0, 1.0) } else { (1.0, 0.0) };
        std::iter::once(Column { series: here, mean, sd }).chain(tangents).collect()
    };
    let mut columns = Vec::new();
    let alone = with(&only(None, shape));
    let acts = alone.iter().flatten().any(|(_, series)| series.iter().any(|x| *x != 0.0));
    if acts {
        columns.extend(block(None, None));
    }
    for k in (0..shape.len()).filter(is_linear) {
        columns.extend(block(Some(k), acts.then_some(&alone[..])));
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
