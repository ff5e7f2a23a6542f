//! A tiny movement breaks up a long wait, so that the brakes never close.
//!
//! ## What it does
//! Finds movements of less than 20 mm and 3° between two waits that last 5 s and more together,
//! each of them 1 s and more.
//!
//! ## Why it wastes energy
//! A controller closes the brakes after a time at standstill. Each movement restarts that time,
//! so the motors hold the arm during the whole wait.
//!
//! ## How the saving is computed
//! None is told: the movement stands between waits, so that nothing proposes to leave it out. Closing
//! the brakes is a setting of the controller and not counted as saved; the message says what it could
//! spare.
//!
//! ## Example
//! ```text
//! WaitTime 10;
//! MoveL Offs(pWait, 0, 0, 2), v100, fine, tGrip;
//! WaitTime 10;
//! ```
//!
//! ## Use instead
//! ```text
//! WaitTime 20;
//! ```
//!
//! ## Safety
//! Without a fix: the small movement may have a purpose.
//!
//! ## Assumptions
//! The controller is set to close its brakes at standstill.

use std::collections::BTreeSet;

use super::super::context::Context;
use super::super::rule::Finding;
use super::super::trace::Action;
use super::brakes_never_close::brake_saving;
use crate::rapid::text::Span;

rule!("EW302", "micro-move-in-dwell", Dwell, Text, Info, "micro_move_in_dwell.rs");

/// Longest way of a tiny movement, m.
const MAX_WAY: f64 = 0.02;
/// Largest turn of one, rad.
const MAX_TURN: f64 = 0.052;
/// Shortest of the two waits, s.
const MIN_WAIT: f64 = 1.0;
/// Both together, s.
const MIN_BOTH_WAITS: f64 = 5.0;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let mut reported: BTreeSet<Span> = BTreeSet::new();
    for step in 1..context.trace.len().saturating_sub(1) {
        let Some(movement) = context.trace[step].what.movement() else { continue };
        let wait = |step: usize| match &context.trace[step].what {
            Action::Wait(..) => Some(context.trace[step].duration).filter(|t| *t >= MIN_WAIT),
            _ => None,
        };
        let (Some(before), Some(after)) = (wait(step - 1), wait(step + 1)) else { continue };
        let total = before + after;
        // All executions of a statement are weighed together.
        if total < MIN_BOTH_WAITS || !is_tiny(context, step) || !reported.insert(movement.span) {
            continue;
        }
        let saving = brake_saving(context, step + 1, total)
            .map(|saving| format!("; closed, they would spare up to {saving:.0} J"));
        let message = format!(
            "a tiny {} breaks {total:.1} s of waiting in two: the brakes can't close{}",
            movement.instruction,
            saving.unwrap_or_default()
        );
        findings.push(Finding::new(&RULE, movement.span, message).doubtful());
    }
}

fn is_tiny(context: &Context<'_>, step: usize) -> bool {
    let before = context.trace[..step].iter().rposition(|done| done.what.movement().is_some());
    let (Some(before), Some(here)) = (before.and_then(|b| context.pose(b)), context.pose(step))
    else {
        return false;
    };
    let way = (here.translation.vector - before.translation.vector).norm();
    way < MAX_WAY && before.rotation.angle_to(&here.rotation) < MAX_TURN
}
