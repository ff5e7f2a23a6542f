//! A motion setting is lowered in the middle of the program and never restored.
//!
//! ## What it does
//! Finds `AccSet` and `VelSet` below 100 % behind the first movements of a program that never
//! sets them back: one finding for each of the two.
//!
//! ## Why it wastes energy
//! From then on everything is slower, in the next cycle also what was at full speed in the first:
//! the base load runs for longer, and no cycle is as it was tried.
//!
//! ## How the saving is computed
//! There is none: the next cycle loses the energy, and one simulated cycle does not show it.
//! EW602 and EW603 weigh the setting itself.
//!
//! ## Example
//! ```text
//! MoveJ pOver, v1000, z50, tGrip;
//! AccSet 40, 40;
//! MoveL pInsert, v100, fine, tGrip;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveJ pOver, v1000, z50, tGrip;
//! AccSet 40, 40;
//! MoveL pInsert, v100, fine, tGrip;
//! AccSet 100, 100;
//! ```
//!
//! ## Safety
//! Without a fix: where the setting ends is the process's.
//!
//! ## Assumptions
//! The program is complete: it has its entry.

use super::super::context::Context;
use super::super::regions::percent;
use super::super::rule::Finding;
use crate::rapid::ir::movement::{Movement, Settings};

rule!("EW601", "setting-never-restored", Settings, Text, Warning, "setting_never_restored.rs");

/// What a setting is, 1 = 100 %.
type Share = fn(&Settings) -> f64;
/// Instructions with what they change.
const SETTINGS: [(&str, Share); 2] =
    [("accset", |settings| settings.acceleration), ("velset", |settings| settings.speed_override)];

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let moves = || context.trace.iter().filter_map(|step| step.what.movement());
    let (Some(first), Some(last)) = (moves().next(), moves().next_back()) else { return };
    for (key, share) in SETTINGS {
        let share = |movement: &Movement| share(&movement.settings);
        if share(first) < 1.0 || share(last) >= 1.0 {
            continue;
        }
        let calls = context.calls(key);
        let values: Option<Vec<f64>> =
            calls.iter().map(|(place, _, call)| percent(context, place.0, call)).collect();
        // A value that is not known may be 100 %.
        if values.is_none_or(|values| values.iter().any(|value| *value >= 100.0)) {
            continue;
        }
        let mut spans = calls.iter().map(|(_, stmt, _)| stmt.span);
        let Some(first) = spans.next() else { continue };
        let message = "lowered here for all that follows, and in the next cycle for all: \
                       nothing sets it back to 100 %";
        let finding = Finding::new(&RULE, first, message).for_places(calls.len());
        findings.push(spans.fold(finding, |finding, span| finding.with_related(span, "and here")));
    }
}
