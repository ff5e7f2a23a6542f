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

use super::super::context::Context;
use super::super::edits::with_acceleration;
use super::super::rule::Finding;
use super::super::saving::Saving;
use super::racing_to_wait::{run_of, slower_run, waits_behind};
use crate::rapid::text::{Edit, Span};
use crate::retime::motion::Step;

rule!("EW203", "accelerated-to-wait", Speed, Robot, Info, "accelerated_to_wait.rs");

/// Shares of the acceleration that are tried, %.
const TRIED: [u32; 3] = [70, 50, 30];
/// Rounding of a time, s.
const ROUNDING: f64 = 1e-6;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for (index, site) in context.sites.iter().enumerate() {
        if !site.is_plain() || !site.is_stop() || site.compact || context.is_process(index) {
            continue;
        }
        let Some((signal, slack)) = waits_behind(context, index) else { continue };
        if run_of(context, index).is_none_or(|run| run != [index])
            || !is_full(context, index)
            || slower_run(context, index, &signal, slack).is_some()
        {
            continue;
        }
        let times = site.executions.len() as f64;
        let mut best: Option<(u32, Saving)> = None;
        for percent in TRIED {
            let change = |step: &Step| with_acceleration(step, f64::from(percent) / 100.0, None);
            let difference = context.difference(&[site.stmt.span], &change);
            let difference = difference.filter(|it| it.longer_s <= slack * times);
            let Some(Ok(saving)) = difference.map(|it| it.saving()) else { continue };
            let most = best.map_or(f64::NEG_INFINITY, |(_, best)| best.energy_j);
            if saving.time_s >= -ROUNDING && saving.energy_j > most {
                best = Some((percent, saving));
            }
        }
        let Some((percent, saving)) = best else { continue };
        let Span { start, end, .. } = site.stmt.span;
        let insertion = |at, text: String| Edit {
            span: Span { start: at, end: at, ..site.stmt.span },
            text: text.into_bytes(),
        };
        let message = format!("{} accelerates at its hardest to wait for {signal}", site.name);
        let change =
            format!("AccSet {percent},100 before this movement and AccSet 100,100 behind it");
        let finding = Finding::new(&RULE, site.stmt.span, message)
            .with_saving(change, saving)
            .with_assumption(format!("{signal} comes when --input says"))
            .with_unsafe_fix([
                insertion(start, format!("AccSet {percent},100; ")),
                insertion(end, " AccSet 100,100;".to_owned()),
            ]);
        findings.push(finding);
    }
}

/// Whether all movements have full acceleration.
fn is_full(context: &Context<'_>, index: usize) -> bool {
    context.always(index, |settings| {
        settings.acceleration == 1.0 && settings.ramp == 1.0 && settings.fine_point_ramp == 1.0
    })
}
