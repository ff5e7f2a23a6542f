//! A dress pack that pulls a joint towards a central angle.

use super::springs::{STIFFNESS_AND_CENTRE, spring};
use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, Variable, free, linear,
};

pub(in crate::arm::effects) const CABLE: Effect = Effect {
    id: "cable",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Body,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: Some(Variable::Position),
    title: "Hose or cable",
    law: "τ = stiffness·(q − centre)",
    source: "FloBaRoID simulation of joint springs",
    parameters: &[
        free("stiffness", "Nm/rad", "stiffness"),
        free("centre", "rad", "angle without torque"),
    ],
    coordinates: &[linear(|of| 0.1 * of.torque[0]), linear(|of| 0.1 * of.torque[0])],
    published: Some(STIFFNESS_AND_CENTRE),
    joints: |dof| (0..dof).filter(|joint| !(1..3).contains(joint)).collect(),
    brings: &["torque_offset"],
    confused: &["torque_offset", "base_tilt"],
    inspect: "dress pack and hoses at the joint",
    experiment: ["--variant gravity", "the whole range of the joint, slowly"],
    form: Form::Law { dissipates: false, torque: spring },
};
