//! Options of a simulation.

use std::collections::BTreeMap;

use crate::retime::path::joint_path::Joints;

/// What a simulation needs besides the program and the robot.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Where the robot stands at first, rad; otherwise at the target of the first movement if
    /// that is a `MoveAbsJ`, else at zero.
    pub start: Option<Joints>,
    /// Seconds after which an input comes, by lower-case name: counted from the start of the
    /// cycle or from the end of the last wait for it.
    pub inputs: BTreeMap<String, f64>,
    /// Levels of inputs, by lower-case name.
    pub levels: BTreeMap<String, f64>,
    /// Override of all speeds, 1 = 100 %.
    pub speed_override: Option<f64>,
    /// How often the loop that never ends runs; once where it is not said.
    pub passes: Option<u32>,
    /// Time after which the simulation ends, s.
    pub max_time: Option<f64>,
}
