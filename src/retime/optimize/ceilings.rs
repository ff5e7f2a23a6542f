//! Speed ceilings of a stream: at most the speeds of the movements that it replaces.

use super::allowed::{Loads, raise, steps};
use super::freedom::{Bound, Freedom};
use crate::arm::robot::Model;
use crate::rapid::builtins::MoveForm;
use crate::retime::motion::controller::joint_limits;
use crate::retime::motion::timeline::{MoveRecord, Run};
use crate::retime::path::Leg;
use crate::retime::path::joint_path::{DOF, Joints};

/// Smallest speed ceiling of a joint, rad/s (0.06 degrees/s): a joint that hardly moves in the
/// program needs room for rounding.
const LEAST_SPEED: f64 = 1e-3;

/// Largest loads and speeds of a stream that replaces a run.
#[derive(Clone, Debug)]
pub(super) struct Ceilings {
    /// Joint loads.
    pub(super) loads: Loads,
    /// Speed ceilings of the part of the stream that replaces each movement.
    pub(super) moves: Vec<Ceiling>,
}

/// Largest speeds along one movement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ceiling {
    /// TCP speed, m/s.
    pub tcp: f64,
    /// TCP speed within the corner zones at its ends, where the controller changes to the speed of
    /// the next movement, m/s.
    pub corner: f64,
    /// Joint speeds, rad/s.
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

impl Ceilings {
    /// Speeds of the movements of the run, or the robot limits where `freedom` permits it.
    pub(super) fn new(model: &Model, run: &Run, freedom: &Freedom) -> Ceilings {
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
        let settings = run.moves.first().map(|record| &record.movement.settings);
        let loads = match settings {
            Some(settings) => freedom.loads(model).under(model, settings),
            None => freedom.loads(model),
        };
        Ceilings { moves: moves.collect(), loads }
    }
}

/// The largest speeds of a movement in the simulated run.
fn reached(model: &Model, run: &Run, record: &MoveRecord, leg: &Leg) -> Ceiling {
    let mut most = Ceiling { tcp: 0.0, corner: 0.0, joints: [0.0; DOF] };
    let (count, step) = steps(record.duration);
    for i in 0..=count {
        let t = record.t_start + i as f64 * step;
        let (q, qd) = (run.at(t).q, run.at(t).qd);
        most.tcp = most.tcp.max(leg.tool.twist(model, &q, &qd).fixed_rows::<3>(0).norm());
        raise(&mut most.joints, &qd);
    }
    most
}

/// Joint speeds of a robot, rad/s.
pub(super) fn speeds(model: &Model) -> Joints {
    joint_limits(model.limits.velocity.as_ref())
}
