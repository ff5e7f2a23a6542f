//! Items that are not yet on the time line.

use std::sync::Arc;

use crate::arm::dynamics::Load;
use crate::arm::robot::Model;
use crate::rapid::ir::movement::{Movement, Output, Settings, Unresolved, Wait};
use crate::retime::motion::run_plan::{Planned, plan_run};
use crate::retime::motion::sampling::Loaded;
use crate::retime::path::Leg;
use crate::retime::path::joint_path::Joints;

/// A run that is not yet planned.
pub(super) struct RunDraft {
    pub(super) movements: Vec<Movement>,
    pub(super) legs: Vec<Leg>,
    /// `\T` of the movements under the overrides, s.
    pub(super) times: Vec<Option<f64>>,
    pub(super) load: Load,
    /// Settings of the first movement.
    pub(super) settings: Arc<Settings>,
}

/// A wait at the joint angles q (rad).
pub(super) struct WaitDraft {
    pub(super) wait: Wait,
    pub(super) q: Joints,
    pub(super) load: Load,
}

/// An item that becomes an event.
pub(super) enum Draft {
    Run(Box<RunDraft>),
    Wait(Box<WaitDraft>),
    Output(Output, usize),
    Left(Unresolved),
}

impl RunDraft {
    /// Keeps the first `count` movements; the robot stops after them.
    pub(super) fn truncate(&mut self, count: usize) {
        self.movements.truncate(count);
        self.legs.truncate(count);
        self.times.truncate(count);
    }

    pub(super) fn plan(&self, model: &Model) -> Planned {
        let loaded = Loaded { model, load: &self.load };
        plan_run(loaded, &self.legs, &self.movements, &self.times, &self.settings)
    }
}
