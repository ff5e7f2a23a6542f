//! Two campaigns, before and after a retrofit, and what makes the comparison hard.

use super::conditions::Conditions;
use super::layout::Plant;
use super::meter::Unit;
use super::script::Script;
use super::truth::Run;

/// What differs between the campaigns beside the program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trouble {
    /// Machines and people have other times of the same distribution after the retrofit, times a factor.
    Machines(f64),
    /// The meter's gain changes, per hour, and goes on from the end of the first campaign.
    Drift(f64),
    /// The meter's gain is another one after the retrofit.
    Gain(f64),
    /// The second log is in kW.
    Kilowatts,
    /// Parts come with these frequencies after the retrofit: at most three sorts.
    Mix([f64; 3]),
    /// Temperature of the hall after the retrofit \[°C\].
    Ambient(f64),
    /// In this share of the cycles of each campaign the program of the other one runs.
    Swapped(f64),
    /// The robot's part of the cell has other draws after the retrofit: faults, overrides, parts.
    OtherDays,
}

/// The logs of both campaigns.
#[derive(Clone, Debug, PartialEq)]
pub struct Campaign {
    /// With the program before the retrofit.
    pub before: Run,
    /// With the program after it.
    pub after: Run,
    /// What the program alone saves of the energy of a cycle: 1 − after / before, in the conditions of
    /// the first campaign.
    pub saving: f64,
    /// The same for the energy of the movements.
    pub motion_saving: f64,
}

/// Added to the seed for draws of another day.
const OTHER_DAY: u64 = 0x5eed;

/// Days from the first campaign to the second one.
const LATER_DAYS: u32 = 7;

/// Two campaigns of one plant.
#[must_use]
pub fn campaign(
    plant: &Plant,
    programs: (&Script, &Script),
    usual: &Conditions,
    troubles: &[Trouble],
) -> Campaign {
    let (old, new) = programs;
    let (mut before, mut after) = (usual.clone(), usual.clone());
    after.day += LATER_DAYS;
    let mut mix = None;
    for trouble in troubles {
        match trouble {
            Trouble::Machines(factor) => {
                after.other_machines = Some((usual.seed.wrapping_add(OTHER_DAY), *factor));
            }
            Trouble::Drift(per_hour) => {
                before.meter.drift_per_hour = *per_hour;
                after.meter.drift_per_hour = *per_hour;
                let hours = usual.cycles as f64 * plant.cell.nominal_s / 3600.0;
                after.meter.gain *= 1.0 + per_hour * hours;
            }
            Trouble::Gain(gain) => after.meter.gain *= gain,
            Trouble::Kilowatts => after.meter.unit = Unit::Kilowatts,
            Trouble::Mix(frequencies) => mix = Some(new.with_mix(frequencies)),
            Trouble::Ambient(degrees) => after.ambient_c = *degrees,
            Trouble::Swapped(share) => {
                before.other = Some((new.clone(), *share));
                after.other = Some((old.clone(), *share));
            }
            Trouble::OtherDays => after.seed = usual.seed.wrapping_add(OTHER_DAY),
        }
    }
    let plain = (plant.run_in(old, usual), plant.run_in(new, usual));
    let saved = |of: fn(&Run) -> f64| 1.0 - of(&plain.1) / of(&plain.0);
    let (saving, motion_saving) = (saved(Run::energy_j), saved(Run::motion_j));
    Campaign {
        before: plant.run_in(old, &before),
        after: plant.run_in(mix.as_ref().unwrap_or(new), &after),
        saving,
        motion_saving,
    }
}
