//! A fault: what it does in the simulation, and its truth.

use super::everyday::Scale;
use super::robot::Robot;
use super::sensor::Sensor;
use super::structure::{Bristle, Change, Contact, Encoder, Flex, Wrist};
use super::terms::Term;
use crate::examine::worlds::api::Truth;
use crate::examine::worlds::model::{MAX, Spread};
use crate::examine::worlds::random::Rng;

/// What a fault does.
#[derive(Clone, Debug)]
pub(super) enum Action {
    /// Torques at joints.
    Terms(Vec<Term>),
    /// Bodies, rotors, gravity.
    Body(Vec<Change>),
    /// An elastic gear or a gap.
    Flex(Flex),
    /// An encoder that shows a wrong angle.
    Encoder(Encoder),
    /// Long bristles.
    Bristle(Bristle),
    /// Coupling of the wrist.
    Wrist(Wrist),
    /// The path of the torque.
    Sensor(Sensor),
    /// A force on the flange.
    Contact(Contact),
    /// No torque.
    Nothing,
}

/// A fault.
#[derive(Clone, Debug)]
pub(super) struct Fault {
    /// The truth.
    pub(super) truth: Truth,
    /// Its action.
    pub(super) action: Action,
}

impl Fault {
    /// A fault; joints from 0.
    pub(super) fn new(id: &str, form: &str, joints: &[usize], action: Action) -> Self {
        Self { truth: Truth::new(id, form, joints), action }
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

    /// Its changes of bodies.
    pub(super) fn changes(&self) -> impl Iterator<Item = &Change> {
        let list: &[Change] = if let Action::Body(list) = &self.action { list } else { &[] };
        list.iter()
    }
}

/// What sizes are drawn from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ground<'a> {
    /// The robot.
    pub(super) robot: &'a Robot,
    /// Levels of the motions.
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
    /// Number of joints.
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

    /// A mask of joints.
    pub(super) fn mask(&self, joints: &[usize]) -> [bool; MAX] {
        let mut out = [false; MAX];
        for (i, place) in out.iter_mut().enumerate() {
            *place = joints.contains(&i) || (joints.is_empty() && i < self.n());
        }
        out
    }
}
