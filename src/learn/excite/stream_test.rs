//! Short test streams around one pose that show how a controller realises streams.

use std::f64::consts::TAU;

use super::error::ExciteError;
use super::feasible::{check, rate_limits};
use super::series::State;
use crate::arm::dynamics::Load;
use crate::arm::kinematics::Body;
use crate::arm::robot::{MAX_DOF, Model};
use crate::retime::motion::stream::{DOF, Joints, Stream};

/// Largest distance of a point from the start \[rad\].
const REACH: f64 = 0.2;
/// Share of the speed and acceleration limits that a test may use: the limits of the controller may
/// be lower than assumed.
const SHARE: f64 = 0.5;
/// Interval at which limits are checked \[s\].
const STEP: f64 = 0.002;
/// Least reach of a test \[rad\]: the log does not resolve smaller ones.
const LEAST_REACH: f64 = 0.03;
/// Factor between successive sizes that are tried.
const SMALLER: f64 = 0.9;

/// One test.
#[derive(Clone, Debug, PartialEq)]
pub struct StreamTest {
    /// Description.
    pub what: &'static str,
    /// Starts and ends at the same pose.
    pub stream: Stream,
}

/// A test of unknown size: points relative to it, and the time `\T` of each \[s\].
struct Pattern {
    what: &'static str,
    points: Vec<Joints>,
    intervals: Vec<f64>,
}

/// The tests around `start` \[rad\] for a robot with six joints, as large as half of the speed and
/// acceleration limits, the other limits, the obstacles and the arm itself allow.
///
/// # Errors
/// Limits of speed or acceleration are missing, or there is no room to move at this pose.
pub fn stream_tests(
    model: &Model,
    body: &Body<'_>,
    start: &Joints,
) -> Result<Vec<StreamTest>, ExciteError> {
    rate_limits(model)?;
    patterns().iter().map(|pattern| sized(model, body, start, pattern)).collect()
}

fn patterns() -> Vec<Pattern> {
    let alone = [0.3, 0.8, 1.0, 0.4, -0.5, -1.0, -0.4, 0.0];
    let waves = |count: usize, turns: [f64; DOF], fades: bool| -> Vec<Joints> {
        let angle = |k: usize| TAU * k as f64 / count as f64;
        let size = |k: usize| if fades { (0.5 * angle(k)).sin().powi(2) } else { 1.0 };
        (1..=count).map(|k| turns.map(|turn| size(k) * (turn * angle(k)).sin())).collect()
    };
    vec![
        Pattern {
            what: "axis 1 alone, uneven times",
            points: alone.iter().map(|x| [*x, 0.0, 0.0, 0.0, 0.0, 0.0]).collect(),
            intervals: vec![0.2, 0.3, 0.25, 0.4, 0.5, 0.35, 0.3, 0.4],
        },
        Pattern {
            what: "all axes, sharp corners",
            points: waves(12, [1.0, 2.0, -1.0, 3.0, -2.0, 1.0], false),
            intervals: vec![0.25; 12],
        },
        Pattern {
            what: "all axes, points every 0.05 s",
            points: waves(40, [1.0, 1.0, -2.0, -1.0, 2.0, 1.0], true),
            intervals: vec![0.05; 40],
        },
        Pattern {
            what: "two points, there and back",
            points: vec![[1.0, -0.5, 0.5, 1.0, -1.0, 1.0], [0.0; DOF]],
            intervals: vec![0.5, 0.6],
        },
    ]
}

fn sized(
    model: &Model,
    body: &Body<'_>,
    start: &Joints,
    pattern: &Pattern,
) -> Result<StreamTest, ExciteError> {
    let mut size = REACH;
    while size >= LEAST_REACH {
        let points = pattern
            .points
            .iter()
            .map(|p| std::array::from_fn(|joint| start[joint] + size * p[joint]));
        let stream = Stream::new(*start, points.collect(), pattern.intervals.clone());
        if let Some(stream) = stream.ok().filter(|stream| fits(model, body, stream)) {
            return Ok(StreamTest { what: pattern.what, stream });
        }
        size *= SMALLER;
    }
    Err(ExciteError::NoRoom)
}

fn fits(model: &Model, body: &Body<'_>, stream: &Stream) -> bool {
    let steps = (stream.duration() / STEP).ceil() as usize;
    let padded = |x: &Joints| -> [f64; MAX_DOF] {
        std::array::from_fn(|joint| x.get(joint).copied().unwrap_or_default())
    };
    let at = |k: usize| -> State {
        let (q, qd, qdd) = stream.eval(STEP * k as f64);
        [padded(&q), padded(&qd), padded(&qdd)]
    };
    // Points may lie outside the predicted motion; without corner zones the robot visits them.
    let visited =
        stream.points().iter().map(|point| [padded(point), [0.0; MAX_DOF], [0.0; MAX_DOF]]);
    let states: Vec<State> = (0..=steps).map(at).chain(visited).collect();
    let found = check(model, body, &Load::none(), &states);
    let r = &found.ratios;
    r.position <= 1.0
        && [r.velocity, r.acceleration].iter().all(|ratio| *ratio <= SHARE)
        && r.torque <= 1.0
        && found.to_obstacles >= 0.0
        && found.to_itself >= 0.0
}
