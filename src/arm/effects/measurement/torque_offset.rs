//! An offset of amplifier or sensor, or Coulomb friction that differs between directions.

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, every, free, linear,
};

pub(in crate::arm::effects) const TORQUE_OFFSET: Effect = Effect {
    id: "torque_offset",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Measurement,
    nature: Nature::Parameter,
    acts: Acts::Always,
    variable: None,
    title: "Offset of the torque",
    law: "τ = offset",
    source: "B. Armstrong-Hélouvry et al., Automatica 30, 1994: asymmetric Coulomb friction is the same while a joint moves",
    parameters: &[free("offset", "Nm", "added to the logged torque")],
    coordinates: &[linear(|of| 0.1 * of.torque[1])],
    published: None,
    joints: every,
    brings: &[],
    confused: &["cable", "gravity_spring", "base_tilt"],
    inspect: "the zero of the current sensor",
    experiment: ["--variant gravity", "each pose from both sides, slowly"],
    form: Form::Model(|model, joint, values| model.sensors.torque_offset[joint] += values[0]),
};
