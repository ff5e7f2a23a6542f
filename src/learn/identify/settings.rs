//! What an identification may change, and how it is done.

use super::fit::Weighting;

/// What is to be identified.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Free {
    /// Rigid bodies, rotors, friction, offsets.
    All,
    /// Friction and offsets; rigid bodies and rotors as the model has them.
    Friction,
    /// What is fixed to the flange; all else as the model has it.
    Payload,
}

/// How an identification is done.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// What is free.
    pub free: Free,
    /// How joints are weighted.
    pub weighting: Weighting,
    /// Who says so, for the identified numbers of the model.
    pub source: String,
}
