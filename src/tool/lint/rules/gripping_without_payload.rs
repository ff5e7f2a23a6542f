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
//! An output that is set at one stop and reset at another, where the tool comes out the way it
//! went in, with a wait at one of them and a joint movement or a fast line between, holds a part.
//! What is set along a path (a weld, a bead of glue) or in passing is none. Names of outputs say
//! nothing.

use std::collections::BTreeMap;

use super::super::context::Context;
use super::super::rule::Finding;
use super::super::trace::{Action, TraceStep};
use crate::rapid::builtins::MoveForm;
use crate::rapid::ir::movement::Movement;

rule!("EW502", "gripping-without-payload", Load, Text, Info, "gripping_without_payload.rs");

/// The tool comes out the way it went in where its direction changes by more, rad.
const MIN_TURN_OUT: f64 = 1.65;
/// It goes on along a path where its direction changes by less, rad.
const MAX_TURN_ON: f64 = 0.9;
/// A movement with a part is a joint movement or faster than a process, m/s.
const MIN_SPEED: f64 = 0.25;
/// Fewest movements with a part.
const MIN_MOVES: usize = 2;
/// Most steps with a part.
const MAX_STEPS_BETWEEN: usize = 500;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    if !context.calls("gripload").is_empty()
        || context.sites.iter().any(|site| site.options.contains(&"tload"))
    {
        return;
    }
    // The program lacks it as a whole: one remark is enough.
    let resets = resets(context);
    let Some((step, _)) = resets.into_iter().find(|(on, off)| carries(context, *on, *off)) else {
        return;
    };
    let Action::Output(output) = &context.trace[step].what else { return };
    let message = format!(
        "{} is set where the tool goes in and out, and reset at another such place: a part is \
         carried, but no GripLoad says what it weighs",
        output.signal
    );
    findings.push(Finding::new(&RULE, output.span, message));
}

/// The steps that set an output, in order, each with the step that resets it.
fn resets(context: &Context<'_>) -> Vec<(usize, usize)> {
    let mut next: BTreeMap<String, usize> = BTreeMap::new();
    let mut found = Vec::new();
    for (step, done) in context.trace.iter().enumerate().rev() {
        let Action::Output(output) = &done.what else { continue };
        let key = output.signal.to_lowercase();
        if output.value == "0" {
            next.insert(key, step);
        } else if output.value == "1"
            && !output.instruction.eq_ignore_ascii_case("pulsedo")
            && let Some(off) = next.get(&key).filter(|off| **off - step <= MAX_STEPS_BETWEEN)
        {
            found.push((step, *off));
        }
    }
    found.reverse();
    found
}

/// Whether what is set in a step and reset in another one holds a part between them.
fn carries(context: &Context<'_>, step: usize, off: usize) -> bool {
    let mut moves = context.trace[step..off].iter().filter_map(|done| done.what.movement());
    let carries = |movement: &Movement| {
        matches!(movement.form, MoveForm::Joint | MoveForm::AbsJ) || movement.speed.tcp >= MIN_SPEED
    };
    if moves.clone().count() < MIN_MOVES || !moves.any(carries) {
        return false;
    }
    let (Some(on), Some(off)) = (end(context, step), end(context, off)) else { return false };
    let goes_on = |end: &End| end.turn.is_some_and(|turn| turn < MAX_TURN_ON);
    let comes_out = |end: &End| end.turn.is_some_and(|turn| turn > MIN_TURN_OUT);
    let ends = [on, off];
    !ends.iter().any(goes_on) && ends.iter().any(comes_out) && ends.iter().any(|end| end.waits)
}

/// Where an output is set or reset.
struct End {
    /// The change of the tool's direction there, rad, if it is known.
    turn: Option<f64>,
    /// Whether the robot waits there.
    waits: bool,
}

/// The place at which the robot stands in a step; `None` if it passes.
fn end(context: &Context<'_>, step: usize) -> Option<End> {
    let moved = |done: &TraceStep<'_>| done.what.moves();
    let here = context.trace[..step].iter().rposition(moved)?;
    let out = step + context.trace[step..].iter().position(moved)?;
    context.trace[here].what.movement().filter(|movement| movement.zone.fine)?;
    let into = context.trace[..here].iter().rposition(moved);
    let pose = |step: usize| Some(context.pose(step)?.translation.vector);
    let turn = || {
        let [a, b, c] = [pose(into?)?, pose(here)?, pose(out)?];
        Some((b - a).angle(&(c - b)))
    };
    let waits = context.trace[here..out].iter().any(|d| matches!(d.what, Action::Wait(..)));
    Some(End { turn: turn(), waits })
}
