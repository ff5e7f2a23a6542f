//! A torque constant that falls at high speed.

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, Variable, bounded, every, linear, shape,
};
use crate::arm::effects::motion::Motion;

pub(in crate::arm::effects) const FLUX_WEAKENING: Effect = Effect {
    id: "flux_weakening",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Measurement,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: Some(Variable::LoadSpeed),
    title: "Flux weakening",
    law: "τ = τ·(1 + error·(|q̇| − velocity)/(q̇_max − velocity)) above the velocity, logged; q̇_max: the limit, else of the motion",
    source: "T. Jahns, Flux-weakening regime operation of an interior permanent-magnet synchronous motor drive, IEEE T-IA 23, 1987",
    parameters: &[
        bounded("error", "1", "logged over true torque at the largest speed, less 1", [-0.9, 5.0]),
        bounded("velocity", "rad/s", "speed from which on", [0.0, 100.0]),
    ],
    coordinates: &[
        linear(|_| 0.3),
        shape(|of| [0.5, 0.65, 0.8].map(|share| share * of.rate).to_vec()),
    ],
    published: None,
    joints: every,
    brings: &[],
    confused: &["nonlinear_viscous", "torque_constant"],
    inspect: "supply voltage and top speed of the drive",
    experiment: ["--speed-share 1", "top speed with and without load"],
    form: Form::Series(added),
};

fn added(motion: &Motion<'_>, joint: usize, values: &[f64]) -> Vec<(usize, Vec<f64>)> {
    let [error, from] = [values[0], values[1]];
    let rates = &motion.rates[joint];
    // The speed limit, if known, is the same for every motion.
    let limit = motion.model.limits.velocity.as_ref().map(|of| of[joint]);
    let fastest = limit.unwrap_or_else(|| rates.iter().fold(0.0, |m: f64, x| m.max(x.abs())));
    let fastest = fastest.max(from + 1e-9);
    let share = |rate: &f64| ((rate.abs() - from) / (fastest - from)).max(0.0);
    let series =
        motion.torque[joint].iter().zip(rates).map(|(tau, rate)| error * tau * share(rate));
    vec![(joint, series.collect())]
}
