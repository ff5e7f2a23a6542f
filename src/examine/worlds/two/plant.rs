//! The robot of a case, its runs and what happens in them.

use super::everyday::{Day, Everyday};
use super::motion::Motion;
use super::robot::Robot;
use crate::examine::worlds::model::Row;

/// What is the same in all logs of a case.
#[derive(Clone, Debug)]
pub(super) struct Plant {
    /// The model in the file: also the controller's.
    pub(super) nominal: Robot,
    pub(super) robot: Robot,
    pub(super) everyday: Everyday,
    /// The healthy path of the torque.
    pub(super) path: PathSpec,
    /// Rotor inertia \[kg m²\] whose torque the drive takes off what it reports.
    pub(super) subtract: Row,
    pub(super) gains: Gains,
}

/// Numbers of the torque path: poles, moving average, delay \[s\].
#[derive(Clone, Copy, Debug)]
pub(super) struct PathSpec {
    /// Time constants \[s\].
    pub(super) poles: [f64; 2],
    /// Moving average \[s\].
    pub(super) mean: f64,
    /// Delay \[s\].
    pub(super) delay: f64,
}

/// Gains of the cascade.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gains {
    /// Bandwidth of the speed loop \[rad/s\].
    pub(super) speed: f64,
    pub(super) position: f64,
    pub(super) integral: f64,
    /// Share of the reference speed that is fed forward.
    pub(super) forward: f64,
}

/// One run: motion, repetitions and sampling.
#[derive(Clone, Debug)]
pub(super) struct Run<'a> {
    pub(super) motion: &'a Motion,
    pub(super) cycles: usize,
    /// Step \[s\].
    pub(super) dt: f64,
    /// Sampling rate \[Hz\].
    pub(super) rate: f64,
    pub(super) transient: bool,
    pub(super) day: Day,
}

/// What happened, without noise, at the samples.
#[derive(Clone, Debug, Default)]
pub(super) struct Record {
    /// Time from the start of the first period \[s\].
    pub(super) t: Vec<f64>,
    /// Angles of the encoders \[rad\].
    pub(super) q: Vec<Row>,
    /// Rates of the motors \[rad/s\].
    pub(super) v: Vec<Row>,
    /// Accelerations of the motors \[rad/s²\].
    pub(super) a: Vec<Row>,
    /// Torques as the drive reports them \[Nm\].
    pub(super) tau: Vec<Row>,
    /// Torques of the motors, at the joint \[Nm\].
    pub(super) motor: Vec<Row>,
    /// What each fault contributes to the reported torques \[Nm\].
    pub(super) delta: Vec<Vec<Row>>,
}

/// Run-up before the first period: rest, then a ramp of the speed \[s\]:
/// duration of the rest.
pub(super) const REST: f64 = 0.4;
/// Duration of the ramp \[s\].
pub(super) const RAMP: f64 = 2.0;
