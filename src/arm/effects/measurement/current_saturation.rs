//! Torque below proportionality to current due to saturation of the iron.

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, Variable, bounded, every, linear, shape,
};
use crate::arm::effects::motion::Motion;

pub(in crate::arm::effects) const CURRENT_SATURATION: Effect = Effect {
    id: "current_saturation",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Measurement,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: Some(Variable::Load),
    title: "Saturation of the motor",
    law: "τ = τ·(1 + error·(|τ|/τ_max)^exponent), logged; τ_max: the limit, else of the motion",
    source: "G. Terzic, M. Jadric, IEEE T-IE 48, 2001",
    parameters: &[
        bounded(
            "error",
            "1",
            "logged over true torque at the largest current, less 1",
            [-0.9, 5.0],
        ),
        bounded("exponent", "1", "power of the torque; 0: as 2", [0.0, 8.0]),
    ],
    coordinates: &[linear(|_| 0.15), shape(|_| vec![1.0, 2.0, 4.0])],
    published: None,
    joints: every,
    brings: &[],
    confused: &["torque_constant", "load_friction"],
    inspect: "motor and amplifier at their largest currents",
    experiment: ["--harmonics 1,4,7,11", "larger torques"],
    form: Form::Series(added),
};

/// The first exponent of a symmetric curve.
const CUBIC: f64 = 2.0;

fn added(motion: &Motion<'_>, joint: usize, values: &[f64]) -> Vec<(usize, Vec<f64>)> {
    let tau = &motion.torque[joint];
    // The torque limit, if known, is the same for every motion.
    let limit = motion.model.limits.torque.as_ref().map(|of| of[joint]);
    let largest = limit.unwrap_or_else(|| tau.iter().fold(0.0, |m: f64, x| m.max(x.abs())));
    let largest = largest.max(1e-9);
    let series = tau.iter().map(|x| x * gain(x / largest, values));
    vec![(joint, series.collect())]
}

/// Gain − 1 at a share of the largest torque, with `values` = error and exponent.
fn gain(share: f64, values: &[f64]) -> f64 {
    let exponent = if values[1] > 0.0 { values[1] } else { CUBIC };
    values[0] * share.abs().powf(exponent)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_an_exponent_the_curve_is_cubic() {
        assert_eq!(gain(-0.5, &[0.2, 0.0]), gain(0.5, &[0.2, 2.0]));
        assert_eq!(gain(-0.5, &[0.2, 1.0]), 0.1);
    }
}
