//! Torque laws that effects add to a model.

/// The state that a law depends on.
#[derive(Clone, Copy, Debug)]
pub struct LawState {
    /// Time since the start of the log \[s\]; infinite without a log: a robot in steady state.
    pub t: f64,
    /// Position of the joint \[rad\].
    pub q: f64,
    /// Motor speed over the gear ratio \[rad/s\].
    pub rate: f64,
    /// Sign of its motion, 0 at rest; between −1 and 1 if smoothed.
    pub sense: f64,
    /// Rigid-body torque through the gear \[Nm\].
    pub gear: f64,
}

/// One law of one joint.
#[derive(Clone, Copy, Debug)]
pub struct Law {
    /// Joint, from 0.
    pub joint: usize,
    /// Its parameters in the order of the law.
    pub values: [f64; Law::PARAMETERS],
    /// True for friction, which moves with the motor; false for a torque between the links.
    pub dissipates: bool,
    /// Torque \[Nm\] at a state.
    pub torque: fn(&LawState, &[f64; Law::PARAMETERS]) -> f64,
}

impl Law {
    /// Largest number of parameters.
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
