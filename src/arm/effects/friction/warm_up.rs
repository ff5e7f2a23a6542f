//! Friction of a cold robot.

use crate::arm::robot::LawState;

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, Values, Variable, bounded, every, free,
    linear, shape,
};

pub(in crate::arm::effects) const WARM_UP: Effect = Effect {
    id: "warm_up",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::OverTime,
    variable: Some(Variable::TimeSense),
    title: "Warming up",
    law: "τ = (coulomb·s + viscous·q̇)·exp(−t/time_constant)",
    source: "A. Bittencourt, E. Wernholt, S. Sander-Tavallaey, T. Brogårdh, An extended friction model to capture load and temperature effects in robot joints, IROS 2010",
    parameters: &[
        free("coulomb", "Nm", "Coulomb friction more at the start"),
        bounded("viscous", "Nm s/rad", "viscous friction more at the start", [0.0, f64::INFINITY]),
        bounded("time_constant", "s", "time in which 1/e of it is left", [30.0, 36000.0]),
    ],
    coordinates: &[
        linear(|of| 0.3 * of.coulomb),
        linear(|of| 0.4 * of.viscous),
        shape(|_| vec![60.0, 200.0, 700.0]),
    ],
    published: None,
    joints: every,
    brings: &[],
    confused: &["friction_level"],
    inspect: "the temperature of the gear before a run",
    experiment: ["--variant warming", "from cold to warm"],
    form: Form::Law { dissipates: true, torque },
};

fn torque(state: &LawState, [coulomb, viscous, time_constant, ..]: &Values) -> f64 {
    if *time_constant <= 0.0 {
        return 0.0;
    }
    (coulomb * state.sense + viscous * state.rate) * (-state.t / time_constant).exp()
}
