//! A simulated fault and its true parameters.

use super::action::Action;

/// A true parameter.
#[derive(Clone, Debug)]
pub(super) struct Parameter {
    pub(super) name: &'static str,
    pub(super) joint: Option<usize>,
    pub(super) value: f64,
    /// Whether its value is independent of the form of the law.
    pub(super) graded: bool,
}

/// A fault of a robot or its log.
pub(super) struct Disturbance {
    /// Effect id; `outside` for a fault without a corresponding effect.
    pub(super) id: &'static str,
    pub(super) form: &'static str,
    /// Joints, from 0; empty for a fault of the whole arm.
    pub(super) joints: Vec<usize>,
    pub(super) parameters: Vec<Parameter>,
    /// Interval within the period \[s\].
    pub(super) window: Option<[f64; 2]>,
    /// Effects with exactly the same torques in this case.
    pub(super) equivalents: &'static [&'static str],
    pub(super) actions: Vec<Action>,
}

impl Disturbance {
    pub(super) fn new(id: &'static str, form: &'static str, joints: Vec<usize>) -> Disturbance {
        Disturbance {
            id,
            form,
            joints,
            parameters: Vec::new(),
            window: None,
            equivalents: &[],
            actions: Vec::new(),
        }
    }

    pub(super) fn at_joint(id: &'static str, form: &'static str, joint: usize) -> Disturbance {
        Disturbance::new(id, form, vec![joint])
    }

    /// Adds a parameter whose meaning is independent of the law's form.
    pub(super) fn graded(self, name: &'static str, value: f64) -> Disturbance {
        self.parameter(name, value, true)
    }

    /// Adds a parameter specific to this form.
    pub(super) fn with(self, name: &'static str, value: f64) -> Disturbance {
        self.parameter(name, value, false)
    }

    pub(super) fn parameter(mut self, name: &'static str, value: f64, graded: bool) -> Disturbance {
        let joint = self.joints.first().copied();
        self.parameters.push(Parameter { name, joint, value, graded });
        self
    }

    pub(super) fn within(mut self, window: [f64; 2]) -> Disturbance {
        self.window = Some(window);
        self
    }

    pub(super) fn like(mut self, equivalents: &'static [&'static str]) -> Disturbance {
        self.equivalents = equivalents;
        self
    }

    pub(super) fn acting(mut self, action: Action) -> Disturbance {
        self.actions.push(action);
        self
    }
}
