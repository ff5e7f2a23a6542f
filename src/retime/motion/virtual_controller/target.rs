//! The target of a movement in joint angles, in the programmed configuration.

use nalgebra::Isometry3;

use super::state::VirtualController;
use crate::arm::kinematics::{Conf, Tcp, fk, ik_conf, ik_near, limits_ok};
use crate::rapid::builtins::MoveForm;
use crate::rapid::ir::movement::{Movement, Target};
use crate::retime::path::{Leg, LegKind, arrival};

impl VirtualController<'_> {
    /// Solves the geometry of a movement.
    pub(super) fn leg(&self, movement: &Movement) -> Result<Leg, String> {
        if movement.wobj.robhold == movement.tool.robhold {
            let both = if movement.tool.robhold { "both tool and work" } else { "neither" };
            return Err(format!("the robot holds {both}: robhold of tool or work object is wrong"));
        }
        if !movement.wobj.fixed {
            return Err("a work object on a moving mechanical unit is not simulated".into());
        }
        // Fixed frames are stated in the world frame and solved in the base frame.
        let world = self.model.kinematics.base.inverse();
        let held = movement.tool.robhold;
        // A program displacement moves the targets in the object frame.
        let displacement = movement.settings.displacement.unwrap_or_else(Isometry3::identity);
        let object = movement.wobj.frame * displacement;
        let base = if held { world * object } else { object };
        let frame = movement.tool.frame;
        let tool = if held { Tcp::Held(frame) } else { Tcp::Stationary(world * frame) };
        let near = |pose: &Isometry3<f64>| {
            ik_near(self.model, pose, &self.q).map_err(|error| error.to_string())
        };
        let mut stated_end = true;
        let (kind, end, target) = match &movement.target {
            Target::Joints(q) => {
                limits_ok(self.model, q).map_err(|error| error.to_string())?;
                (LegKind::Joint, *q, tool.pose(&fk(self.model, q)))
            }
            Target::Pose(target) => {
                let pose = base * target.pose;
                let flange = tool.flange(&pose);
                let linear = movement.form != MoveForm::Joint;
                let stated = if linear {
                    movement.settings.conf_linear
                } else {
                    movement.settings.conf_joint
                };
                let end = if stated {
                    let [cf1, cf4, cf6, cfx] = target.conf;
                    let conf = Conf { cf1, cf4, cf6, cfx };
                    ik_conf(self.model, &flange, conf).map_err(|error| error.to_string())?
                } else {
                    near(&flange)?
                };
                let kind = match (movement.form, &movement.via) {
                    (MoveForm::Circular, Some(via)) => LegKind::Arc(base * via.pose),
                    (MoveForm::Linear, _) => LegKind::Line,
                    _ => LegKind::Joint,
                };
                stated_end = stated || !linear;
                (kind, end, pose)
            }
        };
        let mut speed = movement.speed;
        let factor = self.speed_override(movement);
        speed.tcp = (speed.tcp * factor).min(movement.settings.speed_max);
        speed.orientation *= factor;
        let axiswise = movement.settings.axiswise_wrist();
        let zone = movement.zone;
        let mut leg = Leg { kind, start: self.q, end, tool, target, axiswise, speed, zone };
        if !stated_end && !axiswise {
            // The configuration at the end of the line.
            leg.end = arrival(self.model, &leg).unwrap_or(end);
        }
        Ok(leg)
    }
}
