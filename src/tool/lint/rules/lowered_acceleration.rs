//! A lowered acceleration costs time, and more energy than it spares.
//!
//! ## What it does
//! Finds `AccSet` below 100 % where the movements under it take fewer joules with 100 %, and not
//! all of them are lines and arcs: these may be a process.
//!
//! ## Why it wastes energy
//! Softer starts spare little; the base load, the open brakes and the holding of the arm run for
//! the longer time.
//!
//! ## How the saving is computed
//! All movements under the setting are laid on a time line with it and with 100 %.
//!
//! ## Example
//! ```text
//! AccSet 30, 30;
//! MoveJ pOver, v2000, z50, tGrip;
//! AccSet 100, 100;
//! ```
//!
//! ## Use instead
//! ```text
//! AccSet 100, 100;
//! MoveJ pOver, v2000, z50, tGrip;
//! AccSet 100, 100;
//! ```
//!
//! ## Safety
//! Unsafe: a part may be held so weakly that it needs the softer start.
//!
//! ## Assumptions
//! No process asks for the softer start.

use super::super::context::Context;
use super::super::edits::{replace, with_acceleration};
use super::super::rule::Finding;
use super::setting_never_restored::percent;
use crate::rapid::ir::hir::{ArgKind, Call, Stmt};
use crate::rapid::ir::movement::Settings;
use crate::rapid::text::Span;

rule!("EW602", "lowered-acceleration", Settings, Robot, Info, "lowered_acceleration.rs");

/// Least setting of the controller, %.
const MIN_PERCENT: f64 = 20.0;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for (stmt, call, value) in lowered(context, "accset") {
        let [acceleration, ramp] = call.args.as_slice() else { continue };
        let (ArgKind::Positional(acceleration), ArgKind::Positional(ramp)) =
            (&acceleration.kind, &ramp.kind)
        else {
            continue;
        };
        let share = value.max(MIN_PERCENT) / 100.0;
        let spans = movements_with(context, |settings| settings.acceleration == share);
        let in_air = |span: &Span| {
            context.site_of(*span).is_some_and(|index| !context.sites[index].is_linear())
        };
        if !spans.iter().any(in_air) {
            continue;
        }
        let full = context.evaluate(&spans, &|step| with_acceleration(step, 1.0, Some(1.0)));
        let Ok(Some(saving)) = full else { continue };
        let message = format!("accelerating with {value} % takes longer and spares nothing");
        let finding = Finding::new(&RULE, stmt.span, message)
            .with_saving("AccSet 100,100", saving)
            .with_assumption("no process asks for the softer start")
            .with_unsafe_fix([acceleration, ramp].map(|argument| replace(argument.span, "100")));
        findings.push(finding);
    }
}

/// The calls of an instruction that set less than 100 %, with the value. A movement shows only the
/// value that it runs with, so calls count only if no other one sets the same.
pub(super) fn lowered<'c>(
    context: &Context<'c>,
    instruction: &'static str,
) -> Vec<(&'c Stmt, &'c Call, f64)> {
    let calls = context.calls(instruction);
    let values: Vec<Option<f64>> =
        calls.iter().map(|(place, _, call)| percent(context, place.0, call)).collect();
    let lowered = calls.into_iter().zip(&values).filter_map(|((_, stmt, call), value)| {
        let value = value.filter(|value| *value < 100.0)?;
        let same = values.iter().filter(|other| **other == Some(value)).count();
        (same == 1).then_some((stmt, call, value))
    });
    lowered.collect()
}

/// The movement statements all of whose executions have settings of a kind.
pub(super) fn movements_with(context: &Context<'_>, has: impl Fn(&Settings) -> bool) -> Vec<Span> {
    let sites = context.sites.iter().enumerate();
    let sites =
        sites.filter(|(index, site)| !site.executions.is_empty() && context.always(*index, &has));
    sites.map(|(_, site)| site.stmt.span).collect()
}
