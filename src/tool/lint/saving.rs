//! What a change saves.

/// What a change saves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saving {
    /// J.
    pub energy_j: f64,
    /// J: 90 % of the plausible robots save more than `low_j` and less than `high_j`, 5 % on each side
    /// left out.
    pub low_j: f64,
    /// As before.
    pub high_j: f64,
    /// s; negative where the change takes longer.
    pub time_s: f64,
}

/// A change saves nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("it saves nothing; leave it as it is")]
pub struct Worthless;

/// What came out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weighed {
    /// Nothing can be said.
    Unknown,
    /// It saves nothing, or may as well cost.
    Nothing,
    /// It saves this.
    Saves(Saving),
}

impl Weighed {
    /// The saving, if there is one.
    ///
    /// # Errors
    /// The change saves nothing.
    pub fn saving(self) -> Result<Option<Saving>, Worthless> {
        match self {
            Weighed::Unknown => Ok(None),
            Weighed::Nothing => Err(Worthless),
            Weighed::Saves(saving) => Ok(Some(saving)),
        }
    }
}
