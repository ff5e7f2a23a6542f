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
        bounded("order", "1", "waves per turn of the joint", [2.0, 5000.0]),
    ],
    coordinates: &[
        linear(|of| 0.1 * of.coulomb),
        linear(|of| 0.1 * of.coulomb),
        Coordinate { role: Role::Choice(orders), usual: shaped },
    ],
    published: Some(AMPLITUDE_AND_PHASE),
    joints: every,
    brings: &[],
    confused: &["torque_offset", "position_friction"],
    inspect: "teeth of the gear, and the mounting of the encoder",
    experiment: ["--speed-share 0.1", "slowly, so that the waves are sampled"],
    form: Form::Law { dissipates: false, torque },
};

/// Typical orders per motor turn of gears and motors.
const OF_MOTOR: [f64; 4] = [1.0, 2.0, 4.0, 6.0];

/// Typical orders of gears and motors that the sampling can resolve.
fn orders(of: &Scale) -> Vec<f64> {
    let most = std::f64::consts::PI / (of.rate * of.step).max(1e-9);
    OF_MOTOR.map(|k| k * of.ratio).into_iter().filter(|order| (2.0..most).contains(order)).collect()
}

fn torque(state: &LawState, [cosine, sine, order, ..]: &Values) -> f64 {
    let (s, c) = (order * state.q).sin_cos();
    cosine * c + sine * s
}
