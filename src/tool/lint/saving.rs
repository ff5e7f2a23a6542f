//! What a change saves.

/// What a change saves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saving {
    /// J.
    pub energy_j: f64,
    /// Lower end of the interval that holds 90 % of the plausible robots (5 % on each side left out), J.
    pub low_j: f64,
    /// Its upper end, J.
    pub high_j: f64,
    /// s; negative where the change takes longer.
    pub time_s: f64,
}

/// A change saves nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("it saves nothing; leave it as it is")]
pub struct SavesNothing;

/// The outcome of weighing a change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weighed {
    /// It cannot be simulated.
    Unknown,
    /// It saves nothing, or its interval reaches below zero.
    Nothing,
    /// It saves this.
    Saves(Saving),
}

impl Weighed {
    /// The saving, if there is one.
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
