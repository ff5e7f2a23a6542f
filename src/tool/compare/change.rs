//! What a comparison finds.

use super::values::Difference;
use crate::rapid::text::Span;

/// A difference in meaning.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// What is concerned.
    pub subject: Subject,
    /// What happened to it.
    pub action: Action,
    /// The task; empty without one.
    pub task: String,
    /// The module, by its new name if it has one.
    pub module: String,
    /// The routine, by its new name if it has one; `None` for what is declared in the module.
    pub routine: Option<String>,
    /// Its place in the old program.
    pub old: Option<Span>,
    /// Its place in the new program.
    pub new: Option<Span>,
    /// In words.
    pub message: String,
    /// The differences of a value that is known on both sides.
    pub differences: Vec<Difference>,
}

/// What a change concerns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Subject {
    /// A movement as a whole.
    Movement,
    /// A `robtarget` or `jointtarget`, or the target of a movement.
    Target,
    /// A speed or time of a movement.
    Speed,
    /// A zone or the condition at a stop point.
    Zone,
    /// A tool.
    Tool,
    /// A work object.
    WorkObject,
    /// A load.
    Load,
    /// A wait.
    Wait,
    /// An output.
    Output,
    /// An awaited input.
    Input,
    /// A setting of motion such as `AccSet`.
    Setting,
    /// Data and assignments.
    Data,
    /// Branches, loops, jumps, handlers.
    ControlFlow,
    /// Calls of procedures and other instructions.
    Call,
    /// A routine.
    Routine,
    /// A module.
    Module,
    /// A record or an alias.
    Type,
    /// Text with a syntax error.
    Unreadable,
}

impl Subject {
    /// Its name in the JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Subject::Movement => "movement",
            Subject::Target => "target",
            Subject::Speed => "speed",
            Subject::Zone => "zone",
            Subject::Tool => "tool",
            Subject::WorkObject => "work_object",
            Subject::Load => "load",
            Subject::Wait => "wait",
            Subject::Output => "output",
            Subject::Input => "input",
            Subject::Setting => "setting",
            Subject::Data => "data",
            Subject::ControlFlow => "control_flow",
            Subject::Call => "call",
            Subject::Routine => "routine",
            Subject::Module => "module",
            Subject::Type => "type",
            Subject::Unreadable => "unreadable",
        }
    }
}

/// What happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Action {
    /// Only the new program has it.
    Added,
    /// Only the old program has it.
    Removed,
    /// Both have it, with another meaning.
    Changed,
    /// It is the same at another place.
    Moved,
    /// It is the same with another name.
    Renamed,
}

impl Action {
    /// Its name in the JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Action::Added => "added",
            Action::Removed => "removed",
            Action::Changed => "changed",
            Action::Moved => "moved",
            Action::Renamed => "renamed",
        }
    }
}
