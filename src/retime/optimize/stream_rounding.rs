//! Times and points, rounded as in the emitted text.

use crate::rapid::ir::number::{TIME_DECIMALS, joint_as_emitted};
use crate::retime::motion::stream::{Stream, StreamError};

/// Resolution of the times of an emitted stream, s.
pub fn quantum() -> f64 {
    1.0 / 10_f64.powf(TIME_DECIMALS as f64)
}

/// `t` rounded down by at least half a step, so that the rounding of one stream does not lengthen
/// the cycle through the time of the next movement.
pub fn round_down(t: f64) -> f64 {
    (t / quantum() - 0.5).floor() * quantum()
}

/// `t` rounded up.
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

/// Intervals rounded as in the emitted text, with the sum `duration`.
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
