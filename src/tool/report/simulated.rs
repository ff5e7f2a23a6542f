//! The input of the reports of a simulation.

use crate::arm::robot::Model;
use crate::retime::energy::Account;
use crate::retime::energy::plausible::Plausibility;
use crate::retime::motion::Simulation;

/// A simulated cycle and its energy.
#[derive(Clone, Copy)]
pub struct Simulated<'a> {
    /// The robot.
    pub model: &'a Model,
    /// The routine that starts the program.
    pub entry: &'a str,
    /// The cycle.
    pub simulation: &'a Simulation,
    /// Its energy.
    pub account: &'a Account,
    /// Intervals over plausible robots.
    pub plausible: Option<&'a Plausibility>,
}
