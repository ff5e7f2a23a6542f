//! How points become RAPID.

/// What the points become.
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

/// How points become RAPID.
#[derive(Clone, Debug)]
pub struct Settings {
    /// What they become.
    pub form: Form,
    /// Name of the file, for names in the program.
    pub name: String,
    /// Least time between two points of a stream, s.
    pub spacing_s: f64,
}
