//! Masses, centres and inertias of the links.

use nalgebra::Isometry3;

use crate::arm::robot::Model;

use super::bodies::added;
use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, every, free, linear,
};
use crate::arm::effects::scale::Scale;

pub(in crate::arm::effects) const LINK_PARAMETERS: Effect = Effect {
    id: "link_parameters",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Body,
    nature: Nature::Parameters,
    acts: Acts::Always,
    variable: None,
    title: "Masses, centres and inertias of the links",
    law: "τ = Y(q, q̇, q̈)·Δπ",
    source: "docs/identification.md",
    parameters: &[
        free("mass", "kg", "mass more, by link"),
        free("moment_x", "kg m", "first moment more, frame of the joint"),
        free("moment_y", "kg m", "first moment more"),
        free("moment_z", "kg m", "first moment more"),
        free("inertia_xx", "kg m2", "moment more, about the joint's origin"),
        free("inertia_yy", "kg m2", "the same"),
        free("inertia_zz", "kg m2", "the same"),
        free("inertia_xy", "kg m2", "the same"),
        free("inertia_xz", "kg m2", "the same"),
        free("inertia_yz", "kg m2", "the same"),
    ],
    coordinates: &[
        linear(|of| MASS * of.link.0),
        linear(first_moment),
        linear(first_moment),
        linear(first_moment),
        linear(moment),
        linear(moment),
        linear(moment),
        linear(moment),
        linear(moment),
        linear(moment),
    ],
    published: None,
    joints: every,
    brings: &[],
    confused: &["payload", "gravity_spring"],
    inspect: "what is mounted on the link",
    experiment: ["", "identify the robot"],
    form: Form::Model(change),
};

/// Large deviations: share of a mass, share of moments, displacement of a centre \[m\].
const MASS: f64 = 0.4;
const MOMENT: f64 = 0.8;
const AWAY: f64 = 0.05;

fn first_moment(of: &Scale) -> f64 {
    AWAY * of.link.0
}

fn moment(of: &Scale) -> f64 {
    MOMENT * of.link.1
}

fn change(model: &mut Model, joint: usize, values: &[f64]) {
    if let Some(link) = model.links.get_mut(joint) {
        *link = added(link, &Isometry3::identity(), values);
    }
}
