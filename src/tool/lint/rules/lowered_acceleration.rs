//! A lowered acceleration costs time, and more energy than it spares.
//!
//! ## What it does
//! Finds `AccSet` below 100 % where the movements for which it is in force take fewer joules with
//! 100 %: one finding for each `AccSet`, not for each movement. Movements of a process (below
//! 200 mm/s, or with an output on for lines alone) and lines and arcs between this `AccSet` and one
//! that raises it again keep it.
//!
//! ## Why it wastes energy
//! Softer starts spare little; the base load, the open brakes and the holding of the arm run for
//! the longer time.
//!
//! ## How the saving is computed
//! These movements are laid on a time line with the setting and with 100 %.
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
//! Unsafe: a part may be held so weakly that it needs the softer start. Without a fix where a process
//! keeps the setting or a part is carried.
//!
//! ## Assumptions
//! No process asks for the softer start.

use super::super::context::Context;
use super::super::edits::{replace, with_acceleration};
use super::super::regions::lowered;
use super::super::rule::Finding;
use crate::rapid::ir::hir::ArgKind;

rule!("EW602", "lowered-acceleration", Settings, Robot, Info, "lowered_acceleration.rs");

/// Least setting of the controller, %.
const MIN_PERCENT: f64 = 20.0;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let regions = lowered(context, "accset", |settings, value| {
        settings.acceleration == value.max(MIN_PERCENT) / 100.0
    });
    for region in regions {
        let arguments = region.call.args.iter().map_while(|argument| match &argument.kind {
            ArgKind::Positional(expr) => Some(expr.span),
            _ => None,
        });
        let arguments: Vec<_> = arguments.collect();
        let [acceleration, ramp] = *arguments.as_slice() else { continue };
        let spans = region.spans(context);
        let full = context.evaluate(&spans, &|step| with_acceleration(step, 1.0, Some(1.0)));
        let Ok(Some(saving)) = full else { continue };
        let message =
            format!("accelerating with {} % takes longer and spares nothing", region.value);
        let change = format!("AccSet 100,100{}", region.lines(context));
        let finding = Finding::new(&RULE, region.stmt.span, message)
            .with_saving(change, saving)
            .for_places(region.free.len())
            .with_assumption("no process asks for the softer start");
        let edits = [acceleration, ramp].map(|argument| replace(argument, "100"));
        findings
            .push(finding.with_unsafe_fix(edits.into_iter().filter(|_| region.may_go(context))));
    }
}
