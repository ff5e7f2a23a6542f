//! Friction that falls with speed from its breakaway value.

use crate::arm::robot::LawState;

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, Values, Variable, bounded, every, free,
    linear, shape,
};

pub(in crate::arm::effects) const STRIBECK: Effect = Effect {
    id: "stribeck",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: Some(Variable::Speed),
    title: "Stribeck friction",
    law: "τ = stiction·exp(−(q̇/velocity)²)·s",
    source: "B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit, Automatica 30, 1994",
    parameters: &[
        free(
            "stiction",
            "Nm",
            "friction at breakaway above Coulomb friction; below where negative",
        ),
        bounded("velocity", "rad/s", "speed at which 1/e of it is left", [1e-3, 1.0]),
    ],
    coordinates: &[linear(|of| 0.4 * of.coulomb), shape(|_| vec![0.02, 0.045, 0.1, 0.22, 0.5])],
    published: None,
    joints: every,
    brings: &["friction_level"],
    confused: &["presliding", "nonlinear_viscous", "backlash"],
    inspect: "the lubricant of the gear",
    experiment: ["--variant friction", "constant speeds, slow ones among them"],
    form: Form::Law { dissipates: true, torque },
};

fn torque(state: &LawState, [stiction, velocity, ..]: &Values) -> f64 {
    if *velocity == 0.0 {
        return 0.0;
    }
    stiction * (-(state.rate / velocity).powi(2)).exp() * state.sense
}
