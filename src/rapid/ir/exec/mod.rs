//! Execution of a program as far as it can be known without the cell.
//!
//! The executor walks the statements, keeps every value together with what it
//! was computed from, and tells a [`Machine`] about movements, waits and
//! outputs. Inputs are 0 until the program has waited for them; a branch on a
//! value that is not known takes the `ELSE`; an endless loop runs once. Each
//! such decision is recorded.

mod call;
mod constant;
mod displacement;
mod eval;
mod external;
mod flow;
mod functions;
mod instruction;
mod loops;
mod modes;
mod motion;
mod polling;
mod system;
mod world_zones;

pub use constant::{evaluate, value_of};

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::Isometry3;

use super::movement::{Movement, Output, Settings, Unresolved, Wait};
use super::program::{DataId, Program, RoutineId};
use super::value::{Origin, Value};
use crate::rapid::text::Span;

/// What execution asks of the robot and tells it.
pub trait Machine {
    /// A movement, or the reason why it can't be worked out.
    fn moves(&mut self, movement: Result<Movement, Unresolved>);
    /// A wait; how it ended.
    fn waits(&mut self, wait: Wait) -> Waited;
    /// A change of an output.
    fn sets(&mut self, output: Output);
    /// An endless loop begins: what comes from here on comes again and again.
    fn repeats(&mut self) {}
    /// The loop that seemed endless was left.
    fn leaves_loop(&mut self) {}
    /// Whether an input has come, if it is known when it does. Once it has, its time counts
    /// again from here.
    fn has_come(&mut self, _signal: &str) -> Option<bool> {
        None
    }
    /// When an input comes that the program waits for, if that is known, s.
    fn comes_at(&mut self, _signal: &str) -> Option<f64> {
        None
    }
    /// How often the loop that never ends is to run.
    fn passes(&self) -> u32 {
        1
    }
    /// The level of an input that the user states, by lower-case name.
    fn stated_level(&self, _signal: &str) -> Option<f64> {
        None
    }
    /// Axis positions in rad, if the robot stands and its position is known.
    fn joints(&mut self) -> Option<[f64; 6]>;
    /// The pose of the flange in the world at these joints (rad), if a robot is there.
    fn flange(&self, _q: &[f64; 6]) -> Option<Isometry3<f64>> {
        None
    }
    /// The speed override that the operator has set, %.
    fn override_percent(&self) -> f64 {
        100.0
    }
    /// What the controller calls its robot.
    fn robot(&self) -> Option<String> {
        None
    }
    /// True once the machine wants no more (limits of time or of length); it tells why itself.
    fn is_full(&self) -> bool;
}

/// How a wait ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Waited {
    /// What it waited for came, or its time was over.
    Ended,
    /// Its `\\MaxTime` was over before.
    TimedOut,
}

/// Something that was not followed exactly, with the place.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// Where.
    pub span: Span,
    /// What and why.
    pub reason: String,
}

/// What one execution left behind besides what the machine was told.
#[derive(Debug, Default)]
pub struct Execution {
    /// What could not be followed: `unresolved` of the reports.
    pub unresolved: Vec<Note>,
    /// What was assumed: levels of inputs, values of `PERS` data.
    pub assumed: Vec<String>,
}

/// Bounds that keep execution finite.
const MAX_STATEMENTS: u64 = 5_000_000;
const MAX_CALL_DEPTH: usize = 100;
/// Passes of a loop whose condition is known and stays true.
const MAX_PASSES: u32 = 100_000;

/// Runs the routine on the machine.
pub fn execute(program: &Program, entry: RoutineId, machine: &mut dyn Machine) -> Execution {
    let mut executor = Executor::new(program, machine);
    executor.run(entry);
    executor.execution
}

/// Index of a storage cell.
type CellId = usize;

/// Where a value is stored.
#[derive(Debug)]
struct Cell {
    value: Value,
    /// What reading it adds to the origin.
    reading: Origin,
    /// Inputs, stored values and places of the robot from which what it holds was worked out.
    history: Origin,
    read_only: bool,
    /// An input from which the value was worked out.
    input: Option<Arc<str>>,
}

