//! Check of the realised motion of a stream against all limits.

use super::allowed::Loads;
use super::ceilings::{Ceiling, speeds};
use super::corridor::{Corridor, Offset};
use super::keep_out::least_room;
use super::plant::STILL;
use crate::arm::dynamics::{Data, Load};
use crate::arm::kinematics::{Body, Tcp, fk, limits_ok};
use crate::arm::robot::Model;
use crate::retime::energy::power::power;
use crate::retime::motion::stream::{Piece, Stream};
use crate::retime::motion::timed::JointState;
use crate::retime::path::joint_path::{DOF, Joints};

/// Longest step between two samples, s.
const STEP: f64 = 0.002;

/// Used shares of the limits and deviation from the path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Check {
    /// Share of the joint speed limits.
    pub velocity: f64,
    /// Share of the joint acceleration limits.
    pub acceleration: f64,
    /// Share of the joint jerk limits.
    pub jerk: f64,
    /// Share of the joint torque limits.
    pub torque: f64,
    /// Share of the TCP speed: of the programmed one and of the limit of the robot.
    pub tcp_speed: f64,
    /// Largest distance from the programmed path, m, with the tool rotation at 0.1 m/rad.
    pub deviation_m: f64,
    /// Largest ratio of this distance to its tolerance.
    pub deviation: f64,
    /// Largest distance of the polygon through the points from the programmed path, m. A robot
    /// that stops at each point follows this polygon.
    pub polygon_m: f64,
    /// Largest ratio of this distance to its tolerance.
    pub polygon: f64,
    /// Error of the end position, rad; 0 outside a corridor.
    pub endpoint_error_rad: f64,
    /// True if all joint angles are within their ranges.
    pub in_range: bool,
    /// Depth of arm and tool in the keep-out zones, m; 0 if the path must be kept.
    pub intrusion_m: f64,
}

