//! Times and points, rounded as in the emitted text.

use crate::rapid::ir::number::{TIME_DECIMALS, joint_as_emitted};
use crate::retime::motion::stream::{Stream, StreamError};

/// Step of the times of an emitted stream, s.
pub fn quantum() -> f64 {
    1.0 / 10_f64.powf(TIME_DECIMALS as f64)
}

/// At least half a step below `t`: what rounding the figures of one stream does to the time of
/// the next movement must not add up to a longer cycle.
pub fn round_down(t: f64) -> f64 {
    (t / quantum() - 0.5).floor() * quantum()
}

/// At or above `t`.
pub fn round_up(t: f64) -> f64 {
    (t / quantum()).ceil() * quantum()
}

/// The stream with points rounded as in the emitted text.
///
/// # Errors
/// None for a valid stream.
pub fn rounded_points(stream: &Stream) -> Result<Stream, StreamError> {
    let points = stream.points().iter().map(|q| q.map(joint_as_emitted)).collect();
    Stream::new(*stream.start(), points, stream.intervals().to_vec())
}

/// Intervals as they will be emitted, with the same sum.
pub fn rounded_intervals(intervals: &[f64], duration: f64) -> Vec<f64> {
    let total = (duration / quantum()).round() as i64;
    let mut ticks: Vec<i64> = Vec::with_capacity(intervals.len());
    let mut exact = 0.0;
    let mut used = 0;
    for interval in intervals {
        exact += interval / quantum();
        let tick = exact.round() as i64 - used;
        ticks.push(tick);
        used += tick;
    }
    if let Some(last) = ticks.last_mut() {
        *last += total - used;
    }
    let scale = 1.0 / quantum();
    ticks.into_iter().map(|t| t as f64 / scale).collect()
}
