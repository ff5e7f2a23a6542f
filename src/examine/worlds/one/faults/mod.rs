//! Faults: what acts on the arm, and the truth about it.

pub(super) mod bodies;
pub(super) mod catalogue;
pub(super) mod forces;
pub(super) mod friction;
pub(super) mod gears;
pub(super) mod outside;
pub(super) mod readings;
pub(super) mod springs;

use super::arm::Arm;
use super::dynamics::Pose;
use super::everyday::Level;
use super::law::{Law, Reader, Static, View};
use super::motion::Path;
use crate::examine::worlds::api::Truth;
use crate::examine::worlds::model::Row;
use crate::examine::worlds::random::Rng;
use std::cell::RefCell;
use std::rc::Rc;

/// The prescribed motion at one time, for fields.
pub(super) struct Moment<'a> {
    /// Time within the period \[s\].
    pub(super) phase: f64,
    pub(super) arm: &'a Arm,
    pub(super) pose: &'a Pose,
    /// Angles \[rad\].
    pub(super) q: &'a Row,
    /// Speeds \[rad/s\].
    pub(super) v: &'a Row,
    /// Accelerations \[rad/s²\].
    pub(super) a: &'a Row,
}

/// Torques \[Nm\] of the joints as a function of the prescribed motion.
pub(super) type Field = Box<dyn Fn(&Moment) -> Row>;

/// A law or a reader at a joint.
pub(super) struct Part<T: ?Sized> {
    pub(super) joint: usize,
    /// The other joint that it sees, from 0.
    pub(super) other: usize,
    pub(super) what: Box<T>,
}

/// A fault.
pub(super) struct Fault {
    /// The truth; `nats` is filled in later.
    pub(super) truth: Truth,
    pub(super) field: Option<Field>,
    /// Whether the field goes through the gears and adds to the load; otherwise only laws see it.
    pub(super) loads: bool,
    pub(super) laws: Vec<Part<dyn Law>>,
    /// Distortions of the reported torque, in order.
    pub(super) readers: Vec<Part<dyn Reader>>,
    /// Whether it changes from period to period.
    pub(super) drifts: bool,
    /// Fields that are known already, by the address of their path.
    pub(super) known: RefCell<Vec<(usize, Rc<Vec<Row>>)>>,
}

impl Fault {
    /// A fault that does nothing yet. Joints count from 0 here.
    pub(super) fn new(id: &str, form: &str, joints: &[usize]) -> Self {
        Self {
            truth: Truth::new(id, form, joints),
            field: None,
            loads: false,
            laws: Vec::new(),
            readers: Vec::new(),
            drifts: false,
            known: RefCell::default(),
        }
    }

    /// Adds a law at a joint.
    pub(super) fn law(&mut self, joint: usize, law: impl Law + 'static) {
        self.laws.push(Part { joint, other: joint, what: Box::new(law) });
    }

    /// Adds a torque \[Nm\] without states at a joint.
    pub(super) fn torque(&mut self, joint: usize, torque: impl Fn(&View) -> f64 + 'static) {
        self.law(joint, Static(torque));
    }

    /// Adds a law that sees another joint.
    pub(super) fn law_with(&mut self, joint: usize, other: usize, law: impl Law + 'static) {
        self.laws.push(Part { joint, other, what: Box::new(law) });
    }

    /// Adds a distortion of a reported torque.
    pub(super) fn reader(&mut self, joint: usize, reader: impl Reader + 'static) {
        self.readers.push(Part { joint, other: joint, what: Box::new(reader) });
    }

    /// Names effects that give the same torques.
    pub(super) fn same_as(&mut self, ids: &[&str]) {
        self.truth.equivalents.extend(ids.iter().map(|id| (*id).to_owned()));
    }
}

/// What a builder knows of the case.
pub(super) struct Context<'a> {
    pub(super) arm: &'a Arm,
    pub(super) level: &'a Level,
    pub(super) path: &'a Path,
    /// Period of the first log \[s\].
    pub(super) period: f64,
    /// Duration of the first log \[s\].
    pub(super) duration: f64,
    /// Sampling rate \[Hz\].
    pub(super) rate: f64,
}

/// Joints and form of a fault, and its size over what is usual (about a tenth of the torque at 1).
pub(super) struct Order<'a> {
    pub(super) joints: &'a [usize],
    pub(super) form: usize,
    pub(super) size: f64,
}

/// Builds a fault; the same random stream gives the same fault but for its size.
pub(super) type Builder = fn(&Context, &Order, &mut Rng) -> Fault;
