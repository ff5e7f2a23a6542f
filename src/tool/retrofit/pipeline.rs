//! The stages of a retrofit in their order.

use rayon::prelude::*;

use super::brakes::add_brake_note;
use super::candidate::{State, candidates, with_states};
use super::emission_context::EmissionContext;
use super::error::RetrofitError;
use super::figures::Retrofit;
use super::files::Source;
use super::goals::{check_factor, goals};
use super::guards::Guards;
use super::guided::guided;
use super::hazards::marked_sites;
use super::job::{Job, Original};
use super::lowered::lowered;
use super::planning::Planning;
use super::read::read_program;
use super::relocated_waits::relocated_waits;
use super::results::results;
use super::rewritten::Rewritten;
use super::rounds::verified;
use super::settings::{Budget, Form, Objective, Settings};
use super::sharing::{enforce_cycle_time, faster, streams, undo_costly_streams};
use super::simulated::Simulated;
use super::spacing_table::spacing_table;
use super::speeds;
use super::torque_demand::mean_robot;
use crate::arm::robot::{Model, Use, ready};
use crate::rapid::text::Span;
use crate::retime::energy::plausible::Robots;
use crate::retime::optimize::energy_curve::{TimeEnergy, pareto};
use crate::retime::optimize::idle::dwells;
use crate::retime::optimize::retime::PathUse;

/// Retrofits a program. `progress` receives the number of finished pieces and the total.
///
/// # Errors
/// An error that prevents the whole retrofit; a piece that cannot be improved stays unchanged.
pub fn retrofit(
    files: &[Source],
    model: &Model,
    settings: &Settings,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Retrofit, RetrofitError> {
    let mut result = once(files, model, settings, progress)?;
    if settings.pareto > 0 && settings.form == Form::Streams {
        let with = |other: &Settings| once(files, model, other, &|_, _| ()).ok();
        result.spacings = spacing_table(settings, &result, &with);
    }
    Ok(result)
}

/// A retrofit without the table of spacings.
fn once(
    files: &[Source],
    model: &Model,
    settings: &Settings,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Retrofit, RetrofitError> {
    ready(model, Use::Optimize)?;
    let (program, entry) = read_program(files, &settings.entry)?;
    let cycle = Simulated::new(&program, entry, model, &settings.options);
    let guards = Guards::new(&program, files, settings);
    let mut sites = marked_sites(&program, entry, &cycle.simulation, &guards, settings.form);
    sites.retain(|site| {
        let is_own = |part: Span| site.pieces.iter().any(|piece| piece.span().touches(part));
        settings.only.is_none_or(is_own)
    });
    let lowered = lowered(&program, entry, model, settings);
    let robots = if settings.point_estimate { None } else { Robots::new(model) };
    let job = Job {
        mean: mean_robot(model, robots.as_ref(), &cycle.simulation),
        settings: settings.with_shown_loads(model, &cycle.simulation),
        original: Original { files, program: &program, entry, cycle, sites, lowered },
        model,
        robots,
    };
    let (rewritten, leaves_path) = match settings.form {
        Form::Speeds => (speeds::rewritten(&job, progress), false),
        Form::Streams | Form::Guided => with_streams(&job, &guards, progress)?,
    };
    Ok(results(job, rewritten, leaves_path))
}

/// The program with streams, or with positions for externally guided motion in separate files; and
/// whether streams leave the programmed path.
fn with_streams(
    job: &Job<'_>,
    guards: &Guards<'_>,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<(Rewritten, bool), RetrofitError> {
    let Job { original, model, settings, .. } = job;
    let planning = Planning::new(job);
    let candidates = candidates(&original.sites);
    let tasks = planning.tasks(&candidates);
    let plan = goals(&planning, &candidates, &tasks)?;
    let mut outcomes = streams(&plan, &tasks, settings.budget, progress);
    match settings.budget {
        Budget::AsBefore => {
            let (plan, kept) = enforce_cycle_time(plan, &tasks, outcomes);
            outcomes = match settings.objective {
                Objective::Energy => undo_costly_streams(&plan, &tasks, kept),
                Objective::Time => faster(&tasks, kept),
            };
        }
        Budget::Factor(factor) => check_factor(factor, &tasks, &outcomes)?,
        Budget::Takt(_) => {}
    }
    let curves: Vec<Vec<TimeEnergy>> = if settings.pareto > 0 {
        tasks.par_iter().map(|(_, task)| pareto(task, settings.pareto)).collect()
    } else {
        Vec::new()
    };
    let tried: Vec<usize> = tasks.iter().map(|(index, _)| *index).collect();
    let states = tried.iter().copied().zip(outcomes.into_iter().map(State::from));
    let mut candidates = with_states(candidates, states);
    for (index, curve) in tried.into_iter().zip(curves) {
        candidates[index].pareto = curve;
    }

    let context = EmissionContext::new(job, guards);
    let waits = relocated_waits(job, &candidates);
    let mut rewritten = verified(&planning, &context, candidates, waits)?;
    let leaves_path = rewritten
        .candidates
        .iter()
        .filter_map(|candidate| candidate.retiming())
        .any(|retiming| retiming.path == PathUse::Left);
    if settings.form == Form::Guided {
        let (files, candidates) = guided(original, rewritten.candidates, &context.emission.names)?;
        rewritten.candidates = candidates;
        rewritten.outputs.files = files;
        rewritten.outputs.guards.clear();
        // The program itself does not change.
        rewritten.simulated =
            Simulated::new(original.program, original.entry, model, &settings.options);
    }
    let dwells = dwells(model, &rewritten.simulated.simulation);
    add_brake_note(&mut rewritten.outputs.files, model, &dwells);
    Ok((rewritten, leaves_path))
}
