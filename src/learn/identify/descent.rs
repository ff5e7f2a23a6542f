//! The fit of Paes et al. 2014, for comparison: masses, centres of mass, moments of inertia and
//! friction by descent from an initial guess.
//!
//! ```text
//! F = sqrt(1/6N Σ Σ (τ − τ_est)²)
//! ```
//!
//! Equation 6 of Paes et al. 2014, without products of inertia. F is not convex, and some of the
//! parameters are not determined: the result depends on the guess. The steps are those of K.
//! Levenberg, "A method for the solution of certain non-linear problems in least squares", Q. Appl.
//! Math. 2, 1944.

use nalgebra::{DMatrix, DVector, Vector3};

use crate::arm::dynamics::{JOINT, Load, RIGID, link_parameters, parameters};
use crate::arm::robot::{Link, Model};

use super::guess::first_guess;
use super::identified::Identified;
use super::misses::root_mean;

/// Parameters of a link: mass, centre of mass, moments of inertia about it.
const LINK: usize = 7;
/// Largest number of steps.
const STEPS: usize = 200;
/// Relative gain at which the descent ends.
const SETTLED: f64 = 1e-9;
/// Initial damping, its factor, and its upper limit.
const DAMPING: [f64; 3] = [1e-3, 10.0, 1e12];

/// The result of the descent.
#[derive(Clone, Debug, PartialEq)]
pub struct Descent {
    /// Links with principal axes parallel to their frames.
    pub links: Vec<Link>,
    /// Rotor inertia, viscous and Coulomb friction and offset of each joint.
    pub joints: Vec<f64>,
    /// F of the guess and of the result \[Nm\].
    pub misses: [f64; 2],
    /// Root mean square of each joint's residuals \[Nm\].
    pub rms: Vec<f64>,
    /// Number of steps.
    pub steps: usize,
}

/// Descends from the links and joints of `guess`, with the geometry of the identification `found`;
/// `None` if not all parameters were free.
#[must_use]
pub fn by_descent(guess: &Model, found: &Identified) -> Option<Descent> {
    let n = guess.dof;
    let base = &found.base;
    if found.among.len() != (RIGID + JOINT) * n {
        return None;
    }
    let links: Vec<Link> = (0..n).map(|joint| first_guess(guess, joint)).collect();
    let all = parameters(guess, &Load::none());
    let joints = all.get(RIGID * n..).map_or_else(|| vec![0.0; JOINT * n], <[f64]>::to_vec);
    // The base parameters as a linear function of all parameters.
    let mut unit = vec![0.0; found.among.len()];
    let mut combination = DMatrix::zeros(base.rank(), unit.len());
    for k in 0..unit.len() {
        unit[k] = 1.0;
        combination.set_column(k, &DVector::from_vec(base.of_parameters(&unit)));
        unit[k] = 0.0;
    }
    let factors = found.fit.factors.merged(None);
    let stacked = factors.stacked(&vec![1.0; n], base.rank());
    let (left, right) = stacked.columns_range_pair(..base.rank(), base.rank()..);
    let equations = Equations {
        through: left * &combination,
        goal: right.column(0).into_owned(),
        count: found.fit.rows.iter().sum(),
    };
    let mut x: Vec<f64> = links.iter().flat_map(numbers).collect();
    x.extend(joints);
    let (x, misses, steps) = equations.descended(DVector::from_vec(x), n);
    let beta = &combination * linear(&x, n);
    Some(Descent {
        links: x.as_slice()[..LINK * n].chunks(LINK).map(link).collect(),
        joints: x.as_slice()[LINK * n..].to_vec(),
        rms: root_mean(&factors.residual_squares(&beta, None), &found.fit.rows),
        misses,
        steps,
    })
}

/// |through · π − goal|² is the sum of the squared residuals.
struct Equations {
    through: DMatrix<f64>,
    goal: DVector<f64>,
    count: usize,
}

impl Equations {
    fn residuals(&self, x: &DVector<f64>, links: usize) -> DVector<f64> {
        &self.through * linear(x, links) - &self.goal
    }

