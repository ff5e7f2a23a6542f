//! What a change of some movements or waits would save: the part of the cycle around them is
//! laid on a time line again, and the difference is taken.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use super::finding::{Per, Saving};
use crate::energy::account::at_rest;
use crate::energy::{Account, EnergyParts, account};
use crate::ir::movement::{Movement, Output, Wait};
use crate::motion::timeline::{Run, Simulation, WaitBasis, What};
use crate::motion::{Options, Step, replay};
use crate::path::joint_path::{DOF, Joints};
use crate::robot::Model;
use crate::text::Span;

/// Share by which a part of the energy may be off, without a calibration: rigid body, friction,
/// copper, drive, idle, brakes. Chosen; docs/lints.md tells them.
const DOUBT: [f64; 6] = [0.1, 0.25, 0.25, 0.5, 0.3, 0.5];
/// Largest distance between two places that count as one, rad.
const SAME: f64 = 1e-4;
/// Runs behind a change that may begin elsewhere because of it.
const MOST_BEHIND: usize = 3;
/// Executions of one statement beyond which no saving is told.
const MOST_EXECUTIONS: usize = 2_000;

/// One simulated cycle of a program.
pub struct Cycle {
    /// What happened.
    pub simulation: Simulation,
    /// The joules of it.
    pub account: Account,
    /// How it was simulated.
    pub options: Options,
    /// The events that hold each statement, in order.
    events: BTreeMap<Span, Vec<usize>>,
    /// Whether the program goes on beside a movement.
    concurrent: bool,
}

impl Cycle {
    /// Of a simulation and its energy.
    pub fn new(simulation: Simulation, account: Account, options: Options) -> Cycle {
        let mut events: BTreeMap<Span, Vec<usize>> = BTreeMap::new();
        let mut concurrent = false;
        for (index, event) in simulation.events.iter().enumerate() {
            let mut add = |span: Span| {
                let places = events.entry(span).or_default();
                if places.last() != Some(&index) {
                    places.push(index);
                }
            };
            match &event.what {
                What::Run(run) => {
                    for record in &run.moves {
                        add(record.movement.span);
                        concurrent |= record.movement.concurrent;
                    }
                }
                What::Wait(wait) => add(wait.wait.span),
                What::Output(..) | What::Left(_) => {}
            }
        }
        Cycle { simulation, account, options, events, concurrent }
    }

    /// Events that hold one of some statements, in order.
    fn touched(&self, spans: &[Span]) -> Vec<usize> {
        let places = spans.iter().filter_map(|span| self.events.get(span));
        let mut touched: Vec<usize> = places.flatten().copied().collect();
        touched.sort_unstable();
        touched.dedup();
        touched
    }
}

/// A change saves nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("it saves nothing; leave it as it is")]
pub struct Worthless;

/// What came out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weighed {
    /// Nothing can be said.
    Unknown,
    /// It saves nothing, or may as well cost.
    Nothing,
    /// It saves this.
    Saves(Saving),
}

impl Weighed {
    /// The saving, if there is one.
    ///
    /// # Errors
    /// The change saves nothing.
    pub fn saving(self) -> Result<Option<Saving>, Worthless> {
        match self {
            Weighed::Unknown => Ok(None),
            Weighed::Nothing => Err(Worthless),
            Weighed::Saves(saving) => Ok(Some(saving)),
        }
    }
}

/// What becomes of a step whose statement was asked for.
pub type Change<'f> = dyn Fn(&Step) -> Vec<Step> + Sync + 'f;

/// What a change does to the cycle.
#[derive(Clone, Copy, Debug)]
pub struct Difference {
    /// Energy that it saves.
    pub saved: EnergyParts,
    /// Time that it saves, s.
    pub time_s: f64,
    /// Time that it would take more without any wait that takes it up, s.
    pub longer_s: f64,
}

impl Difference {
    /// What it is worth.
    pub fn weighed(&self) -> Weighed {
        let parts = &self.saved;
        let energy_j = parts.energy_j();
        let list = [
            parts.mechanical_j,
            parts.friction_j,
            parts.copper_j,
            parts.drive_j,
            parts.idle_j,
            parts.brake_j,
        ];
        let off: f64 = list.iter().zip(DOUBT).map(|(part, share)| part.abs() * share).sum();
        let (low_j, high_j) = (energy_j - off, energy_j + off);
        if low_j <= 0.0 {
            return Weighed::Nothing;
        }
        Weighed::Saves(Saving { energy_j, low_j, high_j, time_s: self.time_s, per: Per::Cycle })
    }
}

/// Weighs a change of every execution of the statements at `spans`.
pub fn weigh(model: &Model, cycle: &Cycle, spans: &[Span], change: &Change<'_>) -> Weighed {
    difference(model, cycle, spans, change).map_or(Weighed::Unknown, |it| it.weighed())
}