/// An active routine.
struct Frame {
    module: usize,
    routine: Arc<str>,
    /// The call that it runs for.
    called_at: Option<Span>,
    /// Parameters, local data and loop variables, innermost last.
    names: Vec<(String, CellId)>,
    /// Optional parameters that were given.
    present: Vec<String>,
    /// Its declaration; none for an expression that stands by itself.
    id: Option<RoutineId>,
    /// True while its error handler runs.
    handling: bool,
    /// Cells from here on are its own.
    base: CellId,
    /// When its own data last changed, see [`Executor::stamp`].
    changed: u64,
}

impl Frame {
    fn new(module: usize, routine: Arc<str>, id: Option<RoutineId>) -> Frame {
        Frame {
            module,
            routine,
            called_at: None,
            names: Vec::new(),
            present: Vec::new(),
            id,
            handling: false,
            base: 0,
            changed: 0,
        }
    }
}

struct Executor<'a> {
    program: &'a Program,
    machine: &'a mut dyn Machine,
    cells: Vec<Cell>,
    globals: BTreeMap<DataId, CellId>,
    /// Cells below this one hold module data and stay.
    kept_cells: usize,
    frames: Vec<Frame>,
    /// Level of each signal that the program has set or waited for.
    signals: BTreeMap<String, f64>,
    settings: Arc<Settings>,
    /// Where the external axes stand, in RAPID's units, once a movement of theirs has told.
    external_axes: Option<Vec<f64>>,
    statements: u64,
    /// Counts changes of data and signals.
    stamp: u64,
    /// When data or signals other than the own ones of an active routine last changed.
    changed_outside: u64,
    /// Number of movements.
    moves: u64,
    /// Length of the waits whose length the program states, s.
    waited_s: f64,
    /// The conditions on inputs of the loops that are watched.
    polls: Vec<polling::Poll>,
    /// Number of loops that are watched for what they ask.
    watchers: usize,
    /// A condition whose next value is taken the other way.
    forced: Option<Span>,
    /// The input that was read last, itself or through data worked out from it.
    seen_input: Option<Arc<str>>,
    /// The inputs because of which the present statements run, innermost last.
    deciding: Vec<Arc<str>>,
    /// The error that a handler deals with: RAPID's `ERRNO`.
    errno: Option<Arc<str>>,
    execution: Execution,
}

impl<'a> Executor<'a> {
    fn new(program: &'a Program, machine: &'a mut dyn Machine) -> Executor<'a> {
        Executor {
            program,
            machine,
            cells: Vec::new(),
            globals: BTreeMap::new(),
            kept_cells: 0,
            frames: Vec::new(),
            signals: BTreeMap::new(),
            settings: Arc::new(Settings::default()),
            external_axes: None,
            statements: 0,
            stamp: 0,
            changed_outside: 0,
            moves: 0,
            waited_s: 0.0,
            polls: Vec::new(),
            watchers: 0,
            forced: None,
            seen_input: None,
            deciding: Vec::new(),
            errno: None,
            execution: Execution::default(),
        }
    }

    fn run(&mut self, entry: RoutineId) {
        let program = self.program;
        for clash in &program.clashes {
            for span in &clash.spans {
                let name = &clash.name.text;
                let times = clash.spans.len();
                self.unresolved(
                    *span,
                    format!("'{name}' is declared {times} times: what uses it is left alone"),
                );
            }
        }
        match self.enter(entry, Vec::new(), Vec::new(), None) {
            flow::Flow::Raised(raised) => {
                let error = raised.error.as_deref().unwrap_or("an error");
                let reason = format!("{error}, which no handler takes, ends the program here");
                self.unresolved(raised.at, reason);
            }
            flow::Flow::Jump(label, _) => {
                self.unresolved(label.span, format!("no label '{}' in reach", label.text));
            }
            _ => {}
        }
    }

    fn frame(&self) -> &Frame {
        self.frames.last().unwrap_or_else(|| unreachable!("execution is inside a routine"))
    }

    fn frame_mut(&mut self) -> &mut Frame {
        self.frames.last_mut().unwrap_or_else(|| unreachable!("execution is inside a routine"))
    }

    fn unresolved(&mut self, span: Span, reason: impl Into<String>) {
        let note = Note { span, reason: reason.into() };
        if !self.execution.unresolved.contains(&note) {
            self.execution.unresolved.push(note);
        }
    }

    fn assume(&mut self, text: String) {
        if !self.execution.assumed.contains(&text) {
            self.execution.assumed.push(text);
        }
    }
}

#[cfg(test)]
mod tests;
