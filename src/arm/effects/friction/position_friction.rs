//! Friction with one period per turn: an eccentric gear, a bent shaft.

use crate::arm::robot::LawState;

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, Values, Variable, bounded, every, free,
    linear,
};
use crate::arm::effects::waves::AMPLITUDE_AND_PHASE;

pub(in crate::arm::effects) const POSITION_FRICTION: Effect = Effect {
    id: "position_friction",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: Some(Variable::PositionSense),
    title: "Friction over the angle",
    law: "τ = amplitude·cos(q − phase)·s",
    source: "B. Armstrong-Hélouvry, Control of Machines with Friction, 1991: friction over position",
    parameters: &[
        bounded("amplitude", "Nm", "half of the difference", [0.0, f64::INFINITY]),
        free("phase", "rad", "angle of the most friction"),
    ],
    coordinates: &[linear(|of| 0.15 * of.coulomb), linear(|of| 0.15 * of.coulomb)],
    published: Some(AMPLITUDE_AND_PHASE),
    joints: every,
    brings: &[],
    confused: &["load_friction", "gear_efficiency"],
    inspect: "gear and bearings at the angles with more friction",
    experiment: ["--variant payload", "the same angles with another load"],
    form: Form::Law { dissipates: true, torque },
};

fn torque(state: &LawState, [cosine, sine, ..]: &Values) -> f64 {
    (cosine * state.q.cos() + sine * state.q.sin()) * state.sense
}
