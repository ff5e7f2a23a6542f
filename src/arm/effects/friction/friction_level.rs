//! Friction that is higher or lower than stated.

use crate::arm::robot::Model;

use crate::arm::effects::effect::{Channel, Effect, Form, Scope, every, free, linear};

pub(in crate::arm::effects) const FRICTION_LEVEL: Effect = Effect {
    id: "friction_level",
    channel: Channel::Torque,
    scope: Scope::Joint,
    title: "Level of friction",
    law: "τ = coulomb·s + viscous·q̇",
    source: "J. Swevers et al., Dynamic model identification for industrial robots, IEEE CSM 27, 2007",
    parameters: &[
        free("coulomb", "Nm", "change of Coulomb friction"),
        free("viscous", "Nm s/rad", "change of viscous friction"),
    ],
    coordinates: &[linear(|of| 0.3 * of.coulomb), linear(|of| 0.3 * of.viscous)],
    published: None,
    joints: every,
    brings: &[],
    confused: &["warm_up", "nonlinear_viscous", "brake_drag"],
    experiment: ["--variant friction", "each joint alone at six speeds both ways"],
    form: Form::Model(change),
};

fn change(model: &mut Model, joint: usize, values: &[f64]) {
    model.friction.coulomb[joint] += values[0];
    model.friction.viscous[joint] += values[1];
}
