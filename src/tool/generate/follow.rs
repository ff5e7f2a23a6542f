//! A timed trajectory as a stream, or as positions at the EGM period.

use super::error::GenerateError;
use super::measure::Measure;
use crate::arm::dynamics::Data;
use crate::arm::kinematics::{jacobian, limits_ok};
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
) -> Result<Followed, GenerateError> {
    let reference = reference(model, t, q)?;
    let duration = (reference.duration() / quantum()).round().max(1.0) * quantum();
    let lever = levers(model, q);
    let limits = limits(model);
    let mut why = GenerateError::Coarse { spacing: spacing_s, distance_mm: f64::INFINITY };
    for share in PLACING {
        let spacing = Spacing {
            shortest: spacing_s,
            tolerance: share * TOLERANCE,
            lever,
            ..Spacing::default()
        };
        let intervals = adaptive_intervals(&reference, duration, &spacing);
        let intervals = rounded_intervals(&intervals, duration);
        let stream = match fit_stream(&reference, intervals, &limits, &lever) {
            Ok(StreamFit::Fitted(fitted)) => rounded_points(&fitted.stream),
            Ok(StreamFit::TooFast { stretch }) => {
                let what = "it is faster than the joints allow".into();
                why = GenerateError::TooFast { what, factor: stretch };
                continue;
            }
            Ok(StreamFit::Failed) | Err(_) => continue,
        };
        let Ok(stream) = stream else { continue };
        let measure = measure(model, &stream, &reference);
        if let Some(error) = too_fast(&measure) {
            why = error;
            continue;
        }
        if measure.deviation_m <= TOLERANCE {
            return Ok(Followed { stream, reference });
        }
        why = GenerateError::Coarse { spacing: spacing_s, distance_mm: measure.deviation_m * 1e3 };
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
            measure.add_deviation(model, &q, &reference.at(start + tau).0);
        }
        start += piece.length;
    }
    measure
}

/// The trajectory at the EGM period.
pub(super) fn sampled(model: &Model, t: &[f64], q: &[Joints]) -> Result<Sampled, GenerateError> {
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
    too_fast(&measure).map_or(Ok(Sampled { positions, measure }), Err)
}

/// The exceeded limit, and how much longer the trajectory has to take.
fn too_fast(measure: &Measure) -> Option<GenerateError> {
    let what = measure.exceeded_limit()?;
    // Torque is about proportional to acceleration, so time scales with its square root.
    let worst = measure.velocity.max(measure.acceleration.max(measure.torque).sqrt());
    Some(GenerateError::TooFast { what, factor: worst.max(measure.tcp_speed).max(1.0) + 0.005 })
}

/// The interpolated trajectory.
fn reference(model: &Model, t: &[f64], q: &[Joints]) -> Result<Reference, GenerateError> {
    for (i, q) in q.iter().enumerate() {
        limits_ok(model, q).map_err(|violation| GenerateError::Range { row: i + 2, violation })?;
    }
    let last = q.len() - 1;
    for (end, from, to) in [("starts", 0, 1), ("ends", last - 1, last)] {
        let speed = |j: usize| (q[to][j] - q[from][j]).abs() / (t[to] - t[from]);
        let fastest = (0..DOF).max_by(|a, b| speed(*a).total_cmp(&speed(*b))).unwrap_or(0);
        // The mean speed of a first step from rest is half of its final speed.
        if q.len() > 2 && speed(fastest) > REST && !ramps_up(t, q, fastest, end == "starts") {
            let (joint, speed) = (fastest + 1, speed(fastest));
            return Err(GenerateError::Moving { end, joint, speed });
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
        .map_err(|_| GenerateError::Coarse { spacing: 0.0, distance_mm: f64::INFINITY })
}

/// Whether a joint ramps up from this end of the trajectory: the second step is clearly faster than
/// the first.
fn ramps_up(t: &[f64], q: &[Joints], j: usize, at_start: bool) -> bool {
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
