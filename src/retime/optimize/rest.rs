//! A wait of known duration at a nearby pose of less holding power: move there, wait, move back.
//!
//! Holding power as in Paes et al. 2014, table 3; the motions must cost less than the pose saves.

use super::allowed::Loads;
use super::check::{Room, check};
use super::standstill::standing;
use super::stream_rounding::{rounded_intervals, rounded_points};
use crate::arm::dynamics::Load;
use crate::arm::kinematics::{Body, Tcp};
use crate::arm::robot::Model;
use crate::retime::energy::power::motion_energy;
use crate::retime::energy::{EnergyParts, account};
use crate::retime::motion::stream::{Joints, Stream};
use crate::retime::motion::timed::TimedMotion;
use crate::retime::path::joint_path::DOF;

/// A robot at standstill.
#[derive(Clone, Copy)]
pub struct Standstill<'a> {
    /// The robot.
    pub model: &'a Model,
    /// Tool and payload.
    pub load: &'a Load,
    /// The tool.
    pub tool: &'a Tcp,
    /// Joint angles, rad.
    pub q: Joints,
    /// Duration, s.
    pub duration: f64,
    /// Largest joint loads.
    pub loads: &'a Loads,
    /// Arm and tool with the keep-out zones.
    pub body: Option<&'a Body<'a>>,
}

/// The wait at a nearby pose.
#[derive(Clone, Debug)]
pub struct Rest {
    /// Motion to the pose, as emitted.
    pub out: Stream,
    /// Duration of standstill at the pose, s.
    pub wait_s: f64,
    /// Motion back, as emitted.
    pub back: Stream,
    /// Energy of the whole wait.
    pub energy: EnergyParts,
    /// Energy without motion, J.
    pub energy_before_j: f64,
}

/// Tried shares of the displacement to the best pose.
const SHARES: [f64; 4] = [0.25, 0.5, 0.75, 1.0];
/// Fewest and most points of a motion.
const POINTS: (usize, usize) = (4, 16);
/// Ratio of successive tried durations of a motion.
const SLOWER: f64 = 1.25;
/// Largest share of the wait for the two motions.
const MOVING: f64 = 0.8;
/// Least saving, as a share of the holding energy.
const WORTHWHILE: f64 = 0.05;
/// Smallest joint displacement that is worth a stream, rad.
const LEAST_DISPLACEMENT: f64 = 0.02;

/// The rest of least energy at a pose within `distance` (rad) in each joint, with streams of at
/// least `spacing` (s) between points. `None` if it saves too little.
pub fn rest(standstill: &Standstill<'_>, distance: f64, spacing: f64) -> Option<Rest> {
    let Standstill { model, load, q, duration, .. } = standstill;
    let standing = standing(model, None, load, q, distance);
    let worth = (1.0 - WORTHWHILE) * standing.holding_w() * duration;
    let farthest = (0..DOF).map(|j| (standing.best[j] - q[j]).abs()).fold(0.0, f64::max);
    if farthest < LEAST_DISPLACEMENT || standing.best_w * duration >= worth {
        return None;
    }
    let base = account::base(model, *duration).energy_j();
    let taken = |rest: &Rest| rest.energy.energy_j() - base;
    let best = SHARES.iter().filter_map(|share| {
        let low = std::array::from_fn(|j| q[j] + share * (standing.best[j] - q[j]));
        let mut best: Option<Rest> = None;
        let mut time = POINTS.0 as f64 * spacing;
        while 2.0 * time <= MOVING * duration {
            match trip(standstill, &low, time, spacing) {
                // Beyond the best duration slower motions only raise the energy.
                Ok(found) if best.as_ref().is_some_and(|best| taken(best) <= taken(&found)) => {
                    break;
                }
                Ok(found) => best = Some(found),
                Err(Refused::AtEverySpeed) => break,
                Err(Refused::TooFast) => {}
            }
            time *= SLOWER;
        }
        best
    });
    best.min_by(|a, b| taken(a).total_cmp(&taken(b))).filter(|rest| taken(rest) < worth)
}

