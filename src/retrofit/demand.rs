//! Streams ask no more of a joint than the original motion, where nobody says what it can do.
//!
//! That a robot can do what it does already is known. So where the limits of torque or acceleration are
//! estimated or assumed, a stream's largest torque and acceleration stay below the largest of the
//! original cycle, the torque in 95 % of the plausible robots.

use rayon::prelude::*;

use super::work::Way;
use crate::energy::along::{Along, Instant};
use crate::energy::plausible::Robots;
use crate::motion::Simulation;
use crate::motion::timeline::{Event, What};
use crate::optimize::reason::Reason;
use crate::optimize::site::Site;
use crate::path::joint_path::DOF;
use crate::robot::Model;

/// Share of the plausible robots in which the torque stays below.
const ENOUGH: f64 = 0.95;
/// Time between two instants that are looked at \[s\], and what a peak between them may add.
const STEP: f64 = 0.02;
const BETWEEN: f64 = 1.01;

/// What the joints of plausible robots have to do in a motion.
pub(super) struct Demand {
    /// Largest torque of each joint \[Nm\], robot by robot.
    torque: Vec<[f64; DOF]>,
    /// Largest acceleration \[rad/s²\].
    acceleration: [f64; DOF],
}

impl Demand {
    /// Of the runs among some events.
    pub(super) fn of<'e>(
        model: &Model,
        robots: &Robots,
        events: impl Iterator<Item = &'e Event>,
    ) -> Demand {
        let mut demand = Demand { torque: Vec::new(), acceleration: [0.0; DOF] };
        let mut instants = Vec::new();
        for event in events {
            let What::Run(run) = &event.what else { continue };
            let count = (event.duration / STEP).ceil();
            instants.extend((0..=count as usize).map(|i| {
                let state = run.at(event.duration * i as f64 / count.max(1.0));
                Instant { load: run.load.clone(), state: [state.q, state.qd, state.qdd] }
            }));
        }
        for instant in &instants {
            for (most, a) in demand.acceleration.iter_mut().zip(instant.state[2]) {
                *most = most.max(a.abs());
            }
        }
        let along = Along::of(model, &instants, Vec::new());
        demand.torque = robots
            .drawn()
            .par_iter()
            .map(|change| {
                let torques = along.torques(change);
                std::array::from_fn(|j| torques[j].amax())
            })
            .collect();
        demand
    }

    /// The joint of which more is asked than `original` does in too many robots, from 1, and the
    /// share in which no more is asked.
    fn exceeds(&self, original: &Demand, limits: Unknown) -> Option<(usize, f64)> {
        (0..DOF).find_map(|j| {
            let faster = self.acceleration[j] > BETWEEN * original.acceleration[j];
            if limits.acceleration && faster {
                return Some((j + 1, 0.0));
            }
            let pairs = self.torque.iter().zip(&original.torque);
            let within = pairs.filter(|(new, old)| new[j] <= BETWEEN * old[j]).count();
            let share = within as f64 / self.torque.len().max(1) as f64;
            (limits.torque && share < ENOUGH).then_some((j + 1, share))
        })
    }
}

/// Limits that nobody knows.
#[derive(Clone, Copy)]
pub(super) struct Unknown {
    torque: bool,
    acceleration: bool,
}

impl Unknown {
    /// Of a robot; `None` where both are known.
    pub(super) fn of(model: &Model) -> Option<Unknown> {
        let [torque, acceleration] =
            ["torque", "acceleration"].map(|key| !model.is_known("limits", key));
        (torque || acceleration).then_some(Unknown { torque, acceleration })
    }
}

/// The ways whose streams ask more of a joint than the original cycle.
pub(super) fn demanding_ways(
    model: &Model,
    robots: &Robots,
    original: &Demand,
    after: &Simulation,
    (sites, ways): (&[Site], &[Way]),
) -> Vec<(usize, Reason)> {
    let Some(limits) = Unknown::of(model) else { return Vec::new() };
    let kept = ways.iter().enumerate().filter(|(_, way)| way.outcome.is_ok());
    kept.filter_map(|(index, way)| {
        let event = *sites[way.site].variants[way.variant].events.first()?;
        let own = Demand::of(model, robots, after.events.get(event).into_iter());
        let (joint, share) = own.exceeds(original, limits)?;
        Some((index, Reason::AsksMore(joint, share)))
    })
    .collect()
}
