//! A fault: what it does in the simulation, and its truth.

use super::everyday::Scale;
use super::robot::Robot;
use super::sensor::Sensor;
use super::structure::{Bristle, Change, Contact, Encoder, Flex, Wrist};
use super::terms::Term;
use crate::examine::worlds::api::Truth;
use crate::examine::worlds::model::Spread;
use crate::examine::worlds::random::Rng;

/// What a fault does.
#[derive(Clone)]
pub(super) enum Action {
    Terms(Vec<Term>),
    Body(Vec<Change>),
    /// An elastic gear or a gap.
    Flex(Flex),
    /// An encoder that shows a wrong angle.
    Encoder(Encoder),
    Bristle(Bristle),
    /// Coupling of the wrist.
    Wrist(Wrist),
    /// The path of the torque.
    Sensor(Sensor),
    /// A force on the flange.
    Contact(Contact),
    Nothing,
}

/// A fault.
#[derive(Clone)]
pub(super) struct Fault {
    pub(super) truth: Truth,
    pub(super) action: Action,
}

impl Fault {
    /// A fault; joints from 0.
    pub(super) fn new(id: &str, form: &str, joints: &[usize], action: Action) -> Self {
        Self { truth: Truth::new(id, form, joints), action }
    }

    /// A fault with a law at each joint, from 0; `make` gives the law and its parameters: name, value,
    /// and whether it means the same in the library.
    pub(super) fn terms(
        id: &str,
        form: &str,
        joints: &[usize],
        mut make: impl FnMut(usize) -> (Term, Vec<(&'static str, f64, bool)>),
    ) -> Self {
        let mut fault = Self::new(id, form, joints, Action::Nothing);
        let mut terms = Vec::new();
        for joint in joints {
            let (term, told) = make(*joint);
            terms.push(term);
            for (name, value, graded) in told {
                fault.truth.tell(name, Some(*joint), value, graded);
            }
        }
        fault.action = Action::Terms(terms);
        fault
    }

    /// Adds a parameter that means the same as in the library.
    pub(super) fn graded(self, name: &str, joint: Option<usize>, value: f64) -> Self {
        self.parameter(name, joint, value, true)
    }

    /// Adds a parameter whose meaning is that of this form alone.
    pub(super) fn own(self, name: &str, joint: Option<usize>, value: f64) -> Self {
        self.parameter(name, joint, value, false)
    }

    /// Adds a parameter; joint from 0.
    pub(super) fn parameter(
        mut self,
        name: &str,
        joint: Option<usize>,
        value: f64,
        graded: bool,
    ) -> Self {
        self.truth.tell(name, joint, value, graded);
        self
    }

    /// Adds effects that cannot be told apart from it.
    pub(super) fn like(mut self, ids: &[&str]) -> Self {
        self.truth.equivalents.extend(ids.iter().map(|id| (*id).to_owned()));
        self
    }

    /// Sets the window within the period \[s\].
    pub(super) fn within(mut self, from: f64, to: f64) -> Self {
        self.truth.window = Some([from, to]);
        self
    }

    pub(super) fn changes(&self) -> impl Iterator<Item = &Change> {
        let list: &[Change] = if let Action::Body(list) = &self.action { list } else { &[] };
        list.iter()
    }
}

/// What sizes are drawn from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ground<'a> {
    pub(super) robot: &'a Robot,
    pub(super) scale: &'a Scale,
    /// How the nominal model is believed.
    pub(super) spread: Spread,
    /// Shortest period \[s\].
    pub(super) period: f64,
    /// Shortest log \[s\].
    pub(super) length: f64,
    /// Sampling rate of the log \[Hz\].
    pub(super) rate: f64,
}

/// Sizes relative to the rms torque: from barely visible to strong.
const SIZE: (f64, f64) = (0.025, 0.45);

impl Ground<'_> {
    pub(super) fn n(&self) -> usize {
        self.robot.arm.n()
    }

    /// One to `most` different joints, from 0.
    pub(super) fn joints(&self, most: usize, rng: &mut Rng) -> Vec<usize> {
        let wanted = rng.pick(&[1, 1, 1, 1, 1, 1, 2, 2, 2, 3]).min(most);
        let mut list: Vec<usize> = Vec::new();
        while list.len() < wanted {
            let i = rng.below(self.n());
            if !list.contains(&i) {
                list.push(i);
            }
        }
        list.sort_unstable();
        list
    }

    /// A joint that carries a load through its gear.
    pub(super) fn loaded(&self, rng: &mut Rng) -> usize {
        let bearing: Vec<usize> = (0..self.n())
            .filter(|&i| i > 0 && self.scale.load[i] > 0.35 * self.scale.torque[i])
            .collect();
        rng.pick(&bearing)
    }

    /// A torque \[Nm\] of a drawn relative size at a joint.
    pub(super) fn torque(&self, i: usize, rng: &mut Rng) -> f64 {
        rng.log_between(SIZE.0, SIZE.1) * self.scale.torque[i]
    }
}
