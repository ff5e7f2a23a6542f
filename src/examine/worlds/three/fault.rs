//! A fault: what acts, where and when.

use super::arm::Arm;
use super::body::BodyLaw;
use super::law::MotorLaw;
use super::link::LinkLaw;
use super::signal::SignalLaw;
use crate::examine::worlds::api::Truth;
use crate::examine::worlds::random::Rng;

/// One law of a fault at its place (joints from 0).
#[derive(Clone)]
pub(super) enum Act {
    /// Bodies, gravity, contact, angles, compliance.
    Body(BodyLaw),
    Link(usize, LinkLaw),
    /// In a motor's coordinates.
    Friction(usize, MotorLaw),
    /// In what the drive reports.
    Report(usize, MotorLaw),
    /// In the signal path.
    Signal(SignalLaw),
    /// Motor `into` also turns with joint `from`.
    Coupling {
        from: usize,
        into: usize,
        /// Turns of the motor per turn of the joint, both behind the gear.
        ratio: f64,
    },
}

/// A fault of torques.
#[derive(Clone)]
pub(super) struct Fault {
    pub(super) id: &'static str,
    pub(super) form: &'static str,
    /// Joints from 0; empty for the whole arm.
    pub(super) joints: Vec<usize>,
    /// Window within each period \[s\].
    pub(super) window: Option<[f64; 2]>,
    pub(super) acts: Vec<Act>,
    /// Smallest and largest factor on its first size that is plausible.
    pub(super) bounds: [f64; 2],
    /// Effects that cannot be told apart.
    pub(super) equivalents: Vec<&'static str>,
}

/// What a draw needs to know of a case.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place<'a> {
    pub(super) arm: &'a Arm,
    /// Duration of a period \[s\].
    pub(super) period: f64,
    /// Duration of a log \[s\].
    pub(super) length: f64,
    /// Sampling rate \[Hz\].
    pub(super) rate: f64,
}

impl Fault {
    /// A fault of a list of laws.
    pub(super) fn new(
        id: &'static str,
        form: &'static str,
        joints: &[usize],
        acts: Vec<Act>,
        bounds: [f64; 2],
    ) -> Self {
        Self {
            id,
            form,
            joints: joints.to_vec(),
            window: None,
            acts,
            bounds,
            equivalents: Vec::new(),
        }
    }

    pub(super) fn like(mut self, ids: &[&'static str]) -> Self {
        self.equivalents.extend(ids);
        self
    }

    /// The fault, `factor` times as large.
    pub(super) fn scaled(&self, factor: f64) -> Self {
        let mut fault = self.clone();
        for act in &mut fault.acts {
            match act {
                Act::Body(law) => *law = law.scaled(factor),
                Act::Link(_, law) => law.stiffness *= factor,
                Act::Friction(_, law) | Act::Report(_, law) => {
                    law.sizes = law.sizes.map(|size| size * factor);
                }
                Act::Signal(law) => law.size *= factor,
                Act::Coupling { ratio, .. } => *ratio *= factor,
            }
        }
        fault
    }

    /// Takes the joints out at which the fault alone cannot be seen, unless none would be left.
    pub(super) fn keep(&mut self, seen: impl Fn(&Self) -> bool) {
        if self.joints.len() < 2 || self.id == "wrist_coupling" || self.id == "outside" {
            return;
        }
        let at = |act: &Act| match act {
            Act::Body(law) => law.parameters().0,
            Act::Link(joint, _) | Act::Friction(joint, _) | Act::Report(joint, _) => Some(*joint),
            Act::Signal(_) | Act::Coupling { .. } => None,
        };
        let alone = |joint: usize| {
            let mut fault = self.clone();
            fault.acts.retain(|act| at(act) == Some(joint));
            fault
        };
        let visible: Vec<usize> =
            self.joints.iter().copied().filter(|joint| seen(&alone(*joint))).collect();
        if !visible.is_empty() && visible.len() < self.joints.len() {
            self.acts.retain(|act| at(act).is_some_and(|joint| visible.contains(&joint)));
            self.joints = visible;
        }
    }

    /// What is true of it; its nats are not known yet. `period`: that of the logs \[s\], if they repeat.
    pub(super) fn truth(&self, period: Option<f64>) -> Truth {
        let mut truth = Truth::new(self.id, self.form, &self.joints);
        truth.window = self.window;
        truth.equivalents = self.equivalents.iter().map(|id| (*id).to_owned()).collect();
        let (coupled, outside) = (self.id == "wrist_coupling", self.id == "outside");
        for act in &self.acts {
            let (joint, list) = match act {
                Act::Body(law) => law.parameters(),
                Act::Link(joint, law) => (Some(*joint), law.parameters()),
                Act::Friction(joint, law) | Act::Report(joint, law) => {
                    (Some(*joint), law.parameters())
                }
                Act::Signal(law) => (None, law.parameters()),
                Act::Coupling { ratio, .. } => (None, vec![("coupling", *ratio, coupled)]),
            };
            // What a coupling has beside its ratio belongs to the form.
            let joint = joint.filter(|_| !coupled);
            for (name, value, graded) in list {
                if !coupled || name == "coupling" {
                    truth.tell(name, joint, value, graded && !outside);
                }
            }
            if let ("brake_drag", Some([from, to])) = (self.id, self.window) {
                truth.tell("t_start_s", joint, from, true);
                truth.tell("t_end_s", joint, to, true);
            }
        }
        if let (Some(period), Some(_), false) = (period, self.window, outside) {
            truth.tell("period_s", self.joints.first().copied(), period, false);
        }
        truth
    }
}

/// One to three joints of an arm, mostly one.
pub(super) fn some_joints(arm: &Arm, rng: &mut Rng) -> Vec<usize> {
    let all: Vec<usize> = (0..arm.axes()).collect();
    let ticket = rng.unit();
    let count = if ticket < 0.6 {
        1
    } else if ticket < 0.87 {
        2
    } else {
        3
    };
    rng.choose(&all, count)
}
