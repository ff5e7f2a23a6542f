//! A robot that is tilted, or not mounted as stated.

use nalgebra::{UnitQuaternion, Vector3};

use crate::arm::robot::Model;

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, bounded, free, linear,
};
use crate::arm::effects::waves::AMPLITUDE_AND_PHASE;

pub(in crate::arm::effects) const BASE_TILT: Effect = Effect {
    id: "base_tilt",
    channel: Channel::Torque,
    scope: Scope::Robot,
    subject: Subject::Body,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: None,
    title: "Tilt of the base",
    law: "gravity turned by angle about (−sin direction, cos direction, 0)",
    source: "ABB: Gravity Alpha and Beta of the base",
    parameters: &[
        bounded("angle", "rad", "angle from the vertical", [0.0, 3.2]),
        free("direction", "rad", "towards which it leans, from x"),
    ],
    coordinates: &[linear(|_| 0.02), linear(|_| 0.02)],
    published: Some(AMPLITUDE_AND_PHASE),
    joints: |_| vec![0],
    brings: &[],
    confused: &["torque_offset", "encoder_offset"],
    inspect: "the mounting of the base, with a level",
    experiment: ["--variant gravity", "axis 1 swept with the arm out"],
    form: Form::Model(change),
};

/// The base tilts towards (x, y) by the length of this vector \[rad\].
fn change(model: &mut Model, _: usize, values: &[f64]) {
    let lean = UnitQuaternion::from_scaled_axis(Vector3::new(-values[1], values[0], 0.0));
    model.kinematics.base.rotation = lean * model.kinematics.base.rotation;
}
