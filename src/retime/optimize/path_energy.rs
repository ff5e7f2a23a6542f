//! The energy of a speed profile on a path by parts.
//!
//! Power at a joint is p = τ q̇ with friction. Of the braking power that no other joint uses (per
//! joint, or as a sum on a common bus) a share is fed back, the rest is lost; a motor adds copper
//! losses k τ². Costs from the literature replace the work by torques or speeds.

use crate::retime::motion::stream::{DOF, Joints};
use crate::retime::motion::timing::grid::{PathGrid, PathPoint};
use crate::retime::motion::timing::profile::Profile;

/// Use of the braking power of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sharing {
    /// None: the negative power of each joint is dissipated.
    PerJoint,
    /// By the other joints: only a negative sum is dissipated.
    Bus,
}

/// Coefficients of the cost of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnergyModel {
    /// Weight of the mechanical work with friction: 1, or 0 for substitutes of the energy.
    pub work: f64,
    /// Cost of the speed of a joint, W/(rad/s)²: 0 for energies.
    pub speed: f64,
    /// Copper loss of each joint, W/(Nm)².
    pub loss: Joints,
    /// Power while the robot is on, W; 0 if the time is fixed.
    pub base_w: f64,
    /// Use of braking power.
    pub sharing: Sharing,
    /// Share of the unused braking power that is fed back, 0…1.
    pub regeneration: f64,
}

/// Energies of a motion, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyParts {
    /// Duration, s.
    pub time: f64,
    /// ∫ Σ `τ_rigid` q̇.
    pub mechanical: f64,
    /// Work of Coulomb and viscous friction.
    pub friction: f64,
    /// Copper losses.
    pub copper: f64,
    /// Braking energy that is not fed back.
    pub drive: f64,
    /// Base power over the duration.
    pub base: f64,
    /// Cost of squared speeds, a substitute for energy.
    pub speed: f64,
}

impl EnergyParts {
    /// The sum, J.
    pub fn total(&self) -> f64 {
        self.mechanical + self.friction + self.copper + self.drive + self.base + self.speed
    }
}

/// Gauss–Legendre nodes on [0, 1] and weights; exact to degree 9.
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_095),
    (0.230_765_344_947_158, 0.239_314_335_249_683),
    (0.5, 0.284_444_444_444_444),
    (0.769_234_655_052_842, 0.239_314_335_249_683),
    (0.953_089_922_969_332, 0.118_463_442_528_095),
];

impl EnergyModel {
    /// Work, copper losses `loss` (W/(Nm)²) and braking power that is lost unless shared.
    pub fn electrical(loss: Joints, sharing: Sharing) -> EnergyModel {
        EnergyModel { work: 1.0, speed: 0.0, loss, base_w: 0.0, sharing, regeneration: 0.0 }
    }

    /// Lost braking power, W, at the joint powers `p` (W).
    pub(super) fn braked(&self, p: &Joints) -> f64 {
        let negative = match self.sharing {
            Sharing::PerJoint => p.iter().map(|p| (-p).max(0.0)).sum(),
            Sharing::Bus => (-p.iter().sum::<f64>()).max(0.0),
        };
        (1.0 - self.regeneration) * negative
    }

    /// Powers at one place with path speed `v` and acceleration `u`, as energies per second.
    fn power(&self, point: &PathPoint, v: f64, u: f64) -> EnergyParts {
        let rigid = point.rigid_torque(u, v * v);
        let friction = point.friction_torque(v);
        let mut parts = EnergyParts { time: 1.0, base: self.base_w, ..EnergyParts::default() };
        let mut p = Joints::default();
        for j in 0..DOF {
            let qd = point.q1[j] * v;
            let torque = rigid[j] + friction[j];
            parts.mechanical += self.work * rigid[j] * qd;
            parts.friction += self.work * friction[j] * qd;
            parts.speed += self.speed * qd * qd;
            parts.copper += self.loss[j] * torque * torque;
            p[j] = torque * qd;
        }
        parts.drive = self.braked(&p);
        parts
    }
}

/// The energies of `profile` on the nodes of the grid: Gauss quadrature in time on each interval
/// with coefficients that are linear in s.
pub fn evaluate(grid: &PathGrid, profile: &Profile, model: &EnergyModel) -> EnergyParts {
    let mut sum = EnergyParts::default();
    for (k, ([begin, end], piece)) in grid.ends().iter().zip(profile.pieces()).enumerate() {
        for (x, weight) in GAUSS {
            let tau = x * piece.duration;
            let v = piece.speed + piece.acceleration * tau;
            let passed = tau * 0.5 * (piece.speed + v) / grid.delta(k);
            let power = model.power(&begin.toward(end, passed), v, piece.acceleration);
            let seconds = weight * piece.duration;
            sum.time += seconds;
            sum.mechanical += seconds * power.mechanical;
            sum.friction += seconds * power.friction;
            sum.copper += seconds * power.copper;
            sum.drive += seconds * power.drive;
            sum.base += seconds * power.base;
            sum.speed += seconds * power.speed;
        }
    }
    sum
}
