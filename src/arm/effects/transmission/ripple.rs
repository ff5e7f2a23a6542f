//! Periodic torque of the gear: teeth, wave generators, kinematic errors.

use crate::arm::robot::LawState;

use crate::arm::effects::effect::{
    Acts, Channel, Coordinate, Effect, Form, Nature, Role, Scope, Subject, Values, bounded, every,
    free, linear, shaped,
};
use crate::arm::effects::scale::Scale;
use crate::arm::effects::waves::AMPLITUDE_AND_PHASE;

pub(in crate::arm::effects) const RIPPLE: Effect = Effect {
    id: "ripple",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: None,
    title: "Ripple",
    law: "τ = amplitude·cos(order·q − phase)",
    source: "C. Kennedy, J. Desai, Modeling and control of the Mitsubishi PA-10 robot arm harmonic drive system, IEEE T-Mech 10, 2005",
    parameters: &[
        bounded("amplitude", "Nm", "amplitude", [0.0, f64::INFINITY]),
        free("phase", "rad", "phase at the angle 0"),
        bounded("order", "1", "waves per turn of the joint", ORDERS),
    ],
    coordinates: &[
        linear(|of| 0.1 * of.coulomb),
        linear(|of| 0.1 * of.coulomb),
        Coordinate { role: Role::Waves { least: ORDERS[0], most: sampled }, usual: shaped },
    ],
    published: Some(AMPLITUDE_AND_PHASE),
    joints: every,
    brings: &[],
    confused: &["torque_offset", "position_friction"],
    inspect: "teeth of the gear, and the mounting of the encoder",
    experiment: ["--speed-share 0.1", "slowly, so that the waves are sampled"],
    form: Form::Law { dissipates: false, torque },
};

/// Orders of gears and motors.
const ORDERS: [f64; 2] = [5.0, 5000.0];

/// The highest order that the sampling resolves.
fn sampled(of: &Scale) -> f64 {
    (std::f64::consts::PI / (of.rate * of.step).max(1e-9)).min(ORDERS[1])
}

fn torque(state: &LawState, [cosine, sine, order, ..]: &Values) -> f64 {
    let (s, c) = (order * state.q).sin_cos();
    cosine * c + sine * s
}
