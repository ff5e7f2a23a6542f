//! Joint loads that a stream may use. Assumed limits are lowered to the loads of the program.

use crate::arm::dynamics::Data;
use crate::arm::robot::Model;
use crate::rapid::ir::movement::Settings;
use crate::retime::energy::power::power;
use crate::retime::motion::Simulation;
use crate::retime::motion::controller::joint_limits;
use crate::retime::motion::timeline::{Run, What};
use crate::retime::path::joint_path::{DOF, Joints};

/// Sample step of a run, s: half the period of the interpolator.
const STEP: f64 = 0.002;

/// Smallest allowed share of a limit: a joint at rest has holding torque and moves by rounding.
const LEAST_SHARE: f64 = 0.02;
/// Smallest allowed share of an assumed limit for motions that the program does not contain.
const NEW_MOTION_SHARE: f64 = 0.5;

/// Joint loads.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Loads {
    /// rad/s².
    pub acceleration: Joints,
    /// rad/s³.
    pub jerk: Joints,
    /// Nm.
    pub torque: Joints,
}

impl Loads {
    /// The limits of the robot.
    pub fn limits(model: &Model) -> Loads {
        Loads {
            acceleration: joint_limits(model.limits.acceleration.as_ref()),
            jerk: joint_limits(model.limits.jerk.as_ref()),
            torque: joint_limits(model.limits.torque.as_ref().filter(|_| model.has_dynamics())),
        }
    }

    /// The largest loads of a run.
    pub fn of(model: &Model, run: &Run) -> Loads {
        let mut most = Loads::default();
        most.raise(model, run);
        most
    }

    /// Loads that a stream may use. A known limit is used in full; an assumed limit is lowered to
    /// the largest load of the program, which the robot can execute.
    pub fn shown(model: &Model, simulation: &Simulation) -> Loads {
        let mut most = Loads::default();
        for event in &simulation.events {
            if let What::Run(run) = &event.what {
                most.raise(model, run);
            }
        }
        let limits = Loads::limits(model);
        let within = |key: &str, limit: Joints, most: Joints| -> Joints {
            let is_known = model.is_known("limits", key);
            let shown = |j: usize| limit[j].min(most[j]).max(LEAST_SHARE * limit[j]);
            std::array::from_fn(|j| if is_known { limit[j] } else { shown(j) })
        };
        Loads {
            acceleration: within("acceleration", limits.acceleration, most.acceleration),
            jerk: within("jerk", limits.jerk, most.jerk),
            torque: within("torque", limits.torque, most.torque),
        }
    }

    /// Loads for motions that the program does not contain and that move other joints: at least
    /// [`NEW_MOTION_SHARE`] of the limits.
    #[must_use]
    pub fn for_new_motions(&self, model: &Model) -> Loads {
        let limits = Loads::limits(model);
        let half = |limit: Joints, own: Joints| -> Joints {
            std::array::from_fn(|j| own[j].max(NEW_MOTION_SHARE * limit[j]))
        };
        Loads {
            acceleration: half(limits.acceleration, self.acceleration),
            jerk: half(limits.jerk, self.jerk),
            torque: half(limits.torque, self.torque),
        }
    }

    /// The loads, at most the limits of the robot under `AccSet`.
    #[must_use]
    pub fn under(self, model: &Model, settings: &Settings) -> Loads {
        let limits = Loads::limits(model);
        let [_, acceleration, ramp] = settings.shares();
        let least = |own: Joints, limit: Joints, share: f64| -> Joints {
            std::array::from_fn(|j| own[j].min(share * limit[j]))
        };
        Loads {
            acceleration: least(self.acceleration, limits.acceleration, acceleration),
            jerk: least(self.jerk, limits.jerk, acceleration * ramp),
            torque: self.torque,
        }
    }

    fn raise(&mut self, model: &Model, run: &Run) {
        let mut data = Data::new();
        let mut before: Option<Joints> = None;
        let (count, step) = steps(run.duration());
        for i in 0..=count {
            let state = run.at(i as f64 * step);
            raise(&mut self.acceleration, &state.qdd);
            if let Some(before) = before {
                let change = |j: usize| (state.qdd[j] - before[j]) / step;
                raise(&mut self.jerk, &std::array::from_fn(change));
            }
            before = Some(state.qdd);
            if model.has_dynamics() {
                let tau = power(model, &mut data, &run.load, &state).tau;
                raise(&mut self.torque, &std::array::from_fn(|j| tau[j]));
            }
        }
    }
}

/// Number and length (s) of the sample steps in a duration.
pub(super) fn steps(duration: f64) -> (usize, f64) {
    let count = (duration / STEP).ceil().max(1.0);
    (count as usize, duration / count)
}

pub(super) fn raise(most: &mut Joints, now: &Joints) {
    for j in 0..DOF {
        most[j] = most[j].max(now[j].abs());
    }
}
