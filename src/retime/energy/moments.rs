//! The energy of a motion as a function of the robot.
//!
//! Along a given motion the torque of a joint is linear in the parameters of the bodies, the rotor,
//! friction and a spring,
//!
//! ```text
//! τ = τ₀ + Y Δπ + q̈ ΔJ + q̇ Δf_v + s Δf_c + τ_spring Δk,
//! ```
//!
//! so the copper loss is quadratic in them and the other parts are linear: a few integrals over the
//! motion give the energy of any robot. The drive loss is integrated over the times at which the
//! model brakes; at their ends the power is zero, so a shift of an end has little effect.

use nalgebra::{DMatrix, DVector};

use super::change::Changes;
use super::features::{self, OF_JOINT};
use super::parts::EnergyParts;
use crate::arm::dynamics::{Data, Load, Regressor};
use crate::arm::robot::{MAX_DOF, Model, Sharing};
use crate::retime::motion::timeline::{Event, Run, What};
use crate::retime::path::joint_path::Joints;

/// Length of an interval with two points, s: the relative error of integrals is some thousandths.
const STEP: f64 = 0.1;
/// Fewest and most intervals of a motion.
const STEPS: (f64, f64) = (6.0, 400.0);
/// Points of the two-point Gauss rule on [0, 1].
const POINTS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// Columns that are multiplied together: few enough for the cache.
const COLUMNS: usize = 64;

/// Integrals over motions and rests.
#[derive(Clone, Debug)]
pub struct Moments {
    joints: Vec<JointSums>,
    /// Time with released brakes, s.
    open_s: f64,
}

/// Integrals of one joint over its features φ: torque of the model, parameters of the links from
/// the joint on, parameters of the joint.
#[derive(Clone, Debug)]
struct JointSums {
    /// ∫ φ φᵀ dt in motion; then at rest.
    moving: DMatrix<f64>,
    resting: DMatrix<f64>,
    /// ∫ φ q̇ dt.
    work: DVector<f64>,
    /// −∫ φ q̇ dt over the times of braking.
    lost: DVector<f64>,
}

impl Moments {
    /// Empty integrals.
    pub fn none(model: &Model) -> Moments {
        let joint = |j: usize| {
            let n = features::count(model, j);
            JointSums {
                moving: DMatrix::zeros(n, n),
                resting: DMatrix::zeros(n, n),
                work: DVector::zeros(n),
                lost: DVector::zeros(n),
            }
        };
        Moments { joints: (0..model.dof).map(joint).collect(), open_s: 0.0 }
    }

    /// The integrals of one event of a simulation.
    pub fn from_event(model: &Model, event: &Event) -> Moments {
        let mut moments = Moments::none(model);
        moments.event(model, event);
        moments
    }

    /// Adds an event.
    pub fn event(&mut self, model: &Model, event: &Event) {
        match &event.what {
            What::Run(run) => self.run(model, run),
            What::Wait(wait) => self.rest(model, &wait.load, &wait.q, event.duration),
            What::Output(..) | What::Left(_) => {}
        }
    }

    /// Adds other integrals, multiplied by `times`.
    pub fn add(&mut self, other: &Moments, times: f64) {
        for (sum, joint) in self.joints.iter_mut().zip(&other.joints) {
            let more = |sum: &mut f64, x: f64| *sum += times * x;
            sum.moving.zip_apply(&joint.moving, more);
            sum.resting.zip_apply(&joint.resting, more);
            sum.work.zip_apply(&joint.work, more);
            sum.lost.zip_apply(&joint.lost, more);
        }
        self.open_s += times * other.open_s;
    }

    /// Adds a run.
    pub fn run(&mut self, model: &Model, run: &Run) {
        let moving = run.duration() - run.settling;
        if moving > 0.0 {
            let steps = (moving / STEP).ceil().clamp(STEPS.0, STEPS.1);
            let h = moving / steps;
            let times = (0..steps as usize).flat_map(|i| POINTS.map(|x| h * (i as f64 + x)));
            let states: Vec<[Joints; 3]> = times.map(|t| run.at(t).list()).collect();
            self.sum(model, &run.load, &states, 0.5 * h);
            self.open_s += moving;
        }
        self.rest(model, &run.load, &run.end, run.settling);
    }

    /// Adds a rest.
    pub fn rest(&mut self, model: &Model, load: &Load, q: &Joints, duration: f64) {
        if duration > 0.0 {
            self.sum(model, load, &[[*q, [0.0; 6], [0.0; 6]]], duration);
            self.open_s += duration;
        }
    }

