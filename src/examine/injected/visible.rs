//! How well an effect can be seen in a real log.
//!
//! The expected log-likelihood ratio in nats, `½ Δᵀ(Σ + B Bᵀ)⁻¹Δ`: Δ is what the effect adds, Σ the
//! covariance of the robot's real residual, B has a column for each parameter of a commissioned
//! robot times its standard deviation. The residual of a joint is a first-order autoregression of
//! means over short intervals.

use nalgebra::{DMatrix, DVector};

use super::arm::Arm;
use super::motion::{Joints, rms};
use crate::arm::dynamics::{RIGID, Regressor, regressor, sign};
use crate::arm::robot::Link;

/// Length of the intervals \[s\]: no frequency of a joint's motion is higher.
const STEP_S: f64 = 0.02;
/// Standard deviations of a commissioned robot: mass \[1\], centre of mass \[m\], inertia \[1\],
/// friction \[1\].
const MASS: f64 = 0.01;
const COM_M: f64 = 0.003;
const INERTIA: f64 = 0.03;
const FRICTION: f64 = 0.05;
/// Parameters of a joint: rotor, Coulomb friction, viscous friction.
const OF_JOINT: usize = 3;

/// Nats of the torques `added` in contiguous runs of rows.
pub(super) fn nats(arm: &Arm, runs: &[Vec<usize>], added: &[Joints]) -> f64 {
    let n = arm.dof();
    let columns = (RIGID + OF_JOINT) * n;
    let every = (STEP_S * (arm.motion.rows() - 1) as f64 / arm.motion.duration()).round().max(1.0);
    let every = every as usize;
    let all: Vec<usize> = (0..arm.motion.rows()).collect();
    let noise = (0..n).map(|joint| Noise::of(&means(&all, every, &arm.residual, joint)));
    let noise: Vec<Noise> = noise.collect();
    let deviations = deviations(arm);

    let mut gram = DMatrix::<f64>::identity(columns, columns);
    let mut projected = DVector::<f64>::zeros(columns);
    let mut squares = 0.0;
    for run in runs {
        let middles: Vec<usize> = run.chunks_exact(every).map(|rows| rows[every / 2]).collect();
        let nuisance: Vec<DMatrix<f64>> =
            middles.iter().map(|row| nuisance(arm, *row, &deviations)).collect();
        for joint in 0..n {
            // Rows in which a joint rests tell nothing of it.
            let rests: Vec<bool> = middles.iter().map(|row| arm.rests(*row, joint)).collect();
            let moving = |values: Vec<f64>| -> Vec<f64> {
                let of = rests.iter().zip(values);
                of.map(|(rests, value)| if *rests { 0.0 } else { value }).collect()
            };
            let delta = moving(means(run, every, added, joint));
            let delta = noise[joint].whitened(&delta);
            let mut block = DMatrix::zeros(delta.len(), columns);
            for column in 0..columns {
                let values = moving(nuisance.iter().map(|at| at[(joint, column)]).collect());
                block.set_column(column, &DVector::from_vec(noise[joint].whitened(&values)));
            }
            let delta = DVector::from_vec(delta);
            gram += block.tr_mul(&block);
            projected += block.tr_mul(&delta);
            squares += delta.norm_squared();
        }
    }
    let Some(factor) = gram.cholesky() else { return 0.0 };
    0.5 * (squares - projected.dot(&factor.solve(&projected))).max(0.0)
}

/// Means of a joint's torque over each `every` of the rows \[Nm\].
fn means(rows: &[usize], every: usize, torques: &[Joints], joint: usize) -> Vec<f64> {
    let mean =
        |rows: &[usize]| rows.iter().map(|row| torques[*row][joint]).sum::<f64>() / every as f64;
    rows.chunks_exact(every).map(mean).collect()
}

/// A first-order autoregression.
struct Noise {
    memory: f64,
    innovation: f64,
}

impl Noise {
    fn of(residual: &[f64]) -> Noise {
        let size = rms(residual.iter().copied()).max(f64::MIN_POSITIVE);
        let products = residual.windows(2).map(|pair| pair[0] * pair[1]);
        let memory = products.sum::<f64>() / (residual.len() as f64 * size * size);
        let memory = memory.clamp(0.0, 0.98);
        Noise { memory, innovation: size * (1.0 - memory * memory).sqrt() }
    }

    /// The innovations of a series over their standard deviation.
    fn whitened(&self, series: &[f64]) -> Vec<f64> {
        let fresh = |pair: &[f64]| (pair[1] - self.memory * pair[0]) / self.innovation;
        series.windows(2).map(fresh).collect()
    }
}

/// Standard deviations of the parameters: of each link, then of each joint.
fn deviations(arm: &Arm) -> Vec<f64> {
    let of_link = |link: &Link| {
        let moment = INERTIA * link.inertia.trace() / 3.0;
        let mut sd = [moment; RIGID];
        sd[0] = MASS * link.mass;
        sd[1..4].fill(COM_M * link.mass);
        sd
    };
    let friction = &arm.model.friction;
    let of_joint = |joint: usize| {
        let levels = [friction.coulomb[joint], friction.viscous[joint]];
        let [dry, viscous] = levels.map(|level| FRICTION * level);
        [INERTIA * arm.rotor(joint), dry, viscous]
    };
    let links = arm.model.links.iter().flat_map(of_link);
    links.chain((0..arm.dof()).flat_map(of_joint)).collect()
}

/// Torques at a row of each parameter at one standard deviation, a row for each joint \[Nm\].
fn nuisance(arm: &Arm, row: usize, deviations: &[f64]) -> DMatrix<f64> {
    let n = arm.dof();
    let motion = &arm.motion;
    let (qd, qdd) = (&motion.qd[row], &motion.qdd[row]);
    let mut bodies = Regressor::new();
    regressor(&arm.model, &mut bodies, &motion.q[row][..n], &qd[..n], &qdd[..n]);
    let mut matrix = DMatrix::zeros(n, deviations.len());
    for joint in 0..n {
        for (link, of_link) in bodies.rows[joint].iter().enumerate().take(n) {
            for (k, entry) in of_link.iter().enumerate() {
                matrix[(joint, RIGID * link + k)] = entry * deviations[RIGID * link + k];
            }
        }
        let first = RIGID * n + OF_JOINT * joint;
        for (k, entry) in [qdd[joint], sign(qd[joint]), qd[joint]].into_iter().enumerate() {
            matrix[(joint, first + k)] = entry * deviations[first + k];
        }
    }
    matrix
}
