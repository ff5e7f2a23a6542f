//! A lowered speed override costs time, and more energy than it spares.
//!
//! ## What it does
//! Finds `VelSet` and `SpeedRefresh` below 100 % where the movements for which they are in force take
//! fewer joules with 100 %: one finding for each of them, not for each movement. Movements of a
//! process (below 200 mm/s, or with an output on for lines alone) and lines and arcs between the
//! setting and one that raises it again keep it.
//!
//! ## Why it wastes energy
//! Slow movements spare friction and copper loss, but the base load, the open brakes and the
//! holding of the arm run for the longer time; below some speed the cycle takes more.
//!
//! ## How the saving is computed
//! These movements are laid on a time line with the setting and with 100 %.
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
//! Unsafe: everything is faster; the override may be left from a test, or be meant. Without a fix
//! where a process keeps the setting or a part is carried.
//!
//! ## Assumptions
//! Programmed speeds are those that the process wants.

use super::super::context::Context;
use super::super::edits::{change_movement, replace};
use super::super::regions::{Region, lowered};
use super::super::rule::Finding;
use super::super::statements::first_argument;
use crate::rapid::ir::movement::Settings;
use crate::retime::motion::Step;

rule!("EW603", "lowered-speed", Settings, Robot, Info, "lowered_speed.rs");

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let of_velset = |settings: &Settings, value: f64| settings.speed_override == value / 100.0;
    for region in lowered(context, "velset", of_velset) {
        let full = |settings: Settings| Settings { speed_override: 1.0, ..settings };
        findings.extend(raised(context, &region, full));
    }
    let of_refresh = |settings: &Settings, value: f64| settings.refresh == value / 100.0;
    for region in lowered(context, "speedrefresh", of_refresh) {
        let full = |settings: Settings| Settings { refresh: 1.0, ..settings };
        findings.extend(raised(context, &region, full));
    }
}

/// A finding where the movements of a region take less with the full setting.
fn raised(
    context: &Context<'_>,
    region: &Region<'_>,
    full: fn(Settings) -> Settings,
) -> Option<Finding> {
    let argument = first_argument(region.call)?;
    let change = |step: &Step| {
        change_movement(step, |movement| {
            movement.settings = full(Settings::clone(&movement.settings)).into();
        })
    };
    let saving = context.evaluate(&region.spans(context), &change).ok()??;
    let message = format!("moving with {} % takes longer and spares nothing", region.value);
    let change =
        format!("100 in place of {}{}", context.text(argument.span), region.lines(context));
    let finding = Finding::new(&RULE, region.stmt.span, message)
        .with_saving(change, saving)
        .for_places(region.free.len())
        .with_assumption("the programmed speeds are those that are wanted");
    let edit = region.may_go(context).then(|| replace(argument.span, "100"));
    Some(finding.with_unsafe_fix(edit))
}
