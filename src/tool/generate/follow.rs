//! A timed trajectory as a stream, or as positions at the EGM period.

use super::measure::Measure;
use crate::arm::dynamics::Data;
use crate::arm::kinematics::{LimitViolation, jacobian, limits_ok};
use crate::arm::robot::Model;
use crate::retime::motion::stream::Stream;
use crate::retime::motion::timed::JointState;
use crate::retime::optimize::stream_fit::{StreamFit, fit_stream};
use crate::retime::optimize::stream_limits::StreamLimits;
use crate::retime::optimize::stream_reference::Reference;
use crate::retime::optimize::stream_rounding::{quantum, rounded_intervals, rounded_points};
use crate::retime::optimize::stream_spacing::{Spacing, adaptive_intervals};
use crate::retime::path::joint_path::{DOF, Joints};
use crate::tool::emit::EGM_STEP_S;
use nalgebra::Isometry3;

/// Maximum distance of the flange from the trajectory at any time, m.
pub(super) const TOLERANCE: f64 = 1e-3;
/// Shares of the tolerance for the placement of points, tried in order.
const PLACING: [f64; 4] = [0.3, 0.1, 0.03, 0.01];
/// Maximum step between two samples, s.
const STEP: f64 = 0.002;
/// Maximum speed of the first and last step that counts as rest, rad/s.
const REST: f64 = 0.02;

/// Why a trajectory cannot be followed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FollowError {
    /// A position is out of range.
    #[error("row {row}: {violation}; if the columns are degrees, name them q1_deg … q6_deg")]
    Range {
        /// Line of the file.
        row: usize,
        /// The violated limit.
        violation: LimitViolation,
    },
    /// It does not start or end at rest.
    #[error(
        "the trajectory {end} with {speed:.3} rad/s in joint {joint}; a program starts and ends at \
         rest: add a ramp"
    )]
    Moving {
        /// `starts` or `ends`.
        end: &'static str,
        /// From 1.
        joint: usize,
        /// rad/s.
        speed: f64,
    },
    /// A limit is exceeded.
    #[error("the trajectory can't be followed: {what}; make it {factor:.2} times as long or more")]
    TooFast {
        /// The exceeded limit.
        what: String,
        /// Minimum stretch of its times.
        factor: f64,
    },
    /// The point spacing is too coarse.
    #[error(
        "with points {spacing} s apart the robot would be {distance_mm:.2} mm from the trajectory; \
         give a smaller --spacing, or a smoother trajectory"
    )]
    Coarse {
        /// s.
        spacing: f64,
        /// mm.
        distance_mm: f64,
    },
}

/// A stream and its reference trajectory.
pub(super) struct Followed {
    pub(super) stream: Stream,
    pub(super) reference: Reference,
}

/// Positions at the EGM period.
pub(super) struct Sampled {
    pub(super) positions: Vec<Joints>,
    pub(super) measure: Measure,
}

impl Sampled {
    pub(super) fn duration(&self) -> f64 {
        EGM_STEP_S * (self.positions.len() - 1) as f64
    }
}

/// The stream that follows the trajectory within [`TOLERANCE`].
pub(super) fn follow(
    model: &Model,
    t: &[f64],
    q: &[Joints],
    spacing_s: f64,
) -> Result<Followed, FollowError> {
    let reference = reference(model, t, q)?;
    let duration = (reference.duration() / quantum()).round().max(1.0) * quantum();
    let lever = levers(model, q);
    let limits = limits(model);
    let mut why = FollowError::Coarse { spacing: spacing_s, distance_mm: f64::INFINITY };
    for share in PLACING {
        let spacing = Spacing {
            shortest: spacing_s,
            tolerance: share * TOLERANCE,
            lever,
            ..Spacing::default()
        };
        let intervals = adaptive_intervals(&reference, duration, &spacing);
        let intervals = rounded_intervals(&intervals, duration);
        let too_fast = |what: &str, factor| FollowError::TooFast { what: what.into(), factor };
        let stream = match fit_stream(&reference, intervals, &limits, &lever) {
            Ok(StreamFit::Fitted(fitted)) => rounded_points(&fitted.stream),
            Ok(StreamFit::TooFast { stretch }) => {
                why = too_fast("it is faster than the joints allow", stretch);
                continue;
            }
            Ok(StreamFit::Failed) | Err(_) => continue,
        };
        let Ok(stream) = stream else { continue };
        let measure = measure(model, &stream, &reference);
        if let Some(fault) = measure.fault() {
            // Torque is about proportional to acceleration, so time scales with its square root.
            let worst = measure.velocity.max(measure.acceleration.max(measure.torque).sqrt());
            why = too_fast(&fault, worst.max(measure.tcp_speed).max(1.0) + 0.005);
            continue;
        }
        if measure.deviation_m <= TOLERANCE {
            return Ok(Followed { stream, reference });
        }
        why = FollowError::Coarse { spacing: spacing_s, distance_mm: measure.deviation_m * 1e3 };
    }
    Err(why)
}

