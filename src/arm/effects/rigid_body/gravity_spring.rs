//! A spring or balancer that is missing in the model.

use super::springs::{STIFFNESS_AND_CENTRE, spring};
use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, Variable, free, linear,
};

pub(in crate::arm::effects) const GRAVITY_SPRING: Effect = Effect {
    id: "gravity_spring",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Body,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: Some(Variable::Position),
    title: "Spring or balancer",
    law: "τ = stiffness·(q − centre)",
    source: "A. Klimchik et al., Advanced robot calibration using partial pose measurements and gravity compensators, arXiv 1311.6674",
    parameters: &[
        free("stiffness", "Nm/rad", "stiffness"),
        free("centre", "rad", "angle without torque"),
    ],
    coordinates: &[linear(|of| 0.1 * of.torque[0]), linear(|of| 0.1 * of.torque[0])],
    published: Some(STIFFNESS_AND_CENTRE),
    joints: |dof| (1..dof.min(3)).collect(),
    brings: &["torque_offset"],
    confused: &["cable", "link_parameters"],
    inspect: "pressure of the balancer, or its spring",
    experiment: ["--variant gravity", "the whole range of the joint, slowly"],
    form: Form::Law { dissipates: false, torque: spring },
};