    /// The end of the descent from `x`, F before and after, and the number of steps.
    fn descended(&self, mut x: DVector<f64>, links: usize) -> (DVector<f64>, [f64; 2], usize) {
        let miss = |e: &DVector<f64>| (e.norm_squared() / self.count.max(1) as f64).sqrt();
        let mut here = self.residuals(&x, links);
        let first = miss(&here);
        let mut damping = DAMPING[0];
        let mut steps = 0;
        while steps < STEPS {
            steps += 1;
            let jacobian = &self.through * slopes(&x, links);
            let normal = jacobian.tr_mul(&jacobian);
            let downhill = jacobian.tr_mul(&here);
            let before = here.norm_squared();
            while damping < DAMPING[2] {
                if let Some(step) = damped(&normal, damping, &downhill) {
                    let next = &x - step;
                    let there = self.residuals(&next, links);
                    if there.norm_squared() < before {
                        (x, here) = (next, there);
                        damping /= DAMPING[1];
                        break;
                    }
                }
                damping *= DAMPING[1];
            }
            if before - here.norm_squared() < SETTLED * before {
                break;
            }
        }
        (x, [first, miss(&here)], steps)
    }
}

/// (N + λ diag N)⁻¹ g.
fn damped(normal: &DMatrix<f64>, damping: f64, slope: &DVector<f64>) -> Option<DVector<f64>> {
    let mut matrix = normal.clone();
    let floor = f64::EPSILON * normal.diagonal().max();
    for k in 0..matrix.nrows() {
        matrix[(k, k)] += damping * normal[(k, k)].max(floor);
    }
    Some(matrix.cholesky()?.solve(slope))
}

fn numbers(link: &Link) -> [f64; LINK] {
    let (c, i) = (link.com, link.inertia.diagonal());
    [link.mass, c.x, c.y, c.z, i.x, i.y, i.z]
}

fn link(x: &[f64]) -> Link {
    Link {
        mass: x[0],
        com: Vector3::new(x[1], x[2], x[3]),
        inertia: nalgebra::Matrix3::from_diagonal(&Vector3::new(x[4], x[5], x[6])),
    }
}

/// All linear parameters.
fn linear(x: &DVector<f64>, links: usize) -> DVector<f64> {
    let x = x.as_slice();
    let rigid = x[..LINK * links].chunks(LINK).flat_map(|of| link_parameters(&link(of)));
    let all: Vec<f64> = rigid.chain(x[LINK * links..].iter().copied()).collect();
    DVector::from_vec(all)
}

/// Derivatives of all linear parameters with respect to `x`.
fn slopes(x: &DVector<f64>, links: usize) -> DMatrix<f64> {
    let joints = x.len() - LINK * links;
    let mut slopes = DMatrix::zeros(RIGID * links + joints, x.len());
    for body in 0..links {
        let (row, column) = (RIGID * body, LINK * body);
        let (m, c) = (x[column], Vector3::new(x[column + 1], x[column + 2], x[column + 3]));
        let mut set = |r: usize, k: usize, value: f64| slopes[(row + r, column + k)] = value;
        set(0, 0, 1.0);
        for axis in 0..3 {
            set(1 + axis, 0, c[axis]);
            set(1 + axis, 1 + axis, m);
            // Moments about the origin: I + m (|c|² − c_a²).
            let others = c.norm_squared() - c[axis] * c[axis];
            set(4 + axis, 0, others);
            for with in (0..3).filter(|with| *with != axis) {
                set(4 + axis, 1 + with, 2.0 * m * c[with]);
            }
            set(4 + axis, 4 + axis, 1.0);
        }
        for (k, (a, b)) in [(0, 1), (0, 2), (1, 2)].into_iter().enumerate() {
            // Products: −m c_a c_b.
            set(7 + k, 0, -c[a] * c[b]);
            set(7 + k, 1 + a, -m * c[b]);
            set(7 + k, 1 + b, -m * c[a]);
        }
    }
    for joint in 0..joints {
        slopes[(RIGID * links + joint, LINK * links + joint)] = 1.0;
    }
    slopes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Step of the central differences.
    const STEP: f64 = 1e-5;

    #[test]
    fn the_jacobian_matches_finite_differences() {
        let x = DVector::from_fn(2 * LINK + 3, |k, _| 0.4 + (1.7 * k as f64).sin());
        let slopes = slopes(&x, 2);
        for column in 0..x.len() {
            let at = |step: f64| {
                let mut x = x.clone();
                x[column] += step;
                linear(&x, 2)
            };
            let found = (at(STEP) - at(-STEP)) / (2.0 * STEP);
            assert!((found - slopes.column(column)).amax() < 1e-8, "{column}");
        }
    }
}
