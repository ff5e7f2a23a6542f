//! Options of a simulation.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::retime::motion::arrivals::Arrival;
use crate::retime::motion::run_plan::Plans;
use crate::retime::path::joint_path::Joints;

/// Inputs of a simulation besides the program and the robot.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Start position, rad; default: the target of the first movement if it is a `MoveAbsJ`,
    /// otherwise zero.
    pub start: Option<Joints>,
    /// Delay of an input (s) by lower-case name, from the start of the cycle or from the end of the
    /// last wait for it.
    pub inputs: BTreeMap<String, f64>,
    /// Arrivals for single waits, which precede those of `inputs`.
    pub arrivals: Vec<Arrival>,
    /// Levels of inputs, by lower-case name.
    pub levels: BTreeMap<String, f64>,
    /// Override of all speeds, 1 = 100 %.
    pub speed_override: Option<f64>,
    /// Number of passes of the endless loop; default 1.
    pub passes: Option<u32>,
    /// Time limit of the simulation, s.
    pub max_time: Option<f64>,
    /// Planned runs of earlier simulations, which are not planned again. No result depends on them.
    pub plans: Option<Arc<Plans>>,
}
