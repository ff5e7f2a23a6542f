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
//! An output that is set and reset at stop points, with movements between, and whose name says
//! gripper, vacuum or clamp, grips.

use super::super::context::Context;
use super::super::finding::Finding;
use super::super::trace::Deed;
use crate::ir::movement::Output;

rule!("EW502", "gripping-without-payload", Load, Text, Info, "gripping_without_payload.rs");

/// Parts of names of outputs that hold something.
const HOLDING: [&str; 11] =
    ["grip", "grp", "vac", "suck", "suction", "greif", "saug", "pinza", "ventos", "clamp", "hand"];
/// Parts of names of outputs of the robot's hands that are none of them.
const OTHERWISE: [&str; 4] = ["handshake", "open", "handle", "blow"];

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    if !context.calls("gripload").is_empty()
        || context.sites.iter().any(|site| site.options.contains(&"tload"))
    {
        return;
    }
    let mut told: Vec<String> = Vec::new();
    for (step, done) in context.trace.iter().enumerate() {
        let Deed::Output(output) = &done.what else { continue };
        let key = output.signal.to_lowercase();
        if !closes(output) || told.contains(&key) || !carries(context, step, &key) {
            continue;
        }
        let message = format!(
            "{} grips, but no GripLoad says what is carried: energy and limits are computed \
             without it",
            output.signal
        );
        findings.push(Finding::new(&RULE, output.span, message));
        told.push(key);
    }
}

fn closes(output: &Output) -> bool {
    let key = output.signal.to_lowercase();
    let named = HOLDING.iter().any(|part| key.contains(part));
    let otherwise = OTHERWISE.iter().any(|part| key.contains(part));
    named
        && !otherwise
        && output.value == "1"
        && !output.instruction.eq_ignore_ascii_case("pulsedo")
}

/// Whether the robot moves between this output at a stop and its reset at another.
fn carries(context: &Context<'_>, step: usize, key: &str) -> bool {
    let stops = |upto: usize| {
        context.trace[..upto].iter().rev().find_map(|done| match &done.what {
            Deed::Move(movement) => Some(movement.zone.fine),
            _ => None,
        })
    };
    let off = context.trace[step + 1..].iter().position(|done| match &done.what {
        Deed::Output(output) => output.signal.to_lowercase() == key && output.value == "0",
        _ => false,
    });
    let Some(off) = off.map(|off| step + 1 + off) else { return false };
    let moves = context.trace[step..off].iter().filter(|d| matches!(d.what, Deed::Move(_))).count();
    moves >= 2 && stops(step) == Some(true) && stops(off) == Some(true)
}
