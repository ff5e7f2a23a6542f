//! Slower execution of a stream that exceeds the limits of the robot.
//!
//! A controller that cannot reach a point within its `\T` takes longer there and keeps the times of
//! the other points. So the intervals with an excess are lengthened in small steps until no limit
//! is exceeded.

use super::controller::joint_limits;
use super::sampling::Loaded;
use super::stream::{Piece, Stream};
use crate::arm::dynamics::{Data, torque};
use crate::arm::robot::Model;
use crate::retime::path::joint_path::{DOF, Joints};

/// Accepted excess of a limit: rounding of the emitted figures.
const ROUNDING: f64 = 1e-3;
/// Largest relative change of an interval in one round.
const STEP: f64 = 0.03;
/// Largest number of rounds.
const ROUNDS: usize = 300;
/// Largest ratio of the duration to that after [`Limits::within_reach`]: slower motion does not lower a
/// torque that exceeds its limit at rest.
const SLOWEST: f64 = 20.0;
/// Ratio of the times that the robot needs to the given ones from which on they are lengthened at once.
const FAR: f64 = 10.0;
/// Share of the time that a displacement takes at the limits.
const LEAST_SHARE: f64 = 0.2;

/// The stream as the robot executes it; unchanged if it keeps all limits. `acceleration`: the share
/// of the accelerations that `AccSet` allows.
pub(super) fn within_limits(loaded: Loaded<'_>, stream: Stream, acceleration: f64) -> Stream {
    let limits = Limits::new(loaded.model, acceleration);
    let mut data = Data::new();
    let mut late = limits.within_reach(stream);
    let longest = SLOWEST * late.duration();
    for _ in 0..ROUNDS {
        let factors: Vec<f64> =
            late.pieces().map(|piece| limits.longer(loaded, &mut data, &piece)).collect();
        if factors.iter().all(|factor| *factor <= 1.0) || late.duration() > longest {
            break;
        }
        // Piece p reaches from the middle of interval p to that of the next one, counted from 1.
        let count = late.intervals().len();
        let interval = |i: usize| late.intervals()[i] * factors[i].max(factors[i + 1]);
        let intervals = (0..count).map(interval).collect();
        match Stream::new(*late.start(), late.points().to_vec(), intervals) {
            Ok(next) => late = next,
            Err(_) => break,
        }
    }
    late
}

struct Limits {
    velocity: Joints,
    acceleration: Joints,
    torque: Joints,
}

impl Limits {
    fn new(model: &Model, acceleration: f64) -> Limits {
        let most = joint_limits(model.limits.acceleration.as_ref());
        Limits {
            velocity: joint_limits(model.limits.velocity.as_ref()),
            acceleration: most.map(|most| acceleration * most),
            torque: joint_limits(model.torque_bounds()),
        }
    }

    /// The stream; where its speeds or accelerations are more than [`FAR`] times what the robot can do,
    /// each interval has at least a share of the time that its displacement takes at the limits, so
    /// that the rounds reach them.
    fn within_reach(&self, stream: Stream) -> Stream {
        if self.excess(&stream.max_velocity(), &stream.max_acceleration()) <= FAR {
            return stream;
        }
        let starts = std::iter::once(stream.start()).chain(stream.points());
        let least = |(from, to): (&Joints, &Joints)| {
            let distance = std::array::from_fn(|j| to[j] - from[j]);
            LEAST_SHARE * self.excess(&distance, &distance)
        };
        let least = starts.zip(stream.points()).map(least);
        let intervals = least.zip(stream.intervals()).map(|(least, time)| time.max(least));
        let intervals = intervals.collect();
        Stream::new(*stream.start(), stream.points().to_vec(), intervals).unwrap_or(stream)
    }

    /// How many times too short the times are for these speeds and accelerations; of displacements, the
    /// time that they take at the limits, s.
    fn excess(&self, qd: &Joints, qdd: &Joints) -> f64 {
        (0..DOF).fold(0.0, |excess: f64, j| {
            excess
                .max(qd[j].abs() / self.velocity[j])
                .max((qdd[j].abs() / self.acceleration[j]).sqrt())
        })
    }

