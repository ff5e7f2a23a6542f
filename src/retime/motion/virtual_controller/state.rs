//! The state of the virtual controller while a program runs.

use std::collections::{BTreeMap, BTreeSet};

use super::draft::Draft;
use super::options::Options;
use crate::arm::robot::Model;
use crate::rapid::ir::exec::{Note, Waited};
use crate::rapid::ir::movement::{Movement, Tool};
use crate::rapid::text::Span;
use crate::retime::motion::timeline::{Event, What};
use crate::retime::path::Leg;
use crate::retime::path::joint_path::{DOF, Joints};

/// A movement whose geometry is solved and that waits for the rest of its run.
pub(super) struct Pending {
    pub(super) movement: Movement,
    pub(super) leg: Leg,
}

pub(super) struct VirtualController<'a> {
    pub(super) model: &'a Model,
    pub(super) options: &'a Options,
    /// Joints after all movements so far, pending ones included, rad.
    pub(super) q: Joints,
    /// False where the position of the robot is not known, at the end of the time line.
    pub(super) certain: bool,
    /// How long the robot rests after the last run before it can move on, s.
    pub(super) settling: f64,
    /// True once the time line is longer than the largest time.
    pub(super) late: bool,
    pub(super) moved: bool,
    /// Tool of the last movement.
    pub(super) tool: Option<Tool>,
    pub(super) time: f64,
    pub(super) events: Vec<Event>,
    pub(super) pending: Vec<Pending>,
    /// Time that the pending movements take at their speeds, s.
    pub(super) pending_s: f64,
    /// Time by which the logic is ahead of the motion (`\Conc`), s.
    pub(super) ahead: f64,
    /// How the wait that was laid out last ended.
    pub(super) waited_last: Waited,
    /// Assumptions about the controller.
    pub(super) assumed: Vec<String>,
    /// Items that are not on the time line yet: each becomes one event.
    pub(super) drafts: Vec<Draft>,
    pub(super) notes: Vec<Note>,
    pub(super) repeats_from: Option<usize>,
    /// End of the last wait for each input.
    pub(super) waited: BTreeMap<String, f64>,
    /// Lower-case names of the inputs that were waited for.
    pub(super) asked: BTreeSet<String>,
    /// Number of movements of the program so far.
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
            waited_last: Waited::Ended,
            assumed: Vec::new(),
            drafts: Vec::new(),
            notes: Vec::new(),
            repeats_from: None,
            waited: BTreeMap::new(),
            asked: BTreeSet::new(),
            moves: 0,
        }
    }

    /// The override of speeds by `VelSet`, `SpeedRefresh` and the user.
    pub(super) fn speed_override(&self, movement: &Movement) -> f64 {
        let settings = &movement.settings;
        settings.speed_override * settings.refresh * self.options.speed_override.unwrap_or(1.0)
    }

    /// `\T` under the overrides: 50 % takes twice the time.
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
