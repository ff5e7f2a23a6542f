//! The nearest body to what was fitted of one.

use nalgebra::{DMatrix, DVector, Matrix3, Matrix4, Vector3};

use crate::arm::dynamics::{RIGID, link_of, link_parameters, pseudo_inertia};
use crate::arm::robot::Link;
use crate::learn::identify::{Piece, Target, consistent};

/// Radius of the ball from which a body is looked for \[m\].
const RADIUS: f64 = 0.1;

/// Squares of deviations from which on what differs is no body.
const CHANGED: f64 = 500.0;

/// The body (mass, first moments, moments) nearest to what was fitted of one, measured by what is
/// known of it; a body with a negative mass is one that is gone. `None` where it is one already,
/// or far from any.
pub(super) fn body_near(fitted: &[f64], covariance: &DMatrix<f64>) -> Option<Vec<f64>> {
    let is_body = |sense: f64| {
        let body: Vec<f64> = fitted.iter().map(|x| sense * x).collect();
        body[0] > 0.0 && link_of(&body).is_consistent()
    };
    if fitted.len() != RIGID || [1.0, -1.0].into_iter().any(is_body) {
        return None;
    }
    // In units of their deviations, or kilograms and milligrams meet in one factor.
    let sds = covariance.diagonal().map(f64::sqrt);
    let correlation = DMatrix::from_fn(RIGID, RIGID, |i, k| covariance[(i, k)] / (sds[i] * sds[k]));
    let known = correlation.cholesky()?.inverse().cholesky()?.l().transpose();
    let factor = DMatrix::from_fn(RIGID, RIGID, |i, k| known[(i, k)] / sds[k]);
    let combination = DMatrix::identity(RIGID, RIGID);
    let near = |sense: f64| {
        let beta = DVector::from_iterator(RIGID, fitted.iter().map(|x| sense * x));
        let target = Target { combination: &combination, factor: &factor, beta: &beta, least: 0.0 };
        let found = consistent(&[Piece::Body(ball(fitted[0].abs().max(sds[0])))], &target)?;
        Some((target.squares(&found), (sense * found).as_slice().to_vec()))
    };
    // One tool in the place of another one is no body more.
    let both = [near(1.0), near(-1.0)].into_iter().flatten();
    let near = both.min_by(|(a, _), (b, _)| a.total_cmp(b));
    near.filter(|(squares, _)| *squares < CHANGED).map(|(_, body)| body)
}

/// A ball at the flange.
fn ball(mass: f64) -> Matrix4<f64> {
    let inertia = Matrix3::identity() * (0.4 * mass * RADIUS * RADIUS);
    pseudo_inertia(&link_parameters(&Link { mass, com: Vector3::zeros(), inertia }))
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

    use super::*;

    /// How well mass, first moments and moments of a body are known.
    const SDS: [f64; RIGID] = [2.0, 0.02, 0.02, 0.02, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01];

    fn covariance() -> DMatrix<f64> {
        DMatrix::from_diagonal(&DVector::from_iterator(RIGID, SDS.map(|sd| sd * sd)))
    }

    /// 3 kg a decimetre above the flange.
    fn above() -> [f64; RIGID] {
        let inertia = Matrix3::from_diagonal(&Vector3::new(0.02, 0.02, 0.01));
        link_parameters(&Link { mass: 3.0, com: Vector3::new(0.02, 0.03, 0.1), inertia })
    }

    #[test]
    fn a_mass_that_is_hardly_known_follows_the_moments() {
        let mut fitted = above();
        fitted[0] = -1.0;
        let body = body_near(&fitted, &covariance()).unwrap();
        assert!(body[0] > 0.0 && link_of(&body).is_consistent());
        // The first moment is known to 0.02 kg m, so that the centre needs a mass.
        assert!((body[3] - above()[3]).abs() < SDS[3], "{body:?}");
        assert!(body[0] > 1.0, "{body:?}");
    }

    #[test]
    fn what_is_gone_was_a_body() {
        let gone = above().map(|x| -x);
        assert_eq!(body_near(&gone, &covariance()), None);
        assert_eq!(body_near(&above(), &covariance()), None);
        let mut flat = gone;
        flat[4] = 0.02;
        let body = body_near(&flat, &covariance()).unwrap();
        assert!(body[0] < 0.0, "{body:?}");
        let was: Vec<f64> = body.iter().map(|x| -x).collect();
        assert!(link_of(&was).is_consistent(), "{body:?}");
    }
}
