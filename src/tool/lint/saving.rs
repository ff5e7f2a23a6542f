//! The saving of a change.

/// The saving of a change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saving {
    /// J.
    pub energy_j: f64,
    /// Lower end of the 90 % interval over the plausible robots, J.
    pub low_j: f64,
    /// Upper end, J.
    pub high_j: f64,
    /// s; negative if the change takes longer.
    pub time_s: f64,
}

/// The change saves nothing, or the interval of its saving includes zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("it saves nothing; leave it as it is")]
pub struct SavesNothing;

/// The saving of a change; `None` if it cannot be simulated.
pub type Evaluation = Result<Option<Saving>, SavesNothing>;
