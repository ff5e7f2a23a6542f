//! Lubricant friction that is not proportional to speed.

use crate::arm::robot::LawState;

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, Values, Variable, bounded, every, free,
    linear, shape,
};

pub(in crate::arm::effects) const NONLINEAR_VISCOUS: Effect = Effect {
    id: "nonlinear_viscous",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: Some(Variable::Speed),
    title: "Nonlinear viscous friction",
    law: "τ = coefficient·|q̇|^exponent·s",
    source: "A. Waiboer, R. Aarts, B. Jonker, Velocity dependence of joint friction in robotic manipulators with gear transmissions, 2005",
    parameters: &[
        free("coefficient", "Nm (s/rad)^exponent", "friction at 1 rad/s"),
        bounded("exponent", "1", "power of the speed", [0.1, 4.0]),
    ],
    coordinates: &[
        linear(|of| 0.5 * of.coulomb.max(of.viscous * of.rate) / of.rate.max(0.1)),
        shape(|_| vec![0.3, 0.5, 0.7, 1.5, 2.0, 3.0]),
    ],
    published: None,
    joints: every,
    brings: &["friction_level"],
    confused: &["stribeck", "viscous_asymmetry", "flux_weakening"],
    inspect: "type, age and temperature of the lubricant",
    experiment: ["--variant friction", "six speeds both ways"],
    form: Form::Law { dissipates: true, torque },
};

fn torque(state: &LawState, [coefficient, exponent, ..]: &Values) -> f64 {
    coefficient * state.rate.abs().powf(*exponent) * state.sense
}
