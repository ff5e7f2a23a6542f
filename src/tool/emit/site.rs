//! The data to emit: sites of the original, their streams, and the compared values.

use super::literal::NO_AXIS;
use crate::rapid::ir::value::Datum;
use crate::rapid::text::{Edit, Span};

/// A site of the original with its streams.
#[derive(Clone, Debug)]
pub struct Site {
    /// The statements.
    pub span: Span,
    /// Place, for comments and messages.
    pub origin: String,
    /// The parameters that the guard compares with the values of the streams.
    pub parameters: Vec<Parameter>,
    /// The motion settings that the movements require.
    pub settings: MotionSettings,
    /// The text of the tool argument.
    pub tool: String,
    /// The streams.
    pub streams: Vec<EmittedStream>,
    /// Its executions in a cycle in order: the index of the stream that runs, if any.
    pub order: Vec<Option<usize>>,
}

impl Site {
    /// Whether the targets of its streams name external axes.
    pub(super) fn has_external(&self) -> bool {
        self.streams.iter().flat_map(|stream| stream.external).any(|x| x < NO_AXIS)
    }
}

/// A value that a guard compares.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its value now.
    pub now: Now,
    /// Name in messages.
    pub label: String,
    /// The name of its type.
    pub type_name: &'static str,
    /// Whether the controller computes it, so that its last digits may differ.
    pub is_computed: bool,
}

/// How a guard gets the present value of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Now {
    /// From an expression of the program, on one line.
    Argument(String),
    /// From the record of the load in the module.
    Load,
    /// From an expression that holds everywhere.
    Anywhere(&'static str),
}

/// Motion settings on which movements depend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionSettings {
    /// Maximum programmed speed, mm/s: `VelSet` must not be below it.
    pub fastest: f64,
    /// `ConfJ`.
    pub conf_joint: bool,
    /// `ConfL`.
    pub conf_linear: bool,
    /// Whether there are lines or arcs, which `SingArea` affects.
    pub lines: bool,
}

/// A stream to emit.
#[derive(Clone, Debug)]
pub struct EmittedStream {
    /// Start position, rad.
    pub start: [f64; 6],
    /// Points, rad.
    pub points: Vec<[f64; 6]>,
    /// `\T` of each point, s.
    pub intervals: Vec<f64>,
    /// A standstill on the way.
    pub pause: Option<Pause>,
    /// Position of the external axes as in RAPID.
    pub external: [f64; 6],
    /// Required values of the site's parameters.
    pub values: Vec<Datum>,
    /// The state of the movements that have to be put off already, 0 for none.
    pub follows: usize,
    /// The movements that are put off in place of a stream.
    pub puts_off: Option<PutOff>,
    /// Origin, for comments.
    pub origin: String,
    /// Time and energy of the movements, for comments.
    pub before: String,
    /// Time and energy of the stream, for comments.
    pub after: String,
}

/// A statement before which movements that were put off are made up for.
#[derive(Clone, Copy, Debug)]
pub struct Stop {
    /// The statement.
    pub span: Span,
    /// Whether it is the statement of a compact IF.
    pub is_compact: bool,
}

/// Movements that are put off: the stream at a later place has them, or they are made up for.
#[derive(Clone, Debug)]
pub struct PutOff {
    /// The state after that, from 1.
    pub state: usize,
    /// The statements.
    pub statements: Vec<Vec<Word>>,
}

/// A part of a statement.
#[derive(Clone, Debug)]
pub enum Word {
    /// RAPID text.
    Text(String),
    /// The value of a parameter of the site, by its index.
    Parameter(usize),
}

/// A standstill at a point of a stream.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pause {
    /// The index of the point.
    pub after: usize,
    /// s.
    pub seconds: f64,
}

/// The robot for which streams are planned.
#[derive(Clone, Debug)]
pub struct Robot {
    /// Type name on the controller.
    pub kind: String,
    /// A posture, rad.
    pub posture: [f64; 6],
    /// The flange position at this posture, in the world frame, m.
    pub place: [f64; 3],
}

/// States that the program records itself because RAPID cannot read them back.
#[derive(Clone, Debug, Default)]
pub struct Recorded {
    /// Settings that are on or off, by instruction name.
    pub switches: Vec<&'static str>,
    /// Whether the load is recorded.
    pub load: bool,
    /// Motion settings that guards compare with those of their streams instead of the usual ones, by
    /// name.
    pub compared: Vec<&'static str>,
    /// Insertions after the statements.
    pub edits: Vec<Edit>,
}

/// The result of an emission.
#[derive(Clone, Debug)]
pub struct Emitted {
    /// Names and texts of the modules; the first one contains the functions of guards.
    pub modules: Vec<(String, String)>,
    /// Insertions into the original files.
    pub edits: Vec<Edit>,
    /// Number of guard instructions of each site in a cycle.
    pub instructions: Vec<usize>,
}

/// Errors of the emission.
#[derive(Debug, thiserror::Error)]
pub enum EmitError {
    /// A value has no RAPID text.
    #[error("'{0}' has a value that can't be written as RAPID")]
    Value(String),
    /// A template failed.
    #[error("a template of the emission failed: {0}")]
    Template(#[from] tera::Error),
}
