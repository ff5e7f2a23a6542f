//! The state of an execution.

use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;

use super::machine::Machine;
use crate::rapid::ir::hir::Expr;
use crate::rapid::ir::movement::{ActiveCall, Settings};
use crate::rapid::ir::program::{DataId, Program, RoutineId};
use crate::rapid::ir::value::{Datum, Origin, Value};
use crate::rapid::text::Span;

/// A statement that was not executed exactly, with the reason.
#[derive(Clone, Debug, Eq, Hash, PartialEq)]
pub struct Note {
    /// Where.
    pub span: Span,
    /// What and why.
    pub reason: String,
}

/// The notes of one execution.
#[derive(Debug, Default)]
pub struct Execution {
    /// Statements that were not executed exactly: `unresolved` of the reports.
    pub unresolved: Vec<Note>,
    /// Assumptions: levels of inputs, values of `PERS` data.
    pub assumed: Vec<String>,
}

/// Bounds that keep execution finite.
pub(super) const MAX_STATEMENTS: u64 = 5_000_000;
pub(super) const MAX_CALL_DEPTH: usize = 100;
/// Largest number of passes of a loop whose condition is known and stays true.
pub(super) const MAX_PASSES: u32 = 100_000;

/// Index of a storage cell.
pub(super) type CellId = usize;

/// Where a value is stored.
#[derive(Debug)]
pub(super) struct Cell {
    pub(super) value: Value,
    /// The origin of a value read from here.
    pub(super) reading: Origin,
    /// Inputs, stored values and robot positions that the value depends on.
    pub(super) history: Origin,
    pub(super) read_only: bool,
    /// An input that the value depends on.
    pub(super) input: Option<Arc<str>>,
}

impl Cell {
    /// A cell that can be written, with a value that depends on no input.
    pub(super) fn new(value: Value, reading: Origin) -> Cell {
        Cell { value, reading, history: Origin::default(), read_only: false, input: None }
    }
}

/// An active routine.
#[derive(Default)]
pub(super) struct Frame {
    pub(super) module: usize,
    pub(super) routine: Arc<str>,
    /// The call that started it.
    pub(super) call: Option<Arc<ActiveCall>>,
    /// Parameters, local data and loop variables, innermost last.
    pub(super) names: Vec<(String, CellId)>,
    /// Optional parameters that were given.
    pub(super) present: Vec<String>,
    /// Its declaration; none for an expression evaluated outside a routine.
    pub(super) id: Option<RoutineId>,
    /// True while its error handler runs.
    pub(super) handling: bool,
    /// The cells from this index on belong to it.
    pub(super) base: CellId,
    /// Value of [`Executor::stamp`] at the last change of its own data.
    pub(super) changed: u64,
}

/// A condition on inputs, and its value.
pub(super) struct Poll {
    pub(super) condition: Expr,
    pub(super) value: bool,
}

pub(super) struct Executor<'a> {
    pub(super) program: &'a Program,
    pub(super) machine: &'a mut dyn Machine,
    pub(super) cells: Vec<Cell>,
    pub(super) globals: BTreeMap<DataId, CellId>,
    /// Cells below this index may hold module data and are kept when a routine returns.
    pub(super) kept_cells: usize,
    pub(super) frames: Vec<Frame>,
    /// The components and elements that the active routines have by reference, innermost last.
    pub(super) lent: Vec<LentPart>,
    /// Level of each signal that the program has set or waited for.
    pub(super) signals: BTreeMap<String, f64>,
    pub(super) settings: Arc<Settings>,
    /// Positions of the external axes after their last movement, in RAPID's units.
    pub(super) external_axes: Option<Vec<f64>>,
    pub(super) statements: u64,
    /// Counts changes of data and signals.
    pub(super) stamp: u64,
    /// Value of `stamp` at the last change of a signal or of data outside the running routine.
    pub(super) changed_outside: u64,
    /// Number of movements.
    pub(super) moves: u64,
    /// Sum of the waiting times that the program states, s.
    pub(super) waited_s: f64,
    /// The conditions on inputs evaluated in the watched loops.
    pub(super) polls: Vec<Poll>,
    /// Number of active loops whose conditions on inputs are recorded.
    pub(super) watchers: usize,
    /// A condition whose next value is inverted.
    pub(super) forced: Option<Span>,
    /// The input that was read last, directly or through data that depend on it.
    pub(super) seen_input: Option<Arc<str>>,
    /// The inputs that decided the current branches, innermost last.
    pub(super) deciding: Vec<Arc<str>>,
    /// The error that is being handled: RAPID's `ERRNO`.
    pub(super) errno: Option<Arc<str>>,
    pub(super) execution: Execution,
    /// The notes of the execution, each once.
    noted: HashSet<Note>,
}

impl<'a> Executor<'a> {
    pub(super) fn new(program: &'a Program, machine: &'a mut dyn Machine) -> Executor<'a> {
        Executor {
            program,
            machine,
            cells: Vec::new(),
            globals: BTreeMap::new(),
            kept_cells: 0,
            lent: Vec::new(),
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
            noted: HashSet::new(),
        }
    }

    pub(super) fn frame(&self) -> &Frame {
        self.frames.last().unwrap_or_else(|| unreachable!("execution is inside a routine"))
    }

    pub(super) fn frame_mut(&mut self) -> &mut Frame {
        self.frames.last_mut().unwrap_or_else(|| unreachable!("execution is inside a routine"))
    }

    pub(super) fn new_cell(&mut self, cell: Cell) -> CellId {
        self.cells.push(cell);
        self.cells.len() - 1
    }

    pub(super) fn unresolved(&mut self, span: Span, reason: impl Into<String>) {
        let note = Note { span, reason: reason.into() };
        if self.noted.insert(note.clone()) {
            self.execution.unresolved.push(note);
        }
    }

    pub(super) fn assume(&mut self, text: String) {
        if !self.execution.assumed.contains(&text) {
            self.execution.assumed.push(text);
        }
    }
}

/// A part of data that a routine has by reference.
pub(super) struct LentPart {
    pub(super) parameter: CellId,
    pub(super) whole: CellId,
    /// Its component indices; `None` for a part that is not known.
    pub(super) indices: Option<Vec<usize>>,
    pub(super) span: Span,
    /// Whether the routine has written to the parameter.
    pub(super) is_written: bool,
    /// Whether the data were written by another name.
    pub(super) is_stale: bool,
}

impl LentPart {
    pub(super) fn overlaps(&self, other: &LentPart) -> bool {
        self.whole == other.whole
            && match (&self.indices, &other.indices) {
                (Some(own), Some(other)) => own.starts_with(other) || other.starts_with(own),
                _ => true,
            }
    }

    pub(super) fn unknown(&self) -> Datum {
        Datum::unknown("a part of it is passed by reference", self.span)
    }
}
