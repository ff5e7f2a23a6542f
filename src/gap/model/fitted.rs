//! Effects with fitted parameters.

use nalgebra::{DMatrix, DVector};

use super::body_near::body_near;
use crate::arm::effects::{Effect, Role};
use crate::gap::design::{BroughtEffect, PieceRows};
use crate::gap::posterior::{Fit, Member};

/// Step over which parameters are differentiated, in deviations.
const DIFFERENCE: f64 = 1e-3;
/// Deviations beyond which a bound is missed by far.
const FAR: f64 = 1e3;

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
    /// Deviations by which the law itself differs from 0, with its shape as it is; `None` where that acts
    /// by itself.
    pub significance: Option<f64>,
}

impl Fitted {
    /// A piece whose columns have these factors; `covariance` is theirs. What the robot carries is
    /// the nearest body.
    #[must_use]
    pub fn new(piece: &PieceRows, factors: &DVector<f64>, covariance: &DMatrix<f64>) -> Fitted {
        let (mut coordinates, jacobian) = coordinates_of(piece.effect, &piece.shape, factors);
        let spread = &jacobian * covariance * jacobian.transpose();
        if piece.effect.is_load()
            && let Some(body) = body_near(&coordinates, &spread)
        {
            coordinates = body;
        }
        let significance = significance(piece.effect, factors, covariance);
        Fitted { significance, ..with_deviations(piece.effect, piece.joint, &coordinates, &spread) }
    }

    /// All pieces of a fit.
    #[must_use]
    pub(in crate::gap) fn of_fit(fit: &Fit) -> Vec<Fitted> {
        let mut from = fit.mean.len() - fit.hypothesis.columns();
        let mut all = Vec::new();
        for member in &fit.hypothesis.members {
            let own = member.piece.own;
            let factors = fit.mean.rows(from, own).into_owned();
            let covariance = fit.covariance.view((from, from), (own, own)).into_owned();
            all.push(Fitted::new(&member.piece, &factors, &covariance));
            from += member.piece.prior.len();
        }
        all
    }

    /// The effects that all pieces of a fit bring along.
    #[must_use]
    pub(super) fn brought(fit: &Fit) -> Vec<Fitted> {
        let mut from = fit.mean.len() - fit.hypothesis.columns();
        let mut all = Vec::new();
        for Member { piece, .. } in &fit.hypothesis.members {
            let mut next = from + piece.own;
            for BroughtEffect { effect, joint, usual, .. } in &piece.brought {
                let count = usual.len();
                let factors = fit.mean.rows(next, count);
                let coordinates: Vec<f64> =
                    usual.iter().zip(&factors).map(|(x, f)| x * f).collect();
                let usual = DMatrix::from_diagonal(&DVector::from_column_slice(usual));
                let spread = &usual * fit.covariance.view((next, next), (count, count)) * &usual;
                all.push(with_deviations(effect, Some(*joint), &coordinates, &spread));
                next += count;
            }
            from += piece.prior.len();
        }
        all
    }

    /// The same where a coordinate, which was held as it is, has a standard deviation.
    #[must_use]
    pub(in crate::gap) fn widened(mut self, coordinate: usize, sd: f64) -> Fitted {
        let mut next = self.coordinates.clone();
        next[coordinate] += DIFFERENCE * sd;
        let changed = self.effect.parameters_of(&next).into_iter().zip(&self.parameters);
        for (deviation, (next, here)) in self.deviations.iter_mut().zip(changed) {
            *deviation = deviation.hypot((next - here) / DIFFERENCE);
        }
        self
    }

    /// The parameter that is so many deviations beyond what can be, and by how many.
    #[must_use]
    pub fn beyond_bounds(&self) -> f64 {
        let values = self.parameters.iter().zip(&self.deviations);
        let beyond = self.effect.parameters.iter().zip(values).map(|(parameter, (value, sd))| {
            let [low, high] = parameter.bounds;
            let outside = (low - value).max(value - high).max(0.0);
            if outside > 0.0 { (outside / sd).min(FAR) } else { 0.0 }
        });
        beyond.fold(0.0, f64::max)
    }

