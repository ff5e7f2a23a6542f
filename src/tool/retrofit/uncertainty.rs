//! What a retrofit saves over plausible robots.

use super::figures::Padding;
use super::notes::end;
use super::work::Way;
use crate::arm::robot::Model;
use crate::retime::energy::moments::Moments;
use crate::retime::energy::plausible::{Contribution, Interval, Robots, moments};
use crate::retime::energy::{Account, EnergyParts};
use crate::retime::motion::Simulation;
use crate::retime::optimize::reason::Reason;
use crate::retime::optimize::site::Site;

/// Share of the plausible robots in which a stream has to save.
pub(super) const ENOUGH: f64 = 0.95;

/// Energies and savings over plausible robots.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertainty {
    /// Of the original: all energy, that of motions, J.
    pub original: [Interval; 2],
    /// Of the retrofit.
    pub optimized: [Interval; 2],
    /// Saved, %: of all energy, of that of motions.
    pub saving_percent: [Interval; 2],
    /// What the variance of the saving comes from.
    pub contributions: Vec<Contribution>,
}

/// Original or retrofit.
#[derive(Clone, Copy)]
pub(super) struct Side<'a> {
    pub(super) simulation: &'a Simulation,
    pub(super) account: &'a Account,
}

/// The ways whose streams do not save in enough of the robots.
pub(super) fn uncertain_ways(
    model: &Model,
    robots: &Robots,
    before: Side<'_>,
    after: Side<'_>,
    sites: &[Site],
    ways: &[Way],
) -> Vec<(usize, Reason)> {
    let sums = |side: Side<'_>, event: usize| {
        Some(Moments::from_event(model, side.simulation.events.get(event)?))
    };
    let own = |side: Side<'_>, event: usize| -> Option<f64> {
        Some(side.account.events.get(event)?.iter().map(EnergyParts::motion_energy_j).sum())
    };
    let weak = |way: &Way| {
        let event = *sites[way.site].variants[way.variant].events.first()?;
        let saved = own(before, event)? - own(after, event)?;
        let share = share(model, robots, saved, [sums(before, event)?, sums(after, event)?]);
        (share < ENOUGH).then_some(Reason::UncertainSaving(share))
    };
    let kept = ways.iter().enumerate().filter(|(_, way)| way.outcome.is_ok());
    kept.filter_map(|(index, way)| Some((index, weak(way)?))).collect()
}

/// The share of the robots that take less motion energy in the whole cycle after than before.
pub(super) fn share_that_saves(
    model: &Model,
    robots: &Robots,
    before: Side<'_>,
    after: Side<'_>,
) -> f64 {
    let own = |side: Side<'_>| side.account.total.motion_energy_j();
    let sums = [before, after].map(|side| moments(model, side.simulation));
    share(model, robots, own(before) - own(after), sums)
}

/// The share of the robots whose motion energy falls, where that of the model falls by `saved` J.
fn share(model: &Model, robots: &Robots, saved: f64, [mut less, after]: [Moments; 2]) -> f64 {
    less.add(&after, -1.0);
    let changes = robots.changes(model, &less);
    let falls = changes.iter().filter(|less| saved + less.motion_energy_j() > 0.0);
    falls.count() as f64 / changes.len() as f64
}

/// Energies and savings of the whole cycle.
pub(super) fn uncertainty(
    model: &Model,
    robots: &Robots,
    (before, padding): (Side<'_>, Option<&Padding>),
    after: Side<'_>,
) -> Uncertainty {
    let mut sums = moments(model, before.simulation);
    if let (Some(padding), Some((load, q))) = (padding, end(before.simulation)) {
        sums.rest(model, load, q, padding.duration_s);
    }
    let padding = padding.map_or_else(EnergyParts::default, |padding| padding.energy);
    let a = robots.changes(model, &sums);
    let b = robots.changes(model, &moments(model, after.simulation));
    let of = |side: Side<'_>, more: f64, changes: &[EnergyParts], part: fn(&EnergyParts) -> f64| {
        let own = part(&side.account.total) + more;
        changes.iter().map(|change| own + part(change)).collect::<Vec<f64>>()
    };
    let parts: [fn(&EnergyParts) -> f64; 2] = [EnergyParts::energy_j, EnergyParts::motion_energy_j];
    let original = parts.map(|part| of(before, part(&padding), &a, part));
    let optimized = parts.map(|part| of(after, 0.0, &b, part));
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
