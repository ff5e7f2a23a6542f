//! What a stream may ask of the robot: no more than the movements that it stands for.

use super::freedom::{Bound, Freedom};
use crate::arm::dynamics::Data;
use crate::arm::robot::Model;
use crate::rapid::builtins::MoveForm;
use crate::retime::energy::power::power;
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::{MoveRecord, Run, What};
use crate::retime::path::Leg;
use crate::retime::path::joint_path::{DOF, Joints};

/// Step of the samples of a run, s: half a period of the interpolator.
const STEP: f64 = 0.002;

/// Share of a limit that a joint has at least: one that stands still in the program still holds, and
/// turns by what is rounding.
const LEAST: f64 = 0.02;
/// Speed that a joint has at least, rad/s: one that all but stands still in the program would leave no
/// stream for what is rounding. That is 0.06 degrees/s.
const LEAST_SPEED: f64 = 1e-3;
/// Share of assumed limits that ways may use that the program does not have.
const OTHER_WAYS: f64 = 0.5;

/// Joint loads.
#[derive(Clone, Copy, Debug, PartialEq)]
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
        let limits = &model.limits;
        Loads {
            acceleration: list(limits.acceleration.as_ref()),
            jerk: list(limits.jerk.as_ref()),
            torque: if model.has_dynamics() {
                list(limits.torque.as_ref())
            } else {
                [f64::INFINITY; DOF]
            },
        }
    }

    /// What streams in the place of a program's movements may ask: where the limits of the robot
    /// are assumed, no more of any joint than the program asks today. The robot has shown that.
    pub fn shown(model: &Model, simulation: &Simulation) -> Loads {
        let mut most = Loads { acceleration: NONE, jerk: NONE, torque: NONE };
        for event in &simulation.events {
            if let What::Run(run) = &event.what {
                most.raise(model, run);
            }
        }
        let limits = Loads::limits(model);
        let within = |key: &str, limit: Joints, most: Joints| -> Joints {
            let is_known = model.is_known("limits", key);
            let shown = |j: usize| limit[j].min(most[j]).max(LEAST * limit[j]);
            std::array::from_fn(|j| if is_known { limit[j] } else { shown(j) })
        };
        Loads {
            acceleration: within("acceleration", limits.acceleration, most.acceleration),
            jerk: within("jerk", limits.jerk, most.jerk),
            torque: within("torque", limits.torque, most.torque),
        }
    }

    /// The same for ways that the program does not have, in which other joints may move: at least
    /// half of the limits, however far the program stays below.
    #[must_use]
    pub fn for_other_ways(&self, model: &Model) -> Loads {
        let limits = Loads::limits(model);
        let half = |limit: Joints, own: Joints| -> Joints {
            std::array::from_fn(|j| own[j].max(OTHER_WAYS * limit[j]))
        };
        Loads {
            acceleration: half(limits.acceleration, self.acceleration),
            jerk: half(limits.jerk, self.jerk),
            torque: half(limits.torque, self.torque),
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

/// Largest values of the stream of a run.
#[derive(Clone, Debug)]
pub(super) struct Allowed {
    /// What joints bear.
    pub(super) loads: Loads,
    /// Speeds along the part that stands for each movement.
    pub(super) moves: Vec<Ceiling>,
}

/// Largest speeds along one movement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ceiling {
    /// Of the TCP, m/s.
    pub tcp: f64,
    /// The same within the corner zones at its ends, where the controller itself comes from the
    /// speed of one movement to that of the next.
    pub corner: f64,
    /// Of the joints, rad/s.
    pub joints: Joints,
}

impl Ceiling {
    /// The larger of each speed.
    pub(super) fn max(&self, other: &Ceiling) -> Ceiling {
        let joints = std::array::from_fn(|j| self.joints[j].max(other.joints[j]));
        let corner = self.corner.max(other.corner);
        Ceiling { tcp: self.tcp.max(other.tcp), corner, joints }
    }

    /// The largest share of a ceiling that joint speeds (rad/s) use.
    pub(super) fn share(&self, qd: &Joints) -> f64 {
        let used = |j: usize| if qd[j] == 0.0 { 0.0 } else { qd[j].abs() / self.joints[j] };
        (0..DOF).map(used).fold(0.0, f64::max)
    }
}

impl Allowed {
    /// No faster than the movements of the run, unless that is free.
    pub(super) fn new(model: &Model, run: &Run, freedom: &Freedom) -> Allowed {
        let velocity = speeds(model);
        let fastest = model.limits.tcp_speed.unwrap_or(f64::INFINITY);
        let moves = run.moves.iter().zip(&run.legs).map(|(record, leg)| {
            let movement = &record.movement;
            let line = matches!(movement.form, MoveForm::Linear | MoveForm::Circular);
            let reached = reached(model, run, record, leg);
            let [tcp, corner] = match freedom.bound(movement) {
                Bound::Original => [reached.tcp.min(movement.line_speed()), reached.tcp],
                Bound::Robot => [fastest; 2],
            };
            let joints = match freedom.joints {
                Bound::Original if !line => {
                    std::array::from_fn(|j| velocity[j].min(reached.joints[j].max(LEAST_SPEED)))
                }
                _ => velocity,
            };
            Ceiling { tcp: tcp.min(fastest), corner: corner.min(fastest), joints }
        });
        Allowed { moves: moves.collect(), loads: freedom.loads(model) }
    }
}

/// The largest speeds of a movement as the controller executes it.
fn reached(model: &Model, run: &Run, record: &MoveRecord, leg: &Leg) -> Ceiling {
    let mut most = Ceiling { tcp: 0.0, corner: 0.0, joints: NONE };
    let (count, step) = steps(record.duration);
    for i in 0..=count {
        let t = record.t_start + i as f64 * step;
        let (q, qd) = (run.at(t).q, run.at(t).qd);
        most.tcp = most.tcp.max(leg.tool.twist(model, &q, &qd).fixed_rows::<3>(0).norm());
        raise(&mut most.joints, &qd);
    }
    most
}

const NONE: Joints = [0.0; DOF];

/// Number and length of the steps in a time, s.
fn steps(duration: f64) -> (usize, f64) {
    let count = (duration / STEP).ceil().max(1.0);
    (count as usize, duration / count)
}

fn raise(most: &mut Joints, now: &Joints) {
    for j in 0..DOF {
        most[j] = most[j].max(now[j].abs());
    }
}

/// Joint speeds of a robot, rad/s.
pub(super) fn speeds(model: &Model) -> Joints {
    list(model.limits.velocity.as_ref())
}

fn list(limits: Option<&Vec<f64>>) -> Joints {
    let limit = |j: usize| limits.and_then(|limits| limits.get(j)).copied();
    std::array::from_fn(|j| limit(j).unwrap_or(f64::INFINITY))
}