    /// The largest parameter of which any robot has some, over what is usual of it; `None` without
    /// such a parameter, or where one joint alone has it.
    #[must_use]
    pub fn over_everyday(&self) -> Option<f64> {
        let mut coordinates = self.effect.coordinates.iter().zip(&self.coordinates);
        if coordinates.any(|(of, joint)| matches!(of.role, Role::OnlyJoint) && *joint != 0.0) {
            return None;
        }
        let values = self.effect.parameters.iter().zip(&self.parameters);
        let usual = values.filter(|(of, _)| of.everyday > 0.0);
        usual.map(|(of, value)| value.abs() / of.everyday).reduce(f64::max)
    }
}

/// Deviations by which the factors of the linear coordinates differ from 0 together, at the shape as it
/// is.
fn significance(effect: &Effect, factors: &DVector<f64>, covariance: &DMatrix<f64>) -> Option<f64> {
    let count = |is: fn(&Role) -> bool| effect.coordinates.iter().filter(|of| is(&of.role)).count();
    let width = 1 + count(|role| matches!(role, Role::Shape(_)));
    let linear: Vec<usize> =
        (0..count(|role| matches!(role, Role::Linear))).map(|k| k * width).collect();
    if linear.is_empty() || factors.len() > linear.len() * width {
        return None;
    }
    // Where all else is 0, the precision is that of these rows, and right-hand sides stay.
    let precision = covariance.clone().cholesky()?.inverse();
    let right = &precision * factors;
    let right = DVector::from_fn(linear.len(), |k, _| right[linear[k]]);
    let own =
        DMatrix::from_fn(linear.len(), linear.len(), |i, k| precision[(linear[i], linear[k])]);
    Some(right.dot(&own.cholesky()?.solve(&right)).sqrt())
}

/// Coordinates of the columns' factors, and how they change with these.
fn coordinates_of(
    effect: &Effect,
    shape: &[f64],
    factors: &DVector<f64>,
) -> (Vec<f64>, DMatrix<f64>) {
    let here = coordinates(effect, shape, factors);
    let mut jacobian = DMatrix::zeros(here.len(), factors.len());
    for column in 0..factors.len() {
        let mut next = factors.clone();
        let step = DIFFERENCE * next[column].abs().max(DIFFERENCE);
        next[column] += step;
        for (row, (a, b)) in coordinates(effect, shape, &next).iter().zip(&here).enumerate() {
            jacobian[(row, column)] = (a - b) / step;
        }
    }
    (here, jacobian)
}

fn coordinates(effect: &Effect, shape: &[f64], factors: &DVector<f64>) -> Vec<f64> {
    let of_role = |is: fn(&Role) -> bool| -> Vec<usize> {
        let all = effect.coordinates.iter().enumerate();
        all.filter(|(_, of)| is(&of.role)).map(|(k, _)| k).collect()
    };
    let shapes = of_role(|role| matches!(role, Role::Shape(_)));
    let linear = of_role(|role| matches!(role, Role::Linear));
    let width = 1 + shapes.len();
    // What the shape does by itself comes first, where it does.
    let blocks = factors.len() / width;
    let alone = blocks.saturating_sub(linear.len());
    // It tells the shape, else the largest of the linear coordinates.
    let by_size =
        |a: &usize, b: &usize| factors[a * width].abs().total_cmp(&factors[b * width].abs());
    let strongest = if alone > 0 { 0 } else { (0..blocks).max_by(by_size).unwrap_or(0) };
    let mut all = shape.to_vec();
    for (place, k) in linear.iter().enumerate() {
        all[*k] = shape[*k] * factors[(alone + place) * width];
    }
    for (place, k) in shapes.iter().enumerate() {
        let amplitude = factors[strongest * width];
        if amplitude != 0.0 {
            all[*k] = shape[*k] + factors[strongest * width + 1 + place] / amplitude;
        }
    }
    all
}

fn with_deviations(
    effect: &'static Effect,
    joint: Option<usize>,
    coordinates: &[f64],
    spread: &DMatrix<f64>,
) -> Fitted {
    let mut parameters = effect.parameters_of(coordinates);
    // An effect that is there or not.
    if coordinates.is_empty() {
        parameters = effect.parameters.iter().map(|of| of.bounds[1]).collect();
    }
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
    Fitted {
        effect,
        joint,
        coordinates: coordinates.to_vec(),
        parameters,
        deviations: covariance.diagonal().iter().map(|x| x.max(0.0).sqrt()).collect(),
        significance: None,
    }
}
