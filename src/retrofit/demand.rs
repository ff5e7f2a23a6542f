//! Streams ask no more of a joint than the original motion, where nobody says what it can do.
//!
//! That a robot can do what it does already is known. Accelerations of streams stay below those of the
//! original cycle anyway (`optimize::allowed::Loads`); where limits of torque are
//! estimated, so does the largest torque of each joint in 95 % of the plausible robots.

use super::settings::Settings;
use super::work::Way;
use crate::energy::along::{Along, Instant};
use crate::energy::plausible::Robots;
use crate::motion::Simulation;
use crate::motion::timeline::{Event, What};
use crate::optimize::reason::Reason;
use crate::optimize::site::Site;
use crate::path::joint_path::DOF;
use crate::robot::{Model, Provenance};

/// Share of the plausible robots in which the torque stays below.
const ENOUGH: f64 = 0.95;
/// Time between two instants that are looked at \[s\], and what a peak between them may add.
const STEP: f64 = 0.01;
const BETWEEN: f64 = 1.01;

/// Share of the mean robot's largest torques that a stream is planned with: what is at its bound with
/// one robot is above it with every other one. Chosen on an IRB1600-10/1.45 and an IRB2600-20/1.65.
const PLANNED: f64 = 0.9;

/// Whether nothing is known of the torques that a robot can do.
pub(super) fn is_estimated(model: &Model) -> bool {
    model.provenance_of("limits", "torque") == Some(Provenance::Estimated)
}

/// The settings with tighter torques.
pub(super) fn tighter(mut settings: Settings) -> Settings {
    if let Some(loads) = &mut settings.freedom.loads {
        loads.torque.iter_mut().for_each(|torque| *torque *= PLANNED);
    }
    settings
}

/// Largest torque of each joint in a motion \[Nm\], robot by robot.
pub(super) struct Demand(Vec<[f64; DOF]>);

impl Demand {
    /// Of the runs among some events.
    pub(super) fn of<'e>(
        model: &Model,
        robots: &Robots,
        events: impl Iterator<Item = &'e Event>,
    ) -> Demand {
        let mut instants = Vec::new();
        for event in events {
            let What::Run(run) = &event.what else { continue };
            let count = (event.duration / STEP).ceil();
            instants.extend((0..=count as usize).map(|i| {
                let state = run.at(event.duration * i as f64 / count.max(1.0));
                Instant { load: run.load.clone(), state: [state.q, state.qd, state.qdd] }
            }));
        }
        let along = Along::of(model, &instants, Vec::new());
        let torques = along.torques(robots.drawn());
        let count = torques.first().map_or(0, nalgebra::Matrix::ncols);
        let largest = |robot| std::array::from_fn(|j| torques[j].column(robot).amax());
        Demand((0..count).map(largest).collect())
    }

    /// The joint, from 1, of which more is asked than `original` does in too many robots, and the
    /// share in which no more is asked.
    fn exceeds(&self, original: &Demand) -> Option<(usize, f64)> {
        (0..DOF).find_map(|j| {
            let pairs = self.0.iter().zip(&original.0);
            let within = pairs.filter(|(new, old)| new[j] <= BETWEEN * old[j]).count();
            let share = within as f64 / self.0.len().max(1) as f64;
            (share < ENOUGH).then_some((j + 1, share))
        })
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
    let kept = ways.iter().enumerate().filter(|(_, way)| way.outcome.is_ok());
    kept.filter_map(|(index, way)| {
        let event = *sites[way.site].variants[way.variant].events.first()?;
        let own = Demand::of(model, robots, after.events.get(event).into_iter());
        let (joint, share) = own.exceeds(original)?;
        Some((index, Reason::AsksMore(joint, share)))
    })
    .collect()
}
