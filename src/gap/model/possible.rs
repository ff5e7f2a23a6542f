//! Parameters that a robot can have, with the same torques.
//!
//! Bodies whose pseudo-inertia is positive semidefinite are a convex cone, parameters with the
//! same base parameters an affine space: projections on one and the other in turn lead to what
//! both have in common (J. von Neumann, Functional Operators II, 1950).
//!
//! Nothing here weighs data against a prior, as `learn::identify` does where it fits: what is
//! possible already stays as it is, and so does what a prior deviation of 0 holds.

use nalgebra::{Cholesky, DMatrix, DVector, Matrix3, SymmetricEigen};

use crate::arm::dynamics::{
    BaseParameters, JOINT, RIGID, base_parameters, body_parameters, link_of, pseudo_inertia,
};
use crate::arm::effects::{Effect, with_body};
use crate::arm::robot::Model;

/// Rounds at most.
const ROUNDS: usize = 400;
/// Change of base parameters, of their own size, at which they count as the same.
const SAME: f64 = 1e-4;
/// Share by which the diagonal of the products is raised, so that they can be solved.
const RIDGE: f64 = 1e-6;
/// Least eigenvalue of a pseudo-inertia, of the largest.
const LEAST: f64 = 1e-7;

/// Standard parameters near `wanted` that a robot can have, whose torques are those of `wanted`
/// as nearly as can be. `sizes` are the changes that are usual, of each.
pub(super) fn possible(model: &Model, wanted: &DVector<f64>, sizes: &DVector<f64>) -> DVector<f64> {
    let mut at = inside(wanted, model);
    if at == *wanted {
        return at;
    }
    let base = base_parameters(model);
    let map = matrix(&base, wanted.len());
    let weights = sizes.map(|size| size * size);
    let mut weighted = map.transpose();
    for (mut row, weight) in weighted.row_iter_mut().zip(weights.iter()) {
        row *= *weight;
    }
    let mut products = &map * &weighted;
    // Of what nothing may change there is nothing to solve for.
    for k in 0..products.nrows() {
        products[(k, k)] += RIDGE * products[(k, k)] + f64::MIN_POSITIVE.sqrt();
    }
    let Some(factor) = Cholesky::new(products) else { return at };
    let goal = &map * wanted;
    let mut best = (f64::INFINITY, at.clone());
    for _ in 0..ROUNDS {
        let off = &goal - &map * &at;
        if off.norm() < best.0 {
            best = (off.norm(), at.clone());
        }
        if off.norm() < SAME * goal.norm() {
            break;
        }
        at = inside(&(at + &weighted * factor.solve(&off)), model);
    }
    best.1
}

/// Parameters of a load near `wanted` with which the last link is a body: its mass and centre stay,
/// moments that no body has are raised.
pub(super) fn possible_load(model: &Model, payload: &Effect, wanted: &[f64]) -> Vec<f64> {
    let mut load = wanted.to_vec();
    let flange = &model.kinematics.flange;
    let Some(last) = model.links.last() else { return load };
    let both = with_body(last, flange, &payload.coordinates_of(wanted));
    if both.mass > 0.0 && !both.is_consistent() {
        // About the common centre, ∫ r rᵀ dm has no negative eigenvalue.
        let spread = Matrix3::identity() * (0.5 * both.inertia.trace()) - both.inertia;
        let mut eigen = SymmetricEigen::new(spread);
        let least = LEAST * eigen.eigenvalues.amax();
        eigen.eigenvalues.iter_mut().for_each(|value| *value = value.max(least));
        let raised = eigen.recompose() - spread;
        let more = Matrix3::identity() * raised.trace() - raised;
        let axes = flange.rotation.to_rotation_matrix();
        let more = axes.matrix().transpose() * more * axes.matrix();
        for (k, at) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].into_iter().enumerate() {
            load[RIGID - 6 + k] += more[at];
        }
    }
    load
}

fn matrix(base: &BaseParameters, width: usize) -> DMatrix<f64> {
    let mut map = DMatrix::zeros(base.rank(), width);
    for (row, index) in base.independent.iter().enumerate() {
        map[(row, *index)] = 1.0;
        for (k, from) in base.dependent.iter().enumerate() {
            map[(row, *from)] = base.grouping[(row, k)];
        }
    }
    map
}

/// The nearest parameters that can be.
fn inside(parameters: &DVector<f64>, model: &Model) -> DVector<f64> {
    let n = model.dof;
    let mut result = parameters.clone();
    for link in 0..n {
        let at = RIGID * link;
        let own: Vec<f64> = parameters.rows(at, RIGID).iter().copied().collect();
        if !(own[0] > 0.0 && link_of(&own).is_consistent()) {
            result.rows_mut(at, RIGID).copy_from_slice(&nearest(&own));
        }
    }
    for joint in 0..n {
        // Rotor, viscous and Coulomb friction; an offset may have any sign, and so may what a model
        // without rotors has of them in its links.
        for k in if model.rotors().is_some() { 0..3 } else { 1..3 } {
            let at = RIGID * n + JOINT * joint + k;
            result[at] = result[at].max(0.0);
        }
    }
    result
}

/// The nearest body: eigenvalues of its pseudo-inertia that are too small are raised.
fn nearest(parameters: &[f64]) -> [f64; RIGID] {
    let mut eigen = SymmetricEigen::new(pseudo_inertia(parameters));
    let least = LEAST * eigen.eigenvalues.amax();
    eigen.eigenvalues.iter_mut().for_each(|value| *value = value.max(least));
    body_parameters(&eigen.recompose())
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

    use super::*;
    use crate::arm::effects::find;

    /// Mass, centre, moments about it: one with a negative moment, one that a body has.
    const LOADS: [[f64; RIGID]; 2] = [
        [3.0, 0.02, 0.03, 0.1, -0.4, 0.01, 0.01, 0.0, 0.0, 0.0],
        [3.0, 0.02, 0.03, 0.1, 0.02, 0.02, 0.02, 0.0, 0.0, 0.0],
    ];

    #[test]
    fn a_load_that_no_body_has_keeps_its_mass_and_centre() {
        let model = crate::arm::robot::load("IRB1600-10/1.45").unwrap();
        let payload = find("payload").unwrap();
        let last = model.links.last().unwrap();
        let both =
            |load: &[f64]| with_body(last, &model.kinematics.flange, &payload.coordinates_of(load));
        let [impossible, own] = LOADS;
        assert!(!both(&impossible).is_consistent());
        let found = possible_load(&model, payload, &impossible);
        assert!(both(&found).is_consistent());
        assert_eq!(found[..4], impossible[..4]);
        assert_eq!(possible_load(&model, payload, &own), own);
    }
}
