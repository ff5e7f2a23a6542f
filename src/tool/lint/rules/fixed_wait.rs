//! The program waits for a fixed time beside an input or output that could tell when to go on.
//!
//! ## What it does
//! Finds `WaitTime` of at least 0.5 s directly behind an output, directly before or behind a wait for an
//! input, or directly before an output that is set: those beside one signal of a file are one finding. A
//! `PulseDO` and an output that is reset right behind the wait are a pulse or a process whose length is
//! meant: they are left alone.
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
use crate::rapid::ir::exec::NO_END;
use crate::rapid::ir::movement::Output;
use crate::rapid::text::{FileId, Span};
use crate::retime::energy::EnergyParts;
use crate::retime::motion::timeline::WaitBasis;

rule!("EW305", "fixed-wait", Dwell, Text, Info, "fixed_wait.rs");

/// Shorter waits are those that a valve takes, s.
const MIN_WAIT: f64 = 0.5;

/// A wait with its executions.
type Executed = (Span, Vec<usize>);

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let mut waits: BTreeMap<Span, Vec<usize>> = BTreeMap::new();
    for (step, done) in context.trace.iter().enumerate() {
        if let Action::Wait(wait, WaitBasis::Stated) = &done.what {
            waits.entry(wait.span).or_default().push(step);
        }
    }
    // Waits for the same signal have one cause.
    let mut of_signal: BTreeMap<(FileId, String), Vec<Executed>> = BTreeMap::new();
    for (span, steps) in waits {
        let fixed = steps.iter().all(|step| is_fixed(context, *step));
        if let Some(signal) = beside(context, steps[0]).filter(|_| fixed) {
            of_signal.entry((span.file, signal.to_lowercase())).or_default().push((span, steps));
        }
    }
    findings.extend(of_signal.into_values().map(|waits| fixed_wait(context, &waits)));
}

/// A finding for the waits beside a signal.
fn fixed_wait(context: &Context<'_>, waits: &[Executed]) -> Finding {
    let steps: Vec<usize> = waits.iter().flat_map(|(_, steps)| steps.iter().copied()).collect();
    let signal = beside(context, steps[0]).unwrap_or_default();
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
    let finding = Finding::new(&RULE, waits[0].0, message)
        .with_saving("WaitDI in place of WaitTime", None::<Saving>)
        .with_at_stake(joules)
        .with_assumption(format!("the wait is for {signal}"))
        .for_places(waits.len());
    let related = waits.iter().skip(1);
    related.fold(finding, |finding, (span, _)| finding.with_related(*span, "and here"))
}

/// Whether a step is a `WaitTime` of some length whose length is not that of a pulse.
fn is_fixed(context: &Context<'_>, step: usize) -> bool {
    let Action::Wait(wait, _) = &context.trace[step].what else { return false };
    let is_pulse = || {
        let [before, after] = [step.wrapping_sub(1), step + 1].map(|at| output(context, at));
        before.is_some_and(|before| {
            before.instruction.eq_ignore_ascii_case("pulsedo")
                || after.is_some_and(|after| after.signal == before.signal)
        })
    };
    wait.instruction.eq_ignore_ascii_case("waittime")
        && context.trace[step].duration >= MIN_WAIT
        && !is_pulse()
}

/// The signal that a wait is beside: an output right before it, an input that is waited for right before or
/// behind it, or else an output that is set right behind it.
fn beside(context: &Context<'_>, step: usize) -> Option<String> {
    let input = |at: usize| match &context.trace.get(at)?.what {
        Action::Wait(wait, _) => wait.signal.as_ref().map(ToString::to_string),
        _ => None,
    };
    let signal = |output: &Output| output.signal.to_string();
    let before = step.checked_sub(1);
    before
        .and_then(|at| output(context, at).map(signal).or_else(|| input(at)))
        .or_else(|| input(step + 1))
        .or_else(|| output(context, step + 1).filter(|it| it.value != "0").map(signal))
}

fn output<'c>(context: &Context<'c>, step: usize) -> Option<&'c Output> {
    match context.trace.get(step)?.what {
        Action::Output(output) => Some(output),
        _ => None,
    }
}

/// What the waits take in a cycle, J; none for a program that does not come to its end.
fn energy(context: &Context<'_>, steps: &[usize]) -> Option<f64> {
    let is_whole = !context.unresolved.iter().any(|note| note.reason == NO_END);
    let has_energy = is_whole && context.model.is_some_and(Model::has_dynamics);
    let cycle = context.cycle.filter(|_| has_energy)?;
    let of = |step: &usize| {
        let (event, _) = context.trace[*step].event?;
        Some(cycle.account.events.get(event)?.iter().map(EnergyParts::energy_j).sum::<f64>())
    };
    steps.iter().map(of).sum()
}
