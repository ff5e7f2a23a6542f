//! The conditions of a run: how long, on which day, with which meter.

use super::meter::Meter;
use super::script::Script;

/// What a run depends on beside plant and program.
#[derive(Clone, Debug, PartialEq)]
pub struct Conditions {
    /// Number of cycles.
    pub cycles: usize,
    /// Draws of the robot, the cell and the machines, by cycle and place: runs with the same seed can be
    /// compared cycle by cycle.
    pub seed: u64,
    /// Machines and people with other times: another seed, and a factor of all their times.
    pub other_machines: Option<(u64, f64)>,
    /// Days between the first day of the plant and this one, for the dates in the log of events.
    pub day: u32,
    /// Temperature of the hall \[°C\].
    pub ambient_c: f64,
    /// The meter.
    pub meter: Meter,
    /// A program that runs in a share of the cycles instead.
    pub other: Option<(Script, f64)>,
    /// Chance of a row of the log of events to be the first of some that are lost.
    pub lost: f64,
}

/// Temperature of a hall \[°C\].
const HALL_C: f64 = 21.0;

impl Conditions {
    /// A usual day with a good meter.
    #[must_use]
    pub fn usual(cycles: usize, seed: u64) -> Conditions {
        Conditions {
            cycles,
            seed,
            other_machines: None,
            day: 0,
            ambient_c: HALL_C,
            meter: Meter::default(),
            other: None,
            lost: 0.0,
        }
    }

    pub(super) fn machine_seed(&self) -> u64 {
        self.other_machines.map_or(self.seed, |(seed, _)| seed)
    }

    pub(super) fn machine_factor(&self) -> f64 {
        self.other_machines.map_or(1.0, |(_, factor)| factor)
    }
}
