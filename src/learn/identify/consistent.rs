//! Physically consistent parameters near those that the data determine.
//!
//! A link is physically consistent if its [`pseudo_inertia`] P is positive definite. The function
//! that is minimised is
//!
//! ```text
//! ½ |R (G π − β)|² + λ Σ [ tr(P₀⁻¹ P) − log det(P₀⁻¹ P) − 4 ] + λ Σ [ s/s₀ − log(s/s₀) − 1 ]
//! ```
//!
//! with β the base parameters of the data and R their triangular factor, and the entropic
//! divergence (T. Lee, P. Wensing, F. Park, "Geometric robot dynamic identification: a
//! convex programming approach", T-RO 36, 2020) of each link from its prior P₀ and of each
//! rotor and friction from its prior s₀. It is convex, and the divergence keeps every P
//! positive definite, so that Newton's method finds the only minimum.
//!
//! `gap::possible` has no data and moves the parameters of a fit as little as necessary.

use nalgebra::{DMatrix, DVector, Matrix4, SymmetricEigen};

use crate::arm::dynamics::{RIGID, body_parameters, pseudo_inertia};

/// Weights λ of the divergence, in descending order: Newton's method converges from any start with
/// the first; with the last the data determine all that they can.
const WEIGHTS: [f64; 13] =
    [1e4, 1e3, 1e2, 1e1, 1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8];
/// Largest number of Newton steps for one weight.
const STEPS: usize = 60;
/// Newton decrement at which the steps end.
const SETTLED: f64 = 1e-9;
/// Largest ratio of the residuals' root mean square to its least value among consistent models.
const GROWTH: f64 = 1.003;
/// Largest increase of the sum of squares for each parameter, in units of the noise: beyond it the
/// estimate would leave its own confidence intervals.
const ALLOWED: f64 = 1.0;

/// Least [`margin`] of a body: below it, the body is numerically flat or a point.
pub(super) const BODY: f64 = 1e-9;

/// A free parameter or body and its prior.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Piece {
    /// Ten parameters of a rigid body, in the order of
    /// [`link_parameters`](crate::arm::dynamics::link_parameters).
    Body(Matrix4<f64>),
    /// A positive number.
    Positive(f64),
    /// A number of any sign, with its typical size.
    Any(f64),
}

impl Piece {
    fn width(&self) -> usize {
        match self {
            Piece::Body(_) => RIGID,
            Piece::Positive(_) | Piece::Any(_) => 1,
        }
    }
}

/// The data as a sum of squares: `least` + |factor (combination · π − beta)|².
pub(crate) struct Target<'a> {
    /// G.
    pub combination: &'a DMatrix<f64>,
    /// R, in units of the noise.
    pub factor: &'a DMatrix<f64>,
    /// β.
    pub beta: &'a DVector<f64>,
    /// Least sum of squares.
    pub least: f64,
}

impl Target<'_> {
    /// The sum of squares at parameters π.
    pub(crate) fn squares(&self, point: &DVector<f64>) -> f64 {
        self.least + (self.factor * (self.combination * point - self.beta)).norm_squared()
    }
}

/// The parameters of all pieces in order; `None` for a prior that is not positive definite.
#[must_use]
pub(crate) fn consistent(pieces: &[Piece], target: &Target<'_>) -> Option<DVector<f64>> {
    let through = target.factor * target.combination;
    let goal = target.factor * target.beta;
    let mut point = start(pieces);
    let mut problem = Problem { pieces, through: &through, goal: &goal, weight: WEIGHTS[0] };
    problem.value(&point)?;
    let mut found = Vec::with_capacity(WEIGHTS.len());
    for weight in WEIGHTS {
        problem.weight = weight;
        point = problem.minimise(point);
        let more = (&through * &point - &goal).norm_squared();
        found.push((target.least + more, point.clone()));
    }
    // The reference is the best consistent model, not the unconstrained fit. Without the prior,
    // parameters that the data hardly determine would be arbitrary.
    let least = found.iter().map(|(squares, _)| *squares).fold(f64::INFINITY, f64::min);
    let allowed = (GROWTH * GROWTH * least).min(least + ALLOWED * target.beta.len() as f64);
    found.into_iter().find(|(squares, _)| *squares <= allowed).map(|(_, point)| point)
}

