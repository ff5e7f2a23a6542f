//! A lowered speed override costs time, and more energy than it spares.
//!
//! ## What it does
//! Finds `VelSet` below 100 % where the movements under it take fewer joules with 100 %.
//!
//! ## Why it wastes energy
//! Slow movements spare friction and copper loss, but the base load, the open brakes and the
//! holding of the arm run for the longer time; below some speed the cycle takes more.
//!
//! ## How the saving is computed
//! All movements under the setting are laid on a time line with it and with 100 %.
//!
//! ## Example
//! ```text
//! VelSet 20, 5000;
//! MoveJ pOver, v1000, z50, tGrip;
//! ```
//!
//! ## Use instead
//! ```text
//! VelSet 100, 5000;
//! MoveJ pOver, v1000, z50, tGrip;
//! ```
//!
//! ## Safety
//! Unsafe: everything is faster; the override may be left from a test, or be meant.
//!
//! ## Assumptions
//! Programmed speeds are those that the process wants.

use super::super::context::Context;
use super::super::edits::{fix, replace};
use super::super::rule::{Applicability, Finding};
use super::super::saving::Weighed;
use super::lowered_acceleration::under;
use super::setting_never_restored::percent;
use crate::rapid::ir::hir::ArgKind;
use crate::rapid::ir::movement::{Movement, Settings};
use crate::retime::motion::Step;

rule!("EW603", "lowered-speed", Settings, Robot, Info, "lowered_speed.rs");

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let calls = context.calls("velset");
    let values: Vec<Option<f64>> =
        calls.iter().map(|(place, _, call)| percent(context, place.0, call)).collect();
    for ((_, stmt, call), value) in calls.iter().zip(&values) {
        let Some(value) = value.filter(|value| *value < 100.0 && *value > 0.0) else { continue };
        let alone = values.iter().filter(|other| **other == Some(value)).count() == 1;
        let Some(ArgKind::Positional(argument)) = call.args.first().map(|arg| &arg.kind) else {
            continue;
        };
        let spans = under(context, |settings| settings.speed_override == value / 100.0);
        if !alone || spans.is_empty() {
            continue;
        }
        let Weighed::Saves(saving) = context.weigh(&spans, &full_speed) else { continue };
        let message = format!("moving with {value} % takes longer and spares nothing");
        let mut finding = Finding::new(&RULE, stmt.span, message);
        finding.change = format!("100 in place of {}", context.text(argument.span));
        finding.saving = Some(saving);
        finding.assumptions.push("the programmed speeds are those that are wanted".to_owned());
        finding.fix = Some(fix(Applicability::Unsafe, replace(argument.span, "100")));
        findings.push(finding);
    }
}

fn full_speed(step: &Step) -> Vec<Step> {
    match step {
        Step::Move(movement) => {
            let settings = Settings { speed_override: 1.0, ..(*movement.settings).clone() };
            let movement = Movement { settings: settings.into(), ..(**movement).clone() };
            vec![Step::Move(Box::new(movement))]
        }
        other => vec![other.clone()],
    }
}
