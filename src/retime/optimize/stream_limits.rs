//! Joint limits of a realised stream.

use crate::retime::motion::stream::{DOF, Joints, Stream};

/// Largest |q̇|, |q̈| and jerk of each joint in the realised motion; infinite without a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreamLimits {
    /// rad/s.
    pub velocity: Joints,
    /// rad/s².
    pub acceleration: Joints,
    /// rad/s³.
    pub jerk: Joints,
}

impl StreamLimits {
    /// The largest used share of a limit.
    pub fn worst_ratio(&self, stream: &Stream) -> f64 {
        let pairs = [
            (stream.max_velocity(), &self.velocity),
            (stream.max_acceleration(), &self.acceleration),
            (stream.max_jerk(), &self.jerk),
        ];
        let shares = pairs.iter().flat_map(|(used, limit)| (0..DOF).map(|j| used[j] / limit[j]));
        shares.fold(0.0, f64::max)
    }

    /// Time factor, at least 1, at which the stream with the same points keeps the limits.
    pub fn stretch(&self, stream: &Stream) -> f64 {
        let pairs = [
            (stream.max_velocity(), self.velocity, 1.0),
            (stream.max_acceleration(), self.acceleration, 2.0),
            (stream.max_jerk(), self.jerk, 3.0),
        ];
        let of = |(used, limit, power): (Joints, Joints, f64)| {
            (0..DOF).map(move |j| (used[j] / limit[j]).powf(1.0 / power))
        };
        pairs.into_iter().flat_map(of).fold(1.0, f64::max)
    }
}
