//! Movements, waits and signals as plain data in SI units.

use std::sync::Arc;

use nalgebra::Isometry3;

use super::value::{Datum, Origin};
use crate::rapid::builtins::MoveForm;
use crate::rapid::text::Span;

/// The target of a movement.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// Axis positions, rad (RAPID: degrees); the robot's six axes.
    Joints([f64; 6]),
    /// A pose of the tool in the work object's frame.
    Pose(RobTarget),
}

/// A `robtarget`.
#[derive(Clone, Debug, PartialEq)]
pub struct RobTarget {
    /// Tool frame in the object frame, m.
    pub pose: Isometry3<f64>,
    /// `cf1, cf4, cf6, cfx`.
    pub conf: [i32; 4],
}

/// A `speeddata`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speed {
    /// TCP speed, m/s.
    pub tcp: f64,
    /// Reorientation speed, rad/s.
    pub orientation: f64,
}

/// A `zonedata`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zone {
    /// True for a stop point.
    pub fine: bool,
    /// Zone of the TCP path, m.
    pub tcp: f64,
    /// Zone of the reorientation, m of TCP path.
    pub orientation: f64,
    /// Zone of the reorientation, rad.
    pub angle: f64,
}

/// The condition at a stop point for the start of the next movement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stop {
    /// Standstill: `fine`.
    Fine,
    /// A waiting time, s: `stoptime` and `fllwtime`.
    Time(f64),
    /// Errors of position and speed below a share of those allowed for `fine`: `inpos`.
    InPosition {
        /// 1 = as for `fine`.
        share: f64,
        /// Shortest time, s.
        least: f64,
        /// Longest time, s.
        most: f64,
    },
}

/// A `loaddata`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadData {
    /// kg.
    pub mass: f64,
    /// Centre of mass, m, in the frame it was given in (tool or flange).
    pub com: [f64; 3],
    /// Principal moments of inertia about the centre of mass, kg m².
    pub inertia: [f64; 3],
    /// Principal axes, quaternion w, x, y, z.
    pub axes: [f64; 4],
}

/// A `tooldata`.
#[derive(Clone, Debug)]
pub struct Tool {
    /// Its name in the program.
    pub name: Arc<str>,
    /// True if the robot holds the tool, false for a stationary tool.
    pub robhold: bool,
    /// TCP in the flange's frame (in the world's, if stationary), m.
    pub frame: Isometry3<f64>,
    /// Its load, in the flange's frame.
    pub load: LoadData,
}

impl PartialEq for Tool {
    /// Compares names without regard to case.
    fn eq(&self, other: &Tool) -> bool {
        self.name.to_lowercase() == other.name.to_lowercase()
            && self.robhold == other.robhold
            && self.frame == other.frame
            && self.load == other.load
    }
}

/// A `wobjdata`.
#[derive(Clone, Debug, PartialEq)]
pub struct WorkObject {
    /// True if the robot holds the work object.
    pub robhold: bool,
    /// Object frame in the world (user frame × object frame), m.
    pub frame: Isometry3<f64>,
    /// True if the user frame is fixed (`ufprog`), false if a mechanical unit moves it.
    pub fixed: bool,
}

/// The maximum TCP speed of a controller until `VelSet` sets another, mm/s.
const USUAL_MAX_SPEED: f64 = 5000.0;

/// Motion settings in force until changed.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// `VelSet` override, 1 = 100 %.
    pub speed_override: f64,
    /// `VelSet` maximum TCP speed, m/s.
    pub speed_max: f64,
    /// `AccSet` acceleration, 1 = 100 %.
    pub acceleration: f64,
    /// `AccSet` ramp, 1 = 100 %.
    pub ramp: f64,
    /// `AccSet\FinePointRamp`, 1 = 100 %: the ramp towards stop points.
    pub fine_point_ramp: f64,
    /// `SpeedRefresh` override, 1 = 100 %.
    pub refresh: f64,
    /// `PathAccLim`: largest acceleration and deceleration along the path of the TCP, m/s².
    pub path_acceleration: [f64; 2],
    /// `WorldAccLim`: largest acceleration of the TCP, m/s².
    pub world_acceleration: f64,
    /// `PathResol`, 1 = 100 %: how densely a path is interpolated; none if unknown.
    pub path_resolution: Option<f64>,
    /// `CirPathMode`: how the tool turns on arcs, by the controller's number.
    pub circle_mode: u8,
    /// `ConfJ`.
    pub conf_joint: bool,
    /// `ConfL`.
    pub conf_linear: bool,
    /// `PDispSet`/`PDispOn` displacement of programmed poses, none at identity.
    pub displacement: Option<Isometry3<f64>>,
    /// `GripLoad`, in the tool's frame.
    pub grip_load: Option<LoadData>,
    /// `GripLoad` as RAPID data.
    pub grip_load_data: Option<Datum>,
    /// `SingArea` other than `\Off`, as written: the orientation on lines and arcs may deviate.
    pub sing_area: Option<Arc<str>>,
    /// Settings in force that this compiler does not model, by instruction name.
    pub other: Vec<Arc<str>>,
}

impl Settings {
    /// The `VelSet` override and `AccSet` acceleration and ramp, 1 = 100 %.
    pub fn shares(&self) -> [f64; 3] {
        [self.speed_override, self.acceleration, self.ramp]
    }

    /// As `C_MOTSET` has them: the `VelSet` override in % and its maximum speed in mm/s, `AccSet`
    /// acceleration and ramp in %.
    pub fn limits(&self) -> [f64; 4] {
        let max = if self.speed_max.is_finite() { 1e3 * self.speed_max } else { USUAL_MAX_SPEED };
        let [speed, acceleration, ramp] = self.shares().map(|share| 100.0 * share);
        [speed, max, acceleration, ramp].map(|value| (value * 1e6).round() / 1e6)
    }