/// Reason why a motion is not possible.
enum Refused {
    /// It is too fast.
    TooFast,
    /// At every speed.
    AtEverySpeed,
}

/// Both motions in `time` (s) each, if they keep the limits.
fn trip(
    standstill: &Standstill<'_>,
    low: &Joints,
    time: f64,
    spacing: f64,
) -> Result<Rest, Refused> {
    let Standstill { model, load, tool, q, duration, loads, body } = standstill;
    let out = straight(q, low, time, spacing).ok_or(Refused::AtEverySpeed)?;
    let back = straight(out.end(), q, time, spacing).ok_or(Refused::AtEverySpeed)?;
    let checked = |stream: &Stream| check(model, load, tool, stream, Room::Free(loads), *body);
    let check = checked(&out).max(&checked(&back));
    if check.intrusion_m > 0.0 || !check.in_range {
        return Err(Refused::AtEverySpeed);
    }
    if !check.holds() {
        return Err(Refused::TooFast);
    }
    let moving = |stream: &Stream| {
        let time = stream.duration();
        let motion = TimedMotion::Stream(stream.clone());
        motion_energy(model, load, &motion, 0.0, time) + account::base(model, time)
    };
    let wait_s = duration - out.duration() - back.duration();
    let energy = moving(&out) + account::at_rest(model, load, out.end(), wait_s) + moving(&back);
    let energy_before_j = account::at_rest(model, load, q, *duration).energy_j();
    Ok(Rest { out, wait_s, back, energy, energy_before_j })
}

/// A stream along the straight joint-space line between two poses with smooth start and end.
fn straight(from: &Joints, to: &Joints, time: f64, spacing: f64) -> Option<Stream> {
    let n = ((time / spacing).floor() as usize).clamp(POINTS.0, POINTS.1);
    let eased = |x: f64| x * x * x * (10.0 - x * (15.0 - 6.0 * x));
    let point = |i: usize| {
        let share = eased(i as f64 / n as f64);
        std::array::from_fn(|j| from[j] + share * (to[j] - from[j]))
    };
    let intervals = rounded_intervals(&vec![time / n as f64; n], time);
    let stream = Stream::new(*from, (1..=n).map(point).collect(), intervals).ok()?;
    rounded_points(&stream).ok()
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

    use nalgebra::Isometry3;

    use super::*;
    use crate::arm::robot;

    /// Tolerance of times, s.
    const TIME: f64 = 1e-9;

    #[test]
    fn a_long_wait_is_spent_where_holding_is_cheap_and_a_short_one_is_not() {
        let model = robot::find("IRB1600-10/1.45").unwrap();
        let q = [0.0, 1.0, -0.4, 0.0, 0.5, 0.0];
        let (load, tool) = (Load::none(), Tcp::Held(Isometry3::identity()));
        let loads = Loads::limits(&model);
        let standstill = |duration| Standstill {
            model: &model,
            load: &load,
            tool: &tool,
            q,
            duration,
            loads: &loads,
            body: None,
        };
        let long = rest(&standstill(60.0), 0.5, 0.05).unwrap();
        assert!(long.energy.energy_j() < long.energy_before_j, "{:?}", long.energy);
        let time = long.out.duration() + long.wait_s + long.back.duration();
        assert!((time - 60.0).abs() < TIME, "{time}");
        for j in 0..DOF {
            assert!((long.out.end()[j] - q[j]).abs() <= 0.5 + 1e-6);
            assert!((long.back.end()[j] - q[j]).abs() < 1e-6);
        }
        // A longer wait saves more; a short one saves less than the motions cost.
        let longer = rest(&standstill(120.0), 0.5, 0.05).unwrap();
        let saved = |rest: &Rest| rest.energy_before_j - rest.energy.energy_j();
        assert!(saved(&longer) > 1.5 * saved(&long), "{} {}", saved(&longer), saved(&long));
        assert!(rest(&standstill(0.5), 0.5, 0.05).is_none());
    }
}
