//! A line is so short for its turn that the turning of the tool sets the pace.
//!
//! ## What it does
//! Finds lines and arcs on which turning the tool at the programmed rate takes at least twice as
//! long as the way of the TCP does.
//!
//! ## Why it wastes energy
//! The programmed speed is not reached, the wrist runs at its limit while the large axes crawl,
//! and the base load runs on.
//!
//! ## How the saving is computed
//! The movement is laid on a time line with the turning speed that it has and with 500 °/s, that of
//! the predefined speeds. Where it already has that, there is no finding.
//!
//! ## Example
//! ```text
//! MoveL Offs(p, 0, 0, 10), v1000, fine, tGrip;
//! MoveL RelTool(p, 0, 0, 0 \Ry:=60), v1000, fine, tGrip;
//! ```
//!
//! ## Use instead
//! Turn the tool on the way there, where there is time for it, or give the speed data a higher
//! turning speed.
//!
//! ## Safety
//! Without a fix: only the process knows where the tool may turn.
//!
//! ## Assumptions
//! The rate of turning is that of the speed data.

use super::super::context::Context;
use super::super::edits::change_movement;
use super::super::rule::Finding;
use crate::rapid::builtins::MoveForm;
use crate::retime::motion::Step;

rule!("EW204", "reorientation-limited-line", Speed, Text, Info, "reorientation_limited_line.rs");

/// Turning speed of the predefined speeds, rad/s: 500 °/s.
const PREDEFINED: f64 = 8.726_646;
/// Times that turning takes longer than the way.
const MIN_RATIO: f64 = 2.0;
/// Smallest turn that is reported, rad.
const MIN_TURN: f64 = 0.5;
/// Least time of turning that is reported, s.
const MIN_TIME: f64 = 0.15;
/// Shortest way of what is still a line and no turn on the spot, m.
const MIN_WAY: f64 = 0.01;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for (index, site) in context.sites.iter().enumerate() {
        let goal = site.facts.goal.as_ref().and_then(|goal| goal.pose());
        let (Some(speed), Some(to)) = (site.facts.speed, goal) else { continue };
        let before = context.before(index);
        let line = site.signature.form == MoveForm::Linear;
        if !line || !site.is_plain() || before.is_empty() || context.is_unknown_before(index) {
            continue;
        }
        let limited = before.iter().all(|before| {
            let before = &context.sites[*before];
            let same = before.wobj_key() == site.wobj_key() && before.tool_key() == site.tool_key();
            let from = before.facts.goal.as_ref().and_then(|goal| goal.pose());
            let Some(from) = from.filter(|_| same) else { return false };
            let way = (to.translation.vector - from.translation.vector).norm();
            let turn = from.rotation.angle_to(&to.rotation);
            let turning = turn / speed.orientation;
            way > MIN_WAY
                && turn > MIN_TURN
                && turning > MIN_TIME
                && turning > MIN_RATIO * way / speed.tcp
        });
        if !limited {
            continue;
        }
        let faster = |step: &Step| change_movement(step, |it| it.speed.orientation = PREDEFINED);
        let slow = speed.orientation < PREDEFINED - 1e-3;
        let evaluation = if slow { context.evaluate(&[site.stmt.span], &faster) } else { Ok(None) };
        let Ok(saving) = evaluation else { continue };
        let message = format!(
            "the turn of the tool sets the pace of this {}: its {:.0} mm/s are not reached",
            site.name,
            speed.tcp * 1e3
        );
        let change = format!(
            "[{},500,5000,1000] in place of {}, which turns with {:.0} °/s,",
            (speed.tcp * 1e6).round() / 1e3,
            context.text(site.speed.span),
            speed.orientation.to_degrees()
        );
        findings.push(Finding::new(&RULE, site.stmt.span, message).with_saving(change, saving));
    }
}
