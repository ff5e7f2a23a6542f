//! The robot accelerates as hard as it can, and then waits for a machine.
//!
//! ## What it does
//! Finds runs of movements that end at a stop behind which the program waits for an input that
//! comes later, where a lower speed saves nothing but a lower acceleration does.
//!
//! ## Why it wastes energy
//! Copper losses grow with the square of the torque, and the time won is spent waiting.
//!
//! ## How the saving is computed
//! The run is laid on a time line with `AccSet` 70, 50 and 30, and the wait behind it made
//! shorter; the setting that saves most without a longer cycle is proposed.
//!
//! ## Example
//! ```text
//! MoveJ pMachine, v200, fine, tGrip;
//! WaitDI diDone, 1;
//! ```
//!
//! ## Use instead
//! ```text
//! AccSet 50, 100;
//! MoveJ pMachine, v200, fine, tGrip;
//! AccSet 100, 100;
//! WaitDI diDone, 1;
//! ```
//!
//! ## Safety
//! Unsafe: the path and the order stay, but the time of the input may not always be that long.
//!
//! ## Assumptions
//! The input comes when `--input` or the configuration says.

use std::sync::Arc;

use super::super::context::Context;
use super::super::rule::{Applicability, Finding, Fix};
use super::super::saving::Weighed;
use super::super::trace::Action;
use super::racing_to_wait::{run_of, slower_run, waits_behind};
use crate::rapid::ir::movement::{Movement, Settings};
use crate::rapid::text::{Edit, Span};
use crate::retime::motion::Step;

rule!("EW203", "accelerated-to-wait", Speed, Robot, Info, "accelerated_to_wait.rs");

/// Shares of the acceleration that are tried, %.
const TRIED: [u32; 3] = [70, 50, 30];
/// Rounding of a time, s.
const LATE: f64 = 1e-6;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for (index, site) in context.sites.iter().enumerate() {
        if !site.is_plain() || !site.is_stop() || site.compact {
            continue;
        }
        let Some((signal, slack)) = waits_behind(context, index) else { continue };
        if run_of(context, index).is_none_or(|run| run != [index])
            || !is_full(context, index)
            || slower_run(context, index, &signal, slack).is_some()
        {
            continue;
        }
        let mut best: Option<(u32, Weighed, f64)> = None;
        for percent in TRIED {
            let share = f64::from(percent) / 100.0;
            let change = |step: &Step| with_acceleration(step, share, None);
            let times = site.executions.len() as f64;
            let difference = context.difference(&[site.stmt.span], &change);
            let Some(difference) = difference.filter(|it| it.longer_s <= slack * times) else {
                continue;
            };
            let weighed = difference.weighed();
            let Weighed::Saves(saving) = weighed else { continue };
            let more = best.as_ref().is_none_or(|(_, _, most)| saving.energy_j > *most);
            if saving.time_s >= -LATE && more {
                best = Some((percent, weighed, saving.energy_j));
            }
        }
        let Some((percent, Weighed::Saves(saving), _)) = best else { continue };
        let message = format!("{} accelerates at its hardest to wait for {signal}", site.name);
        let mut finding = Finding::new(&RULE, site.stmt.span, message);
        finding.change =
            format!("AccSet {percent},100 before this movement and AccSet 100,100 behind it");
        finding.saving = Some(saving);
        finding.assumptions.push(format!("{signal} comes when --input says"));
        let Span { start, end, .. } = site.stmt.span;
        let before = format!("AccSet {percent},100; ").into_bytes();
        let edits = vec![
            Edit { span: Span { end: start, ..site.stmt.span }, text: before },
            Edit {
                span: Span { start: end, ..site.stmt.span },
                text: b" AccSet 100,100;".to_vec(),
            },
        ];
        finding.fix = Some(Fix { applicability: Applicability::Unsafe, edits });
        findings.push(finding);
    }
}

/// Whether all movements have full acceleration.
fn is_full(context: &Context<'_>, index: usize) -> bool {
    context.sites[index].executions.iter().all(|step| match &context.trace[*step].what {
        Action::Move(movement) => {
            let settings = &movement.settings;
            settings.acceleration == 1.0 && settings.ramp == 1.0 && settings.fine_point_ramp == 1.0
        }
        _ => false,
    })
}

/// A movement with another acceleration and, if it is given, another ramp (1 = 100 %).
pub(super) fn with_acceleration(step: &Step, share: f64, ramp: Option<f64>) -> Vec<Step> {
    match step {
        Step::Move(movement) => {
            let before = Settings::clone(&movement.settings);
            let ramp = ramp.unwrap_or(before.ramp);
            let settings = Arc::new(Settings { acceleration: share, ramp, ..before });
            vec![Step::Move(Box::new(Movement { settings, ..(**movement).clone() }))]
        }
        other => vec![other.clone()],
    }
}
