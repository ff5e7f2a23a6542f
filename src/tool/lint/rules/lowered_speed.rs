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
use super::super::edits::{change_movement, replace};
use super::super::rule::Finding;
use super::super::statements::first_argument;
use super::lowered_acceleration::{lowered, movements_with};
use crate::rapid::ir::movement::Settings;
use crate::retime::motion::Step;

rule!("EW603", "lowered-speed", Settings, Robot, Info, "lowered_speed.rs");

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for (stmt, call, value) in lowered(context, "velset") {
        let Some(argument) = first_argument(call).filter(|_| value > 0.0) else { continue };
        let spans = movements_with(context, |settings| settings.speed_override == value / 100.0);
        if spans.is_empty() {
            continue;
        }
        let Ok(Some(saving)) = context.evaluate(&spans, &full_speed) else { continue };
        let message = format!("moving with {value} % takes longer and spares nothing");
        let finding = Finding::new(&RULE, stmt.span, message)
            .with_saving(format!("100 in place of {}", context.text(argument.span)), saving)
            .with_assumption("the programmed speeds are those that are wanted")
            .with_unsafe_fix([replace(argument.span, "100")]);
        findings.push(finding);
    }
}

fn full_speed(step: &Step) -> Vec<Step> {
    change_movement(step, |movement| {
        let settings = Settings::clone(&movement.settings);
        movement.settings = Settings { speed_override: 1.0, ..settings }.into();
    })
}