fn start(pieces: &[Piece]) -> DVector<f64> {
    let values = pieces.iter().flat_map(|piece| match piece {
        Piece::Body(prior) => body_parameters(prior).to_vec(),
        Piece::Positive(prior) => vec![*prior],
        Piece::Any(_) => vec![0.0],
    });
    DVector::from_vec(values.collect())
}

/// The pieces, each with the place of its first parameter.
pub(super) fn placed(pieces: &[Piece]) -> impl Iterator<Item = (usize, &Piece)> {
    let mut next = 0;
    pieces.iter().map(move |piece| {
        let at = next;
        next += piece.width();
        (at, piece)
    })
}

struct Problem<'a> {
    pieces: &'a [Piece],
    through: &'a DMatrix<f64>,
    goal: &'a DVector<f64>,
    weight: f64,
}

impl Problem<'_> {
    /// The value of the objective; `None` outside its domain.
    fn value(&self, point: &DVector<f64>) -> Option<f64> {
        let mut sum = 0.0;
        for (at, piece) in placed(self.pieces) {
            match piece {
                Piece::Body(prior) => {
                    let p = pseudo_inertia(&point.as_slice()[at..at + RIGID]);
                    let inverse = prior.cholesky()?.inverse();
                    let log_det = |m: &Matrix4<f64>| -> Option<f64> {
                        Some(2.0 * m.cholesky()?.l().diagonal().map(f64::ln).sum())
                    };
                    let (log, log_prior) = (log_det(&p)?, log_det(prior)?);
                    sum += (inverse * p).trace() - (log - log_prior) - 4.0;
                }
                Piece::Positive(prior) => {
                    let ratio = point[at] / prior;
                    if ratio <= 0.0 {
                        return None;
                    }
                    sum += ratio - ratio.ln() - 1.0;
                }
                Piece::Any(size) => sum += 0.5 * (point[at] / size).powi(2),
            }
        }
        let value = 0.5 * (self.through * point - self.goal).norm_squared() + self.weight * sum;
        value.is_finite().then_some(value)
    }

    fn slope(&self, point: &DVector<f64>) -> (DVector<f64>, DMatrix<f64>) {
        let mut gradient = self.through.tr_mul(&(self.through * point - self.goal));
        let mut hessian = self.through.tr_mul(self.through);
        for (at, piece) in placed(self.pieces) {
            match piece {
                Piece::Body(prior) => {
                    let p = pseudo_inertia(&point.as_slice()[at..at + RIGID]);
                    let invert = |m: Matrix4<f64>| m.try_inverse().unwrap_or_default();
                    let (inverse, prior) = (invert(p), invert(*prior));
                    let turned: Vec<Matrix4<f64>> =
                        (0..RIGID).map(|k| inverse * direction(k)).collect();
                    for k in 0..RIGID {
                        let pull = (prior * direction(k)).trace() - turned[k].trace();
                        gradient[at + k] += self.weight * pull;
                        for l in 0..RIGID {
                            hessian[(at + k, at + l)] +=
                                self.weight * (turned[k] * turned[l]).trace();
                        }
                    }
                }
                Piece::Positive(prior) => {
                    gradient[at] += self.weight * (1.0 / prior - 1.0 / point[at]);
                    hessian[(at, at)] += self.weight / (point[at] * point[at]);
                }
                Piece::Any(size) => {
                    gradient[at] += self.weight * point[at] / (size * size);
                    hessian[(at, at)] += self.weight / (size * size);
                }
            }
        }
        (gradient, hessian)
    }

    /// Newton's method with backtracking inside the domain.
    fn minimise(&self, mut point: DVector<f64>) -> DVector<f64> {
        let Some(mut value) = self.value(&point) else { return point };
        for _ in 0..STEPS {
            let (gradient, mut hessian) = self.slope(&point);
            // Columns are scaled, because units differ by orders of magnitude.
            let size: Vec<f64> =
                hessian.diagonal().iter().map(|d| d.max(f64::MIN_POSITIVE).sqrt()).collect();
            for a in 0..size.len() {
                for b in 0..size.len() {
                    hessian[(a, b)] /= size[a] * size[b];
                }
                hessian[(a, a)] += f64::EPSILON;
            }
            let scaled =
                DVector::from_iterator(size.len(), gradient.iter().zip(&size).map(|(g, s)| g / s));
            let Some(factor) = hessian.cholesky() else { return point };
            let mut step = factor.solve(&scaled);
            step.iter_mut().zip(&size).for_each(|(x, s)| *x /= s);
            let decrement = gradient.dot(&step);
            if decrement < 2.0 * SETTLED * (1.0 + value.abs()).min(1.0) {
                break;
            }
            let mut share = 1.0;
            loop {
                let next = &point - &step * share;
                if let Some(found) =
                    self.value(&next).filter(|v| *v <= value - 0.1 * share * decrement)
                {
                    point = next;
                    value = found;
                    break;
                }
                share *= 0.5;
                if share < 1e-12 {
                    return point;
                }
            }
        }
        point
    }
}

