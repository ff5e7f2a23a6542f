//! The unit of analysis: a complete cycle with its energy and its circumstances.

/// A side of a campaign.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Period {
    /// The baseline period.
    Before,
    /// The reporting period.
    After,
}

impl Period {
    /// The option that names its logs.
    #[must_use]
    pub fn option(self) -> &'static str {
        match self {
            Period::Before => "--before",
            Period::After => "--after",
        }
    }
}

/// What a cycle makes, as far as it is known.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Kind {
    /// The column `part`.
    pub(super) part: Option<String>,
    /// Payload in steps of 0.1 kg.
    pub(super) payload: Option<i64>,
    /// Waits, outputs and loads in their order: the branch that was taken.
    pub(super) way: Option<String>,
}

/// Points of the course of the power over a cycle: enough to tell ten movements apart.
pub(super) const POINTS: usize = 64;

/// A wait.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wait {
    /// Its place in the cycle, from 0.
    pub(super) place: usize,
    /// Begin and end on the clock of the log, s.
    pub(super) from: f64,
    pub(super) to: f64,
}

/// A complete cycle.
#[derive(Clone, Debug)]
pub(super) struct Unit {
    /// The log.
    pub(super) file: String,
    /// Start on the clock of the side, s.
    pub(super) t: f64,
    /// ∫ power dt, J.
    pub(super) energy_j: f64,
    /// Its duration, s.
    pub(super) duration_s: f64,
    /// Time that the robot waits, s.
    pub(super) rest_s: f64,
    /// Its waits, if the log of events has them.
    pub(super) waits: Vec<Wait>,
    /// What the program before takes in such waits, as time at its mean power of waiting, s.
    pub(super) waiting_s: f64,
    /// Mean power while it waits, W.
    pub(super) rest_w: Option<f64>,
    /// Power while it waits at places and times that all cycles have, else the lowest power that lasts, W.
    pub(super) level_w: Option<f64>,
    /// Mean temperature, °C.
    pub(super) temperature: Option<f64>,
    /// What it makes.
    pub(super) kind: Kind,
    /// Course of the power, W.
    pub(super) course: Vec<f64>,
}

/// Cycles that were left out.
#[derive(Clone, Debug, PartialEq)]
pub struct LeftOut {
    /// The side.
    pub period: Period,
    /// How many.
    pub count: usize,
    /// Why.
    pub why: String,
}
