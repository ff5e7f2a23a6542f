//! A current with inverted sign.

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, bounded, every,
};
use crate::arm::effects::motion::Motion;

pub(in crate::arm::effects) const CURRENT_SIGN: Effect = Effect {
    id: "current_sign",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Measurement,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: None,
    title: "Sign of the current",
    law: "τ = −τ, logged",
    source: "docs/identification.md",
    parameters: &[bounded("flipped", "1", "1 where the sign is the other one", [0.0, 1.0])],
    coordinates: &[],
    published: None,
    joints: every,
    brings: &[],
    confused: &[],
    inspect: "the sign of the logged signal",
    experiment: ["--variant gravity", "weights tell the sign"],
    form: Form::Series(added),
};

fn added(motion: &Motion<'_>, joint: usize, _: &[f64]) -> Vec<(usize, Vec<f64>)> {
    vec![(joint, motion.torque[joint].iter().map(|tau| -2.0 * tau).collect())]
}
