//! The robot travels through free air at a speed at which it takes more energy than at a higher one.
//!
//! ## What it does
//! Finds joint movements and lines that the programmed speed limits, lines of at least 200 mm/s, and looks
//! for the predefined speed at which they take fewest joules. Movements of a procedure with the same
//! written speed are one finding. While a speed override is below 100 % nothing is told: EW603 comes first.
//!
//! ## Why it wastes energy
//! The base load, the open brakes and the holding of the arm run for as long as the way takes. Slow
//! travel spares friction and copper loss, but below some speed it spares less than the time costs.
//!
//! ## How the saving is computed
//! Two of these movements are laid on a time line with each higher predefined speed, as long as each step
//! saves at least 1 J more by what these two stand for; the best one is proposed. Its saving is that of all
//! these movements with the written speed and with this one.
//!
//! ## Example
//! ```text
//! MoveJ pOverPick, v300, z50, tGrip;
//! MoveJ pOverPlace, v300, z50, tGrip;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveJ pOverPick, v1500, z50, tGrip;
//! MoveJ pOverPlace, v1500, z50, tGrip;
//! ```
//!
//! ## Safety
//! Unsafe: the path stays, but everything on it comes faster: a part may be held too weakly, hoses
//! may swing, and the speed may be meant, as where people stand near. Without a fix, and with low
//! confidence, where a part is carried or a joint movement is slower than 200 mm/s.
//!
//! ## Assumptions
//! A line slower than 200 mm/s is a process, and so is what has an output that is on for lines and arcs
//! alone. Lines next to work (an output, a wait, another tool or load) or next to a movement slower than
//! 200 mm/s, lines along the tool's axis, lines of less than 150 mm and lines next to such a one across the axis
//! are ways into or out of it, or contours, and keep their speed. So do joint movements of less than 150 mm
//! that are next to work or slower than 200 mm/s, and movements from an unknown place, such as the first one.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use super::super::context::Context;
use super::super::edits::{faster, replace, with_predefined_speed};
use super::super::rule::Finding;
use super::super::settings::THRESHOLD_J;
use crate::rapid::builtins::MoveForm;
use crate::rapid::ir::movement::Settings;
use crate::rapid::ir::program::RoutineId;
use crate::rapid::text::Span;
use crate::retime::motion::pace::Pace;
use crate::retime::motion::timing::grid::SpeedBound;

rule!("EW206", "slow-travel", Speed, Robot, Info, "slow_travel.rs");

/// Shorter ways may belong to work, m: as in EW101.
const MIN_WAY: f64 = 0.15;
/// Largest cosine between the tool's axis and a way across it: tools may lean by 30°.
const MAX_ACROSS: f64 = 0.5;
/// Statements on which the best speed is looked for, to save time; the saving is simulated for all of them.
const SAMPLE: usize = 2;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let mut groups: BTreeMap<(RoutineId, String), Vec<usize>> = BTreeMap::new();
    for (index, site) in context.sites.iter().enumerate() {
        if travels(context, index) {
            let written = context.text(site.speed.span).to_lowercase();
            groups.entry((site.place.0, written)).or_default().push(index);
        }
    }
    findings.extend(groups.into_values().filter_map(|sites| faster_travel(context, &sites)));
}

/// Whether a movement only travels, and its programmed speed limits it.
fn travels(context: &Context<'_>, index: usize) -> bool {
    let site = &context.sites[index];
    let is_limited = |step: &usize| {
        let record = context.record(*step);
        record.is_some_and(|(_, it, _)| it.pace == Pace::Speed(SpeedBound::Programmed))
    };
    let long = || site.executions.iter().all(|step| way(context, *step).norm() >= MIN_WAY);
    let goes_in = || site.executions.iter().any(|step| is_along_tool(context, *step));
    // A lowered override is a finding of its own: without it the speed may be right.
    let full = |settings: &Settings| settings.speed_override >= 1.0 && settings.refresh >= 1.0;
    let free = if site.is_linear() {
        let path = context.is_next_to_slow(index)
            || site.executions.iter().any(|step| is_on_contour(context, *step));
        !(context.is_process(index) || context.is_next_to_work(index) || path || goes_in())
    } else {
        !context.is_in_process(index)
    };
    let short_is_free =
        !site.is_linear() && !context.is_next_to_work(index) && !context.is_process(index);
    // Where the robot comes from is not known: neither are the joules, nor what is on the way.
    let starts = |step: &usize| {
        let before = context.trace[..*step].iter().rfind(|done| done.what.moves());
        before.is_none_or(|done| done.what.movement().is_none())
    };
    site.is_plain()
        && site.signature.form != MoveForm::Circular
        && !site.executions.iter().any(starts)
        && site.executions.iter().any(is_limited)
        && context.always(index, full)
        && free
        && (short_is_free || long())
}

