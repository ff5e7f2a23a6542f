//! The state of the virtual controller during the execution of a program.

use std::collections::{BTreeMap, BTreeSet};

use super::draft::Draft;
use super::options::Options;
use crate::arm::robot::Model;
use crate::rapid::ir::exec::{Note, WaitResult};
use crate::rapid::ir::movement::{Movement, Target, Tool};
use crate::rapid::text::Span;
use crate::retime::motion::timeline::{Event, Simulation, What};
use crate::retime::path::Leg;
use crate::retime::path::joint_path::{DOF, Joints};

/// A movement with solved geometry in an incomplete run.
pub(super) struct Pending {
    pub(super) movement: Movement,
    pub(super) leg: Leg,
}

pub(super) struct VirtualController<'a> {
    pub(super) model: &'a Model,
    pub(super) options: &'a Options,
    /// Joint angles after all movements, including pending ones, rad.
    pub(super) q: Joints,
    /// False if the position at the end of the time line is unknown.
    pub(super) certain: bool,
    /// Rest after the last run before the next movement, s.
    pub(super) settling: f64,
    /// True if the time line exceeds the time limit.
    pub(super) late: bool,
    pub(super) moved: bool,
    /// Tool of the last movement.
    pub(super) tool: Option<Tool>,
    pub(super) time: f64,
    pub(super) events: Vec<Event>,
    pub(super) pending: Vec<Pending>,
    /// Time of the pending movements at their programmed speeds, s.
    pub(super) pending_s: f64,
    /// Lead of the program over the motion (`\Conc`), s.
    pub(super) ahead: f64,
    /// Outcome of the last wait.
    pub(super) waited_last: WaitResult,
    /// Assumptions about the controller.
    pub(super) assumed: Vec<String>,
    /// Items that are not yet on the time line; each becomes one event.
    pub(super) drafts: Vec<Draft>,
    pub(super) notes: Vec<Note>,
    pub(super) repeats_from: Option<usize>,
    /// End of the last wait for each input.
    pub(super) waited: BTreeMap<String, f64>,
    /// Lower-case names of the inputs that were waited for.
    pub(super) asked: BTreeSet<String>,
    /// Number of executed movements.
    pub(super) moves: usize,
}

impl<'a> VirtualController<'a> {
    pub(super) fn new(model: &'a Model, options: &'a Options) -> VirtualController<'a> {
        VirtualController {
            model,
            options,
            q: options.start.unwrap_or([0.0; DOF]),
            certain: true,
            settling: 0.0,
            late: false,
            moved: false,
            tool: None,
            time: 0.0,
            events: Vec::new(),
            pending: Vec::new(),
            pending_s: 0.0,
            ahead: 0.0,
            waited_last: WaitResult::Ended,
            assumed: Vec::new(),
            drafts: Vec::new(),
            notes: Vec::new(),
            repeats_from: None,
            waited: BTreeMap::new(),
            asked: BTreeSet::new(),
            moves: 0,
        }
    }

    /// The time line.
    pub(super) fn into_simulation(self) -> Simulation {
        let count = self.events.len();
        Simulation {
            events: self.events,
            cycle_s: self.time,
            repeats_from: self.repeats_from.filter(|first| *first < count),
            unresolved: self.notes,
            assumed: self.assumed,
            inputs_asked: self.asked,
        }
    }

    /// Where the robot stands before its first movement, if nobody states it: at a target in joints.
    pub(super) fn begin(&mut self, movement: &Movement) {
        let first = !std::mem::replace(&mut self.moved, true);
        if first
            && self.options.start.is_none()
            && let Target::Joints(q) = &movement.target
        {
            self.q = *q;
        }
    }

    /// The speed override of `VelSet`, `SpeedRefresh` and the user.
    pub(super) fn speed_override(&self, movement: &Movement) -> f64 {
        let settings = &movement.settings;
        settings.speed_override * settings.refresh * self.options.speed_override.unwrap_or(1.0)
    }

    /// `\T` under the overrides: at 50 % the time is doubled.
    pub(super) fn timed(&self, movement: &Movement) -> Option<f64> {
        movement.time.map(|t| t / self.speed_override(movement))
    }

    pub(super) fn note(&mut self, span: Span, reason: &str) {
        let note = Note { span, reason: reason.to_owned() };
        if !self.notes.contains(&note) {
            self.notes.push(note);
        }
    }

    pub(super) fn push(&mut self, duration: f64, what: What) {
        self.events.push(Event { t_start: self.time, duration, what });
        self.time += duration;
    }
}
