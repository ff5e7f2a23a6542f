//! Friction that is higher or lower than stated.

use crate::arm::robot::Model;

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, every, free, linear,
};

pub(in crate::arm::effects) const FRICTION_LEVEL: Effect = Effect {
    id: "friction_level",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Drive,
    nature: Nature::Parameter,
    acts: Acts::Always,
    variable: None,
    title: "Level of friction",
    law: "τ = coulomb·s + viscous·q̇",
    source: "J. Swevers et al., Dynamic model identification for industrial robots, IEEE CSM 27, 2007",
    parameters: &[
        free("coulomb", "Nm", "change of Coulomb friction")
            .beside(|model, joint| Some(model.friction.coulomb[joint])),
        free("viscous", "Nm s/rad", "change of viscous friction")
            .beside(|model, joint| Some(model.friction.viscous[joint])),
    ],
    coordinates: &[linear(|of| 0.3 * of.coulomb), linear(|of| 0.3 * of.viscous)],
    published: None,
    joints: every,
    brings: &[],
    confused: &["warm_up", "nonlinear_viscous", "brake_drag"],
    inspect: "lubricant, seals and bearings of the gear",
    experiment: ["--variant friction", "each joint alone at six speeds both ways"],
    form: Form::Model(change),
};

fn change(model: &mut Model, joint: usize, values: &[f64]) {
    model.friction.coulomb[joint] += values[0];
    model.friction.viscous[joint] += values[1];
}
