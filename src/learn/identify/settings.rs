//! Settings of an identification.

use super::fit::Weighting;

/// The parameters to identify.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Free {
    /// Rigid bodies, rotors, friction, offsets.
    All,
    /// Friction and offsets; rigid bodies and rotors of the model stay.
    Friction,
    /// The payload at the flange; the other parameters of the model stay.
    Payload,
}

/// Settings of an identification.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The free parameters.
    pub free: Free,
    /// Weights of the joints.
    pub weighting: Weighting,
    /// Source to state for the identified parameters.
    pub source: String,
}
