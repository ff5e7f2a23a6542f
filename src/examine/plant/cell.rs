//! The robot and its surroundings from cycle to cycle: speed, temperature, faults, breaks.

use super::random::Random;
use super::script::Place;

/// What the robot takes beside its movements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Power {
    /// Controller, fans, drives without load \[W\].
    pub base_w: f64,
    /// What motors take beyond that while they hold the arm \[W\].
    pub hold_w: f64,
    /// Standing time after which the brakes hold it instead \[s\].
    pub brakes_after_s: f64,
}

/// A stop of the cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fault {
    /// Share of the steps that may have a fault before it: the waits, or all.
    pub(super) at: f64,
    pub(super) at_wait: bool,
    pub(super) seconds: f64,
    /// Whether the program begins again from `main`.
    pub(super) restarts: bool,
}

/// Chances are for one cycle.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cell {
    /// Mean cycle in which all goes as planned \[s\]; the temperature follows it, so that it is the
    /// same in campaigns whose cycles differ.
    pub(super) nominal_s: f64,
    slow: f64,
    fault: f64,
    pause: f64,
    /// Slow cycles after the start of the shift.
    first: u64,
    /// Standard deviation of a movement's time \[s\].
    jitter_s: f64,
    /// What friction adds to the energy of movements at the planned temperature; more below.
    cold: f64,
    /// Rise of the temperature \[K\], and its time constant \[s\].
    rise: (f64, f64),
}

/// Most cycles with a lowered override in a row.
const LONGEST_SLOW: u64 = 20;
/// Slow cycles after a restart.
const AFTER_RESTART: u64 = 2;
/// Settings of the override that operators choose.
const OVERRIDES: [f64; 4] = [0.25, 0.5, 0.5, 0.75];
/// Temperature at which friction has its planned value \[°C\], and how fast it grows below \[K\].
const PLANNED_C: f64 = 45.0;
const SOFTENS_K: f64 = 20.0;
/// Greatest excess of friction, over that of a robot at its planned temperature: grease sets a limit.
const MOST_COLD: f64 = 8.0;
/// Share of a movement's time that the override does not stretch: accelerations.
const UNSTRETCHED: f64 = 0.3;
/// Share of faults that happen where the robot waits: parts that stick, doors that do not open.
const AT_WAIT: f64 = 0.5;
/// Shares of a movement's energy that stay, fall with the speed, and with its square.
const ENERGY: [f64; 3] = [0.45, 0.2, 0.35];
/// Share of friction's excess that the time of a movement shows: the drives settle later.
const SETTLING: f64 = 0.02;
/// Spread of a movement's energy from cycle to cycle.
const ENERGY_SPREAD: f64 = 0.004;
/// Cycles for which an operator's mood lasts.
const MOOD: u64 = 37;

impl Cell {
    pub(super) fn drawn(nominal_s: f64, draws: &mut Random) -> Cell {
        Cell {
            nominal_s,
            slow: draws.between(0.0, 0.01),
            fault: draws.between(0.0, 0.012),
            pause: draws.between(0.004, 0.015),
            first: draws.below(6) as u64,
            jitter_s: draws.log_between(0.001, 0.006),
            cold: draws.between(0.01, 0.06),
            rise: (draws.between(8.0, 25.0), draws.log_between(1800.0, 7200.0)),
        }
    }

    /// The cell on a day without faults, breaks and slow cycles.
    pub(super) fn calm(&mut self) {
        (self.slow, self.fault, self.pause, self.first) = (0.0, 0.0, 0.0, 0);
    }

    /// Temperature of the robot \[°C\].
    pub(super) fn temperature(&self, cycle: u64, ambient: f64) -> f64 {
        let (rise, constant_s) = self.rise;
        ambient + rise * (1.0 - (-(cycle as f64) * self.nominal_s / constant_s).exp())
    }

    /// Speed override, `since` cycles after a restart.
    pub(super) fn speed(&self, seed: u64, cycle: u64, since: Option<u64>) -> f64 {
        if cycle < self.first || since.is_some_and(|since| since < AFTER_RESTART) {
            return 0.5;
        }
        let lowered = |from: u64| {
            let mut draws = Random::of(seed, "override", &[from]);
            let begins = draws.chance(self.slow);
            let lasts = 3 + draws.below(LONGEST_SLOW as usize - 2) as u64;
            (begins && cycle - from < lasts).then(|| OVERRIDES[draws.below(OVERRIDES.len())])
        };
        (cycle.saturating_sub(LONGEST_SLOW)..=cycle).rev().find_map(lowered).unwrap_or(1.0)
    }

    pub(super) fn fault(&self, seed: u64, cycle: u64) -> Option<Fault> {
        let mut draws = Random::of(seed, "fault", &[cycle]);
        draws.chance(self.fault).then(|| Fault {
            at: draws.unit(),
            at_wait: draws.chance(AT_WAIT),
            seconds: draws.log_between(40.0, 900.0),
            restarts: draws.chance(0.4),
        })
    }

    /// Factor of the operator's times, and a break \[s\].
    pub(super) fn mood(&self, seed: u64, cycle: u64) -> (f64, f64) {
        let mood = Random::of(seed, "mood", &[cycle / MOOD]).lognormal(0.12);
        let mut draws = Random::of(seed, "break", &[cycle]);
        let pause = if draws.chance(self.pause) { draws.between(120.0, 900.0) } else { 0.0 };
        (mood, pause)
    }

    /// Duration \[s\] and energy \[J\] of a movement, the `nth` one of a place in its cycle.
    pub(super) fn movement(
        &self,
        planned: (f64, f64),
        of: &Circumstances,
        place: &Place,
        nth: u64,
    ) -> (f64, f64) {
        let (duration_s, energy_j) = planned;
        let purpose = format!("move {}", place.file);
        let mut draws = Random::of(of.seed, &purpose, &[place.line as u64, of.cycle, nth]);
        let excess = self.cold * ((PLANNED_C - of.temperature) / SOFTENS_K).exp().min(MOST_COLD);
        let stretch = UNSTRETCHED + (1.0 - UNSTRETCHED) / of.speed;
        let [stays, linear, square] = ENERGY;
        let slower = stays + linear / stretch + square / stretch.powi(2);
        let jitter = self.jitter_s * draws.normal();
        let time = (duration_s * stretch * (1.0 + SETTLING * excess) + jitter).max(0.001);
        let spread = 1.0 + ENERGY_SPREAD * draws.normal();
        (time, energy_j * slower * (1.0 + excess) * spread)
    }
}

/// What one cycle is like.
#[derive(Clone, Debug)]
pub(super) struct Circumstances {
    pub(super) seed: u64,
    pub(super) cycle: u64,
    pub(super) speed: f64,
    pub(super) temperature: f64,
}
