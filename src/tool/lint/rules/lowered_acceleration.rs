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
use super::super::edits::replace;
use super::super::rule::{Applicability, Finding, Fix};
use super::super::saving::Weighed;
use super::super::trace::Action;
use super::accelerated_to_wait::with_acceleration;
use super::setting_never_restored::percent;
use crate::rapid::ir::hir::ArgKind;
use crate::rapid::text::Span;

rule!("EW602", "lowered-acceleration", Settings, Robot, Info, "lowered_acceleration.rs");

/// Least setting of the controller, %.
const LEAST: f64 = 20.0;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let calls = context.calls("accset");
    let values: Vec<Option<f64>> =
        calls.iter().map(|(place, _, call)| percent(context, place.0, call)).collect();
    for ((_, stmt, call), value) in calls.iter().zip(&values) {
        let Some(value) = value.filter(|value| *value < 100.0) else { continue };
        // Movements are recognised by the value: only this statement may set it.
        let alone = values.iter().filter(|other| **other == Some(value)).count() == 1;
        let [acceleration, ramp] = call.args.as_slice() else { continue };
        let (ArgKind::Positional(acceleration), ArgKind::Positional(ramp)) =
            (&acceleration.kind, &ramp.kind)
        else {
            continue;
        };
        let share = value.max(LEAST) / 100.0;
        let spans = under(context, |settings| settings.acceleration == share);
        let in_air = |span: &Span| {
            let site = context.site_of(*span).map(|index| &context.sites[index]);
            site.is_some_and(|site| !site.is_linear())
        };
        if !alone || !spans.iter().any(in_air) {
            continue;
        }
        let weighed = context.weigh(&spans, &|step| with_acceleration(step, 1.0, Some(1.0)));
        let Weighed::Saves(saving) = weighed else { continue };
        let message = format!("accelerating with {value} % takes longer and spares nothing");
        let mut finding = Finding::new(&RULE, stmt.span, message);
        "AccSet 100,100".clone_into(&mut finding.change);
        finding.saving = Some(saving);
        finding.assumptions.push("no process asks for the softer start".to_owned());
        finding.fix = Some(Fix {
            applicability: Applicability::Unsafe,
            edits: vec![replace(acceleration.span, "100"), replace(ramp.span, "100")],
        });
        findings.push(finding);
    }
}

/// The movement statements all of whose executions are under a setting.
pub(super) fn under(
    context: &Context<'_>,
    is_under: impl Fn(&crate::rapid::ir::movement::Settings) -> bool,
) -> Vec<Span> {
    let sites = context.sites.iter().filter(|site| {
        let mut executions = site.executions.iter();
        !site.executions.is_empty()
            && executions.all(|step| match &context.trace[*step].what {
                Action::Move(movement) => is_under(&movement.settings),
                _ => false,
            })
    });
    sites.map(|site| site.stmt.span).collect()
}
