//! A line is so short for its turn that the turning of the tool sets the pace.
//!
//! ## What it does
//! Finds lines on which, in the simulation, the turning speed of the speed data is the limit for the
//! longest time, below the 500 °/s of the predefined speeds.
//!
//! ## Why it wastes energy
//! The programmed speed is not reached, the wrist runs at its limit while the large axes crawl,
//! and the base load runs on.
//!
//! ## How the saving is computed
//! The movement is laid on a time line with the turning speed that it has and with 500 °/s.
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
//! The simulated pace is that of the controller. Movements of a process (below 200 mm/s, or with an
//! output on for lines alone) are left alone.

use super::super::context::Context;
use super::super::edits::{PREDEFINED_TURN, change_movement};
use super::super::rule::Finding;
use super::super::saving::SavesNothing;
use crate::rapid::builtins::MoveForm;
use crate::retime::motion::Step;
use crate::retime::motion::pace::Pace;
use crate::retime::motion::timing::grid::SpeedBound;

rule!("EW204", "reorientation-limited-line", Speed, Robot, Info, "reorientation_limited_line.rs");

/// Shortest way of what is still a line and no turn on the spot, m.
const MIN_WAY: f64 = 0.01;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for (index, site) in context.sites.iter().enumerate() {
        let Some(speed) = site.facts.speed else { continue };
        if site.signature.form != MoveForm::Linear
            || !site.is_plain()
            || site.executions.is_empty()
            || context.is_process(index)
            || !site.executions.iter().all(|step| is_paced_by_turn(context, *step))
        {
            continue;
        }
        let faster =
            |step: &Step| change_movement(step, |it| it.speed.orientation = PREDEFINED_TURN);
        let is_slow = speed.orientation < PREDEFINED_TURN - 1e-3;
        let evaluation =
            if is_slow { context.evaluate(&[site.stmt.span], &faster) } else { Err(SavesNothing) };
        let Ok(Some(saving)) = evaluation else { continue };
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

/// Whether the simulated turn of the tool limits an execution of a line for the longest time.
fn is_paced_by_turn(context: &Context<'_>, step: usize) -> bool {
    let Some((_, record, leg)) = context.record(step) else { return false };
    let before = context.trace[..step].iter().rposition(|done| done.what.moves());
    let from = before.and_then(|before| context.pose(before));
    let way = from.map(|from| (leg.target.translation.vector - from.translation.vector).norm());
    record.pace == Pace::Speed(SpeedBound::Reorientation) && way.is_some_and(|way| way > MIN_WAY)
}
