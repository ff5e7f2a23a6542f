//! What is emitted: places of the original, the streams that may stand for them, and what their
//! guards compare.

use super::literal::NO_AXIS;
use crate::rapid::ir::value::Datum;
use crate::rapid::text::{Edit, Span};

/// A place of the original with the streams that may stand for it.
#[derive(Clone, Debug)]
pub struct Site {
    /// The statements.
    pub span: Span,
    /// Where it is, for comments and messages.
    pub origin: String,
    /// What the guard compares with what the streams were made for.
    pub parameters: Vec<Parameter>,
    /// The motion settings that the movements need.
    pub settings: MotionSettings,
    /// The tool as the program names it at that place.
    pub tool: String,
    /// The streams.
    pub streams: Vec<EmittedStream>,
    /// Its executions in a cycle, in their order: the index of the stream that runs, if one does.
    pub order: Vec<Option<usize>>,
}

impl Site {
    /// Whether the targets of its streams name external axes.
    pub(super) fn has_external(&self) -> bool {
        self.streams.iter().flat_map(|stream| stream.external).any(|x| x < NO_AXIS)
    }
}

/// Something that a guard compares.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// The expression as the program writes it at that place, on one line; none for what the
    /// module itself records.
    pub text: Option<String>,
    /// What messages call it.
    pub label: String,
    /// The name of its type.
    pub type_name: &'static str,
    /// Whether it is worked out, so that its last digits are those of the controller.
    pub is_computed: bool,
}

/// Motion settings on which movements depend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionSettings {
    /// Largest speed that is programmed, mm/s: `VelSet` must not be below.
    pub fastest: f64,
    /// `ConfJ`.
    pub conf_joint: bool,
    /// `ConfL`.
    pub conf_linear: bool,
    /// Whether there are lines or arcs, on which `SingArea` acts.
    pub lines: bool,
}

/// A stream to emit.
#[derive(Clone, Debug)]
pub struct EmittedStream {
    /// Where it starts, rad.
    pub start: [f64; 6],
    /// Its points, rad.
    pub points: Vec<[f64; 6]>,
    /// `\T` of each, s.
    pub intervals: Vec<f64>,
    /// Where the robot stands still on the way.
    pub pause: Option<Pause>,
    /// Where the external axes stand meanwhile, as the program writes it.
    pub external: [f64; 6],
    /// What the parameters of its site have to be.
    pub values: Vec<Datum>,
    /// Where it comes from, for comments.
    pub origin: String,
    /// Time and energy before, for comments.
    pub before: String,
    /// After, for comments.
    pub after: String,
}

/// Standing still at a point of a stream.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pause {
    /// The index of the point.
    pub after: usize,
    /// s.
    pub seconds: f64,
}

/// The robot that streams are made for.
#[derive(Clone, Debug)]
pub struct Robot {
    /// What its controller calls it.
    pub kind: String,
    /// A posture, rad.
    pub posture: [f64; 6],
    /// Where the flange is then, in the world, m.
    pub place: [f64; 3],
}

/// What the program's own statements write down beside them, since nothing can read it back.
#[derive(Clone, Debug, Default)]
pub struct Recorded {
    /// Settings that are on or off, by the name of the instruction.
    pub switches: Vec<&'static str>,
    /// Whether the load is written down.
    pub load: bool,
    /// Insertions behind the statements.
    pub edits: Vec<Edit>,
}

/// What was emitted.
#[derive(Clone, Debug)]
pub struct Emitted {
    /// Names and texts of the modules with streams; the first one has the functions of guards.
    pub modules: Vec<(String, String)>,
    /// Insertions into the original files.
    pub edits: Vec<Edit>,
    /// Instructions that the guard of each site runs in a cycle.
    pub instructions: Vec<usize>,
}

/// Why nothing was emitted.
#[derive(Debug, thiserror::Error)]
pub enum EmitError {
    /// A value that can't be written down.
    #[error("'{0}' has a value that can't be written as RAPID")]
    Value(String),
    /// A template failed.
    #[error("a template of the emission failed: {0}")]
    Template(#[from] tera::Error),
}
