//! The program grips parts and never says that they weigh anything.
//!
//! ## What it does
//! Finds programs that close and open a gripper or a vacuum, with movements between, and have
//! neither `GripLoad` nor `\TLoad`.
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
//! An output that is set where the tool goes in and comes out the way it went, and reset at
//! another such place, with a wait at one of them, holds a part on the way between. What is set
//! along a path (a weld, a bead of glue) or at places that are passed by is none.

use super::super::context::Context;
use super::super::finding::Finding;
use super::super::trace::{Deed, Done};

rule!("EW502", "gripping-without-payload", Load, Text, Info, "gripping_without_payload.rs");

/// The tool comes out the way it went in where its direction changes by more, rad.
const OUT: f64 = 2.0;
/// Fewest movements with a part.
const MOVES: usize = 2;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    if !context.calls("gripload").is_empty()
        || context.sites.iter().any(|site| site.options.contains(&"tload"))
    {
        return;
    }
    // The program lacks it as a whole: one remark is enough.
    let carries = (0..context.trace.len()).find(|step| carries(context, *step));
    let Some(Deed::Output(output)) = carries.map(|step| &context.trace[step].what) else { return };
    let message = format!(
        "{} is set where the tool goes in and out, and reset at another such place: a part is \
         carried, but no GripLoad says what it weighs",
        output.signal
    );
    findings.push(Finding::new(&RULE, output.span, message));
}

/// Whether what a step sets holds a part until it is reset.
fn carries(context: &Context<'_>, step: usize) -> bool {
    let Deed::Output(output) = &context.trace[step].what else { return false };
    if output.value != "1" || output.instruction.eq_ignore_ascii_case("pulsedo") {
        return false;
    }
    let off = context.trace[step + 1..].iter().position(|done| match &done.what {
        Deed::Output(other) => {
            other.signal.eq_ignore_ascii_case(&output.signal) && other.value == "0"
        }
        _ => false,
    });
    let Some(off) = off.map(|off| step + 1 + off) else { return false };
    let moves = context.trace[step..off].iter().filter(|d| matches!(d.what, Deed::Move(_))).count();
    let Some(ends) = [step, off].map(|step| end(context, step)).into_iter().collect() else {
        return false;
    };
    let ends: Vec<End> = ends;
    moves >= MOVES
        && ends.iter().all(|end| end.in_and_out != Some(false))
        && ends.iter().any(|end| end.in_and_out == Some(true))
        && ends.iter().any(|end| end.waits)
}

/// Where an output is set or reset.
struct End {
    /// Whether the tool comes out the way it went in, if that is known.
    in_and_out: Option<bool>,
    /// Whether the robot waits there.
    waits: bool,
}

/// The place at which the robot stands in a step; `None` if it passes.
fn end(context: &Context<'_>, step: usize) -> Option<End> {
    let moved = |done: &Done<'_>| matches!(done.what, Deed::Move(_) | Deed::Left(_));
    let here = context.trace[..step].iter().rposition(moved)?;
    let out = step + context.trace[step..].iter().position(moved)?;
    match &context.trace[here].what {
        Deed::Move(movement) if movement.zone.fine => {}
        _ => return None,
    }
    let into = context.trace[..here].iter().rposition(moved);
    let pose = |step: usize| Some(context.pose(step)?.translation.vector);
    let turn = || {
        let [a, b, c] = [pose(into?)?, pose(here)?, pose(out)?];
        Some((b - a).angle(&(c - b)))
    };
    let waits = context.trace[here..out].iter().any(|d| matches!(d.what, Deed::Wait(..)));
    Some(End { in_and_out: turn().map(|turn| turn > OUT), waits })
}
