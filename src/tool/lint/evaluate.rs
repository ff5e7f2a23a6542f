//! The saving of a change of movements or waits: the part of the cycle around it is simulated again
//! and compared.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

use super::known::Known;
use super::saving::{Evaluation, SavesNothing, Saving};
use super::trace::{self, Action, TraceStep, run};
use crate::arm::dynamics::Load;
use crate::arm::robot::Model;
use crate::rapid::ir::movement::Wait;
use crate::rapid::text::Span;
use crate::retime::energy::account::at_rest;
use crate::retime::energy::moments::Moments;
use crate::retime::energy::plausible::Interval;
use crate::retime::energy::{Account, EnergyParts};
use crate::retime::motion::timeline::{Event, Run, Simulation, WaitBasis, What};
use crate::retime::motion::{Options, Step, replay};
use crate::retime::path::joint_path::{Joints, are_close};

/// Maximum distance of equal joint positions, rad.
pub(super) const POSITION_TOLERANCE: f64 = 1e-4;
/// Maximum number of later runs whose start a change may affect.
const MAX_RUNS_BEHIND: usize = 3;
/// Maximum number of executions of a statement for which a saving is computed.
const MAX_EXECUTIONS: usize = 2_000;

/// One simulated cycle of a program.
pub struct Cycle {
    /// Its events.
    pub simulation: Simulation,
    /// Its energy.
    pub account: Account,
    /// Options of the simulation.
    pub options: Options,
    /// The runs of this simulation and of earlier ones.
    known: Known,
    /// The events of each statement, in order.
    events: BTreeMap<Span, Vec<usize>>,
    /// Whether the program continues during a movement (`\Conc`).
    concurrent: bool,
}

impl Cycle {
    /// A cycle from its simulation and energy.
    pub fn new(
        simulation: Simulation,
        account: Account,
        options: &Options,
        known: &Known,
    ) -> Cycle {
        let mut events: BTreeMap<Span, Vec<usize>> = BTreeMap::new();
        let mut concurrent = false;
        for step in trace::of_events(&simulation.events) {
            if let (Action::Move(_) | Action::Wait(..), Some((event, _))) = (&step.what, step.event)
            {
                events.entry(step.what.span()).or_default().push(event);
            }
            concurrent |= step.what.movement().is_some_and(|movement| movement.concurrent);
        }
        let options = known.options(options);
        let known = known.clone();
        Cycle { simulation, account, options, known, events, concurrent }
    }

    /// The events of some statements, in order.
    fn events_of(&self, spans: &[Span]) -> Vec<usize> {
        let places = spans.iter().filter_map(|span| self.events.get(span));
        let events: BTreeSet<usize> = places.flatten().copied().collect();
        events.into_iter().collect()
    }
}

/// The steps that replace a step of a changed statement.
pub type Change<'f> = dyn Fn(&Step) -> Vec<Step> + Sync + 'f;

/// The effect of a change on the cycle.
pub struct Difference<'c> {
    model: &'c Model,
    cycle: &'c Cycle,
    parts: Vec<Replayed>,
    rests: Vec<Rest>,
    /// Saved energy.
    pub saved: EnergyParts,
    /// Saved time, s.
    pub time_s: f64,
    /// Increase of the cycle time if no wait absorbed it, s.
    pub longer_s: f64,
}

