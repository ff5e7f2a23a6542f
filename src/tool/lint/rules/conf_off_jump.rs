//! Under `ConfL \Off` the robot arrives a whole turn of an axis away from what the target says.
//!
//! ## What it does
//! Finds lines under `ConfL \Off` that end with axis 4 or 6 a whole turn (225° and more) from where
//! the target's configuration has it, behind a movement that kept its configuration.
//!
//! ## Why it wastes energy
//! The next movement that keeps configurations has to turn the axis all the way back, and so may
//! the next cycle.
//!
//! ## How the saving is computed
//! There is none: the program does not say which configuration is right, and with `ConfL \On` the
//! robot would stop here, so there is no second program to simulate.
//!
//! ## Example
//! ```text
//! ConfL \Off;
//! MoveL pTurned, v500, fine, tGrip;
//! ConfL \On;
//! MoveJ pHome, v1000, fine, tGrip;
//! ```
//!
//! ## Use instead
//! Teach the target in the configuration in which the line arrives, and leave `ConfL \On`.
//!
//! ## Safety
//! Without a fix.
//!
//! ## Assumptions
//! The robot starts where the simulation does.

use super::super::context::Context;
use super::super::rule::Finding;
use super::super::trace::TraceStep;
use crate::arm::kinematics::{Conf, ik_conf};
use crate::rapid::builtins::MoveForm;
use crate::rapid::ir::movement::Target;

rule!("EW604", "conf-off-jump", Settings, Robot, Warning, "conf_off_jump.rs");

/// More than half a turn, which only leads to the other solution of the wrist, rad.
const MIN_TURN: f64 = 1.25 * std::f64::consts::PI;
/// Axes that can turn by whole turns: 4 and 6.
const AXES: [usize; 2] = [3, 5];

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let Some(model) = context.model else { return };
    // Before it the configuration is one of the simulation's assumptions.
    let Some(known) = context.trace.iter().position(keeps) else { return };
    for site in &context.sites {
        let jump = site.executions.iter().find_map(|step| {
            let (run, record, leg) = context.record(*step)?;
            let movement = &record.movement;
            let Target::Pose(target) = &movement.target else { return None };
            if movement.form != MoveForm::Linear
                || movement.settings.conf_linear
                || *step <= known
                || run.problem.is_some()
                || !run.start_known
            {
                return None;
            }
            let [cf1, cf4, cf6, cfx] = target.conf;
            let conf = Conf { cf1, cf4, cf6, cfx };
            let stated = ik_conf(model, &leg.tool.flange(&leg.target), conf).ok()?;
            let far = |axis: &usize| (leg.end[*axis] - stated[*axis]).abs() > MIN_TURN;
            AXES.into_iter().find(far).map(|axis| (axis, leg.end[axis] - stated[axis]))
        });
        let Some((axis, off)) = jump else { continue };
        let message = format!(
            "{} arrives with axis {} {:.0}° from where the target's configuration has it",
            site.name,
            axis + 1,
            off.to_degrees().abs()
        );
        findings.push(Finding::new(&RULE, site.stmt.span, message));
    }
}

/// Whether a movement goes to the configuration that is stated for it.
fn keeps(done: &TraceStep<'_>) -> bool {
    done.what.movement().is_some_and(|movement| match movement.form {
        MoveForm::AbsJ => true,
        MoveForm::Joint => movement.settings.conf_joint,
        _ => movement.settings.conf_linear,
    })
}
