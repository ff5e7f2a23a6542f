//! Check of a motion against all limits.

use crate::arm::dynamics::{Data, Load, torque};
use crate::arm::kinematics::Body;
use crate::arm::robot::Model;

use super::error::ExciteError;
use super::series::State;

/// Limits of the joints' speeds \[rad/s\] and accelerations \[rad/s²\].
///
/// # Errors
/// The robot lacks one.
pub(super) fn rate_limits(model: &Model) -> Result<[&[f64]; 2], ExciteError> {
    let limits = &model.limits;
    let lacks = |what| ExciteError::Lacks { name: model.name.clone(), what };
    let velocity = limits.velocity.as_deref().ok_or_else(|| lacks("joint speeds"))?;
    let acceleration =
        limits.acceleration.as_deref().ok_or_else(|| lacks("joint accelerations"))?;
    Ok([velocity, acceleration])
}

/// Largest ratios of a motion's values to the limits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ratios {
    /// Distance from the middle over half the range of a joint.
    pub position: f64,
    /// Speed over its limit.
    pub velocity: f64,
    /// Acceleration over its limit.
    pub acceleration: f64,
    /// Torque over its limit; 0 without limits.
    pub torque: f64,
}

/// Extremes of a motion relative to the limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checked {
    /// Largest ratios.
    pub ratios: Ratios,
    /// Least distance to the obstacles \[m\]; infinite without obstacles.
    pub to_obstacles: f64,
    /// Least distance between parts of the arm \[m\].
    pub to_itself: f64,
}

impl Checked {
    /// Sum of the violations of limits with the largest allowed ratios `allowed`, as shares of the
    /// limits and lengths; 0 if all limits hold.
    #[must_use]
    pub fn excess(&self, allowed: &Ratios) -> f64 {
        let over = |ratio: f64, share: f64| (ratio / share - 1.0).max(0.0);
        let r = &self.ratios;
        over(r.position, allowed.position)
            + over(r.velocity, allowed.velocity)
            + over(r.acceleration, allowed.acceleration)
            + over(r.torque, allowed.torque)
            + (-self.to_obstacles).max(0.0)
            + (-self.to_itself).max(0.0)
    }
}

/// The extremes of states with `load` at the flange.
#[must_use]
pub fn check(model: &Model, body: &Body<'_>, load: &Load, states: &[State]) -> Checked {
    let n = model.dof;
    let limits = &model.limits;
    let mut data = Data::new();
    let mut found = Checked {
        ratios: Ratios::default(),
        to_obstacles: f64::INFINITY,
        to_itself: f64::INFINITY,
    };
    let torques = limits.torque.as_ref().filter(|_| model.has_dynamics());
    for [q, qd, qdd] in states {
        let ratios = &mut found.ratios;
        for joint in 0..n {
            let [low, high] = limits.position_at(&q[..n], joint);
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            ratios.position = ratios.position.max((q[joint] - middle).abs() / half);
            let of = |limits: &Option<Vec<f64>>, value: f64| {
                limits.as_ref().map_or(0.0, |limits| value.abs() / limits[joint])
            };
            ratios.velocity = ratios.velocity.max(of(&limits.velocity, qd[joint]));
            ratios.acceleration = ratios.acceleration.max(of(&limits.acceleration, qdd[joint]));
        }
        if let Some(largest) = torques {
            let parts = torque(model, &mut data, load, &q[..n], &qd[..n], &qdd[..n]);
            for joint in 0..n {
                let tau = parts.rigid[joint] + parts.friction[joint];
                ratios.torque = ratios.torque.max(tau.abs() / largest[joint]);
            }
        }
        let [to_obstacles, to_itself] = body.margins(&q[..n]);
        found.to_obstacles = found.to_obstacles.min(to_obstacles);
        found.to_itself = found.to_itself.min(to_itself);
    }
    found
}
