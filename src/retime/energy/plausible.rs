//! The energy of a simulation over plausible robots.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::account::Account;
use super::change::Changes;
use super::moments::Moments;
use super::parts::EnergyParts;
use super::peaks::peaks;
use crate::arm::robot::Model;
use crate::arm::robot::prior::{Draws, Plausible, Spread};
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::Event;

/// Number of drawn robots.
pub const DRAWS: usize = 256;
/// Share of the draws within an interval.
const WITHIN: f64 = 0.9;
/// Largest number of groups in a report.
const LISTED: usize = 5;
/// Number of parts of a simulation that are summed in parallel; each takes memory.
const PARTS: usize = 4;
/// Share of the variance below which a group is not listed.
pub const LEAST: f64 = 0.02;

/// Quantiles of a number over plausible robots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Median.
    pub median: f64,
    /// Lower bound; 90 % of the robots are between both bounds.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

impl Interval {
    /// The interval of the values of the draws.
    pub fn from_values(values: &[f64]) -> Interval {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let place = share * (sorted.len().max(1) - 1) as f64;
            let (i, rest) = (place.floor() as usize, place.fract());
            let value = |i: usize| sorted.get(i).copied().unwrap_or(0.0);
            value(i) + rest * (value((i + 1).min(sorted.len().max(1) - 1)) - value(i))
        };
        let tail = 0.5 * (1.0 - WITHIN);
        Interval { median: at(0.5), low: at(tail), high: at(1.0 - tail) }
    }
}

/// A group of uncertain parameters and its share of the variance of a result.
#[derive(Clone, Debug, PartialEq)]
pub struct Contribution {
    /// Name of the group.
    pub group: String,
    /// Share of the variance.
    pub share: f64,
    /// A measurement that reduces it.
    pub narrowed_by: &'static str,
}

/// Draws of plausible robots with their parameter differences from the model.
pub struct Robots {
    spread: Spread,
    pub(super) draws: Draws,
    changes: Changes,
}

impl Robots {
    /// The draws for a model; `None` if all parameters are known or it has no dynamics.
    pub fn new(model: &Model) -> Option<Robots> {
        if !model.has_dynamics() {
            return None;
        }
        let spread = Spread::new(model);
        if spread.latents.is_empty() {
            return None;
        }
        let draws = spread.draws(model, DRAWS);
        let changes = Changes::new(model, &draws.robots);
        Some(Robots { spread, draws, changes })
    }

    /// The drawn robots.
    pub fn drawn_robots(&self) -> &[Plausible] {
        &self.draws.robots
    }

    /// Their parameter differences from the model.
    pub fn drawn(&self) -> &Changes {
        &self.changes
    }

    /// Energy of each robot minus that of the model.
    pub fn changes(&self, model: &Model, moments: &Moments) -> Vec<EnergyParts> {
        moments.changes(model, &self.changes)
    }

    /// Energy of a cycle for each robot; `total` is that of the model.
    pub fn energies(
        &self,
        model: &Model,
        simulation: &Simulation,
        total: EnergyParts,
    ) -> Vec<EnergyParts> {
        let changes = self.changes(model, &moments(model, simulation));
        changes.into_iter().map(|change| total + change).collect()
    }

