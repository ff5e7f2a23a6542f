//! The result of a simulation: runs, waits and outputs on one time line.

use std::collections::BTreeSet;

use super::memo::Key;
use super::pace::Pace;
use super::timed::{JointState, TimedMotion};
use crate::arm::dynamics::Load;
use crate::rapid::ir::exec::Note;
use crate::rapid::ir::movement::{Movement, Output, Unresolved, Wait};
use crate::retime::path::Leg;
use crate::retime::path::joint_path::Joints;

/// One cycle of a program.
#[derive(Debug)]
pub struct Simulation {
    /// The events in order; their durations add up to the cycle.
    pub events: Vec<Event>,
    /// Duration of the cycle, s.
    pub cycle_s: f64,
    /// The first event of an endless loop; the events contain one pass of it.
    pub repeats_from: Option<usize>,
    /// Statements that could not be simulated.
    pub unresolved: Vec<Note>,
    /// Assumptions about the program.
    pub assumed: Vec<String>,
    /// Lower-case names of the inputs that the cycle waits for.
    pub inputs_asked: BTreeSet<String>,
}

/// An entry of the time line.
#[derive(Debug)]
pub struct Event {
    /// Start, s from the start of the cycle.
    pub t_start: f64,
    /// Duration, s.
    pub duration: f64,
    /// Its kind and data.
    pub what: What,
}

impl Event {
    /// Whether it is an output between fly-by movements, which precedes their run in the list.
    pub fn is_within_next_run(&self) -> bool {
        matches!(&self.what, What::Output(_, position) if *position > 0)
    }
}

/// The kinds of events.
#[derive(Debug)]
pub enum What {
    /// Movements from rest to rest.
    Run(Box<Run>),
    /// A wait.
    Wait(Box<WaitRecord>),
    /// A change of an output, and the number of fly-by movements in progress.
    Output(Output, usize),
    /// A movement that could not be simulated; the position after it is unknown.
    Left(Unresolved),
}

/// Movements from rest to rest.
#[derive(Debug)]
pub struct Run {
    /// The movements with their times.
    pub moves: Vec<MoveRecord>,
    /// Their geometry, one leg per movement.
    pub legs: Vec<Leg>,
    /// The consecutive motions with their starts in the run, s.
    pub motions: Vec<(f64, TimedMotion)>,
    /// Tool and payload.
    pub load: Load,
    /// Joint angles at the start, rad.
    pub start: Joints,
    /// Joint angles at the end, rad.
    pub end: Joints,
    /// Time at rest at the end, s.
    pub settling: f64,
    /// False if the start position is unknown.
    pub start_known: bool,
    /// Reason why the path could not be followed as programmed.
    pub problem: Option<String>,
    /// What its motion was found by, if planned runs are kept.
    pub key: Option<Key>,
}

impl Run {
    /// Duration with settling, s.
    pub fn duration(&self) -> f64 {
        self.moves.iter().map(|m| m.duration).sum()
    }

    /// The motions between two times, s from the start of the run.
    pub fn motions_between(&self, from: f64, to: f64) -> &[(f64, TimedMotion)] {
        let first = self.motions.partition_point(|(begin, _)| *begin <= from).saturating_sub(1);
        let last = self.motions.partition_point(|(begin, _)| *begin < to);
        self.motions.get(first..last).unwrap_or_default()
    }

    /// The state at `t` after the start of the run.
    pub fn at(&self, t: f64) -> JointState {
        if t >= self.duration() - self.settling {
            return JointState::rest(self.end);
        }
        let after = self.motions.partition_point(|(begin, _)| *begin <= t);
        match after.checked_sub(1).and_then(|i| self.motions.get(i)) {
            Some((begin, motion)) => motion.at(t - begin),
            None => JointState::rest(self.start),
        }
    }
}

/// A movement with its time.
#[derive(Debug)]
pub struct MoveRecord {
    /// The movement.
    pub movement: Movement,
    /// Start, s from the start of the run.
    pub t_start: f64,
    /// Duration, s.
    pub duration: f64,
    /// The limit that determines its speed.
    pub pace: Pace,
}

/// A wait with its duration.
#[derive(Debug)]
pub struct WaitRecord {
    /// The wait.
    pub wait: Wait,
    /// Source of its duration.
    pub basis: WaitBasis,
    /// Joint angles, rad.
    pub q: Joints,
    /// Tool and payload.
    pub load: Load,
    /// False if the position is uncertain.
    pub position_known: bool,
}

/// Source of the duration of a wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaitBasis {
    /// The program.
    Stated,
    /// The user states the time of the input.
    Input,
    /// Unknown, taken as 0 s.
    Unknown,
}