impl Difference<'_> {
    /// Its saving; an error if the interval of the saving over the plausible robots includes zero. The
    /// interval takes more time than the difference.
    pub fn saving(&self) -> Result<Saving, SavesNothing> {
        let energy_j = self.saved.energy_j();
        if energy_j <= 0.0 {
            return Err(SavesNothing);
        }
        let (low_j, high_j) = match self.cycle.known.robots() {
            Some(robots) => {
                let changes = robots.changes(self.model, &self.saved_moments());
                let plausible: Vec<f64> =
                    changes.iter().map(|change| energy_j + change.energy_j()).collect();
                let Interval { low, high, .. } = Interval::from_values(&plausible);
                (low, high)
            }
            None => (energy_j, energy_j),
        };
        if low_j <= 0.0 {
            return Err(SavesNothing);
        }
        Ok(Saving { energy_j, low_j, high_j, time_s: self.time_s })
    }

    /// Energy moments of the saving, summed over the replayed parts.
    fn saved_moments(&self) -> Moments {
        let model = self.model;
        let mut sums = Moments::none(model);
        for Replayed { range, after, .. } in &self.parts {
            for event in &self.cycle.simulation.events[range.clone()] {
                sums.add(&Moments::from_event(model, event), 1.0);
            }
            for event in &after.events {
                sums.add(&Moments::from_event(model, event), -1.0);
            }
        }
        for rest in &self.rests {
            let mut of = Moments::none(model);
            of.rest(model, &rest.load, &rest.q, rest.longer_s.abs());
            sums.add(&of, -rest.longer_s.signum());
        }
        sums
    }
}

/// Evaluates a change of every execution of the statements at `spans`.
pub fn evaluate(model: &Model, cycle: &Cycle, spans: &[Span], change: &Change<'_>) -> Evaluation {
    difference(model, cycle, spans, change).map(|it| it.saving()).transpose()
}

/// The effect of a change of every execution of the statements at `spans`; `None` if it cannot be
/// simulated.
pub fn difference<'c>(
    model: &'c Model,
    cycle: &'c Cycle,
    spans: &[Span],
    change: &Change<'_>,
) -> Option<Difference<'c>> {
    if !model.has_dynamics() {
        return None;
    }
    let (parts, mut rests) = replayed(model, cycle, spans, change)?;
    let (more, time_s) = saved_time(cycle, &cycle.options.inputs, &parts);
    let (_, alone_s) = saved_time(cycle, &BTreeMap::new(), &parts);
    rests.extend(more);
    let mut saved = EnergyParts::default();
    for Replayed { range, after, .. } in &parts {
        for part in cycle.account.events[range.clone()].iter().flatten() {
            saved += *part;
        }
        saved += cycle.known.account(after).total * -1.0;
    }
    for rest in &rests {
        let lasts = rest.longer_s.abs();
        saved += at_rest(model, &rest.load, &rest.q, lasts) * -rest.longer_s.signum();
    }
    Some(Difference { model, cycle, parts, rests, saved, time_s, longer_s: -alone_s })
}

/// A range of events, and its simulation after a change.
struct Replayed {
    range: RangeInclusive<usize>,
    after: Simulation,
    /// Increase of the rest after it, s.
    longer_s: f64,
}

/// A longer or shorter standstill.
struct Rest {
    load: Load,
    q: Joints,
    longer_s: f64,
}

/// The parts of the cycle that a change affects, and the rests after them.
fn replayed(
    model: &Model,
    cycle: &Cycle,
    spans: &[Span],
    change: &Change<'_>,
) -> Option<(Vec<Replayed>, Vec<Rest>)> {
    let simulation = &cycle.simulation;
    let changed = cycle.events_of(spans);
    if changed.is_empty() || changed.len() > MAX_EXECUTIONS || cycle.concurrent {
        return None;
    }
    let (mut replayed, mut rests) = (Vec::new(), Vec::new());
    let mut next = 0;
    while next < changed.len() {
        let mut window = window(simulation, changed[next], spans, change);
        next += 1;
        while let Some(event) = changed.get(next) {
            let further = self::window(simulation, *event, spans, change);
            // A wait behind a changed run needs that run.
            if event > window.end() && *further.start() > changed[next - 1] {
                break;
            }
            window = *window.start()..=*further.end();
            next += 1;
        }
        let (range, after, rest) = extended_window(model, cycle, window, spans, change)?;
        while next < changed.len() && changed[next] <= *range.end() {
            next += 1;
        }
        let behind = rest_behind(simulation, &range, &after, rest);
        let longer_s = behind.as_ref().map_or(0.0, |rest| rest.longer_s);
        rests.extend(behind);
        replayed.push(Replayed { range, after, longer_s });
    }
    Some((replayed, rests))
}

