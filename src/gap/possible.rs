//! Parameters that a robot can have, with the same torques.
//!
//! Bodies whose pseudo-inertia is positive semidefinite are a convex cone, parameters with the
//! same base parameters an affine space: projections on one and the other in turn lead to what
//! both have in common (J. von Neumann, Functional Operators II, 1950).

use nalgebra::{Cholesky, DMatrix, DVector, Matrix3, Matrix4, SymmetricEigen, Vector3};

use crate::dynamics::{BaseParameters, JOINT, Parameters, RIGID, base_parameters};
use crate::robot::{Link, Model};

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
    let n = model.dof;
    let mut at = inside(wanted, n);
    if at == *wanted {
        return at;
    }
    let base = base_parameters(model, Parameters::WithJoints);
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
        at = inside(&(at + &weighted * factor.solve(&off)), n);
    }
    best.1
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
fn inside(parameters: &DVector<f64>, n: usize) -> DVector<f64> {
    let mut result = parameters.clone();
    for link in 0..n {
        let at = RIGID * link;
        let own: Vec<f64> = parameters.rows(at, RIGID).iter().copied().collect();
        if !(own[0] > 0.0 && body(&own).is_consistent()) {
            result.rows_mut(at, RIGID).copy_from_slice(&nearest(&own));
        }
    }
    for joint in 0..n {
        // Rotor, viscous and Coulomb friction; an offset may have any sign.
        for k in 0..3 {
            let at = RIGID * n + JOINT * joint + k;
            result[at] = result[at].max(0.0);
        }
    }
    result
}

/// The link of ten parameters about its frame's origin.
pub(super) fn body(parameters: &[f64]) -> Link {
    let m = parameters[0];
    let com = Vector3::new(parameters[1], parameters[2], parameters[3]) / m.max(1e-12);
    let [xx, yy, zz, xy, xz, yz] = std::array::from_fn(|k| parameters[4 + k]);
    let about = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let steiner = (Matrix3::identity() * com.norm_squared() - com * com.transpose()) * m;
    Link { mass: m, com, inertia: about - steiner }
}

/// The nearest body: eigenvalues of its pseudo-inertia that are too small are raised.
fn nearest(x: &[f64]) -> [f64; RIGID] {
    let about = Matrix3::new(x[4], x[7], x[8], x[7], x[5], x[9], x[8], x[9], x[6]);
    let spread = Matrix3::identity() * (0.5 * about.trace()) - about;
    let mut pseudo = Matrix4::zeros();
    pseudo.fixed_view_mut::<3, 3>(0, 0).copy_from(&spread);
    for k in 0..3 {
        pseudo[(k, 3)] = x[1 + k];
        pseudo[(3, k)] = x[1 + k];
    }
    pseudo[(3, 3)] = x[0];
    let mut eigen = SymmetricEigen::new(pseudo);
    let least = LEAST * eigen.eigenvalues.amax();
    eigen.eigenvalues.iter_mut().for_each(|value| *value = value.max(least));
    let pseudo = eigen.recompose();
    let spread: Matrix3<f64> = pseudo.fixed_view::<3, 3>(0, 0).into_owned();
    let about = Matrix3::identity() * spread.trace() - spread;
    let p = |k: usize| pseudo[(k, 3)];
    let i = |row: usize, column: usize| about[(row, column)];
    [p(3), p(0), p(1), p(2), i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2)]
}
