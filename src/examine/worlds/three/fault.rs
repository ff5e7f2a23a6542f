//! A fault: what acts, where and when; and the list of all faults.

use crate::api::TrueParameter;
use crate::arm::Arm;
use crate::body::BodyLaw;
use crate::friction::FrictionLaw;
use crate::link::LinkLaw;
use crate::report::ReportLaw;
use crate::rng::Rng;
use crate::signal::SignalLaw;
use crate::{draw_body, draw_drive, draw_friction};

/// One law of a fault at its place (joints from 0).
#[derive(Clone, Debug)]
pub enum Act {
    /// Bodies, gravity, contact, angles, compliance.
    Body(BodyLaw),
    /// Between the links.
    Link(usize, LinkLaw),
    /// In a motor's coordinates.
    Friction(usize, FrictionLaw),
    /// In what the drive reports.
    Report(usize, ReportLaw),
    /// In the signal path.
    Signal(SignalLaw),
    /// Motor `into` also turns with joint `from`.
    Coupling {
        /// The joint.
        from: usize,
        /// The motor.
        into: usize,
        /// Turns of the motor per turn of the joint, both behind the gear.
        ratio: f64,
    },
}

/// A fault of torques.
#[derive(Clone, Debug)]
pub struct Fault {
    /// Effect id, or `outside`.
    pub id: &'static str,
    /// Functional form.
    pub form: &'static str,
    /// Joints from 0; empty for the whole arm.
    pub joints: Vec<usize>,
    /// Window within each period \[s\].
    pub window: Option<[f64; 2]>,
    /// Its laws.
    pub acts: Vec<Act>,
    /// Smallest and largest factor on its first size that is plausible.
    pub bounds: [f64; 2],
    /// Effects that cannot be told apart.
    pub equivalents: Vec<&'static str>,
}

/// What a draw needs to know of a case.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    /// The nominal arm.
    pub arm: &'a Arm,
    /// Duration of a period \[s\].
    pub period: f64,
    /// Duration of a log \[s\].
    pub length: f64,
    /// Sampling rate \[Hz\].
    pub rate: f64,
}

/// All torque effects but `link_parameters`, which has its own kind of case.
pub const EFFECTS: [&str; 29] = [
    "payload",
    "rotor_inertia",
    "gravity_spring",
    "base_tilt",
    "encoder_offset",
    "cable",
    "friction_level",
    "torque_offset",
    "stribeck",
    "nonlinear_viscous",
    "viscous_asymmetry",
    "load_friction",
    "gear_efficiency",
    "warm_up",
    "position_friction",
    "presliding",
    "backlash",
    "elasticity",
    "ripple",
    "wrist_coupling",
    "brake_drag",
    "torque_constant",
    "current_saturation",
    "flux_weakening",
    "time_delay",
    "filter_lag",
    "current_sign",
    "contact",
    "apparent_torque",
];

/// Faults for which torques must be the motors' and the model must have rotors.
pub const MOTOR_EFFECTS: [&str; 6] = [
    "rotor_inertia",
    "wrist_coupling",
    "torque_constant",
    "current_saturation",
    "flux_weakening",
    "current_sign",
];

impl Fault {
    /// A fault of a list of laws.
    #[must_use]
    pub fn new(
        id: &'static str,
        form: &'static str,
        joints: &[usize],
        acts: Vec<Act>,
        bounds: [f64; 2],
    ) -> Self {
        Self { id, form, joints: joints.to_vec(), window: None, acts, bounds, equivalents: Vec::new() }
    }

    /// The same with equivalents.
    #[must_use]
    pub fn like(mut self, ids: &[&'static str]) -> Self {
        self.equivalents.extend(ids);
        self
    }

    /// The fault of an effect; none where the arm has no place for it.
    #[must_use]
    pub fn draw(id: &'static str, place: &Place, rng: &mut Rng) -> Option<Self> {
        draw_friction::draw(id, place, rng)
            .or_else(|| draw_drive::draw(id, place, rng))
            .or_else(|| draw_body::draw(id, place, rng))
    }

    /// The fault, `factor` times as large.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let mut fault = self.clone();
        for act in &mut fault.acts {
            match act {
                Act::Body(law) => *law = law.scaled(factor),
                Act::Link(_, law) => law.stiffness *= factor,
                Act::Friction(_, law) => law.sizes = law.sizes.map(|size| size * factor),
                Act::Report(_, law) => {
                    law.size *= factor;
                    law.second *= factor;
                }
                Act::Signal(law) => law.size *= factor,
                Act::Coupling { ratio, .. } => *ratio *= factor,
            }
        }
        fault
    }

    /// Takes the joints out at which the fault alone cannot be seen, unless none would be left.
    pub fn keep(&mut self, seen: impl Fn(&Self) -> bool) {
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
        let visible: Vec<usize> = self.joints.iter().copied().filter(|joint| seen(&alone(*joint))).collect();
        if !visible.is_empty() && visible.len() < self.joints.len() {
            self.acts.retain(|act| at(act).is_some_and(|joint| visible.contains(&joint)));
            self.joints = visible;
        }
    }

    /// Its parameters.
    #[must_use]
    pub fn parameters(&self, period: Option<f64>) -> Vec<TrueParameter> {
        let mut out = Vec::new();
        for act in &self.acts {
            let (joint, list) = match act {
                Act::Body(law) => law.parameters(),
                Act::Link(joint, law) => (Some(*joint), law.parameters()),
                Act::Friction(joint, law) => (Some(*joint), law.parameters()),
                Act::Report(joint, law) => (Some(*joint), law.parameters()),
                Act::Signal(law) => (None, law.parameters()),
                Act::Coupling { ratio, .. } => {
                    (None, vec![("coupling", *ratio, self.id == "wrist_coupling")])
                }
            };
            // What a coupling has beside its ratio belongs to the form.
            let joint = if self.id == "wrist_coupling" { None } else { joint };
            for (name, value, graded) in list {
                if self.id == "wrist_coupling" && name != "coupling" {
                    continue;
                }
                let graded = graded && self.id != "outside";
                out.push(TrueParameter { name: name.to_owned(), joint: joint.map(|i| i + 1), value, graded });
            }
            if self.id == "brake_drag"
                && let Some([from, to]) = self.window
            {
                for (name, value) in [("t_start_s", from), ("t_end_s", to)] {
                    let joint = joint.map(|i| i + 1);
                    out.push(TrueParameter { name: name.to_owned(), joint, value, graded: true });
                }
            }
        }
        if let (Some(period), true) = (period, self.window.is_some() && self.id != "outside") {
            out.push(TrueParameter {
                name: "period_s".to_owned(),
                joint: self.joints.first().map(|i| i + 1),
                value: period,
                graded: false,
            });
        }
        out
    }
}

/// One to three joints of an arm, mostly one.
pub fn some_joints(arm: &Arm, rng: &mut Rng) -> Vec<usize> {
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