    /// True for `SingArea\Wrist`: on lines and arcs the wrist axes are interpolated one by one.
    pub fn axiswise_wrist(&self) -> bool {
        self.sing_area.as_ref().is_some_and(|area| area.to_lowercase().ends_with("\\wrist"))
    }
}

impl Default for Settings {
    /// The settings after a start of the program from `main`.
    fn default() -> Settings {
        Settings {
            speed_override: 1.0,
            speed_max: f64::INFINITY,
            acceleration: 1.0,
            ramp: 1.0,
            fine_point_ramp: 1.0,
            refresh: 1.0,
            path_acceleration: [f64::INFINITY; 2],
            world_acceleration: f64::INFINITY,
            path_resolution: Some(1.0),
            circle_mode: 0,
            conf_joint: true,
            conf_linear: true,
            displacement: None,
            grip_load: None,
            grip_load_data: None,
            sing_area: None,
            other: Vec::new(),
        }
    }
}

/// An argument of a movement with its value at execution.
#[derive(Clone, Debug, PartialEq)]
pub struct Argument {
    /// The expression.
    pub span: Span,
    /// Name of the type of the parameter.
    pub type_name: &'static str,
    /// Its value.
    pub datum: Datum,
}

/// A call of a routine that has not returned yet.
#[derive(Debug, PartialEq, Eq)]
pub struct ActiveCall {
    /// The name of the routine in the call; the expression of a late call.
    pub name: Span,
    /// The call of the routine that contains this call.
    pub within: Option<Arc<ActiveCall>>,
}

/// The names in the calls that led to a statement, the last call first.
pub fn calls(last: Option<&Arc<ActiveCall>>) -> impl Iterator<Item = Span> {
    std::iter::successors(last, |call| call.within.as_ref()).map(|call| call.name)
}

/// A movement as it is executed.
#[derive(Clone, Debug)]
pub struct Movement {
    /// The instruction as written.
    pub instruction: Arc<str>,
    /// Interpolation.
    pub form: MoveForm,
    /// True for `Move…` instructions without further effect.
    pub plain: bool,
    /// The statement.
    pub span: Span,
    /// Name of the routine that contains it.
    pub routine: Arc<str>,
    /// The call of its routine; none in the routine that starts the program.
    pub call: Option<Arc<ActiveCall>>,
    /// Circle point of a circular movement.
    pub via: Option<RobTarget>,
    /// Where it goes.
    pub target: Target,
    /// The external axes of the target, in mm or degrees depending on the axis (not stated in the
    /// program); 9E9 for an axis that does not exist. `None` if unknown.
    pub external: Option<[f64; 6]>,
    /// Speed, `\V` applied.
    pub speed: Speed,
    /// `\T`, s.
    pub time: Option<f64>,
    /// Zone, `\Z` and `\Inpos` applied.
    pub zone: Zone,
    /// `\Inpos`: the condition at a stop point.
    pub stop: Stop,
    /// Tool.
    pub tool: Tool,
    /// The argument that states the tool.
    pub tool_span: Span,
    /// Work object.
    pub wobj: WorkObject,
    /// `\TLoad`: replaces the tool's load and `GripLoad`, in the flange's frame.
    pub total_load: Option<LoadData>,
    /// Settings in force.
    pub settings: Arc<Settings>,
    /// `\Conc`: the following statements run during the movement.
    pub concurrent: bool,
    /// Optional arguments that change the movement in ways not modelled (`\Corr`, `\ID` …).
    pub other_arguments: Vec<Arc<str>>,
    /// The dependences of the arguments.
    pub origin: Origin,
    /// The arguments that determine path and speed.
    pub arguments: Vec<Argument>,
}

impl Movement {
    /// The TCP speed stated for a line or arc, m/s; infinite for a joint movement, whose stated
    /// speed is only an average.
    pub fn line_speed(&self) -> f64 {
        match self.form {
            MoveForm::Linear | MoveForm::Circular => self.speed.tcp.min(self.settings.speed_max),
            _ => f64::INFINITY,
        }
    }
}

/// A movement with unknown arguments.
#[derive(Clone, Debug)]
pub struct Unresolved {
    /// The statement.
    pub span: Span,
    /// Why, in words.
    pub reason: String,
    /// True if the robot may be elsewhere afterwards.
    pub moves: bool,
}

/// A wait.
#[derive(Clone, Debug)]
pub struct Wait {
    /// The instruction as written.
    pub instruction: Arc<str>,
    /// The statement.
    pub span: Span,
    /// Name of the routine that contains it.
    pub routine: Arc<str>,
    /// The call of its routine; none in the routine that starts the program.
    pub call: Option<Arc<ActiveCall>>,
    /// Duration, s, if the program states it.
    pub duration: Option<f64>,
    /// The argument with the duration, if it consists only of literals and constants.
    pub constant: Option<Span>,
    /// `\MaxTime`: longest duration, s.
    pub max_time: Option<f64>,
    /// The awaited input.
    pub signal: Option<Arc<str>>,
    /// The cause in words, if neither duration nor input is known.
    pub other: Option<String>,
    /// `GripLoad` in force, in the tool's frame.
    pub grip_load: Option<LoadData>,
    /// For a movement of external axes: their positions after it, in RAPID's units, if known.
    pub external: Option<[f64; 6]>,
}

/// A change of an output.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// The instruction as written.
    pub instruction: Arc<str>,
    /// The statement.
    pub span: Span,
    /// The signal.
    pub signal: Arc<str>,
    /// Its new value as written, after evaluation.
    pub value: String,
}