/// What a change of every execution of the statements at `spans` does; `None` where it can't be
/// told.
pub fn difference(
    model: &Model,
    cycle: &Cycle,
    spans: &[Span],
    change: &Change<'_>,
) -> Option<Difference> {
    if !model.has_dynamics() {
        return None;
    }
    let (saved, replayed) = replayed(model, cycle, spans, change)?;
    let (more, time_s) = laid_out(model, cycle, &cycle.options.inputs, &replayed);
    let (_, alone_s) = laid_out(model, cycle, &BTreeMap::new(), &replayed);
    Some(Difference { saved: saved - more, time_s, longer_s: -alone_s })
}

/// A part of the cycle, as events, with what it is after a change and the rest behind it, s.
type Replayed = (RangeInclusive<usize>, Simulation, f64);

/// The parts of the cycle that a change touches, and the energy that is saved in them.
fn replayed(
    model: &Model,
    cycle: &Cycle,
    spans: &[Span],
    change: &Change<'_>,
) -> Option<(EnergyParts, Vec<Replayed>)> {
    let simulation = &cycle.simulation;
    let touched = cycle.touched(spans);
    if touched.is_empty() || touched.len() > MOST_EXECUTIONS || cycle.concurrent {
        return None;
    }
    let mut saved = EnergyParts::default();
    let mut replayed: Vec<Replayed> = Vec::new();
    let mut next = 0;
    while next < touched.len() {
        let mut window = window(simulation, touched[next], spans, change);
        next += 1;
        while next < touched.len() && touched[next] <= *window.end() {
            let further = self::window(simulation, touched[next], spans, change);
            window = *window.start()..=*further.end();
            next += 1;
        }
        let (range, after, rest) = settle_window(model, cycle, window, spans, change)?;
        while next < touched.len() && touched[next] <= *range.end() {
            next += 1;
        }
        let (more, longer) = rest_behind(model, simulation, &range, &after, rest);
        let parts = &cycle.account.events[range.clone()];
        let mut before = EnergyParts::default();
        for part in parts.iter().flatten() {
            before += *part;
        }
        saved += before - account(model, &after).total - more;
        replayed.push((range, after, longer));
    }
    Some((saved, replayed))
}

/// From the run at or before an event to the next run; to the event alone if it is a run that
/// stops at its end after the change as before: the next run begins as it did.
fn window(
    simulation: &Simulation,
    event: usize,
    spans: &[Span],
    change: &Change<'_>,
) -> RangeInclusive<usize> {
    if let What::Run(run) = &simulation.events[event].what
        && stops(run, spans, change)
    {
        return event..=event;
    }
    let is_run = |index: &usize| matches!(simulation.events[*index].what, What::Run(_));
    let first = (0..=event).rev().find(is_run).unwrap_or(event);
    first..=next_run(simulation, event)
}

/// Whether the last movement of a run is a stop point after a change.
fn stops(run: &Run, spans: &[Span], change: &Change<'_>) -> bool {
    let Some(last) = run.moves.last() else { return false };
    if !spans.contains(&last.movement.span) {
        return last.movement.zone.fine;
    }
    let changed = change(&Step::Move(Box::new(last.movement.clone())));
    matches!(changed.last(), Some(Step::Move(movement)) if movement.zone.fine)
}

/// The last movement before an event.
fn movement_before(simulation: &Simulation, event: usize) -> Option<&Movement> {
    simulation.events[..event].iter().rev().find_map(|event| match &event.what {
        What::Run(run) => run.moves.last().map(|record| &record.movement),
        _ => None,
    })
}

/// The next run behind an event, or the last event.
fn next_run(simulation: &Simulation, event: usize) -> usize {
    let last = simulation.events.len() - 1;
    let mut behind = event + 1..=last;
    behind.find(|i| matches!(simulation.events[*i].what, What::Run(_))).unwrap_or(last)
}

/// The window with its replay, made longer until the robot stands where it stood, and the rest
/// that a movement right behind would add, s.
fn settle_window(
    model: &Model,
    cycle: &Cycle,
    window: RangeInclusive<usize>,
    spans: &[Span],
    change: &Change<'_>,
) -> Option<(RangeInclusive<usize>, Simulation, f64)> {
    let simulation = &cycle.simulation;
    let (first, mut last) = window.into_inner();
    let before = movement_before(simulation, first);
    for _ in 0..=MOST_BEHIND {
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
        let ends = |simulation: &Simulation, upto: usize| {
            simulation.events[..upto].iter().rev().find_map(|event| match &event.what {
                What::Run(run) => Some(run.end),
                _ => None,
            })
        };
        let was = ends(simulation, last + 1)?;
        let is = ends(&after, after.events.len()).unwrap_or(start);
        if apart(&was, &is) <= SAME || last + 1 == simulation.events.len() {
            return Some((first..=last, after, rest));
        }
        last = next_run(simulation, last);
    }
    None
}

fn apart(a: &Joints, b: &Joints) -> f64 {
    (0..DOF).map(|j| (a[j] - b[j]).abs()).fold(0.0, f64::max)
}

