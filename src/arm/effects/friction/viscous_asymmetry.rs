//! Viscous friction that differs between directions.

use crate::arm::robot::LawState;

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, Values, Variable, every, free, linear,
};

pub(in crate::arm::effects) const VISCOUS_ASYMMETRY: Effect = Effect {
    id: "viscous_asymmetry",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: Some(Variable::Speed),
    title: "Asymmetry of viscous friction",
    law: "τ = asymmetry·|q̇|",
    source: "J. Hollerbach, W. Khalil, M. Gautier, Model identification, Springer Handbook of Robotics, 2016",
    parameters: &[free("asymmetry", "Nm s/rad", "half of what it is more forwards than backwards")],
    coordinates: &[linear(|of| 0.2 * of.viscous)],
    published: None,
    joints: every,
    brings: &[],
    confused: &["nonlinear_viscous", "torque_offset"],
    inspect: "teeth and seals that are worn in one direction",
    experiment: ["--variant friction", "six speeds both ways"],
    form: Form::Law { dissipates: true, torque },
};

fn torque(state: &LawState, [asymmetry, ..]: &Values) -> f64 {
    asymmetry * state.rate * state.sense
}
