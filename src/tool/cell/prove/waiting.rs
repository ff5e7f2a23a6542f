//! What the program before takes while it waits: the power over the time since it came to a wait. A robot that
//! stands for long closes its brakes, so the next second of a wait costs less than its mean second.

use std::collections::BTreeMap;

use super::series::Series;
use super::unit::{Unit, Wait};

/// Width of a step of the time since the robot came, s.
const STEP_S: f64 = 0.1;
/// Least number of waits that a mean power needs.
const LEAST: usize = 3;
/// Samples at both ends of a wait in which a meter that averages may still show the motion.
const EDGE: f64 = 2.0;

/// Sums over the waits that last longer than each step.
#[derive(Clone, Debug, Default)]
struct Course {
    energy_j: Vec<f64>,
    count: Vec<usize>,
}

impl Course {
    fn add(&mut self, step: usize, energy_j: f64) {
        if self.energy_j.len() <= step {
            self.energy_j.resize(step + 1, 0.0);
            self.count.resize(step + 1, 0);
        }
        self.energy_j[step] += energy_j;
        self.count[step] += 1;
    }

    /// Mean power in a step, W.
    fn power(&self, step: usize) -> Option<f64> {
        let count = self.count.get(step).filter(|count| **count >= LEAST)?;
        Some(self.energy_j[step] / STEP_S / *count as f64)
    }
}

/// The power while waiting, by the place of the wait in the cycle and over all waits.
#[derive(Clone, Debug)]
pub(super) struct Waiting {
    places: BTreeMap<usize, Course>,
    all: Course,
    /// All waits of the other side.
    after: Course,
    /// Mean power of all waits, W.
    pub(super) mean_w: f64,
}

impl Waiting {
    /// The power of the waits in cycles with their logs, before and after; `None` if there are too few waits
    /// before.
    pub(super) fn of<'a>(
        before: impl Iterator<Item = (&'a Unit, &'a Series)>,
        after: impl Iterator<Item = (&'a Unit, &'a Series)>,
    ) -> Option<Waiting> {
        let (mut places, mut all) = (BTreeMap::<usize, Course>::new(), Course::default());
        for (unit, series) in before {
            for (place, step, energy) in energies(unit, series) {
                places.entry(place).or_default().add(step, energy);
                all.add(step, energy);
            }
        }
        let mut others = Course::default();
        for (unit, series) in after {
            for (_, step, energy) in energies(unit, series) {
                others.add(step, energy);
            }
        }
        let count = all.count.iter().sum::<usize>() as f64;
        let mean_w = all.energy_j.iter().sum::<f64>() / STEP_S / count;
        let is_known = all.power(0).is_some() && mean_w > 0.0;
        is_known.then_some(Waiting { places, all, after: others, mean_w })
    }

    /// The power while a cycle waits, W: that of all waits before, times what this cycle takes over what the
    /// program before took at the same places after the same time. `None` if no wait can be compared.
    pub(super) fn level_w(&self, unit: &Unit, series: &Series) -> Option<f64> {
        let (mut own, mut usual) = (0.0, 0.0);
        for (place, step, energy) in energies(unit, series) {
            if let Some(power) = self.places.get(&place).and_then(|course| course.power(step)) {
                own += energy;
                usual += power * STEP_S;
            }
        }
        (usual > 0.0).then(|| self.mean_w * own / usual)
    }

    /// Energy of the waits of a cycle if the program before waited for as long, J. Beyond the longest waits at
    /// a place, waits at other places tell the power, then waits of the other side, at last the last power.
    pub(super) fn energy_j(&self, unit: &Unit) -> f64 {
        unit.waits.iter().map(|wait| self.of_wait(wait)).sum()
    }

    fn of_wait(&self, wait: &Wait) -> f64 {
        let own = self.places.get(&wait.place);
        let mut power = self.mean_w;
        let mut energy = 0.0;
        let whole = steps(wait);
        for step in 0..=whole {
            let known = own.and_then(|own| own.power(step)).or_else(|| self.all.power(step));
            power = known.or_else(|| self.after.power(step)).unwrap_or(power);
            let lasts =
                if step < whole { STEP_S } else { wait.to - wait.from - whole as f64 * STEP_S };
            energy += power * lasts.max(0.0);
        }
        energy
    }
}

/// Place, step and energy \[J\] of all whole steps of the waits of a cycle in which the robot surely stands.
fn energies(unit: &Unit, series: &Series) -> impl Iterator<Item = (usize, usize, f64)> {
    let edge = EDGE * series.step;
    unit.waits.iter().flat_map(move |wait| {
        let inner = Wait { from: wait.from + edge, to: wait.to - edge, ..*wait };
        (0..steps(&inner)).map(move |step| {
            let from = inner.from + step as f64 * STEP_S;
            (wait.place, step, series.energy(from + STEP_S) - series.energy(from))
        })
    })
}

/// Whole steps of a wait.
fn steps(wait: &Wait) -> usize {
    ((wait.to - wait.from) / STEP_S).max(0.0) as usize
}
