//! The simulation of a program: of its entry, and of each procedure that starts by itself.

use std::collections::BTreeSet;

use super::entries::Entries;
use super::evaluate::Cycle;
use super::job::Job;
use super::known::Known;
use super::trace::{self, Recording, TraceStep, record};
use crate::rapid::ir::movement::Unresolved;
use crate::rapid::ir::program::{Program, RoutineId};
use crate::rapid::text::Span;
use crate::retime::motion::timeline::{Event, What};
use crate::retime::motion::{Simulation, simulate};

/// The cycle of a program; `None` without a robot, or without anything that starts. `known` belongs to
/// the robot.
pub(super) fn cycle(
    job: &Job<'_>,
    known: Option<&Known>,
    program: &Program,
    entry: Option<RoutineId>,
) -> Option<Cycle> {
    let (model, known) = job.model.zip(known)?;
    let options = known.options(&job.options);
    let run = |entry| simulate(program, entry, model, &options);
    let entries = Entries::new(program, entry);
    let mut simulation = entry.map(run);
    let mut tried: BTreeSet<RoutineId> = entry.into_iter().collect();
    loop {
        let steps = simulation.iter().flat_map(|it| trace::of_events(&it.events));
        let further = entries.further(&movements(steps), &tried);
        if further.is_empty() {
            break;
        }
        for entry in further {
            tried.insert(entry);
            simulation = Some(match simulation {
                Some(before) => joined(before, program.routine(entry).span, run(entry)),
                None => run(entry),
            });
        }
    }
    let simulation = simulation?;
    let account = known.account(&simulation);
    Some(Cycle::new(simulation, account, &job.options, known))
}

/// The actions of a program without a robot.
pub(super) fn recording(program: &Program, entry: Option<RoutineId>) -> Recording {
    let entries = Entries::new(program, entry);
    let mut all = entry.map(|entry| record(program, entry)).unwrap_or_default();
    let mut tried: BTreeSet<RoutineId> = entry.into_iter().collect();
    loop {
        let further = entries.further(&movements(all.trace()), &tried);
        if further.is_empty() {
            return all;
        }
        for entry in further {
            tried.insert(entry);
            all.append(program.routine(entry).span, record(program, entry));
        }
    }
}

/// The statements of the movements of a trace.
fn movements<'t>(trace: impl IntoIterator<Item = TraceStep<'t>>) -> BTreeSet<Span> {
    let moves = trace.into_iter().filter(|step| step.what.moves());
    moves.map(|step| step.what.span()).collect()
}

/// One simulation after another, with an unknown way between them.
fn joined(before: Simulation, start: Span, after: Simulation) -> Simulation {
    let Simulation { mut events, cycle_s, repeats_from, .. } = before;
    let reason = "a procedure that starts by itself".to_owned();
    let between = What::Left(Unresolved { span: start, reason, moves: true });
    events.push(Event { t_start: cycle_s, duration: 0.0, what: between });
    let later = |event: Event| Event { t_start: event.t_start + cycle_s, ..event };
    events.extend(after.events.into_iter().map(later));
    let mut unresolved = [before.unresolved, after.unresolved].concat();
    unresolved.sort_by_key(|note| note.span);
    unresolved.dedup_by(|a, b| a.span == b.span);
    let assumed = after.assumed.into_iter().filter(|text| !before.assumed.contains(text));
    let assumed = before.assumed.iter().cloned().chain(assumed).collect();
    let inputs_asked = &before.inputs_asked | &after.inputs_asked;
    Simulation {
        events,
        cycle_s: cycle_s + after.cycle_s,
        repeats_from,
        unresolved,
        assumed,
        inputs_asked,
    }
}
