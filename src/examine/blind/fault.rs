//! A simulated fault and its true parameters.

use super::action::Action;
use super::label::{TrueParameter, Truth};

/// A fault of a robot or its log.
pub(super) struct Disturbance {
    /// What the label says of it; `nats` is set later.
    pub(super) truth: Truth,
    pub(super) actions: Vec<Action>,
}

impl Disturbance {
    /// A fault of these joints, from 0; without any, of the whole arm.
    pub(super) fn new(id: &str, form: &str, joints: &[usize]) -> Disturbance {
        Disturbance { truth: Truth::new(id, form, joints), actions: Vec::new() }
    }

    pub(super) fn at_joint(id: &str, form: &str, joint: usize) -> Disturbance {
        Disturbance::new(id, form, &[joint])
    }

    /// Adds a parameter whose meaning is independent of the law's form.
    pub(super) fn graded(self, name: &str, value: f64) -> Disturbance {
        self.parameter(name, value, true)
    }

    /// Adds a parameter specific to this form.
    pub(super) fn with(self, name: &str, value: f64) -> Disturbance {
        self.parameter(name, value, false)
    }

    fn parameter(mut self, name: &str, value: f64, graded: bool) -> Disturbance {
        let joint = self.truth.joints.first().copied();
        self.truth.parameters.push(TrueParameter { name: name.into(), joint, value, graded });
        self
    }

    pub(super) fn within(mut self, window: [f64; 2]) -> Disturbance {
        self.truth.window = Some(window);
        self
    }

    /// Effects with exactly the same torques in this case.
    pub(super) fn like(mut self, equivalents: &[&str]) -> Disturbance {
        self.truth.equivalents = equivalents.iter().map(|&id| id.to_owned()).collect();
        self
    }

    pub(super) fn acting(mut self, action: Action) -> Disturbance {
        self.actions.push(action);
        self
    }
}