    /// Factor on the intervals at a piece; 1 within the limits.
    fn longer(&self, loaded: Loaded<'_>, data: &mut Data, piece: &Piece) -> f64 {
        let mut excess: f64 = 1.0;
        for share in [0.0, 0.5, 1.0] {
            let (q, qd, qdd) = piece.at(share * piece.length);
            let tau = if self.torque.iter().any(|limit| limit.is_finite()) {
                let found = torque(loaded.model, data, loaded.load, &q, &qd, &qdd);
                std::array::from_fn(|j| found.rigid[j] + found.friction[j])
            } else {
                [0.0; DOF]
            };
            excess = excess.max(self.excess(&qd, &qdd));
            for j in 0..DOF {
                excess = excess.max((tau[j].abs() / self.torque[j]).sqrt());
            }
        }
        if excess > 1.0 + ROUNDING { excess.min(1.0 + STEP) } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

    use super::*;
    use crate::arm::dynamics::Load;
    use crate::arm::robot;

    /// Joint 1 moves by 1 rad in 20 equal intervals (s).
    fn stream(interval: f64) -> Stream {
        let place = |i: usize| 0.5 - 0.5 * (i as f64 * std::f64::consts::PI / 20.0).cos();
        let point = |i: usize| std::array::from_fn(|j| if j == 0 { place(i) } else { 0.3 });
        Stream::new(point(0), (1..=20).map(point).collect(), vec![interval; 20]).unwrap()
    }

    fn keeps_limits(stream: &Stream, model: &Model) -> bool {
        let within = |found: Joints, limits: &Option<Vec<f64>>| {
            let limits = limits.as_ref().unwrap();
            found.iter().zip(limits).all(|(x, most)| *x <= (1.0 + 2.0 * ROUNDING) * most)
        };
        within(stream.max_velocity(), &model.limits.velocity)
            && within(stream.max_acceleration(), &model.limits.acceleration)
    }

    #[test]
    fn no_time_is_too_short_for_the_limits() {
        let model = robot::find("IRB1600-10/1.45").unwrap();
        let load = Load::none();
        let loaded = Loaded { model: &model, load: &load };
        for interval in [1e-2, 1e-3, 1e-4, 1e-6] {
            assert!(
                keeps_limits(&within_limits(loaded, stream(interval), 1.0), &model),
                "{interval}"
            );
            // Points that can be reached in time keep theirs.
            let point =
                |i: usize| std::array::from_fn(|j| if j == 0 { 0.09 * i as f64 } else { 0.3 });
            let mut times = vec![1.0; 7];
            times[2..5].fill(interval);
            let hasty = Stream::new(point(0), (1..=7).map(point).collect(), times).unwrap();
            let late = within_limits(loaded, hasty, 1.0);
            assert!(keeps_limits(&late, &model), "{interval}");
            assert!(late.duration() < 4.6, "{interval}: {}", late.duration());
            assert!((late.intervals()[0] - 1.0).abs() < 1e-9, "{:?}", late.intervals());
        }
    }

    #[test]
    fn only_intervals_beyond_the_limits_get_longer() {
        let model = robot::find("IRB1600-10/1.45").unwrap();
        let load = Load::none();
        let loaded = Loaded { model: &model, load: &load };
        let calm = stream(0.08);
        assert_eq!(within_limits(loaded, calm.clone(), 1.0), calm);
        let hasty = stream(0.03);
        let most = model.limits.acceleration.as_ref().unwrap()[0];
        let ratio = (hasty.max_acceleration()[0] / most).sqrt();
        assert!(ratio > 1.0, "{ratio}");
        let late = within_limits(loaded, hasty.clone(), 1.0);
        assert!(late.max_acceleration()[0] <= (1.0 + 2.0 * ROUNDING) * most);
        // Uniform slowing takes the factor `ratio`.
        assert!(late.duration() > hasty.duration());
        assert!(late.duration() < ratio.max(1.0) * hasty.duration() * 1.05, "{}", late.duration());
        let middle = |stream: &Stream| stream.intervals()[10] / stream.intervals()[0];
        assert!(middle(&late) < 1.0, "{:?}", late.intervals());
        let gentle = within_limits(loaded, hasty, 0.5);
        assert!(gentle.max_acceleration()[0] <= 0.5 * (1.0 + 2.0 * ROUNDING) * most);
    }
}
