//! The actions of a program in order, from its simulation or from a run without a robot.

use std::collections::BTreeMap;

use crate::rapid::ir::exec::{Machine, Note, WaitResult, execute};
use crate::rapid::ir::movement::{Movement, Output, Unresolved, Wait};
use crate::rapid::ir::program::{Program, RoutineId};
use crate::rapid::text::Span;
use crate::retime::motion::timeline::{Event, Run, WaitBasis, What};

/// Maximum number of steps of a recording.
const MAX_STEPS: usize = 50_000;

/// One action of a program.
#[derive(Debug)]
pub struct TraceStep<'c> {
    /// Index of the event of the simulation, and of the movement in it.
    pub event: Option<(usize, usize)>,
    /// s; 0 if unknown.
    pub duration: f64,
    /// The action.
    pub what: Action<'c>,
}

/// An action.
#[derive(Debug)]
pub enum Action<'c> {
    /// It moves.
    Move(&'c Movement),
    /// It waits.
    Wait(&'c Wait, WaitBasis),
    /// It sets an output.
    Output(&'c Output),
    /// It moves to an unknown place.
    Left(Span),
}

impl<'c> Action<'c> {
    /// The movement, if it moves to a known place.
    pub fn movement(&self) -> Option<&'c Movement> {
        match self {
            Action::Move(movement) => Some(movement),
            _ => None,
        }
    }

    /// Whether it moves, to a known place or not.
    pub fn moves(&self) -> bool {
        matches!(self, Action::Move(_) | Action::Left(_))
    }

    /// The statement.
    pub fn span(&self) -> Span {
        match self {
            Action::Move(movement) => movement.span,
            Action::Wait(wait, _) => wait.span,
            Action::Output(output) => output.span,
            Action::Left(span) => *span,
        }
    }
}

/// The actions of events, in the order in which they happen. Steps have indices into `events`.
pub fn of_events(events: &[Event]) -> Vec<TraceStep<'_>> {
    let mut trace = Vec::new();
    // Outputs between fly-by movements precede the run to which they belong.
    let mut held: Vec<(usize, TraceStep<'_>)> = Vec::new();
    for (event, it) in events.iter().enumerate() {
        let step =
            |index, duration, what| TraceStep { event: Some((event, index)), duration, what };
        match &it.what {
            What::Output(output, position) => {
                held.push((*position, step(0, 0.0, Action::Output(output))));
            }
            What::Run(run) => {
                for (index, record) in run.moves.iter().enumerate() {
                    let due = held.iter().take_while(|(position, _)| *position <= index).count();
                    trace.extend(held.drain(..due).map(|(_, output)| output));
                    trace.push(step(index, record.duration, Action::Move(&record.movement)));
                }
            }
            What::Wait(wait) => {
                trace.extend(held.drain(..).map(|(_, output)| output));
                trace.push(step(0, it.duration, Action::Wait(&wait.wait, wait.basis)));
            }
            What::Left(left) => {
                trace.extend(held.drain(..).map(|(_, output)| output));
                trace.push(step(0, 0.0, Action::Left(left.span)));
            }
        }
    }
    trace.extend(held.into_iter().map(|(_, output)| output));
    trace
}

/// The run of an event.
pub fn run(event: &Event) -> Option<&Run> {
    match &event.what {
        What::Run(run) => Some(run),
        _ => None,
    }
}

/// The recorded actions of a program without a robot.
#[derive(Debug, Default)]
pub struct Recording {
    steps: Vec<Recorded>,
    /// Statements that could not be executed.
    pub notes: Vec<Note>,
}

#[derive(Debug)]
enum Recorded {
    Move(Box<Movement>),
    Wait(Box<Wait>),
    Output(Output),
    Left(Span),
}

/// Runs a program without a robot.
pub fn record(program: &Program, entry: RoutineId) -> Recording {
    let mut recording = Recording::default();
    recording.notes = execute(program, entry, &mut recording).unresolved;
    recording
}

impl Recording {
    /// Appends another recording, with an unknown way between them.
    pub fn append(&mut self, start: Span, other: Recording) {
        self.steps.push(Recorded::Left(start));
        self.steps.extend(other.steps);
        self.notes.extend(other.notes);
    }

    /// The trace.
    pub fn trace(&self) -> Vec<TraceStep<'_>> {
        let done = |step| {
            let (duration, what) = match step {
                &Recorded::Left(span) => (0.0, Action::Left(span)),
                Recorded::Move(movement) => (0.0, Action::Move(movement)),
                Recorded::Output(output) => (0.0, Action::Output(output)),
                Recorded::Wait(wait) => {
                    let stated = wait.duration.map_or(WaitBasis::Unknown, |_| WaitBasis::Stated);
                    (wait.duration.unwrap_or(0.0), Action::Wait(wait, stated))
                }
            };
            TraceStep { event: None, duration, what }
        };
        self.steps.iter().map(done).collect()
    }
}

impl Machine for Recording {
    fn on_movement(&mut self, movement: Result<Movement, Unresolved>) {
        match movement {
            Ok(movement) => self.steps.push(Recorded::Move(Box::new(movement))),
            Err(unresolved) => self.steps.push(Recorded::Left(unresolved.span)),
        }
    }

    fn on_wait(&mut self, wait: Wait) -> WaitResult {
        self.steps.push(Recorded::Wait(Box::new(wait)));
        WaitResult::Ended
    }

    fn on_output(&mut self, output: Output) {
        self.steps.push(Recorded::Output(output));
    }

    fn joints(&mut self) -> Option<[f64; 6]> {
        None
    }

    fn is_at_limit(&self) -> bool {
        self.steps.len() > MAX_STEPS
    }
}

/// The executions of each statement, as indices into the trace.
pub fn executions(trace: &[TraceStep<'_>]) -> BTreeMap<Span, Vec<usize>> {
    let mut found: BTreeMap<Span, Vec<usize>> = BTreeMap::new();
    for (index, done) in trace.iter().enumerate() {
        found.entry(done.what.span()).or_default().push(index);
    }
    found
}
