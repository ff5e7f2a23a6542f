//! An elastic joint: the link angle lags behind the logged motor angle.

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Published, Scope, Subject, bounded, every, linear,
};
use crate::arm::effects::motion::{Motion, Slopes};

pub(in crate::arm::effects) const ELASTICITY: Effect = Effect {
    id: "elasticity",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: None,
    title: "Elasticity of a joint",
    law: "q_link = q − τ_L/stiffness",
    source: "M. Spong, Modeling and control of elastic joint robots, ASME JDSMC 109, 1987",
    parameters: &[bounded("stiffness", "Nm/rad", "stiffness of the gear", [1.0, f64::INFINITY])],
    coordinates: &[linear(|of| 2e-3 / of.torque[0].max(1e-9))],
    published: Some(STIFFNESS),
    joints: every,
    brings: &[],
    confused: &["rotor_inertia", "filter_lag", "encoder_offset"],
    inspect: "gear, bearings and couplings that are loose",
    experiment: ["--harmonics 1,4,7,11", "short, hard moves"],
    form: Form::Series(added),
};

/// The coordinate is the compliance.
const STIFFNESS: Published = Published {
    parameters: |x| x.iter().map(|compliance| 1.0 / compliance).collect(),
    coordinates: |x| x.iter().map(|stiffness| 1.0 / stiffness).collect(),
};

fn added(motion: &Motion<'_>, joint: usize, values: &[f64]) -> Vec<(usize, Vec<f64>)> {
    let behind: Vec<f64> = motion.gear[joint].iter().map(|tau| values[0] * tau).collect();
    displaced(motion, joint, &behind)
}

/// Change of the torques if the link is `behind` \[rad\] the motor, to first order: rotor torques at
/// the logged angle, rigid-body torques at the link angle.
pub(in crate::arm::effects) fn displaced(
    motion: &Motion<'_>,
    joint: usize,
    behind: &[f64],
) -> Vec<(usize, Vec<f64>)> {
    let rate = motion.changes(behind);
    let acceleration = motion.changes(&rate);
    let change = |slopes: &Slopes, row: usize| {
        let [position, speed, inertia] = slopes[row];
        -(position * behind[row] + speed * rate[row] + inertia * acceleration[row])
    };
    let series = |slopes: &Slopes| (0..motion.rows()).map(|row| change(slopes, row)).collect();
    motion.slopes(joint).iter().map(series).enumerate().collect()
}
