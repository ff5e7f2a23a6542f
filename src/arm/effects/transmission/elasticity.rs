//! An elastic joint: the link angle lags behind the logged motor angle.

use crate::arm::dynamics::Load;

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Published, Scope, Subject, bounded, every, linear,
};
use crate::arm::effects::motion::Motion;

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

/// Change of the torques if the link is `behind` \[rad\] the motor: rotor torques at the logged
/// angle, rigid-body torques at the link angle.
pub(in crate::arm::effects) fn displaced(
    motion: &Motion<'_>,
    joint: usize,
    behind: &[f64],
) -> Vec<(usize, Vec<f64>)> {
    let rate = motion.changes(behind);
    let acceleration = motion.changes(&rate);
    let mut moved = motion.clone();
    for (series, less) in
        [(&mut moved.q, behind), (&mut moved.qd, &rate[..]), (&mut moved.qdd, &acceleration[..])]
    {
        series[joint].iter_mut().zip(less).for_each(|(x, less)| *x -= less);
    }
    let after = moved.rigid(motion.there(), &Load::none());
    let difference = |(after, before): (Vec<f64>, &Vec<f64>)| {
        after.iter().zip(before).map(|(a, b)| a - b).collect::<Vec<f64>>()
    };
    after.into_iter().zip(motion.bodies()).map(difference).enumerate().collect()
}
