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
/// Largest ratio of the duration to that of a stream whose speeds and accelerations are near the
/// limits: a torque beyond its limit at rest stays there at any speed.
const SLOWEST: f64 = 20.0;

/// The stream as the robot executes it; unchanged if it keeps all limits.
pub(super) fn within_limits(loaded: Loaded<'_>, stream: Stream) -> Stream {
    let limits = Limits::new(loaded.model);
    let mut data = Data::new();
    let mut late = limits.near(stream);
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
    fn new(model: &Model) -> Limits {
        Limits {
            velocity: joint_limits(model.limits.velocity.as_ref()),
            acceleration: joint_limits(model.limits.acceleration.as_ref()),
            torque: joint_limits(model.torque_bounds()),
        }
    }

    /// A stream whose times are far too short for the speeds and accelerations of the robot, slower as a
    /// whole so that the rounds reach the limits; others unchanged.
    fn near(&self, stream: Stream) -> Stream {
        let excess = self.excess(&stream.max_velocity(), &stream.max_acceleration());
        let slower = excess / (0.5 * SLOWEST);
        if slower <= 1.0 {
            return stream;
        }
        let intervals = stream.intervals().iter().map(|interval| interval * slower).collect();
        Stream::new(*stream.start(), stream.points().to_vec(), intervals).unwrap_or(stream)
    }

    /// How many times too short the times are for these speeds and accelerations.
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

    #[test]
    fn no_time_is_too_short_for_the_limits() {
        let model = robot::find("IRB1600-10/1.45").unwrap();
        let load = Load::none();
        let loaded = Loaded { model: &model, load: &load };
        let within = |found: Joints, limits: &Option<Vec<f64>>| {
            let limits = limits.as_ref().unwrap();
            found.iter().zip(limits).all(|(x, most)| *x <= (1.0 + 2.0 * ROUNDING) * most)
        };
        for interval in [1e-2, 1e-3, 1e-4, 1e-6] {
            let late = within_limits(loaded, stream(interval));
            assert!(within(late.max_velocity(), &model.limits.velocity), "{interval}");
            assert!(within(late.max_acceleration(), &model.limits.acceleration), "{interval}");
        }
    }

    #[test]
    fn only_intervals_beyond_the_limits_get_longer() {
        let model = robot::find("IRB1600-10/1.45").unwrap();
        let load = Load::none();
        let loaded = Loaded { model: &model, load: &load };
        let calm = stream(0.08);
        assert_eq!(within_limits(loaded, calm.clone()), calm);
        let hasty = stream(0.03);
        let most = model.limits.acceleration.as_ref().unwrap()[0];
        let ratio = (hasty.max_acceleration()[0] / most).sqrt();
        assert!(ratio > 1.0, "{ratio}");
        let late = within_limits(loaded, hasty.clone());
        assert!(late.max_acceleration()[0] <= (1.0 + 2.0 * ROUNDING) * most);
        // Uniform slowing takes the factor `ratio`.
        assert!(late.duration() > hasty.duration());
        assert!(late.duration() < ratio.max(1.0) * hasty.duration() * 1.05, "{}", late.duration());
        let middle = |stream: &Stream| stream.intervals()[10] / stream.intervals()[0];
        assert!(middle(&late) < 1.0, "{:?}", late.intervals());
    }
}
