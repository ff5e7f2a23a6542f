//! Energies and savings over plausible robots.

use super::candidate::{Candidate, State, with_stream};
use super::job::Original;
use super::padding::Padding;
use super::simulated::Simulated;
use crate::arm::robot::Model;
use crate::retime::energy::EnergyParts;
use crate::retime::energy::moments::Moments;
use crate::retime::energy::plausible::{Contribution, Interval, Robots, moments};
use crate::retime::optimize::reason::Reason;

/// Share of the plausible robots in which a stream must save energy.
pub(super) const ENOUGH: f64 = 0.95;

/// Energies and savings over plausible robots.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertainty {
    /// Original: total energy, motion energy, J.
    pub original: [Interval; 2],
    /// Retrofit: the same.
    pub optimized: [Interval; 2],
    /// Saving, %: of total energy, of motion energy.
    pub saving_percent: [Interval; 2],
    /// Contributions to the variance of the saving.
    pub contributions: Vec<Contribution>,
}

/// Refuses the candidates whose streams save energy in too few robots.
pub(super) fn uncertain(
    model: &Model,
    robots: &Robots,
    original: &Original<'_>,
    after: &Simulated,
    candidates: &[Candidate],
) -> Vec<(usize, State)> {
    let before = &original.cycle;
    let moments = |cycle: &Simulated, event: usize| {
        Some(Moments::from_event(model, cycle.simulation.events.get(event)?))
    };
    let energy = |cycle: &Simulated, event: usize| -> Option<f64> {
        Some(cycle.account.events.get(event)?.iter().map(EnergyParts::motion_energy_j).sum())
    };
    let weak = |candidate: &Candidate| {
        let event = *original.events(candidate).first()?;
        let saved = energy(before, event)? - energy(after, event)?;
        let moments = [moments(before, event)?, moments(after, event)?];
        let share = share(model, robots, saved, moments);
        (share < ENOUGH).then_some(State::Refused(Reason::UncertainSaving(share)))
    };
    with_stream(candidates).filter_map(|(index, c)| Some((index, weak(c)?))).collect()
}

/// The share of the robots whose motion energy of the whole cycle falls.
pub(super) fn share_that_saves(
    model: &Model,
    robots: &Robots,
    before: &Simulated,
    after: &Simulated,
) -> f64 {
    let energy = |cycle: &Simulated| cycle.account.total.motion_energy_j();
    let moments = [before, after].map(|cycle| moments(model, &cycle.simulation));
    share(model, robots, energy(before) - energy(after), moments)
}

/// The share of the robots whose motion energy falls. `saved`: saving of the model, J.
fn share(model: &Model, robots: &Robots, saved: f64, [mut less, after]: [Moments; 2]) -> f64 {
    less.add(&after, -1.0);
    let changes = robots.changes(model, &less);
    let falls = changes.iter().filter(|less| saved + less.motion_energy_j() > 0.0);
    falls.count() as f64 / changes.len() as f64
}

pub(super) fn uncertainty(
    model: &Model,
    robots: &Robots,
    (before, padding): (&Simulated, Option<&Padding>),
    after: &Simulated,
) -> Uncertainty {
    let mut sums = moments(model, &before.simulation);
    if let (Some(padding), Some((load, q))) = (padding, before.end()) {
        sums.rest(model, load, q, padding.standing_s);
    }
    let padding = padding.map_or_else(EnergyParts::default, |padding| padding.energy);
    let a = robots.changes(model, &sums);
    let b = robots.changes(model, &moments(model, &after.simulation));
    let energies = |total: f64, changes: &[EnergyParts], part: fn(&EnergyParts) -> f64| {
        changes.iter().map(|change| total + part(change)).collect::<Vec<f64>>()
    };
    let parts: [fn(&EnergyParts) -> f64; 2] = [EnergyParts::energy_j, EnergyParts::motion_energy_j];
    let original =
        parts.map(|part| energies(part(&before.account.total) + part(&padding), &a, part));
    let optimized = parts.map(|part| energies(part(&after.account.total), &b, part));
    let saving = [0, 1].map(|i| -> Vec<f64> {
        let pairs = original[i].iter().zip(&optimized[i]);
        pairs.map(|(a, b)| if *a > 0.0 { 100.0 * (a - b) / a } else { 0.0 }).collect()
    });
    let interval = |values: [Vec<f64>; 2]| values.map(|values| Interval::from_values(&values));
    Uncertainty {
        contributions: robots.contributions(&saving[1]),
        original: interval(original),
        optimized: interval(optimized),
        saving_percent: interval(saving),
    }
}
