//! The program grips parts and never says that they weigh anything.
//!
//! ## What it does
//! Finds programs that close and open a gripper or a vacuum, with movements between, and have
//! neither `GripLoad` nor `\TLoad`, or `GripLoad` only in code that nothing calls.
//!
//! ## Why it wastes energy
//! The controller accelerates a loaded arm as if it were empty: torques, wear and energy are
//! higher than it knows, and every figure about energy is wrong.
//!
//! ## How the saving is computed
//! There is none to tell: without the mass no figure is right.
//!
//! ## Example
//! ```text
//! MoveL pPick, v300, fine, tGrip;
//! SetDO doGripClose, 1;
//! WaitTime 0.3;
//! MoveL pAbove, v300, z10, tGrip;
//! MoveL pPlace, v300, fine, tGrip;
//! SetDO doGripClose, 0;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveL pPick, v300, fine, tGrip;
//! SetDO doGripClose, 1;
//! WaitTime 0.3;
//! GripLoad loadPart;
//! MoveL pAbove, v300, z10, tGrip;
//! MoveL pPlace, v300, fine, tGrip;
//! SetDO doGripClose, 0;
//! GripLoad load0;
//! ```
//!
//! ## Safety
//! Without a fix: only a scale or a load identification knows the mass.
//!
//! ## Assumptions
//! An output that is set at one stop and reset at another, where the tool comes out the way it
//! went in, with a wait at one of them and a joint movement or a fast line between, holds a part.
//! What is set along a path (a weld, a bead of glue) or in passing is none, and a tool of another mass
//! behind the grip has the part's mass. Names of outputs say nothing: a lamp or a signal to another machine
//! may look the same, so the confidence is low.

use super::super::context::Context;
use super::super::outputs::{carries, resets};
use super::super::rule::Finding;
use super::super::trace::Action;
use super::dead_procedure::calls_others;
use crate::rapid::ir::movement::Movement;
use crate::rapid::ir::program::RoutineId;

rule!("EW502", "gripping-without-payload", Load, Text, Info, "gripping_without_payload.rs");

/// Whether the robot moves with another tool behind a grip than before: its mass has the part's.
fn takes_another_tool(context: &Context<'_>, on: usize, off: usize) -> bool {
    let mass = |movement: &Movement| movement.tool.load.mass;
    let before = context.trace[..on].iter().rev().find_map(|done| done.what.movement());
    let mut behind = context.trace[on..off].iter().filter_map(|done| done.what.movement());
    before.is_some_and(|before| behind.any(|it| mass(it) != mass(before)))
}

/// Whether the program may run a routine: it is reached from its start, or calls leave open what runs.
pub(super) fn may_run(context: &Context<'_>, routine: RoutineId) -> bool {
    let Some(entry) = context.entry else { return true };
    context.flow.has_late_calls()
        || calls_others(context)
        || context.flow.running([entry]).contains(&routine)
}

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let loads = context.calls("gripload");
    if loads.iter().any(|(place, ..)| may_run(context, place.0))
        || context.sites.iter().any(|site| site.options.contains(&"tload"))
    {
        return;
    }
    // The program lacks it as a whole: one remark is enough.
    let resets = resets(context);
    let grips = |(on, off): &(usize, usize)| {
        carries(context, *on, *off) && !takes_another_tool(context, *on, *off)
    };
    let Some((step, _)) = resets.into_iter().find(grips) else { return };
    let Action::Output(output) = &context.trace[step].what else { return };
    let missing = match loads.first() {
        Some(_) => "GripLoad stands only in code that nothing calls",
        None => "no GripLoad says what it weighs",
    };
    let message = format!(
        "{} is set where the tool goes in and out, and reset at another such place: a part seems \
         to be carried, but {missing}",
        output.signal
    );
    let finding = Finding::new(&RULE, output.span, message).doubtful();
    findings.push(match loads.first() {
        Some((_, stmt, _)) => finding.with_related(stmt.span, "nothing calls this"),
        None => finding,
    });
}
