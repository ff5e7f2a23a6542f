//! Limits of the robot.

use super::error::RobotError;
use super::fields::{Accepts, Fields};
use super::pose_acceleration::PoseAcceleration;

/// Joint speeds \[rad/s\].
const SPEED: Accepts = Accepts::Between(
    f64::MIN_POSITIVE,
    100.0,
    "more than 0 and at most 100, in rad/s (180 deg/s are 3.14159)",
);
/// Joint accelerations \[rad/s²\].
const ACCELERATION: Accepts =
    Accepts::Between(f64::MIN_POSITIVE, 2000.0, "more than 0 and at most 2000, in rad/s2");
/// TCP speeds \[m/s\].
pub(super) const TCP_SPEED: Accepts =
    Accepts::Between(f64::MIN_POSITIVE, 50.0, "more than 0 and at most 50, in m/s (not mm/s)");

/// Limits of the joints and of the TCP; `None` without a source.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits {
    /// Range of each joint \[rad\].
    pub position: Vec<[f64; 2]>,
    /// Wider ranges under a condition.
    pub position_if: Vec<PositionIf>,
    /// Range of q3 − q2 within the rods of a parallelogram robot \[rad\].
    pub coupled: Option<[f64; 2]>,
    /// Largest speed of each joint \[rad/s\].
    pub velocity: Option<Vec<f64>>,
    /// Largest acceleration of each joint \[rad/s²\].
    pub acceleration: Option<Vec<f64>>,
    /// Pose dependence of the accelerations of axes 1 to 3; the constant limits hold in all poses.
    pub acceleration_by_pose: Option<PoseAcceleration>,
    /// Largest jerk of each joint \[rad/s³\].
    pub jerk: Option<Vec<f64>>,
    /// Largest torque of each joint, at the joint \[Nm\].
    pub torque: Option<Vec<f64>>,
    /// Largest speed of the tool centre point \[m/s\].
    pub tcp_speed: Option<f64>,
    /// Largest acceleration of the tool centre point \[m/s²\].
    pub tcp_acceleration: Option<f64>,
}

/// A wider range of one joint while another joint is within an interval.
#[derive(Clone, Debug, PartialEq)]
pub struct PositionIf {
    /// The joint with the wider range, from 0.
    pub joint: usize,
    /// Its range under the condition \[rad\].
    pub position: [f64; 2],
    /// The joint of the condition, from 0.
    pub if_joint: usize,
    /// Interval of that joint \[rad\].
    pub if_within: [f64; 2],
}

impl Limits {
    /// The range of `joint` (from 0) at the joint angles `q` \[rad\]: its range, widened by each
    /// fulfilled condition; for joint 3 narrowed by the [`coupled`](Self::coupled) range at the
    /// angle of joint 2. Unbounded for a missing joint.
    #[must_use]
    pub fn position_at(&self, q: &[f64], joint: usize) -> [f64; 2] {
        let unbounded = [f64::NEG_INFINITY, f64::INFINITY];
        let [mut low, mut high] = self.position.get(joint).copied().unwrap_or(unbounded);
        for wider in self.position_if.iter().filter(|wider| wider.joint == joint) {
            let [from, to] = wider.if_within;
            if q.get(wider.if_joint).is_some_and(|angle| (from..=to).contains(angle)) {
                low = low.min(wider.position[0]);
                high = high.max(wider.position[1]);
            }
        }
        if let ([from, to], 2, Some(upper_arm)) =
            (self.coupled.unwrap_or(unbounded), joint, q.get(1))
        {
            low = low.max(upper_arm + from);
            high = high.min(upper_arm + to);
        }
        [low, high]
    }

    pub(super) fn read(fields: &mut Fields, dof: usize) -> Result<Limits, RobotError> {
        Ok(Limits {
            position: fields.must("position", |f, key| f.intervals(key, dof))?,
            position_if: fields.parts("position_if", |table| PositionIf::read(table, dof))?,
            acceleration_by_pose: fields.part("acceleration_by_pose", PoseAcceleration::read)?,
            coupled: fields.interval("coupled")?,
            velocity: fields.per_joint("velocity", dof, SPEED)?,
            acceleration: fields.per_joint("acceleration", dof, ACCELERATION)?,
            jerk: fields.per_joint("jerk", dof, Accepts::Positive)?,
            torque: fields.per_joint("torque", dof, Accepts::Positive)?,
            tcp_speed: fields.number("tcp_speed", TCP_SPEED)?,
            tcp_acceleration: fields.number("tcp_acceleration", Accepts::Positive)?,
        })
    }
}

impl PositionIf {
    fn read(fields: &mut Fields, dof: usize) -> Result<PositionIf, RobotError> {
        let joint = fields.joint("joint", dof)?;
        let position = fields.must("position", Fields::interval)?;
        let place = fields.place_of("if_joint");
        let if_joint = fields.joint("if_joint", dof)?;
        if if_joint == joint {
            return Err(RobotError::Value {
                place,
                key: fields.path("if_joint"),
                value: (if_joint + 1).to_string(),
                must: "another joint than the one whose range widens".into(),
            });
        }
        let if_within = fields.must("if_within", Fields::interval)?;
        Ok(PositionIf { joint, position, if_joint, if_within })
    }
}
