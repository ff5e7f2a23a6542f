//! Torque laws that effects add to a model.

/// The state that a law depends on.
#[derive(Clone, Copy, Debug)]
pub struct LawState {
    /// Time since the log began \[s\]; infinite where there is none: a robot that has run
    /// for long.
    pub t: f64,
    /// Position of the joint \[rad\].
    pub q: f64,
    /// Rate of the motor over the gear ratio \[rad/s\].
    pub rate: f64,
    /// Its sense, 1, −1, or 0 at rest; between them where it has to be smooth.
    pub sense: f64,
    /// Torque of the rigid bodies through the gear \[Nm\].
    pub gear: f64,
}

/// One law of one joint.
#[derive(Clone, Copy, Debug)]
pub struct Law {
    /// Joint, from 0.
    pub joint: usize,
    /// Its parameters, in the order in which the law takes them.
    pub values: [f64; Law::PARAMETERS],
    /// Friction, which turns with the motor; else a torque between the links.
    pub dissipates: bool,
    /// Torque \[Nm\] at a state.
    pub torque: fn(&LawState, &[f64; Law::PARAMETERS]) -> f64,
}

impl Law {
    /// Parameters at most.
    pub const PARAMETERS: usize = 4;
}

impl PartialEq for Law {
    fn eq(&self, other: &Law) -> bool {
        self.joint == other.joint
            && self.values == other.values
            && self.dissipates == other.dissipates
            && std::ptr::fn_addr_eq(self.torque, other.torque)
    }
}
