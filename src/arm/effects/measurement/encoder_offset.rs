//! An angle that differs from the log: calibration error, slipped revolution counter.

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, bounded, every, linear,
};

pub(in crate::arm::effects) const ENCODER_OFFSET: Effect = Effect {
    id: "encoder_offset",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Measurement,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: None,
    title: "Offset of an angle",
    law: "τ = τ(q + offset)",
    source: "FACTS of calibration: fine calibration is within 0.5 mrad, one motor turn is 2π/n",
    parameters: &[bounded("offset", "rad", "true less logged angle", [-0.5, 0.5])],
    coordinates: &[linear(|of| (2.0 / of.ratio).clamp(5e-3, 0.05))],
    published: None,
    joints: every,
    brings: &[],
    confused: &["link_parameters", "base_tilt"],
    inspect: "revolution counter and calibration of the axis",
    experiment: ["--variant gravity", "poses on both sides of the vertical"],
    form: Form::Model(|model, joint, values| model.sensors.position_offset[joint] += values[0]),
};
