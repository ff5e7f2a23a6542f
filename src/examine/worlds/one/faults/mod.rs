//! Faults: what acts on the arm, and the truth about it.

pub mod bodies;
pub mod catalogue;
pub mod forces;
pub mod friction;
pub mod gears;
pub mod outside;
pub mod readings;
pub mod springs;

use crate::api::{TrueParameter, Truth};
use crate::arm::{Arm, Row};
use crate::dynamics::Pose;
use crate::everyday::Level;
use crate::law::{Law, Reader};
use crate::motion::Path;
use crate::rng::Rng;
use std::cell::RefCell;
use std::rc::Rc;

/// The prescribed motion at one time, for fields.
pub struct Moment<'a> {
    /// Time within the period \[s\].
    pub phase: f64,
    /// The real arm.
    pub arm: &'a Arm,
    /// Where it is.
    pub pose: &'a Pose,
    /// Angles \[rad\].
    pub q: &'a Row,
    /// Speeds \[rad/s\].
    pub v: &'a Row,
    /// Accelerations \[rad/s²\].
    pub a: &'a Row,
}

/// Torques \[Nm\] of the joints as a function of the prescribed motion.
pub type Field = Box<dyn Fn(&Moment) -> Row>;

/// A law or a reader at a joint.
pub struct Part<T: ?Sized> {
    /// Joint, from 0.
    pub joint: usize,
    /// The other joint that it sees, from 0.
    pub other: usize,
    /// What it does.
    pub what: Box<T>,
}

/// A fault.
pub struct Fault {
    /// The truth; `nats` is filled in later.
    pub truth: Truth,
    /// Torques of the prescribed motion.
    pub field: Option<Field>,
    /// Whether the field goes through the gears and adds to the load; otherwise only laws see it.
    pub loads: bool,
    /// Laws of joints.
    pub laws: Vec<Part<dyn Law>>,
    /// Distortions of the reported torque, in order.
    pub readers: Vec<Part<dyn Reader>>,
    /// Whether it changes from period to period.
    pub drifts: bool,
    /// Fields that are known already, by the address of their path.
    pub known: RefCell<Vec<(usize, Rc<Vec<Row>>)>>,
}

impl Fault {
    /// A fault that does nothing yet. Joints count from 0 here.
    pub fn new(id: &str, form: &str, joints: &[usize]) -> Self {
        let truth = Truth {
            id: id.to_owned(),
            form: form.to_owned(),
            joints: joints.iter().map(|j| j + 1).collect(),
            parameters: Vec::new(),
            window: None,
            equivalents: Vec::new(),
            nats: 0.0,
        };
        Self {
            truth,
            field: None,
            loads: false,
            laws: Vec::new(),
            readers: Vec::new(),
            drifts: false,
            known: RefCell::default(),
        }
    }

    /// Adds a parameter of a joint (from 0) or of the robot.
    pub fn tell(&mut self, name: &str, joint: Option<usize>, value: f64, graded: bool) {
        let joint = joint.map(|j| j + 1);
        self.truth.parameters.push(TrueParameter { name: name.to_owned(), joint, value, graded });
    }

    /// Adds a law at a joint.
    pub fn law(&mut self, joint: usize, law: impl Law + 'static) {
        self.laws.push(Part { joint, other: joint, what: Box::new(law) });
    }

    /// Adds a law that sees another joint.
    pub fn law_with(&mut self, joint: usize, other: usize, law: impl Law + 'static) {
        self.laws.push(Part { joint, other, what: Box::new(law) });
    }

    /// Adds a distortion of a reported torque.
    pub fn reader(&mut self, joint: usize, reader: impl Reader + 'static) {
        self.readers.push(Part { joint, other: joint, what: Box::new(reader) });
    }

    /// Names effects that give the same torques.
    pub fn same_as(&mut self, ids: &[&str]) {
        self.truth.equivalents.extend(ids.iter().map(|id| (*id).to_owned()));
    }
}

/// What a builder knows of the case.
pub struct Context<'a> {
    /// The real arm.
    pub arm: &'a Arm,
    /// Levels of the first log.
    pub level: &'a Level,
    /// Motion of the first log.
    pub path: &'a Path,
    /// Period of the first log \[s\].
    pub period: f64,
    /// Duration of the first log \[s\].
    pub duration: f64,
    /// Sampling rate \[Hz\].
    pub rate: f64,
}

/// Joints and form of a fault, and its size over what is usual (about a tenth of the torque at 1).
pub struct Order<'a> {
    /// Joints, from 0.
    pub joints: &'a [usize],
    /// Number of the form.
    pub form: usize,
    /// Size.
    pub size: f64,
}

/// Builds a fault; the same random stream gives the same fault but for its size.
pub type Builder = fn(&Context, &Order, &mut Rng) -> Fault;