/// From the run at or before an event to the next run. Only the event itself if it is a run that
/// also stops after the change: then the next run starts as before.
fn window(
    simulation: &Simulation,
    event: usize,
    spans: &[Span],
    change: &Change<'_>,
) -> RangeInclusive<usize> {
    if run(&simulation.events[event]).is_some_and(|run| stops(run, spans, change)) {
        return event..=event;
    }
    let is_run = |index: &usize| run(&simulation.events[*index]).is_some();
    let first = (0..=event).rev().find(is_run).unwrap_or(event);
    first..=next_run(simulation, event)
}

/// Whether a run ends at a stop point after a change.
fn stops(run: &Run, spans: &[Span], change: &Change<'_>) -> bool {
    let Some(last) = run.moves.last() else { return false };
    if !spans.contains(&last.movement.span) {
        return last.movement.zone.fine;
    }
    let changed = change(&Step::Move(Box::new(last.movement.clone())));
    matches!(changed.last(), Some(Step::Move(movement)) if movement.zone.fine)
}

/// The last run of events.
fn last_run(events: &[Event]) -> Option<&Run> {
    events.iter().rev().find_map(run)
}

/// Whether the robot may be anywhere after an event: what follows does not depend on what was before.
fn is_elsewhere(event: &Event) -> bool {
    matches!(&event.what, What::Left(left) if left.moves)
}

/// The next run after an event, or the last event before the robot may be anywhere.
fn next_run(simulation: &Simulation, event: usize) -> usize {
    for index in event + 1..simulation.events.len() {
        if run(&simulation.events[index]).is_some() {
            return index;
        }
        if is_elsewhere(&simulation.events[index]) {
            return index - 1;
        }
    }
    simulation.events.len() - 1
}

/// Extends the window until the robot ends at the same place as before the change. Returns it with
/// its replay and the rest (s) that a directly following movement would add.
fn extended_window(
    model: &Model,
    cycle: &Cycle,
    window: RangeInclusive<usize>,
    spans: &[Span],
    change: &Change<'_>,
) -> Option<(RangeInclusive<usize>, Simulation, f64)> {
    let simulation = &cycle.simulation;
    let (first, mut last) = window.into_inner();
    let mut runs = simulation.events[..first].iter().rev().filter_map(run);
    let before = runs.find_map(|run| run.moves.last()).map(|record| &record.movement);
    for _ in 0..=MAX_RUNS_BEHIND {
        let (start, steps) = steps(cycle, first..=last, spans, change)?;
        let (after, rest) = replay(model, &cycle.options, start, before, steps);
        let sound = after.events.iter().all(|event| match &event.what {
            What::Run(run) => run.problem.is_none(),
            What::Left(_) => false,
            _ => true,
        });
        if !sound {
            return None;
        }
        let was = last_run(&simulation.events[..=last])?.end;
        let is = last_run(&after.events).map_or(start, |run| run.end);
        let next = simulation.events.get(last + 1);
        if are_close(&was, &is, POSITION_TOLERANCE) || next.is_none_or(is_elsewhere) {
            return Some((first..=last, after, rest));
        }
        last = next_run(simulation, last);
    }
    None
}