/// Whether the line before or behind an execution is short and across the tool's axis, as on a contour and
/// between the lanes of a meander.
fn is_on_contour(context: &Context<'_>, step: usize) -> bool {
    let is_side_step = |step: usize| {
        let form = context.trace[step].what.movement().map(|movement| movement.form);
        let is_line = matches!(form, Some(MoveForm::Linear | MoveForm::Circular));
        let way = way(context, step).norm();
        is_line && way > 0.0 && way < MIN_WAY && !is_along_tool(context, step)
    };
    context.neighbours(step).is_some_and(|(a, b)| is_side_step(a) || is_side_step(b))
}

/// Whether a movement goes into or out of something in an execution: along the tool's axis.
fn is_along_tool(context: &Context<'_>, step: usize) -> bool {
    let way = way(context, step);
    let axis = context.pose(step).map(|pose| pose.rotation * Vector3::z());
    axis.is_none_or(|axis| axis.dot(&way).abs() > MAX_ACROSS * way.norm())
}

/// The way of the tool in an execution, m; none if it is unknown.
fn way(context: &Context<'_>, step: usize) -> Vector3<f64> {
    let before = context.trace[..step].iter().rposition(|done| done.what.moves());
    let from = before.and_then(|before| context.pose(before));
    let ends = from.zip(context.pose(step));
    ends.map_or_else(Vector3::zeros, |(from, to)| to.translation.vector - from.translation.vector)
}

/// The predefined speed above `fastest` with which some statements take least energy, m/s; the
/// statements are a sample of the given ones.
fn best_speed(context: &Context<'_>, spans: &[Span], fastest: f64) -> Option<(String, f64)> {
    let sample: Vec<Span> = spans.iter().copied().step_by(spans.len().div_ceil(SAMPLE)).collect();
    let least = THRESHOLD_J * sample.len() as f64 / spans.len() as f64;
    let mut best: Option<(String, f64, f64)> = None;
    for (name, speed) in faster(fastest) {
        let difference = context.difference(&sample, &|step| with_predefined_speed(step, speed))?;
        let saved = difference.saved.energy_j();
        if saved < best.as_ref().map_or(0.0, |(.., best)| *best) + least {
            break;
        }
        best = Some((name, speed, saved));
    }
    best.map(|(name, speed, _)| (name, speed))
}

fn faster_travel(context: &Context<'_>, indices: &[usize]) -> Option<Finding> {
    let sites: Vec<_> = indices.iter().map(|site| &context.sites[*site]).collect();
    let spans: Vec<Span> = sites.iter().map(|site| site.stmt.span).collect();
    let speeds = sites.iter().map(|site| site.facts.speed.map(|speed| speed.tcp));
    let fastest = speeds.collect::<Option<Vec<f64>>>()?.into_iter().fold(0.0, f64::max);
    let (name, speed) = best_speed(context, &spans, fastest)?;
    let difference = context.difference(&spans, &|step| with_predefined_speed(step, speed))?;
    let saving = difference.saving().ok()?;
    let written = context.text(sites[0].speed.span);
    let (text, count) = match sites.len() {
        1 => (format!("{} travels", sites[0].name), String::new()),
        count => {
            (format!("{count} movements of this procedure travel"), format!(" in all {count}"))
        }
    };
    let message = format!("{text} through free air with {written}, slower than takes least energy");
    let mut finding = Finding::new(&RULE, spans[0], message)
        .with_saving(format!("{name} in place of {written}{count}"), saving)
        .for_places(sites.len())
        .with_assumption("no part, hose or person needs the lower speed");
    for span in spans.iter().skip(1) {
        finding = finding.with_related(*span, "and here");
    }
    // Faster with a part, or where the speed is that of a process, only who knows the cell can say.
    if indices.iter().any(|site| context.carries_part(*site) || context.is_process(*site)) {
        return Some(finding.doubtful());
    }
    let edits = sites.iter().map(|site| replace(site.speed.span, &name));
    Some(finding.with_unsafe_fix(edits))
}
