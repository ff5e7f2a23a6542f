//! The robot waits long, and its controller has no time after which the brakes close.
//!
//! ## What it does
//! Finds waits of 20 s and more in the program of a backup whose `MOC.cfg` states no
//! `brake_on_timeout`.
//!
//! ## Why it wastes energy
//! Motors hold the arm for the whole wait, although closed brakes would.
//!
//! ## How the saving is computed
//! It is a setting of the controller and not counted as saved; where the robot's brakes are known
//! the message says what closing them could spare.
//!
//! ## Example
//! ```text
//! WaitTime 60;
//! ```
//!
//! ## Use instead
//! State the time in the motion configuration: "Brake on Timeout" of the motion planner.
//!
//! ## Safety
//! Without a fix: releasing the brakes takes time, and wears them.
//!
//! ## Assumptions
//! The controller has the parameter, and a backup states what differs from the default.

use std::collections::BTreeSet;

use super::super::context::Context;
use super::super::rule::Finding;
use super::super::trace::Action;
use crate::rapid::text::Span;
use crate::retime::energy::brakes::spared_j;
use crate::retime::energy::power::holding_w;
use crate::retime::motion::timeline::What;

rule!("EW801", "brakes-never-close", System, Backup, Info, "brakes_never_close.rs");

/// Waits from here on are long, s.
const MIN_WAIT: f64 = 20.0;
/// The parameter.
const TIMEOUT: &str = "brake_on_timeout";

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let motion = context.system.and_then(|system| system.motion.as_ref());
    if motion.is_none_or(|motion| motion.to_lowercase().contains(TIMEOUT)) {
        return;
    }
    let mut reported: BTreeSet<Span> = BTreeSet::new();
    for (step, done) in context.trace.iter().enumerate() {
        let Action::Wait(wait, _) = &done.what else { continue };
        if done.duration < MIN_WAIT || !reported.insert(wait.span) {
            continue;
        }
        let saving = brake_saving(context, step, done.duration)
            .map(|saving| format!("; closed as it waits, they would spare {saving:.0} J"));
        let message = format!(
            "the robot waits {:.0} s and MOC.cfg states no {TIMEOUT}: the brakes stay open{}",
            done.duration,
            saving.unwrap_or_default()
        );
        findings.push(Finding::new(&RULE, wait.span, message));
    }
}

/// What closed brakes would save in `duration` s where the robot stands in a step, J, if that is
/// known and anything.
pub(super) fn brake_saving(context: &Context<'_>, step: usize, duration: f64) -> Option<f64> {
    let (event, _) = context.trace[step].event?;
    let model = context.model.filter(|model| model.has_dynamics())?;
    let What::Wait(wait) = &context.cycle?.simulation.events[event].what else { return None };
    let holding: f64 = holding_w(model, &wait.load, &wait.q).iter().sum();
    Some(spared_j(model, holding, duration)).filter(|saving| *saving > 0.0)
}
