//! The program waits for a fixed time beside an input or output that could tell when to go on.
//!
//! ## What it does
//! Finds `WaitTime` of at least 0.5 s directly behind an output or directly before or behind a wait
//! for an input. An output that is reset right behind the wait is a pulse or a process whose length is
//! meant: it is left alone.
//!
//! ## Why it wastes energy
//! A fixed time is as long as the slowest case ever seen. The base load and the holding of the arm
//! run on in each cycle, although the gripper has closed long before.
//!
//! ## How the saving is computed
//! None is claimed: how much of the wait is needed only the cell knows. The message says what the wait
//! takes a second and in a cycle, by the simulation; that is the limit of the saving.
//!
//! ## Example
//! ```text
//! Set doGripClose;
//! WaitTime 1.5;
//! ```
//!
//! ## Use instead
//! ```text
//! Set doGripClose;
//! WaitDI diGripClosed, 1;
//! ```
//!
//! ## Safety
//! Never a fix: the input has to be there, and has to tell what the wait is for.
//!
//! ## Assumptions
//! The wait is for what the signal beside it does.

use std::collections::BTreeMap;

use super::super::context::Context;
use super::super::rule::Finding;
use super::super::saving::Saving;
use super::super::trace::Action;
use crate::arm::robot::Model;
use crate::rapid::text::Span;
use crate::retime::energy::EnergyParts;
use crate::retime::motion::timeline::WaitBasis;

rule!("EW305", "fixed-wait", Dwell, Text, Info, "fixed_wait.rs");

/// Shorter waits are those that a valve takes, s.
const MIN_WAIT: f64 = 0.5;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let mut waits: BTreeMap<Span, Vec<usize>> = BTreeMap::new();
    for (step, done) in context.trace.iter().enumerate() {
        if let Action::Wait(wait, WaitBasis::Stated) = &done.what {
            waits.entry(wait.span).or_default().push(step);
        }
    }
    for (span, steps) in waits {
        let fixed = steps.iter().all(|step| is_fixed(context, *step));
        let Some(signal) = beside(context, steps[0]).filter(|_| fixed) else { continue };
        let seconds: f64 = steps.iter().map(|step| context.trace[*step].duration).sum();
        let times = match steps.len() {
            1 => String::new(),
            times => format!(" {times} times"),
        };
        let joules = energy(context, &steps);
        let cost = joules.map(|joules| {
            let share = context.cycle.map_or(0.0, |it| it.account.total.energy_j());
            format!(
                "; {seconds:.1} s in a cycle take {joules:.1} J ({:.1} J a second, {:.1} % of the cycle)",
                joules / seconds,
                100.0 * joules / share
            )
        });
        let message = format!(
            "a fixed wait{times} beside {signal}: WaitDI on an input that tells when it is done ends \
             sooner{}",
            cost.unwrap_or_default()
        );
        let finding = Finding::new(&RULE, span, message)
            .with_saving("WaitDI in place of WaitTime", None::<Saving>)
            .with_at_stake(joules)
            .with_assumption(format!("the wait is for {signal}"));
        findings.push(finding);
    }
}

/// Whether a step is a `WaitTime` of some length whose length is not that of a pulse.
fn is_fixed(context: &Context<'_>, step: usize) -> bool {
    let Action::Wait(wait, _) = &context.trace[step].what else { return false };
    let is_pulse = || {
        let [before, after] = [step.wrapping_sub(1), step + 1].map(|at| output(context, at));
        before.is_some() && before == after
    };
    wait.instruction.eq_ignore_ascii_case("waittime")
        && context.trace[step].duration >= MIN_WAIT
        && !is_pulse()
}

/// The signal that a wait is beside: an output right before it, or an input that is waited for right
/// before or behind it.
fn beside(context: &Context<'_>, step: usize) -> Option<String> {
    let input = |at: usize| match &context.trace.get(at)?.what {
        Action::Wait(wait, _) => wait.signal.as_ref().map(ToString::to_string),
        _ => None,
    };
    let before = step.checked_sub(1);
    before.and_then(|at| output(context, at).or_else(|| input(at))).or_else(|| input(step + 1))
}

fn output(context: &Context<'_>, step: usize) -> Option<String> {
    match &context.trace.get(step)?.what {
        Action::Output(output) => Some(output.signal.to_string()),
        _ => None,
    }
}

/// What the waits take, J.
fn energy(context: &Context<'_>, steps: &[usize]) -> Option<f64> {
    let cycle = context.cycle.filter(|_| context.model.is_some_and(Model::has_dynamics))?;
    let of = |step: &usize| {
        let (event, _) = context.trace[*step].event?;
        Some(cycle.account.events.get(event)?.iter().map(EnergyParts::energy_j).sum::<f64>())
    };
    steps.iter().map(of).sum()
}