/// Derivative of P with respect to parameter `k`.
fn direction(k: usize) -> Matrix4<f64> {
    let mut e = Matrix4::zeros();
    match k {
        0 => e[(3, 3)] = 1.0,
        1..=3 => {
            e[(k - 1, 3)] = 1.0;
            e[(3, k - 1)] = 1.0;
        }
        4..=6 => {
            for axis in 0..3 {
                e[(axis, axis)] = if axis == k - 4 { -0.5 } else { 0.5 };
            }
        }
        _ => {
            let (a, b) = [(0, 1), (0, 2), (1, 2)][(k - 7).min(2)];
            e[(a, b)] = -1.0;
            e[(b, a)] = -1.0;
        }
    }
    e
}

/// Least over largest eigenvalue of a body's pseudo-inertia.
#[must_use]
pub(super) fn margin(parameters: &[f64]) -> f64 {
    let values = SymmetricEigen::new(pseudo_inertia(parameters)).eigenvalues;
    values.min() / values.max()
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

    use nalgebra::{Matrix3, Vector3};

    use super::*;
    use crate::arm::dynamics::link_parameters;
    use crate::arm::robot::Link;

    fn body(mass: f64, com: [f64; 3], moments: [f64; 3]) -> Link {
        let inertia = Matrix3::from_diagonal(&Vector3::from(moments));
        Link { mass, com: Vector3::from(com), inertia }
    }

    #[test]
    fn directions_sum_to_the_pseudo_inertia() {
        let there = link_parameters(&body(3.0, [0.1, -0.2, 0.3], [0.02, 0.03, 0.04]));
        let sum: Matrix4<f64> = (0..RIGID).map(|k| direction(k) * there[k]).sum();
        assert!((sum - pseudo_inertia(&there)).norm() < 1e-14);
        assert!(margin(&there) > 0.0);
    }

    /// The data require impossible moments of inertia. The result is the best body: a grid search
    /// finds none with smaller residuals.
    #[test]
    fn impossible_moments_give_the_nearest_body() {
        let prior = pseudo_inertia(&link_parameters(&body(2.0, [0.0; 3], [0.02, 0.02, 0.02])));
        let mut combination = DMatrix::zeros(3, RIGID);
        for (row, column) in [4, 5, 6].into_iter().enumerate() {
            combination[(row, column)] = 1.0;
        }
        let factor = DMatrix::identity(3, 3) * 1e3;
        let beta = DVector::from_vec(vec![0.01, 0.01, 0.05]);
        let target =
            Target { combination: &combination, factor: &factor, beta: &beta, least: 1e-9 };
        let found = consistent(&[Piece::Body(prior)], &target).unwrap();
        assert!(margin(found.as_slice()) > 0.0);
        let miss = |xx: f64, yy: f64, zz: f64| {
            (xx - 0.01).powi(2) + (yy - 0.01).powi(2) + (zz - 0.05).powi(2)
        };
        let here = miss(found[4], found[5], found[6]);
        let mut best = f64::INFINITY;
        for i in 0..60 {
            for k in 0..60 {
                let (xx, yy) = (0.001 * f64::from(i), 0.001 * f64::from(k));
                for zz in (0..60).map(|l| 0.001 * f64::from(l)) {
                    if zz <= xx + yy && xx <= yy + zz && yy <= xx + zz {
                        best = best.min(miss(xx, yy, zz));
                    }
                }
            }
        }
        assert!(here <= best * 1.01, "{here} {best}");
    }
}