    /// Adds states with an integration weight of `weight` seconds each.
    fn sum(&mut self, model: &Model, load: &Load, states: &[[Joints; 3]], weight: f64) {
        let mut data = Data::new();
        let mut rows = Regressor::new();
        let mut features: Vec<DMatrix<f64>> = self
            .joints
            .iter()
            .map(|joint| DMatrix::zeros(states.len(), joint.work.len()))
            .collect();
        let mut rates = vec![[0.0; MAX_DOF]; states.len()];
        let mut brakes = vec![[false; MAX_DOF]; states.len()];
        let resting = states.iter().all(|[_, qd, qdd]| qd.iter().chain(qdd).all(|x| *x == 0.0));
        for (k, [q, qd, qdd]) in states.iter().enumerate() {
            let scratch = (&mut data, &mut rows);
            let tau = features::write(model, scratch, load, [q, qd, qdd], (&mut features, k));
            let mut power = 0.0;
            for j in 0..model.dof {
                power += tau[j] * qd[j];
                rates[k][j] = qd[j];
                brakes[k][j] = tau[j] * qd[j] < 0.0;
            }
            if model.drive.sharing == Sharing::Bus {
                brakes[k] = [power < 0.0; MAX_DOF];
            }
        }
        for (j, (joint, phi)) in self.joints.iter_mut().zip(&features).enumerate() {
            let gram = if resting { &mut joint.resting } else { &mut joint.moving };
            gram.gemm(weight, &phi.transpose(), phi, 1.0);
            let qd = DVector::from_iterator(states.len(), rates.iter().map(|rate| rate[j]));
            joint.work.gemv_tr(weight, phi, &qd, 1.0);
            let lost = brakes.iter().zip(&rates);
            let lost = lost.map(|(brakes, rate)| if brakes[j] { -rate[j] } else { 0.0 });
            let lost = DVector::from_iterator(states.len(), lost);
            joint.lost.gemv_tr(weight, phi, &lost, 1.0);
        }
    }

    /// ∫ τ² dt of a joint in motion and at rest, per robot \[(Nm)² s\].
    pub fn squares(&self, joint: usize, robots: &Changes) -> Vec<f64> {
        let (sums, values) = (&self.joints[joint], &robots.joints[joint].values);
        quadratic(&(&sums.moving + &sums.resting), values)
    }

    /// Energy of each robot minus that of the model.
    pub fn changes(&self, model: &Model, robots: &Changes) -> Vec<EnergyParts> {
        let rests =
            robots.base_w.iter().zip(&robots.coils_w).map(|(base_w, coils_w)| EnergyParts {
                idle_j: base_w * self.open_s,
                brake_j: coils_w * self.open_s,
                ..EnergyParts::default()
            });
        let mut all: Vec<EnergyParts> = rests.collect();
        let left = 1.0 - model.drive.regeneration;
        for (joint, of) in self.joints.iter().zip(&robots.joints) {
            let own = of.values.nrows() - OF_JOINT;
            let [moving, resting] =
                [&joint.moving, &joint.resting].map(|gram| quadratic(gram, &of.values));
            for (robot, parts) in all.iter_mut().enumerate() {
                let copper = |gram: &DMatrix<f64>, square: &[f64]| {
                    of.loss[robot] * square[robot] - of.model_loss * gram[(0, 0)]
                };
                parts.copper_j += copper(&joint.moving, &moving);
                parts.idle_j += copper(&joint.resting, &resting);
                let values = of.values.column(robot);
                let linear = |sums: &DVector<f64>, range: std::ops::Range<usize>| -> f64 {
                    range.map(|i| sums[i] * values[i]).sum()
                };
                parts.friction_j += linear(&joint.work, own + 1..own + 3);
                parts.mechanical_j += linear(&joint.work, 1..own + 1);
                parts.mechanical_j += linear(&joint.work, own + 3..own + 4);
                parts.drive_j += left * linear(&joint.lost, 1..values.len());
            }
        }
        all
    }
}

/// `vᵀ G v` of each column v.
fn quadratic(gram: &DMatrix<f64>, values: &DMatrix<f64>) -> Vec<f64> {
    let mut squares = Vec::with_capacity(values.ncols());
    for first in (0..values.ncols()).step_by(COLUMNS) {
        let values = values.columns(first, COLUMNS.min(values.ncols() - first));
        let product = gram * values;
        squares.extend(product.column_iter().zip(values.column_iter()).map(|(a, b)| a.dot(&b)));
    }
    squares
}
