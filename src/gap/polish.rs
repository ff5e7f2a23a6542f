//! From the nearest of the tried shapes to the best one, with deviations.

use nalgebra::{DMatrix, DVector};

use crate::arm::effects::{Effect, Role};

use super::body_near::body_near;
use super::chosen::Chosen;
use super::column::{Owner, Piece, columns_at};
use super::effect_ids::{GATED, LOAD};
use super::evidence::Estimate;
use super::fitted::{Fitted, Polished};
use super::record::Record;
use super::search::Search;
use super::table::Placed;

/// Rounds of new tangents.
const ROUNDS: usize = 8;
/// Deviations that a shape may still move.
const STAYS: f64 = 0.1;
/// Relative change of a shape in one round at most.
const STEP: f64 = 0.5;
/// A shape may be this many times beyond the tried values.
const BEYOND: f64 = 2.0;
/// Rounds in which friction is held at no less than nothing, and a load is held to be a body.
const BOUNDED: usize = 3;
/// Step over which parameters are differentiated, in deviations.
const DIFFERENCE: f64 = 1e-3;

/// Bins of the frequencies that tell what a window holds.
const SLOW: usize = 80;

impl Search<'_, '_> {
    /// Whether tangents bring a piece to a better shape.
    fn has_shape(&self, piece: usize) -> bool {
        let Owner::Effect(effect) = self.table.pieces[piece].owner else { return false };
        effect.coordinates.iter().any(|of| matches!(of.role, Role::Shape(_)))
    }

    /// A set at its best shapes; the table has them then.
    pub fn polish(&mut self, set: &[Chosen]) -> Option<Polished> {
        let pieces: Vec<usize> = set.iter().flat_map(|of| of.pieces.clone()).collect();
        self.bring_to_best(set, &pieces);
        let has_window = |of: &Chosen| GATED.contains(&self.families[of.family].owner.id());
        if !set.iter().any(has_window) {
            return self.fitted(&pieces, &self.columns(set));
        }
        // How sharply a window ends no law tells, so what is in it is told by its slow part.
        self.table.limit(SLOW);
        self.weigh();
        let fitted = self.fitted(&pieces, &self.columns(set));
        self.table.limit(usize::MAX);
        self.weigh();
        fitted
    }

    /// Improves the shapes of some pieces of a set by new tangents until they stay.
    pub(super) fn bring_to_best(&mut self, set: &[Chosen], pieces: &[usize]) {
        let columns = self.columns(set);
        let shaped: Vec<usize> = pieces.iter().copied().filter(|of| self.has_shape(*of)).collect();
        if shaped.is_empty() {
            return;
        }
        let mut here: Shapes =
            shaped.iter().map(|of| (*of, self.table.pieces[*of].shape.clone())).collect();
        let mut best: Option<(f64, Shapes)> = None;
        for _ in 0..ROUNDS {
            self.reshape(&here);
            let Some((gain, moved, next)) = self.moved(&shaped, &columns) else { break };
            match &best {
                Some((most, from)) if gain < *most => {
                    // Too far: back half the way.
                    for ((_, shape), (_, from)) in here.iter_mut().zip(from) {
                        for (x, from) in shape.iter_mut().zip(from) {
                            *x = f64::midpoint(*x, *from);
                        }
                    }
                    continue;
                }
                _ => best = Some((gain, std::mem::replace(&mut here, next))),
            }
            if moved <= STAYS {
                break;
            }
        }
        if let Some((_, shapes)) = best {
            self.reshape(&shapes);
        }
    }

    /// Brings pieces to shapes.
    pub(super) fn reshape(&mut self, shapes: &[(usize, Vec<f64>)]) {
        let mut changed: Vec<usize> = Vec::new();
        for (number, shape) in shapes {
            let placed = &self.table.pieces[*number];
            if placed.shape == *shape {
                continue;
            }
            changed.extend(placed.columns.clone());
            let piece = shaped(placed, shape.clone(), self.records);
            self.table.replace(*number, &piece, self.records);
        }
        changed.sort_unstable();
        self.table.through_columns(self.records, &self.channels, &changed);
    }

    /// The gain at the shapes as they are, by how many deviations these would move at most, and
    /// where to.
    fn moved(&self, pieces: &[usize], columns: &[usize]) -> Option<(f64, f64, Shapes)> {
        let evidence = self.table.evidence_of(self.error, columns);
        let all: Vec<usize> = (0..columns.len()).collect();
        let estimate = evidence.estimate(&all)?;
        let mut shapes = Vec::new();
        let mut moved = 0.0_f64;
        for number in pieces {
            let placed = &self.table.pieces[*number];
            let Owner::Effect(effect) = placed.owner else { continue };
            let (coordinates, spread) = estimated(placed, effect, columns, &estimate);
            let mut shape = placed.shape.clone();
            for (k, coordinate) in effect.coordinates.iter().enumerate() {
                if !matches!(coordinate.role, Role::Shape(_)) {
                    continue;
                }
                let before = shape[k];
                let most = STEP * before.abs();
                let mut next = before + (coordinates[k] - before).clamp(-most, most);
                if let Some([low, high]) = range(effect, self.records, placed.joint, k) {
                    next = next.clamp(low, high);
                }
                moved = moved.max((next - before).abs() / spread[(k, k)].sqrt().max(1e-12));
                shape[k] = next;
            }
            shapes.push((*number, shape));
        }
        Some((evidence.gain(&all), moved, shapes))
    }

