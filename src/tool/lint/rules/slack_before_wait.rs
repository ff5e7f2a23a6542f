//! A wait for a machine could be slower travel before it.
//!
//! ## What it does
//! Finds waits for an input that comes later than the robot, where only outputs and short waits
//! of stated length stand between the last movements and the wait.
//!
//! ## Why it wastes energy
//! The movements are faster than they need to be, and the time won is spent waiting with open
//! brakes.
//!
//! ## How the saving is computed
//! As of EW201: the run before the wait is laid on a time line with each slower predefined speed,
//! and the speed that saves most without a longer cycle is proposed.
//!
//! ## Example
//! ```text
//! MoveJ pMachine, v3000, fine, tGrip;
//! SetDO doStart, 1;
//! WaitDI diDone, 1;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveJ pMachine, v800, fine, tGrip;
//! SetDO doStart, 1;
//! WaitDI diDone, 1;
//! ```
//!
//! ## Safety
//! Unsafe: the outputs come later. If one of them starts what the input answers, the input comes
//! later too and the cycle is longer: then nothing can be saved here.
//!
//! ## Assumptions
//! The input comes when `--input` or the configuration says, whenever the outputs are set.

use super::super::context::Context;
use super::super::rule::Finding;
use super::super::trace::Action;
use super::racing_to_wait::slower_run;
use crate::rapid::text::Span;
use crate::retime::motion::timeline::WaitBasis;

rule!("EW304", "slack-before-wait", Dwell, Robot, Info, "slack_before_wait.rs");

/// Shortest wait that is worth a change, s.
const MIN_WAIT: f64 = 0.5;
/// Steps between the movement and the wait.
const MAX_STEPS_BETWEEN: usize = 8;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for (index, site) in context.sites.iter().enumerate() {
        if !site.is_plain() || !site.is_stop() || site.executions.is_empty() {
            continue;
        }
        let behind = site.executions.iter().map(|step| wait_behind(context, *step));
        let Some(behind) = behind.collect::<Option<Vec<_>>>() else { continue };
        let slack = behind.iter().map(|(_, _, slack)| *slack).fold(f64::INFINITY, f64::min);
        let (signal, span, _) = &behind[0];
        let Some(finding) = slower_run(context, index, signal, slack) else { continue };
        let finding = Finding { rule: &RULE, ..finding }
            .with_related(*span, format!("waits for {signal}"))
            .with_assumption("no output before the wait starts what it waits for");
        findings.push(finding);
    }
}

/// The input that is waited for behind some outputs and short waits, where, and how long, s.
fn wait_behind(context: &Context<'_>, step: usize) -> Option<(String, Span, f64)> {
    for (count, done) in context.trace[step + 1..].iter().enumerate().take(MAX_STEPS_BETWEEN) {
        match &done.what {
            Action::Output(_) | Action::Wait(_, WaitBasis::Stated) => {}
            Action::Wait(wait, WaitBasis::Input) if count > 0 && done.duration >= MIN_WAIT => {
                return Some((wait.signal.as_ref()?.to_string(), wait.span, done.duration));
            }
            _ => return None,
        }
    }
    None
}
