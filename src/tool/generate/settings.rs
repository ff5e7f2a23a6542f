//! Settings of the generation.

/// The kind of output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// `MoveAbsJ`; a stream of them for a trajectory.
    AbsJ,
    /// `MoveJ`.
    MoveJ,
    /// `MoveL`.
    MoveL,
    /// A file of joint positions for externally guided motion, and the module that runs it.
    Egm,
}

/// Settings of the generation.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The kind of output.
    pub form: Form,
    /// Name of the input file, for names in the program.
    pub name: String,
    /// Minimum time between two points of a stream, s.
    pub spacing_s: f64,
}
