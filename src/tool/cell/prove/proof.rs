//! What a campaign shows.

use super::doubt::Doubt;
use super::series::Measure;
use super::strata::Stratum;
use super::unit::LeftOut;

/// What is asked of a campaign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The saving that the campaign has to be able to show, share.
    pub effect: f64,
    /// The saving that was promised, share.
    pub promised: Option<f64>,
}

/// The outcome.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The interval is above 0.
    Saves,
    /// The interval holds 0, and the campaign is long enough to show the effect.
    NoDifference,
    /// The interval is below 0.
    Costs,
    /// The interval holds 0, and the campaign is too short.
    TooFewCycles,
}

impl Verdict {
    /// Its name in the JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Saves => "saves",
            Verdict::NoDifference => "no_difference",
            Verdict::Costs => "costs",
            Verdict::TooFewCycles => "too_few_cycles",
        }
    }
}

/// An estimate with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimated {
    /// The estimate.
    pub value: f64,
    /// Lower and upper end; `None` for too few cycles.
    pub interval: Option<[f64; 2]>,
}

/// Durations of a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CycleTime {
    /// Mean before and after, s.
    pub means_s: [f64; 2],
    /// Upper 95 % bound of after − before, s; `None` for too few cycles.
    pub difference_high_s: Option<f64>,
    /// Part of the difference that is not the program's own: waits, s.
    pub foreign_s: f64,
    /// Whether cycles are longer beyond their scatter.
    pub is_longer: bool,
}

/// A routine adjustment.
#[derive(Clone, Debug, PartialEq)]
pub struct Adjustment {
    /// What it corrects for.
    pub name: &'static str,
    /// Change of the circumstance from before to after, and its unit.
    pub change: f64,
    /// Unit of the change.
    pub unit: &'static str,
    /// Energy for a unit of the change, and its standard deviation, J.
    pub slope: f64,
    /// See `slope`.
    pub slope_sd: f64,
    /// Energy that is taken from the side after, J.
    pub energy_j: f64,
}

/// What a campaign shows.
#[derive(Clone, Debug)]
pub struct Proof {
    /// The outcome.
    pub verdict: Verdict,
    /// Saving as a share of the energy before, with all doubts in its interval.
    pub saving: Estimated,
    /// Standard error of the saving, share; `None` for too few cycles.
    pub standard_error: Option<f64>,
    /// The interval by the scatter of the cycles alone.
    pub statistical: Option<[f64; 2]>,
    /// Saving without adjustments.
    pub raw_saving: f64,
    /// Saving with the cycles that were left out as faults.
    pub saving_with_faults: Option<f64>,
    /// Durations.
    pub cycle: CycleTime,
    /// Mean energy of a cycle, adjusted, J.
    pub energy_j: [f64; 2],
    /// Number of cycles that were used.
    pub cycles: [usize; 2],
    /// Cycles of each side that show the effect.
    pub needed: usize,
    /// Where the energy was measured.
    pub measure: Measure,
    /// Power at rest before and after, W.
    pub rest_w: Option<[f64; 2]>,
    /// Routine adjustments.
    pub adjustments: Vec<Adjustment>,
    /// Non-routine adjustments: what widens the interval.
    pub doubts: Vec<Doubt>,
    /// What was made on both sides.
    pub strata: Vec<Stratum>,
    /// Cycles that were not used.
    pub left_out: Vec<LeftOut>,
    /// Lengths of the blocks that were resampled.
    pub blocks: [usize; 2],
    /// Effects with the cycles of each side that show them.
    pub plan: Vec<(f64, usize)>,
    /// Adjusted energies of the cycles, J.
    pub energies: [Vec<f64>; 2],
    /// Hashes of the programs.
    pub programs: [Option<String>; 2],
    /// What was noticed.
    pub notes: Vec<String>,
    /// What was asked.
    pub settings: Settings,
}

/// The power analysis of a campaign.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Number of cycles that were used.
    pub cycles: usize,
    /// Mean energy of a cycle, J.
    pub energy_j: f64,
    /// Mean duration, s.
    pub duration_s: f64,
    /// Standard deviation of the adjusted energy, share.
    pub deviation: f64,
    /// Cycles of each side that show the effect.
    pub needed: usize,
    /// Effects with the cycles of each side that show them.
    pub plan: Vec<(f64, usize)>,
    /// Where the energy was measured.
    pub measure: Measure,
    /// Cycles that were not used.
    pub left_out: Vec<LeftOut>,
    /// What was noticed.
    pub notes: Vec<String>,
    /// What was asked.
    pub settings: Settings,
}
