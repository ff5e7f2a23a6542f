//! A gear with a gap, which the motor crosses where the load changes sides.

use super::effect::{Channel, Effect, Form, Of, bounded, every, shape};
use super::motion::Motion;

/// Backlash.
pub(super) const BACKLASH: Effect = Effect {
    id: "backlash",
    channel: Channel::Torque,
    of: Of::Joint,
    title: "Backlash",
    law: "τ = −τ_L until the motor has turned by gap after each change of the sign of τ_L",
    source: "M. Nordin, P.-O. Gutman, Controlling mechanical systems with backlash: a survey, Automatica 38, 2002",
    parameters: &[bounded("gap", "rad", "angle of the gap at the joint", [1e-5, 0.1])],
    coordinates: &[shape(|_| vec![0.001, 0.003, 0.008, 0.02])],
    published: None,
    joints: every,
    brings: &[],
    confused: &["presliding", "stribeck", "time_delay"],
    experiment: ["--variant gravity", "reversals with and without load on the gear"],
    form: Form::Series(added),
};

fn added(motion: &Motion<'_>, joint: usize, values: &[f64]) -> Vec<(usize, Vec<f64>)> {
    let step = motion.step();
    let gear = &motion.gear[joint];
    let mut side = gear.first().map_or(1.0, |tau| tau.signum());
    let mut crossed = values[0];
    let mut series = vec![0.0; motion.len()];
    for _ in 0..if motion.closed { 2 } else { 1 } {
        for (row, to) in series.iter_mut().enumerate() {
            if gear[row] * side < 0.0 {
                side = -side;
                crossed = 0.0;
            }
            *to = if crossed < values[0] { -gear[row] } else { 0.0 };
            crossed += motion.rates[joint][row].abs() * step;
        }
    }
    motion.at_joints(joint, series)
}
