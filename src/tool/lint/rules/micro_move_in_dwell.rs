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
//! The cycle is laid on a time line without the movement: that is what leaving it out saves by
//! itself. Closing the brakes is a setting of the controller and not counted as saved; the message
//! says what it could spare.
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
use super::super::saving::Weighed;
use super::super::trace::Action;
use crate::rapid::text::Span;
use crate::retime::energy::brakes::spared_j;
use crate::retime::energy::power::holding_w;
use crate::retime::motion::timeline::What;

rule!("EW302", "micro-move-in-dwell", Dwell, Text, Info, "micro_move_in_dwell.rs");

/// Longest way of a tiny movement, m.
const WAY: f64 = 0.02;
/// Largest turn of one, rad.
const TURN: f64 = 0.052;
/// Shortest of the two waits, s.
const WAIT: f64 = 1.0;
/// Both together, s.
const BOTH: f64 = 5.0;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let mut told: BTreeSet<Span> = BTreeSet::new();
    for step in 1..context.trace.len().saturating_sub(1) {
        let Action::Move(movement) = &context.trace[step].what else { continue };
        let wait = |step: usize| match &context.trace[step].what {
            Action::Wait(..) => Some(context.trace[step].duration).filter(|t| *t >= WAIT),
            _ => None,
        };
        let (Some(before), Some(after)) = (wait(step - 1), wait(step + 1)) else { continue };
        // All executions of a statement are weighed together.
        if before + after < BOTH || !is_tiny(context, step) || !told.insert(movement.span) {
            continue;
        }
        let total = before + after;
        let spared = spared(context, step + 1, total);
        let message = format!(
            "a tiny {} breaks {total:.1} s of waiting in two: the brakes can't close{spared}",
            movement.instruction
        );
        let mut finding = Finding::new(&RULE, movement.span, message);
        if let Weighed::Saves(saving) = context.weigh(&[movement.span], &|_| Vec::new()) {
            "leaving it out".clone_into(&mut finding.change);
            finding.saving = Some(saving);
        }
        findings.push(finding);
    }
}

fn is_tiny(context: &Context<'_>, step: usize) -> bool {
    let before =
        context.trace[..step].iter().rposition(|done| matches!(done.what, Action::Move(_)));
    let (Some(before), Some(here)) = (before.and_then(|b| context.pose(b)), context.pose(step))
    else {
        return false;
    };
    let way = (here.translation.vector - before.translation.vector).norm();
    way < WAY && before.rotation.angle_to(&here.rotation) < TURN
}

/// What closed brakes would spare, in words.
fn spared(context: &Context<'_>, step: usize, total: f64) -> String {
    let known = || {
        let (event, _) = context.trace[step].event?;
        let model = context.model.filter(|model| model.has_dynamics())?;
        let cycle = context.cycle?;
        let What::Wait(wait) = &cycle.simulation.events[event].what else { return None };
        let holding: f64 = holding_w(model, &wait.load, &wait.q).iter().sum();
        let spared = spared_j(model, holding, total);
        (spared > 0.0).then(|| format!("; closed, they would spare up to {spared:.0} J"))
    };
    known().unwrap_or_default()
}