/// Compares the realised motion of a stream with limits and trajectory.
pub(super) fn measure(model: &Model, stream: &Stream, reference: &Reference) -> Measure {
    let mut measure = Measure::default();
    let mut data = Data::new();
    let mut start = 0.0;
    for piece in stream.pieces() {
        let steps = (piece.length / STEP).ceil().max(1.0) as usize;
        for i in 0..=steps {
            let tau = piece.length * i as f64 / steps as f64;
            let (q, qd, qdd) = piece.at(tau);
            measure.add(model, &mut data, &JointState { q, qd, qdd });
            measure.stray(model, &q, &reference.at(start + tau).0);
        }
        start += piece.length;
    }
    measure
}

/// The trajectory at the EGM period.
pub(super) fn sampled(model: &Model, t: &[f64], q: &[Joints]) -> Result<Sampled, FollowError> {
    let reference = reference(model, t, q)?;
    let steps = (reference.duration() / EGM_STEP_S).ceil() as usize;
    let positions: Vec<Joints> =
        (0..=steps).map(|i| reference.at(EGM_STEP_S * i as f64).0).collect();
    let mut measure = Measure::default();
    let mut data = Data::new();
    for three in positions.windows(3) {
        let qd = std::array::from_fn(|j| (three[2][j] - three[0][j]) / (2.0 * EGM_STEP_S));
        let bend = |j: usize| three[2][j] - 2.0 * three[1][j] + three[0][j];
        let qdd = std::array::from_fn(|j| bend(j) / (EGM_STEP_S * EGM_STEP_S));
        measure.add(model, &mut data, &JointState { q: three[1], qd, qdd });
    }
    match measure.fault() {
        Some(what) => {
            let worst = measure.velocity.max(measure.acceleration.max(measure.torque).sqrt());
            Err(FollowError::TooFast {
                what,
                factor: worst.max(measure.tcp_speed).max(1.0) + 0.005,
            })
        }
        None => Ok(Sampled { positions, measure }),
    }
}

/// The interpolated trajectory.
fn reference(model: &Model, t: &[f64], q: &[Joints]) -> Result<Reference, FollowError> {
    for (i, q) in q.iter().enumerate() {
        limits_ok(model, q).map_err(|violation| FollowError::Range { row: i + 2, violation })?;
    }
    let last = q.len() - 1;
    for (end, from, to) in [("starts", 0, 1), ("ends", last - 1, last)] {
        let speed = |j: usize| (q[to][j] - q[from][j]).abs() / (t[to] - t[from]);
        let fastest = (0..DOF).max_by(|a, b| speed(*a).total_cmp(&speed(*b))).unwrap_or(0);
        // The mean speed of a first step from rest is half of its final speed.
        if q.len() > 2 && speed(fastest) > REST && !eases(t, q, fastest, end == "starts") {
            let (joint, speed) = (fastest + 1, speed(fastest));
            return Err(FollowError::Moving { end, joint, speed });
        }
    }
    let velocity = |i: usize| -> Joints {
        if i == 0 || i == last {
            return [0.0; DOF];
        }
        let (h0, h1) = (t[i] - t[i - 1], t[i + 1] - t[i]);
        std::array::from_fn(|j| {
            let (d0, d1) = ((q[i][j] - q[i - 1][j]) / h0, (q[i + 1][j] - q[i][j]) / h1);
            (d0 * h1 + d1 * h0) / (h0 + h1)
        })
    };
    let qd = (0..q.len()).map(velocity).collect();
    Reference::new(t.to_vec(), q.to_vec(), qd)
        .map_err(|_| FollowError::Coarse { spacing: 0.0, distance_mm: f64::INFINITY })
}

/// Whether a joint ramps up from this end of the trajectory: the second step is clearly faster than
/// the first.
fn eases(t: &[f64], q: &[Joints], j: usize, at_start: bool) -> bool {
    let speed = |i: usize| (q[i + 1][j] - q[i][j]).abs() / (t[i + 1] - t[i]);
    let (first, second) = if at_start { (0, 1) } else { (q.len() - 2, q.len() - 3) };
    speed(first) < 0.75 * speed(second)
}

fn limits(model: &Model) -> StreamLimits {
    let list = |values: &Option<Vec<f64>>| -> Joints {
        std::array::from_fn(|j| values.as_ref().map_or(f64::INFINITY, |values| values[j]))
    };
    StreamLimits {
        velocity: list(&model.limits.velocity),
        acceleration: list(&model.limits.acceleration),
        jerk: list(&model.limits.jerk),
    }
}

/// Maximum flange displacement per joint angle, m/rad.
fn levers(model: &Model, q: &[Joints]) -> Joints {
    let mut levers = [0.0_f64; DOF];
    for q in q {
        let rates = jacobian::<DOF>(model, q, &Isometry3::identity());
        for (j, lever) in levers.iter_mut().enumerate() {
            *lever = lever.max(rates.fixed_view::<3, 1>(0, j).norm());
        }
    }
    // Pure rotations of the flange count as with a tool of 0.1 m.
    levers.map(|lever| lever.max(0.1))
}
