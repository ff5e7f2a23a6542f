//! The robot hurries, and then waits for a machine.
//!
//! ## What it does
//! Finds runs of movements that end at a stop behind which the program waits for an input that
//! comes later. Where it is not known when the input comes, only movements at `vmax` and the like
//! (5 m/s and more) right before such a wait are told. What does more than move (`MoveLDO`), and what comes
//! before it in the run, keeps its speed.
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
use super::super::edits::{replace, slower, with_speed};
use super::super::flow::{Next, Through};
use super::super::purpose::PROCESS_SPEED;
use super::super::rule::Finding;
use super::super::site::Site;
use super::super::statements::called_instruction;
use super::super::trace::Action;
use crate::rapid::builtins::Instruction;
use crate::rapid::text::Span;
use crate::retime::motion::timeline::WaitBasis;

rule!("EW201", "racing-to-wait", Speed, Text, Warning, "racing_to_wait.rs");

/// Speeds from here on are those of a robot that hurries, m/s.
const MIN_SPEED: f64 = 5.0;
/// Shortest wait that is worth a change, s.
const MIN_WAIT: f64 = 0.1;
/// Rounding of a time, s.
const ROUNDING: f64 = 1e-6;

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
        if done.duration < MIN_WAIT {
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
    // What does more than move keeps its time, and so does what comes before it.
    let last = run.iter().rposition(|site| !context.sites[*site].is_plain());
    let run = &run[last.map_or(0, |last| last + 1)..];
    let sites: Vec<_> = run.iter().map(|site| &context.sites[*site]).collect();
    if run.is_empty() || run.iter().any(|it| context.is_in_process(*it)) {
        return None;
    }
    let spans: Vec<Span> = sites.iter().map(|site| site.stmt.span).collect();
    let fastest = sites.iter().map(|site| site.facts.speed.map(|speed| speed.tcp));
    let fastest = fastest.collect::<Option<Vec<f64>>>()?.into_iter().fold(0.0, f64::max);
    let times = context.sites[index].executions.len() as f64;
    let mut found = Vec::new();
    for (name, speed) in slower(fastest).take_while(|(_, speed)| *speed >= PROCESS_SPEED) {
        let difference = context.difference(&spans, &|step| with_speed(step, speed))?;
        if difference.longer_s > slack * times {
            break;
        }
        if difference.time_s >= -ROUNDING {
            found.push((name, speed, difference));
        }
    }
    found.sort_by(|(.., a), (.., b)| b.saved.energy_j().total_cmp(&a.saved.energy_j()));
    let (name, speed, saving) =
        found.into_iter().find_map(|(name, speed, it)| Some((name, speed, it.saving().ok()?)))?;
    let faster = |site: &&&Site<'_>| site.facts.speed.is_some_and(|s| s.tcp > speed);
    let lines: Vec<String> =
        sites.iter().filter(faster).map(|site| context.line(site.stmt.span).to_string()).collect();
    let plural = if lines.len() == 1 { "" } else { "s" };
    let edits = sites.iter().filter(faster).map(|site| replace(site.speed.span, &name));
    let message = format!("the robot hurries to wait for {signal}");
    let finding = Finding::new(&RULE, context.sites[index].stmt.span, message)
        .with_saving(format!("{name} in line{plural} {}", lines.join(", ")), saving)
        .with_assumption(format!("{signal} comes when --input says"))
        .with_unsafe_fix(edits);
    Some(finding)
}

/// A movement at the largest speed right before a wait of unknown length for an input.
fn hurries(context: &Context<'_>, index: usize) -> Option<Finding> {
    let site = &context.sites[index];
    site.facts.speed.filter(|speed| speed.tcp >= MIN_SPEED)?;
    let known = site.executions.iter().any(|step| {
        let next = context.trace.get(step + 1).map(|done| &done.what);
        matches!(next, Some(Action::Wait(_, basis)) if *basis != WaitBasis::Unknown)
    });
    let next = context.next(index, Through::NoEffect);
    let waits = next.iter().all(|next| match next {
        Next::Wait(place) => {
            let instruction = context.flow.statement(*place).and_then(called_instruction);
            instruction.is_some_and(Instruction::waits_for_input)
        }
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
    let needs = "the time of the input (--input SIGNAL=SECONDS)";
    Some(Finding::new(&RULE, site.stmt.span, message).needing(needs))
}
