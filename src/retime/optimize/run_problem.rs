//! A run on its path with the limits of its stream, and the timing problem on a grid.

use super::allowed::Loads;
use super::ceilings::{Ceiling, speeds};
use super::check::{Check, Room, check};
use super::corridor::{Corridor, JOINT_TOLERANCE, LINE_TOLERANCE, levers};
use super::cost::Cost;
use super::freedom::Freedom;
use super::keep_out;
use super::margins::Margins;
use super::path_energy::EnergyModel;
use super::path_grid;
use super::reason::Reason;
use super::stream_limits::StreamLimits;
use crate::arm::kinematics::Body;
use crate::arm::robot::Model;
use crate::retime::energy::EnergyParts;
use crate::retime::motion::sampling::{Loaded, SpeedCap};
use crate::retime::motion::stream::Stream;
use crate::retime::motion::timed::TimedMotion;
use crate::retime::motion::timeline::Run;
use crate::retime::motion::timing::grid::PathGrid;
use crate::retime::motion::timing::limits::PathLimits;
use crate::retime::motion::timing::profile::Profile;
use crate::retime::motion::timing::reachability::time_optimal;
use crate::retime::path::LegKind;
use crate::retime::path::joint_path::{JointPath, Joints};

/// Usual number of grid intervals in addition to those of zones.
pub(super) const INTERVALS: usize = 44;
/// Time by which the points of a stream smooth its speed to each side, s.
const SHAPING_TIME: f64 = 0.04;
/// Distance from the path with a noticeable cost in polishing, as a share of the tolerance.
const CORRIDOR: f64 = 0.3;

/// A run to be replaced by a stream.
#[derive(Clone, Copy)]
pub struct Task<'a> {
    /// The robot.
    pub model: &'a Model,
    /// The simulated run.
    pub run: &'a Run,
    /// Its energy.
    pub energy_before: EnergyParts,
    /// Least time between two points, s.
    pub spacing_s: f64,
    /// The same where a wider spacing moves the polygon too far from the path, s.
    pub closest_s: f64,
    /// What the stream may change relative to the run.
    pub freedom: &'a Freedom,
    /// The cost that is minimised.
    pub cost: Cost,
}

/// A run with its path, corridor, limits and cost.
pub(super) struct RunProblem<'a> {
    pub(super) task: &'a Task<'a>,
    pub(super) path: &'a JointPath,
    pub(super) corridor: Corridor,
    pub(super) body: Option<Body<'a>>,
    pub(super) limits: StreamLimits,
    /// The electrical energy.
    pub(super) electrical: EnergyModel,
    /// The cost that is minimised.
    pub(super) model: EnergyModel,
    pub(super) lever: Joints,
}

impl<'a> RunProblem<'a> {
    pub(super) fn new(task: &'a Task<'a>) -> Result<RunProblem<'a>, Reason> {
        let [(_, TimedMotion::Path(path, _))] = task.run.motions.as_slice() else {
            return Err(Reason::SharpCorner);
        };
        let corridor =
            Corridor::new(task.model, task.run, task.freedom).ok_or(Reason::SharpCorner)?;
        let robot = task.model;
        let (electrical, model) = (Cost::Electrical.model(robot), task.cost.model(robot));
        let Loads { acceleration, jerk, .. } = corridor.ceilings.loads;
        let limits = StreamLimits { velocity: speeds(robot), acceleration, jerk };
        let lever = levers(robot, task.run);
        let body = keep_out::body(robot, task.run, task.freedom);
        Ok(RunProblem { task, path, corridor, body, limits, electrical, model, lever })
    }

    /// Checks the realised motion of a stream.
    pub(super) fn check(&self, stream: &Stream) -> Check {
        let Task { model, run, .. } = self.task;
        let tool = &run.legs[0].tool;
        let room = Room::Corridor(&self.corridor);
        check(model, &run.load, tool, stream, room, self.body.as_ref())
    }

    /// Distance from the path without a noticeable cost in polishing, m.
    pub(super) fn free_distance(&self) -> f64 {
        let moves = self.task.run.moves.iter();
        let free = moves
            .map(|record| self.task.freedom.free_deviation(&record.movement))
            .fold(0.0, f64::max);
        if free > 0.0 { free } else { CORRIDOR * self.tolerance() }
    }

    /// The smallest tolerance on the path, m.
    pub(super) fn tolerance(&self) -> f64 {
        let legs = &self.task.run.legs;
        let line = legs.iter().any(|leg| !matches!(leg.kind, LegKind::Joint));
        if line { LINE_TOLERANCE } else { JOINT_TOLERANCE }
    }

    /// The timing problem on the path, smoothed so that a stream can follow its solution.
    pub(super) fn grid(
        &self,
        margins: &Margins,
        intervals: usize,
    ) -> Result<(PathGrid, PathLimits), Reason> {
        let (grid, limits) = self.bare_grid(margins, intervals)?;
        Ok((grid.holding(SHAPING_TIME, margins.reach), limits))
    }

    /// The timing problem on the path.
    pub(super) fn bare_grid(
        &self,
        margins: &Margins,
        intervals: usize,
    ) -> Result<(PathGrid, PathLimits), Reason> {
        let ceilings = &self.corridor.ceilings;
        let cap = |ceiling: &Ceiling| SpeedCap {
            peak: [ceiling.tcp, ceiling.corner].map(|speed| margins.speed * speed),
            joints: ceiling.joints.map(|speed| margins.speed * speed),
            ..SpeedCap::NONE
        };
        let caps: Vec<SpeedCap> = ceilings.moves.iter().map(cap).collect();
        let loaded = Loaded { model: self.task.model, load: &self.task.run.load };
        let nodes = path_grid::nodes(self.task.model, self.path, &caps, intervals);
        let no_grid = |why: String| Reason::NoStream(why);
        let grid = path_grid::grid(loaded, self.path, &nodes, &caps)
            .map_err(|error| no_grid(error.to_string()))?;
        let acceleration = ceilings.loads.acceleration.map(|x| x * margins.load);
        let torque = ceilings.loads.torque.map(|x| x * margins.torque());
        let limits =
            PathLimits::new(acceleration, torque).map_err(|error| no_grid(error.to_string()))?;
        Ok((grid, limits))
    }
}

/// The fastest profile on a grid.
pub(super) fn fastest_profile(grid: &PathGrid, limits: &PathLimits) -> Result<Profile, Reason> {
    time_optimal(grid, limits)
        .into_profile()
        .ok_or_else(|| Reason::NoStream("the torque limits leave no timing on the path".into()))
}
