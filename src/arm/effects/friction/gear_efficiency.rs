//! A gear with different losses when it drives and when it is driven.

use crate::arm::robot::LawState;

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, Values, Variable, bounded, every, linear,
};

pub(in crate::arm::effects) const GEAR_EFFICIENCY: Effect = Effect {
    id: "gear_efficiency",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: Some(Variable::LoadSense),
    title: "Efficiency of the gear",
    law: "τ = motoring·|τ_L|·s where τ_L·q̇ > 0, generating·|τ_L|·s elsewhere",
    source: "A. Abedinnasab et al.; harmonic drives lose more when driven back: T. Tuttle, W. Seering, IEEE T-RA 12, 1996",
    parameters: &[
        bounded("motoring", "1", "loss per torque where the motor drives", [0.0, 0.9]),
        bounded("generating", "1", "loss per torque where the load drives", [0.0, 0.9]),
    ],
    coordinates: &[linear(|_| 0.12), linear(|_| 0.12)],
    published: None,
    joints: every,
    brings: &[],
    confused: &["load_friction", "position_friction"],
    inspect: "wear and lubricant of the gear",
    experiment: ["--variant gravity", "lifting and lowering"],
    form: Form::Law { dissipates: true, torque },
};

fn torque(state: &LawState, [motoring, generating, ..]: &Values) -> f64 {
    let loss = if state.gear * state.rate > 0.0 { motoring } else { generating };
    loss * state.gear.abs() * state.sense
}