    /// What pieces are, and what they bring, at their shapes.
    fn fitted(&mut self, pieces: &[usize], columns: &[usize]) -> Option<Polished> {
        let is_brought = |number: &usize| {
            let there = self.table.pieces[*number].columns.clone();
            !there.is_empty()
                && !pieces.contains(number)
                && there.clone().all(|k| columns.binary_search(&k).is_ok())
        };
        let brought: Vec<usize> = (0..self.table.pieces.len()).filter(is_brought).collect();
        let before = (self.table.means.clone(), self.table.sds.clone());
        let mut polished: Option<Polished> = None;
        let mut held: Option<(Vec<f64>, f64)> = None;
        for _ in 0..BOUNDED {
            let evidence = self.table.evidence_of(self.error, columns);
            let all: Vec<usize> = (0..columns.len()).collect();
            let Some(estimate) = evidence.estimate(&all) else { break };
            let mut effects = Vec::new();
            let mut bodies = Vec::new();
            for number in pieces.iter().chain(&brought) {
                let placed = &self.table.pieces[*number];
                let Owner::Effect(effect) = placed.owner else { continue };
                let (coordinates, spread) = estimated(placed, effect, columns, &estimate);
                let mut fitted = of(effect, placed.joint, &coordinates, &spread);
                if acts_alone(placed, effect) {
                    fitted.significance = f64::INFINITY;
                }
                if let Some(free) = &held
                    && effect.id == LOAD
                {
                    // What holds it tells nothing of how well it is known.
                    (fitted.deviations, fitted.significance) = free.clone();
                } else if effect.id == LOAD
                    && let Some(body) = body_near(&coordinates, &spread)
                {
                    bodies.push((*number, body));
                    held = Some((fitted.deviations.clone(), fitted.significance));
                }
                effects.push(fitted);
            }
            let bounded =
                polished.as_mut().map_or_else(Vec::new, |of| std::mem::take(&mut of.bounded));
            let of = polished.insert(Polished {
                effects,
                bounded,
                parameters: evidence.parameters(&all, &estimate.mean),
            });
            let is_load_held = !bodies.is_empty();
            for (number, body) in bodies {
                self.hold(number, &body);
            }
            if !self.bound_friction(of, pieces, &brought) && !is_load_held {
                break;
            }
        }
        (self.table.means, self.table.sds) = before;
        polished
    }

    /// Holds a piece at linear coordinates.
    fn hold(&mut self, number: usize, coordinates: &[f64]) {
        let placed = &self.table.pieces[number];
        for ((column, shape), value) in placed.columns.clone().zip(&placed.shape).zip(coordinates) {
            self.table.means[column] = value / shape;
            self.table.sds[column] = 0.0;
        }
    }

    /// Holds friction that came out below nothing at nothing; whether there was some.
    fn bound_friction(&mut self, of: &mut Polished, pieces: &[usize], brought: &[usize]) -> bool {
        let Some(model) = self.records.first().map(|record| record.motion.model) else {
            return false;
        };
        let friction = [&model.friction.coulomb, &model.friction.viscous];
        let numbers = pieces
            .iter()
            .chain(brought)
            .filter(|number| matches!(self.table.pieces[**number].owner, Owner::Effect(_)));
        let mut fixed = Vec::new();
        for (number, fitted) in numbers.zip(&of.effects) {
            let placed = &self.table.pieces[*number];
            let Some(joint) = placed.joint.filter(|_| fitted.effect.id == "friction_level") else {
                continue;
            };
            for (k, nominal) in friction.into_iter().enumerate() {
                let column = placed.columns.start + k;
                let least = -nominal[joint];
                if fitted.coordinates[k] < least && self.table.sds[column] > 0.0 {
                    fixed.push((column, least / placed.shape[k]));
                    of.bounded.push(joint);
                }
            }
        }
        let has_some = !fixed.is_empty();
        for (column, factor) in fixed {
            self.table.means[column] = factor;
            self.table.sds[column] = 0.0;
        }
        has_some
    }
}

/// Numbers of pieces with their shapes.
type Shapes = Vec<(usize, Vec<f64>)>;

/// Coordinates of a piece and their covariance.
fn estimated(
    placed: &Placed,
    effect: &Effect,
    columns: &[usize],
    estimate: &Estimate,
) -> (Vec<f64>, DMatrix<f64>) {
    let at: Vec<usize> =
        placed.columns.clone().filter_map(|k| columns.binary_search(&k).ok()).collect();
    let mean = DVector::from_iterator(at.len(), at.iter().map(|k| estimate.mean[*k]));
    let covariance =
        DMatrix::from_fn(at.len(), at.len(), |i, k| estimate.covariance[(at[i], at[k])]);
    let (coordinates, jacobian) = coordinates_of(effect, &placed.shape, &mean);
    let spread = &jacobian * &covariance * jacobian.transpose();
    (coordinates, spread)
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

/// The piece at a shape.
fn shaped(placed: &Placed, shape: Vec<f64>, records: &[Record<'_>]) -> Piece {
    let columns = match placed.owner {
        Owner::Effect(effect) => columns_at(
            effect,
            records,
            placed.joint.unwrap_or_else(|| of_robot(effect, records)),
            &shape,
        ),
        Owner::Generic(id) => super::generic::named(id, records, placed.joint.unwrap_or(0)),
    };
    Piece { owner: placed.owner, joint: placed.joint, shape, choices: placed.choices, columns }
}

/// Whether an effect acts by its shape, its linear coordinates being nothing.
fn acts_alone(placed: &Placed, effect: &Effect) -> bool {
    let is_linear = |role: &Role| matches!(role, Role::Linear);
    let roles = || effect.coordinates.iter().map(|coordinate| coordinate.role);
    let shapes = roles().filter(|role| matches!(role, Role::Shape(_))).count();
    placed.columns.len() > roles().filter(is_linear).count() * (1 + shapes)
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