    /// Contributions to the variance of a result, largest first. Groups of a calibrated robot are
    /// correlated, so each group explains a part of the variance that the groups before it leave.
    pub fn contributions(&self, values: &[f64]) -> Vec<Contribution> {
        let mut groups: BTreeMap<&str, Vec<&Vec<f64>>> = BTreeMap::new();
        for (latent, z) in self.spread.latents.iter().zip(&self.draws.latents) {
            groups.entry(&latent.group).or_default().push(z);
        }
        let count = values.len() as f64;
        let mut rest = DVector::from_column_slice(values);
        rest.add_scalar_mut(-rest.mean());
        let variance = rest.norm_squared();
        let mut parts = Vec::new();
        while parts.len() < LISTED {
            let explained = groups.iter().map(|(group, latents)| {
                let part = explained(latents, &rest);
                // Subtract what a group explains by chance.
                let chance = latents.len() as f64 / count * rest.norm_squared();
                let share = (part.norm_squared() - chance) / variance;
                (*group, share, part)
            });
            let most = explained.max_by(|(_, a, _), (_, b, _)| a.total_cmp(b));
            let Some((group, share, part)) = most.filter(|(_, share, _)| *share >= LEAST) else {
                break;
            };
            groups.remove(group);
            rest -= part;
            let narrowed_by = narrowed_by(group);
            parts.push(Contribution { group: group.to_owned(), share, narrowed_by });
        }
        parts
    }
}

/// Least-squares fit of values by the latent variables of a group, one value per draw.
fn explained(latents: &[&Vec<f64>], values: &DVector<f64>) -> DVector<f64> {
    let columns: Vec<DVector<f64>> =
        latents.iter().map(|z| DVector::from_column_slice(z)).collect();
    let z = DMatrix::from_columns(&columns);
    let slopes = z.tr_mul(&z).svd(true, true).solve(&z.tr_mul(values), SINGULAR);
    slopes.map_or_else(|_| DVector::zeros(values.len()), |slopes| z * slopes)
}

/// Singular values below this are zero.
const SINGULAR: f64 = 1e-9;

/// The measurement that reduces the uncertainty of a group most.
fn narrowed_by(group: &str) -> &'static str {
    match group {
        "base power" | "brake coils" => "the cabinet's power at standstill, brakes closed and open",
        "release of the brakes" => "the cabinet's power while brakes open",
        "total mass" => "the robot's data sheet: mass in its file",
        _ if group.starts_with("masses") || group.starts_with("balancer") => {
            "currents of an excitation (joulepath excite, identify)"
        }
        _ => {
            "the cabinet's power in the running program, or currents of an excitation (joulepath identify)"
        }
    }
}

/// Energies of a simulation over plausible robots.
#[derive(Clone, Debug, PartialEq)]
pub struct Plausibility {
    /// Total energy, J.
    pub energy_j: Interval,
    /// Motion energy, J.
    pub motion_energy_j: Interval,
    /// Largest torque of each joint \[Nm\].
    pub torque_nm: Vec<Interval>,
    /// Contributions to the variance of the total energy.
    pub contributions: Vec<Contribution>,
}

/// The integrals over a whole simulation.
pub fn moments(model: &Model, simulation: &Simulation) -> Moments {
    let of = |events: &[Event]| {
        let mut sums = Moments::none(model);
        for event in events {
            sums.event(model, event);
        }
        sums
    };
    let length = simulation.events.len().div_ceil(PARTS).max(1);
    let parts: Vec<Moments> = simulation.events.par_chunks(length).map(of).collect();
    // Sum in a fixed order for reproducible digits.
    let sum = |mut all: Moments, part: Moments| {
        all.add(&part, 1.0);
        all
    };
    parts.into_iter().reduce(sum).unwrap_or_else(|| Moments::none(model))
}

/// The intervals of the energies of a simulation; `None` if all parameters are known.
pub fn plausibility(
    model: &Model,
    simulation: &Simulation,
    account: &Account,
) -> Option<Plausibility> {
    let robots = Robots::new(model)?;
    let energies = robots.energies(model, simulation, account.total);
    let of = |part: fn(&EnergyParts) -> f64| -> Vec<f64> { energies.iter().map(part).collect() };
    let energy = of(EnergyParts::energy_j);
    let torques = peaks(model, robots.drawn(), simulation);
    Some(Plausibility {
        energy_j: Interval::from_values(&energy),
        motion_energy_j: Interval::from_values(&of(EnergyParts::motion_energy_j)),
        torque_nm: torques.iter().map(|largest| Interval::from_values(largest)).collect(),
        contributions: robots.contributions(&energy),
    })
}
