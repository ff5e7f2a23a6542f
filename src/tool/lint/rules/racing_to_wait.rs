//! The robot hurries, and then waits for a machine.
//!
//! ## What it does
//! Finds runs of movements that end at a stop behind which the program waits for an input that
//! comes later. Where it is not known when the input comes, only movements at `vmax` and the like
//! (5 m/s and more) right before such a wait are told.
//!
//! ## Why it wastes energy
//! Acceleration, friction and copper losses grow with speed, and the time won is spent waiting
//! with open brakes.
//!
//! ## How the saving is computed
//! The run is laid on a time line with each slower predefined speed and the wait behind it made
//! shorter; the speed that saves most without a longer cycle is proposed.
//!
//! ## Example
//! ```text
//! MoveJ pMachine, vmax, fine, tGrip;
//! WaitDI diDone, 1;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveJ pMachine, v800, fine, tGrip;
//! WaitDI diDone, 1;
//! ```
//!
//! ## Safety
//! Unsafe: the path and the order stay, but the time of the input may not always be that long.
//!
//! ## Assumptions
//! The input comes when `--input` or the configuration says.

use super::super::context::Context;
use super::super::edits::{replace, slower};
use super::super::flow::{Next, Through};
use super::super::rule::{Applicability, Finding, Fix};
use super::super::saving::Weighed;
use super::super::site::Site;
use super::super::trace::Action;
use crate::rapid::builtins::{self, Instruction};
use crate::rapid::ir::hir::{Callee, StmtKind};
use crate::rapid::ir::movement::{Movement, Speed};
use crate::rapid::text::Span;
use crate::retime::motion::Step;
use crate::retime::motion::timeline::WaitBasis;

rule!("EW201", "racing-to-wait", Speed, Text, Warning, "racing_to_wait.rs");

/// Speeds from here on are those of a robot that hurries, m/s.
const HURRY: f64 = 5.0;
/// Shortest wait that is worth a change, s.
const SHORTEST: f64 = 0.1;
/// Rounding of a time, s.
const LATE: f64 = 1e-6;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for (index, site) in context.sites.iter().enumerate() {
        if !site.is_plain() || !site.is_stop() || !site.reachable {
            continue;
        }
        let finding = match waits_behind(context, index) {
            Some((signal, slack)) => slower_run(context, index, &signal, slack),
            None => hurries(context, index),
        };
        findings.extend(finding);
    }
}

/// The input that is waited for, with its time known, right behind each execution, and the
/// shortest of these waits, s.
pub(super) fn waits_behind(context: &Context<'_>, index: usize) -> Option<(String, f64)> {
    let mut found: Option<(String, f64)> = None;
    for step in &context.sites[index].executions {
        let done = context.trace.get(step + 1)?;
        let Action::Wait(wait, WaitBasis::Input) = &done.what else { return None };
        if done.duration < SHORTEST {
            return None;
        }
        let slack = found.map_or(done.duration, |(_, slack)| slack.min(done.duration));
        found = Some((wait.signal.as_ref()?.to_string(), slack));
    }
    found
}

/// The movements of the run that ends with a movement, if they are the same statements each time.
pub(super) fn run_of(context: &Context<'_>, index: usize) -> Option<Vec<usize>> {
    let mut found: Option<Vec<Span>> = None;
    for step in &context.sites[index].executions {
        let (run, ..) = context.record(*step)?;
        let spans: Vec<Span> = run.moves.iter().map(|record| record.movement.span).collect();
        if found.as_ref().is_some_and(|found| *found != spans) {
            return None;
        }
        found = Some(spans);
    }
    found?.iter().map(|span| context.site_of(*span)).collect()
}

/// A finding with the speed that saves most in the run that ends with a movement, if the robot
/// is no later than `slack` s by it each time.
pub(super) fn slower_run(
    context: &Context<'_>,
    index: usize,
    signal: &str,
    slack: f64,
) -> Option<Finding> {
    let run = run_of(context, index)?;
    let sites: Vec<_> = run.iter().map(|site| &context.sites[*site]).collect();
    if sites.iter().any(|site| !site.is_plain()) {
        return None;
    }
    let spans: Vec<Span> = sites.iter().map(|site| site.stmt.span).collect();
    let fastest = sites.iter().map(|site| site.facts.speed.map(|speed| speed.tcp));
    let fastest = fastest.collect::<Option<Vec<f64>>>()?.into_iter().fold(0.0, f64::max);
    let mut best: Option<(String, f64, Weighed, f64)> = None;
    for (name, speed) in slower(fastest) {
        let times = context.sites[index].executions.len() as f64;
        let change = |step: &Step| with_speed(step, speed);
        let difference = context.difference(&spans, &change)?;
        if difference.longer_s > slack * times {
            break;
        }
        let weighed = difference.weighed();
        let Weighed::Saves(saving) = weighed else { continue };
        if saving.time_s < -LATE {
            continue;
        }
        if best.as_ref().is_none_or(|(_, _, _, most)| saving.energy_j > *most) {
            best = Some((name, speed, weighed, saving.energy_j));
        }
    }
    let (name, speed, weighed, _) = best?;
    let site = &context.sites[index];
    let message = format!("the robot hurries to wait for {signal}");
    let mut finding = Finding::new(&RULE, site.stmt.span, message);
    let faster = |site: &&&Site<'_>| site.facts.speed.is_some_and(|s| s.tcp > speed);
    let lines: Vec<String> =
        sites.iter().filter(faster).map(|site| context.line(site.stmt.span).to_string()).collect();
    let plural = if lines.len() == 1 { "" } else { "s" };
    finding.change = format!("{name} in line{plural} {}", lines.join(", "));
    finding.saving = weighed.saving().ok()?;
    finding.assumptions.push(format!("{signal} comes when --input says"));
    let edits = sites.iter().filter(faster).map(|site| replace(site.speed.span, &name)).collect();
    finding.fix = Some(Fix { applicability: Applicability::Unsafe, edits });
    Some(finding)
}

/// A movement that is at most so fast, m/s.
pub(super) fn with_speed(step: &Step, most: f64) -> Vec<Step> {
    match step {
        Step::Move(movement) if movement.speed.tcp > most => {
            let speed = Speed { tcp: most, ..movement.speed };
            vec![Step::Move(Box::new(Movement { speed, ..(**movement).clone() }))]
        }
        other => vec![other.clone()],
    }
}

/// A movement at the largest speed right before a wait of unknown length for an input.
fn hurries(context: &Context<'_>, index: usize) -> Option<Finding> {
    let site = &context.sites[index];
    site.facts.speed.filter(|speed| speed.tcp >= HURRY)?;
    let known = site.executions.iter().any(|step| {
        context.trace.get(step + 1).is_some_and(|done| match &done.what {
            Action::Wait(_, basis) => *basis != WaitBasis::Unknown,
            _ => false,
        })
    });
    let next = context.next(index, Through::Quiet);
    let waits = next.iter().all(|next| match next {
        Next::Wait(place) => context.flow.statement(*place).is_some_and(|stmt| match &stmt.kind {
            StmtKind::Call(call) => match &call.callee {
                Callee::Name(name) => {
                    builtins::instruction(&name.key).is_some_and(Instruction::waits_for_input)
                }
                Callee::Late(_) => false,
            },
            _ => false,
        }),
        _ => false,
    });
    if known || !waits || next.is_empty() {
        return None;
    }
    let written = context.text(site.speed.span);
    let message = format!(
        "{} hurries with {written} to wait for an input: --input SIGNAL=SECONDS tells what slower \
         travel saves",
        site.name
    );
    Some(Finding::new(&RULE, site.stmt.span, message))
}
