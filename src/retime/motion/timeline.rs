//! The result of a simulation: runs, waits and outputs on one time line.

use std::collections::BTreeSet;

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
    /// s.
    pub cycle_s: f64,
    /// The first event of a loop that never ends; one pass of it is in the events.
    pub repeats_from: Option<usize>,
    /// What could not be simulated.
    pub unresolved: Vec<Note>,
    /// What was assumed about the program.
    pub assumed: Vec<String>,
    /// Lower-case names of the inputs that the cycle waits for.
    pub inputs_asked: BTreeSet<String>,
}

/// Something on the time line.
#[derive(Debug)]
pub struct Event {
    /// s from the start of the cycle.
    pub t_start: f64,
    /// s.
    pub duration: f64,
    /// What.
    pub what: What,
}

impl Event {
    /// Whether it is an output between fly-by movements, which stands before their run.
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
    /// A change of an output, and the number of fly-by movements that were under way.
    Output(Output, usize),
    /// A movement that could not be simulated; the robot may stand elsewhere afterwards.
    Left(Unresolved),
}

/// Movements from rest to rest.
#[derive(Debug)]
pub struct Run {
    /// The movements with their share of the time.
    pub moves: Vec<MoveRecord>,
    /// Their geometry, one for each movement.
    pub legs: Vec<Leg>,
    /// The motions one after the other, each with its start in the run, s.
    pub motions: Vec<(f64, TimedMotion)>,
    /// Tool and payload.
    pub load: Load,
    /// Joints at the start, rad.
    pub start: Joints,
    /// Joints at the end, rad.
    pub end: Joints,
    /// Time at rest at the end, s.
    pub settling: f64,
    /// False if its start is not known.
    pub start_known: bool,
    /// Why the path could not be followed as programmed.
    pub problem: Option<String>,
}

impl Run {
    /// Duration with settling, s.
    pub fn duration(&self) -> f64 {
        self.moves.iter().map(|m| m.duration).sum()
    }

    /// The motions that may be under way between two times, s from the start of the run.
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
    /// s from the start of the run.
    pub t_start: f64,
    /// s.
    pub duration: f64,
    /// What sets its pace.
    pub pace: Pace,
}

/// A wait with its length.
#[derive(Debug)]
pub struct WaitRecord {
    /// The wait.
    pub wait: Wait,
    /// Where its length comes from.
    pub basis: WaitBasis,
    /// Where the robot stands, rad.
    pub q: Joints,
    /// Tool and payload that it holds.
    pub load: Load,
    /// False if it may stand elsewhere.
    pub position_known: bool,
}

/// Where the length of a wait comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaitBasis {
    /// The program states it.
    Stated,
    /// The user stated when the input comes.
    Input,
    /// Not known: 0 s.
    Unknown,
}
