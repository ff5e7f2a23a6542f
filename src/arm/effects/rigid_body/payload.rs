//! Load at the flange in addition to the stated one.

use crate::arm::robot::Model;

use super::bodies::{about_centre, about_origin, added};
use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Published, Scope, Subject, free, linear,
};

pub(in crate::arm::effects) const PAYLOAD: Effect = Effect {
    id: "payload",
    channel: Channel::Torque,
    scope: Scope::Robot,
    subject: Subject::Body,
    nature: Nature::Parameter,
    acts: Acts::Always,
    variable: None,
    title: "Payload",
    law: "τ = Y_flange·(mass, mass·com, inertia)",
    source: "C. Atkeson, C. An, J. Hollerbach, Estimation of inertial parameters of manipulator loads and links, IJRR 5, 1986",
    parameters: &[
        free("mass", "kg", "mass more"),
        free("com_x", "m", "its centre, flange frame"),
        free("com_y", "m", "its centre"),
        free("com_z", "m", "its centre"),
        free("inertia_xx", "kg m2", "about its centre"),
        free("inertia_yy", "kg m2", "about its centre"),
        free("inertia_zz", "kg m2", "about its centre"),
        free("inertia_xy", "kg m2", "about its centre"),
        free("inertia_xz", "kg m2", "about its centre"),
        free("inertia_yz", "kg m2", "about its centre"),
    ],
    coordinates: &[
        linear(|of| of.payload),
        linear(|of| 0.1 * of.payload),
        linear(|of| 0.1 * of.payload),
        linear(|of| 0.1 * of.payload),
        linear(|of| 0.02 * of.payload),
        linear(|of| 0.02 * of.payload),
        linear(|of| 0.02 * of.payload),
        linear(|of| 0.02 * of.payload),
        linear(|of| 0.02 * of.payload),
        linear(|of| 0.02 * of.payload),
    ],
    published: Some(MASS_AND_CENTRE),
    joints: |dof| vec![dof - 1],
    brings: &[],
    confused: &["link_parameters", "torque_constant"],
    inspect: "what the flange carries, and its loaddata",
    experiment: ["--variant payload", "with and without it"],
    form: Form::Model(change),
};

/// Coordinates are mass, first moments and moments about the flange, which are additive.
const MASS_AND_CENTRE: Published =
    Published { parameters: about_centre, coordinates: about_origin };

fn change(model: &mut Model, _: usize, values: &[f64]) {
    let flange = model.kinematics.flange;
    if let Some(last) = model.links.last_mut() {
        *last = added(last, &flange, values);
    }
}
