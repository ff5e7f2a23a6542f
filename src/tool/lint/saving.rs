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

/// The change saves nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("it saves nothing; leave it as it is")]
pub struct SavesNothing;

/// The result of evaluating a change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weighed {
    /// It cannot be simulated.
    Unknown,
    /// It saves nothing, or its interval includes zero.
    Nothing,
    /// It saves energy.
    Saves(Saving),
}

impl Weighed {
    /// The saving, if known.
    ///
    /// # Errors
    /// The change saves nothing.
    pub fn saving(self) -> Result<Option<Saving>, SavesNothing> {
        match self {
            Weighed::Unknown => Ok(None),
            Weighed::Nothing => Err(SavesNothing),
            Weighed::Saves(saving) => Ok(Some(saving)),
        }
    }
}