/// The steps of a window with the change, and the robot position at its start.
fn steps(
    cycle: &Cycle,
    window: RangeInclusive<usize>,
    spans: &[Span],
    change: &Change<'_>,
) -> Option<(Joints, Vec<Step>)> {
    let events = &cycle.simulation.events[window];
    let mut runs = events.iter().filter_map(run);
    if runs.any(|run| !run.start_known || run.problem.is_some()) {
        return None;
    }
    let start = events.iter().find_map(|event| match &event.what {
        What::Run(run) => Some(run.start),
        What::Wait(wait) => Some(wait.q),
        _ => None,
    });
    let mut steps = Vec::new();
    for TraceStep { what, duration, .. } in trace::of_events(events) {
        let step = match what {
            Action::Move(movement) => Step::Move(Box::new(movement.clone())),
            Action::Wait(wait, basis) => Step::Wait(Box::new(Wait {
                duration: Some(duration),
                max_time: None,
                // Only a wait for an input of stated time changes its length.
                signal: wait.signal.clone().filter(|_| basis == WaitBasis::Input),
                ..wait.clone()
            })),
            Action::Output(output) => Step::Output(Box::new(output.clone())),
            Action::Left(_) => return None,
        };
        if !matches!(step, Step::Output(_)) && spans.contains(&what.span()) {
            steps.extend(change(&step));
        } else {
            steps.push(step);
        }
    }
    Some((start?, steps))
}

/// The rest between the last run of a window and a directly following run; a replay does not
/// include it.
fn rest_behind(
    simulation: &Simulation,
    window: &RangeInclusive<usize>,
    after: &Simulation,
    longer_s: f64,
) -> Option<Rest> {
    let next = simulation.events[window.end() + 1..].iter().find(|it| !it.is_within_next_run());
    let moves_on = next.is_some_and(|it| it.duration > 0.0 && run(it).is_some());
    let last = after.events.last().filter(|event| moves_on && event.duration > 0.0)?;
    run(last).map(|run| Rest { load: run.load.clone(), q: run.end, longer_s })
}

/// The additional rests in waits for inputs of stated time, and the saved time of the cycle: such a
/// wait absorbs an earlier delay.
fn saved_time(
    cycle: &Cycle,
    inputs: &BTreeMap<String, f64>,
    replayed: &[Replayed],
) -> (Vec<Rest>, f64) {
    let simulation = &cycle.simulation;
    if inputs.is_empty() {
        // No wait absorbs a delay: only the replayed parts change.
        let saved = replayed.iter().map(|Replayed { range, after, longer_s }| {
            let before: f64 = simulation.events[range.clone()].iter().map(|it| it.duration).sum();
            before - after.events.iter().map(|it| it.duration).sum::<f64>() - longer_s
        });
        return (Vec::new(), saved.sum());
    }
    let mut clock = Clock { inputs, waited: BTreeMap::new(), time: 0.0 };
    let mut more = Vec::new();
    let mut index = 0;
    let mut windows = replayed.iter().peekable();
    while index < simulation.events.len() {
        if let Some(part) = windows.next_if(|part| *part.range.start() == index) {
            more.extend(part.after.events.iter().filter_map(|event| clock.advance(event, true)));
            clock.time += part.longer_s;
            index = part.range.end() + 1;
        } else {
            more.extend(clock.advance(&simulation.events[index], false));
            index += 1;
        }
    }
    (more, simulation.cycle_s - clock.time)
}

struct Clock<'c> {
    inputs: &'c BTreeMap<String, f64>,
    waited: BTreeMap<String, f64>,
    time: f64,
}

impl Clock<'_> {
    /// Advances by an event; returns the additional rest of a wait.
    fn advance(&mut self, event: &Event, replayed: bool) -> Option<Rest> {
        let mut duration = event.duration;
        let mut more = None;
        if let What::Wait(wait) = &event.what
            && (replayed || wait.basis == WaitBasis::Input)
            && let Some(signal) = &wait.wait.signal
            && let Some(delay) = self.inputs.get(&signal.to_lowercase())
        {
            let key = signal.to_lowercase();
            let at = self.waited.get(&key).copied().unwrap_or(0.0) + delay;
            duration = (at - self.time).max(0.0);
            let longer_s = duration - event.duration;
            more = Some(Rest { load: wait.load.clone(), q: wait.q, longer_s });
            self.waited.insert(key, self.time + duration);
        }
        self.time += duration;
        more
    }
}