/// What was done in a window, with the change, and where the robot stood at first.
fn steps(
    cycle: &Cycle,
    window: RangeInclusive<usize>,
    spans: &[Span],
    change: &Change<'_>,
) -> Option<(Joints, Vec<Step>)> {
    let mut start = None;
    let mut steps = Vec::new();
    // Outputs between fly-by movements stand before the run that they belong into.
    let mut held: Vec<(usize, &Output)> = Vec::new();
    let output = |(_, output): (usize, &Output)| Step::Output(Box::new(output.clone()));
    for event in &cycle.simulation.events[window] {
        match &event.what {
            What::Run(run) => {
                if !run.start_known || run.problem.is_some() {
                    return None;
                }
                start.get_or_insert(run.start);
                for (index, record) in run.moves.iter().enumerate() {
                    let due = held.iter().take_while(|(position, _)| *position <= index).count();
                    steps.extend(held.drain(..due).map(output));
                    let step = Step::Move(Box::new(record.movement.clone()));
                    if spans.contains(&record.movement.span) {
                        steps.extend(change(&step));
                    } else {
                        steps.push(step);
                    }
                }
            }
            What::Wait(wait) => {
                start.get_or_insert(wait.q);
                steps.extend(held.drain(..).map(output));
                let comes = wait.basis == WaitBasis::Input;
                let wait = Wait {
                    duration: Some(event.duration),
                    max_time: None,
                    // Only a wait for an input whose time is stated gets shorter or longer.
                    signal: wait.wait.signal.clone().filter(|_| comes),
                    ..wait.wait.clone()
                };
                let span = wait.span;
                let step = Step::Wait(Box::new(wait));
                if spans.contains(&span) {
                    steps.extend(change(&step));
                } else {
                    steps.push(step);
                }
            }
            What::Output(output, position) => held.push((*position, output)),
            What::Left(_) => return None,
        }
    }
    steps.extend(held.into_iter().map(output));
    Some((start?, steps))
}

/// The rest between the last run of a window and a run right behind it, which a replay does not
/// know: what it costs, and its time.
fn rest_behind(
    model: &Model,
    simulation: &Simulation,
    window: &RangeInclusive<usize>,
    after: &Simulation,
    rest: f64,
) -> (EnergyParts, f64) {
    let next = simulation.events[window.end() + 1..].iter().find(|it| !it.is_within_next_run());
    let moves_on = next.is_some_and(|it| it.duration > 0.0 && matches!(it.what, What::Run(_)));
    let last = after.events.last().filter(|event| moves_on && event.duration > 0.0);
    match last.map(|event| &event.what) {
        Some(What::Run(run)) => (at_rest_behind(model, run, rest), rest),
        _ => (EnergyParts::default(), 0.0),
    }
}

fn at_rest_behind(model: &Model, run: &Run, longer: f64) -> EnergyParts {
    at_rest(model, &run.load, &run.end, longer)
}

/// The time that the whole cycle saves; waits for inputs whose time is stated take up what
/// comes before them. Also what these waits take more.
fn laid_out(
    model: &Model,
    cycle: &Cycle,
    inputs: &BTreeMap<String, f64>,
    replayed: &[Replayed],
) -> (EnergyParts, f64) {
    let simulation = &cycle.simulation;
    if inputs.is_empty() {
        // No wait takes anything up: what is laid out again is all that changes.
        let saved = replayed.iter().map(|(range, after, longer)| {
            let before: f64 = simulation.events[range.clone()].iter().map(|it| it.duration).sum();
            before - after.events.iter().map(|it| it.duration).sum::<f64>() - longer
        });
        return (EnergyParts::default(), saved.sum());
    }
    let mut clock = Clock { inputs, waited: BTreeMap::new(), time: 0.0 };
    let mut more = EnergyParts::default();
    let mut index = 0;
    let mut windows = replayed.iter().peekable();
    while index < simulation.events.len() {
        if let Some((range, after, longer)) = windows.next_if(|(range, ..)| *range.start() == index)
        {
            for event in &after.events {
                more += clock.passes(model, event, true);
            }
            clock.time += longer;
            index = range.end() + 1;
        } else {
            more += clock.passes(model, &simulation.events[index], false);
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
    /// Lets an event pass; what it takes more than its own time says.
    fn passes(
        &mut self,
        model: &Model,
        event: &crate::motion::timeline::Event,
        replayed: bool,
    ) -> EnergyParts {
        let mut duration = event.duration;
        let mut more = EnergyParts::default();
        if let What::Wait(wait) = &event.what
            && (replayed || wait.basis == WaitBasis::Input)
            && let Some(signal) = &wait.wait.signal
            && let Some(delay) = self.inputs.get(&signal.to_lowercase())
        {
            let key = signal.to_lowercase();
            let at = self.waited.get(&key).copied().unwrap_or(0.0) + delay;
            duration = (at - self.time).max(0.0);
            let longer = duration - event.duration;
            let sign = longer.signum();
            more = at_rest(model, &wait.load, &wait.q, longer.abs()) * sign;
            self.waited.insert(key, self.time + duration);
        }
        self.time += duration;
        more
    }
}