impl Check {
    /// The used share of each limit with its name.
    fn shares(&self) -> [(&'static str, f64); 7] {
        [
            ("joint speed", self.velocity),
            ("joint acceleration", self.acceleration),
            ("jerk", self.jerk),
            ("torque", self.torque),
            ("TCP speed", self.tcp_speed),
            ("distance from the path", self.deviation),
            ("distance of the points' polygon from the path", self.polygon),
        ]
    }

    /// The largest share of a limit.
    pub fn worst(&self) -> f64 {
        self.shares().into_iter().map(|(_, share)| share).fold(0.0, f64::max)
    }

    /// True if no limit is exceeded.
    pub fn holds(&self) -> bool {
        self.worst() <= 1.0 && self.in_range && self.intrusion_m <= 0.0
    }

    /// The most exceeded limit in words, for a check that does not hold.
    pub fn fault(&self) -> String {
        let (limit, share) =
            self.shares().into_iter().fold(("", 0.0), |a, b| if b.1 > a.1 { b } else { a });
        match (share <= 1.0, self.in_range) {
            (true, true) => format!("the arm would come {:.0} mm too near", 1e3 * self.intrusion_m),
            (true, false) => "a joint would leave its range".to_owned(),
            (false, _) => format!("{limit} would be {:.1} % of what is allowed", 100.0 * share),
        }
    }

    /// The larger of each figure.
    #[must_use]
    pub fn max(&self, other: &Check) -> Check {
        Check {
            velocity: self.velocity.max(other.velocity),
            acceleration: self.acceleration.max(other.acceleration),
            jerk: self.jerk.max(other.jerk),
            torque: self.torque.max(other.torque),
            tcp_speed: self.tcp_speed.max(other.tcp_speed),
            deviation_m: self.deviation_m.max(other.deviation_m),
            deviation: self.deviation.max(other.deviation),
            polygon_m: self.polygon_m.max(other.polygon_m),
            polygon: self.polygon.max(other.polygon),
            endpoint_error_rad: self.endpoint_error_rad.max(other.endpoint_error_rad),
            in_range: self.in_range && other.in_range,
            intrusion_m: self.intrusion_m.max(other.intrusion_m),
        }
    }

    /// The neutral element of [`Check::max`].
    pub fn none() -> Check {
        Check { in_range: true, ..Check::default() }
    }
}

/// The space in which a stream may move.
#[derive(Clone, Copy)]
pub enum Room<'a> {
    /// In the corridor of the movements that it replaces.
    Corridor(&'a Corridor),
    /// Anywhere, with at most these joint loads.
    Free(&'a Loads),
}

/// Checks the realised motion of a stream against all limits; `body` is the arm with the
/// keep-out zones of the cell.
pub fn check(
    model: &Model,
    load: &Load,
    tool: &Tcp,
    stream: &Stream,
    room: Room<'_>,
    body: Option<&Body<'_>>,
) -> Check {
    let velocity = speeds(model);
    let (corridor, loads) = match room {
        Room::Corridor(corridor) => (Some(corridor), &corridor.ceilings.loads),
        Room::Free(loads) => (None, loads),
    };
    let share = |values: &[f64], limit: &Joints| {
        let used = |(x, limit): (&f64, &f64)| if *x == 0.0 { 0.0 } else { x.abs() / limit };
        values.iter().zip(limit).map(used).fold(0.0, f64::max)
    };
    let mut result = Check {
        velocity: share(&stream.max_velocity(), &velocity),
        acceleration: share(&stream.max_acceleration(), &loads.acceleration),
        jerk: share(&stream.max_jerk(), &loads.jerk),
        endpoint_error_rad: corridor.map_or(0.0, |corridor| {
            let error = |j: usize| (stream.end()[j] - corridor.end[j]).abs();
            (0..DOF).map(error).fold(0.0, f64::max)
        }),
        intrusion_m: body.map_or(0.0, |body| (-least_room(model, body, stream)).max(0.0)),
        ..Check::none()
    };
    let tcp = model.limits.tcp_speed.unwrap_or(f64::INFINITY);
    let ceiling = Ceiling { tcp, corner: tcp, joints: velocity };
    let anywhere =
        Offset { distance: 0.0, tolerance: f64::INFINITY, polygon: f64::INFINITY, ceiling };
    let mut data = Data::new();
    let mut at = 0;
    for piece in stream.pieces() {
        for tau in samples(&piece) {
            let (q, qd, qdd) = piece.at(tau);
            let qd = qd.map(|v| if v.abs() < STILL { 0.0 } else { v });
            result.in_range &= limits_ok(model, &q).is_ok();
            let state = JointState { q, qd, qdd };
            let torque = if model.has_dynamics() {
                share(&power(model, &mut data, load, &state).tau, &loads.torque)
            } else {
                0.0
            };
            result.torque = result.torque.max(torque);
            let offset = corridor
                .map_or(anywhere, |corridor| corridor.offset(&tool.pose(&fk(model, &q)), &mut at));
            result.deviation_m = result.deviation_m.max(offset.distance);
            result.deviation = result.deviation.max(offset.distance / offset.tolerance);
            let rate = tool.twist(model, &q, &qd);
            let speed = rate.fixed_rows::<3>(0).norm() / offset.ceiling.tcp;
            result.tcp_speed = result.tcp_speed.max(speed);
            result.velocity = result.velocity.max(offset.ceiling.share(&qd));
        }
    }
    if let Some(corridor) = corridor {
        let mut at = 0;
        for edge in stream.polygon() {
            for i in 0..=EDGE_STEPS {
                let (q, _, _) = edge.at(i as f64 / EDGE_STEPS as f64);
                let offset = corridor.offset(&tool.pose(&fk(model, &q)), &mut at);
                result.polygon_m = result.polygon_m.max(offset.distance);
                result.polygon = result.polygon.max(offset.distance / offset.polygon);
            }
        }
    }
    result
}

/// Steps per edge of the polygon.
const EDGE_STEPS: usize = 16;

/// Offset of samples from a reversal of a joint, s: Coulomb friction jumps at the reversal.
const BESIDE: f64 = 1e-6;

/// Rising sample times in a piece, s: at most a step apart, and on both sides of each reversal
/// of a joint.
fn samples(piece: &Piece) -> Vec<f64> {
    let steps = (piece.length / STEP).ceil().max(1.0) as usize;
    let turns = (0..DOF).map(|j| -piece.qd[j] / piece.qdd[j]);
    let inside = turns.filter(|turn| *turn > BESIDE && *turn < piece.length - BESIDE);
    let mut samples: Vec<f64> = (0..=steps)
        .map(|i| piece.length * i as f64 / steps as f64)
        .chain(inside.flat_map(|turn| [turn - BESIDE, turn + BESIDE]))
        .collect();
    samples.sort_by(f64::total_cmp);
    samples
}
