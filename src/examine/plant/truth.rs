//! What is true of a run: times are seconds of the plant's clock, which no restart sets back.

use super::script::Place;

/// An event of the robot that a machine starts from.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Event {
    /// The program sets an output.
    Output {
        /// The statement.
        place: Place,
        /// The output.
        signal: String,
        /// Its new level.
        level: u8,
    },
    /// The robot leaves a stop point with this movement.
    Departure {
        /// The movement.
        place: Place,
    },
}

/// What the time of a signal counts from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum After {
    /// An event of the robot, earlier in this cycle or in the one before.
    Event(Event),
    /// A clock of its own.
    Clock,
}

/// What makes a wait end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Truth {
    /// The answer to the robot's arrival, or to the output just before the wait.
    Process,
    /// Something that does not see when the robot comes.
    Slack {
        /// What its time counts from.
        after: After,
    },
    /// If the robot comes later, so does the signal, but in part of the cycles or by part of the time.
    Coupled,
}

/// One wait of a cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct Visit {
    /// The statement.
    pub place: Place,
    /// The awaited signal.
    pub signal: String,
    /// When the robot came \[s\].
    pub arrived_s: f64,
    /// When the signal came \[s\]; `None` if it was there since the start.
    pub came_s: Option<f64>,
    /// When the wait ended \[s\].
    pub ended_s: f64,
    /// How much later the signal would have come, had the robot come [`LATER_S`] later and the rest of
    /// the run been the same \[s\].
    pub later_s: f64,
}

/// The delay of the question that [`Visit::later_s`] answers \[s\].
pub const LATER_S: f64 = 0.5;

/// What was unusual about a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Disturbance {
    /// Nothing.
    None,
    /// The speed override was below 100 %.
    Slow,
    /// The robot stood for minutes and went on.
    Stop,
    /// A fault ended the cycle; the next one is the first of a session.
    Restart,
}

/// One cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct CycleTruth {
    /// Number within the run, from 0.
    pub index: usize,
    /// Number of the session in the log of events, from 0.
    pub session: usize,
    /// Number that the log of events has, from 1 in each session.
    pub number: usize,
    /// Name of the part.
    pub part: String,
    /// Whether the robot ran [`super::Conditions::other`].
    pub by_other: bool,
    /// What was unusual.
    pub disturbance: Disturbance,
    /// Start \[s\].
    pub start_s: f64,
    /// From the start of this cycle to that of the next one \[s\].
    pub duration_s: f64,
    /// Electrical energy in that time \[J\].
    pub energy_j: f64,
    /// The part of it that the movements take \[J\].
    pub motion_j: f64,
    /// The waits that ended, in the order of the program.
    pub visits: Vec<Visit>,
}

/// What a recorder and a meter write, and what is true.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Log of events, CSV (`docs/cell.md`).
    pub events: String,
    /// Log of power, CSV: `t`, `power`, `cycle`, `part`, `temp1`.
    pub power: String,
    /// Starts of the sessions \[s\].
    pub sessions: Vec<f64>,
    /// The cycles.
    pub cycles: Vec<CycleTruth>,
}

impl Run {
    /// Energy of all cycles \[J\].
    #[must_use]
    pub fn energy_j(&self) -> f64 {
        self.cycles.iter().map(|cycle| cycle.energy_j).sum()
    }

    /// Energy of all movements \[J\].
    #[must_use]
    pub fn motion_j(&self) -> f64 {
        self.cycles.iter().map(|cycle| cycle.motion_j).sum()
    }
}
