//! A gear with a gap, which the motor crosses where the load changes sides.

use super::effect::{Channel, Coordinate, Effect, Form, Of, Role, bounded, every, shape, shaped};
use super::elasticity::displaced;
use super::motion::Motion;

/// Backlash.
pub(super) const BACKLASH: Effect = Effect {
    id: "backlash",
    channel: Channel::Torque,
    of: Of::Joint,
    title: "Backlash",
    law: "width 0: τ = −τ_L until the motor has turned by gap after each change of the sign of τ_L; else q_link = q − gap/2·tanh(τ_L/width)",
    source: "M. Nordin, P.-O. Gutman, Controlling mechanical systems with backlash: a survey, Automatica 38, 2002",
    parameters: &[
        bounded("gap", "rad", "angle of the gap at the joint", [1e-5, 0.1]),
        bounded("width", "Nm", "torque beyond which the link is at a side", [0.0, f64::INFINITY]),
    ],
    coordinates: &[
        shape(|_| vec![0.0005, 0.001, 0.003, 0.008, 0.02]),
        Coordinate {
            role: Role::Choice(|of| WIDTHS.map(|width| width * of.torque[0]).to_vec()),
            usual: shaped,
        },
    ],
    published: None,
    joints: every,
    brings: &[],
    confused: &["presliding", "stribeck", "time_delay"],
    experiment: ["--variant gravity", "reversals with and without load on the gear"],
    form: Form::Series(added),
};

/// Widths that are tried, of the torque.
const WIDTHS: [f64; 4] = [0.0, 0.02, 0.06, 0.2];

fn added(motion: &Motion<'_>, joint: usize, values: &[f64]) -> Vec<(usize, Vec<f64>)> {
    match values[1] {
        0.0 => crossed(motion, joint, values[0]),
        width => {
            let side = |tau: &f64| 0.5 * values[0] * (tau / width).tanh();
            displaced(motion, joint, &motion.gear[joint].iter().map(side).collect::<Vec<f64>>())
        }
    }
}

/// The gear carries nothing while its gap is crossed.
fn crossed(motion: &Motion<'_>, joint: usize, gap: f64) -> Vec<(usize, Vec<f64>)> {
    let step = motion.step();
    let gear = &motion.gear[joint];
    let mut side = gear.first().map_or(1.0, |tau| tau.signum());
    let mut crossed = gap;
    let mut series = vec![0.0; motion.len()];
    for _ in 0..if motion.closed { 2 } else { 1 } {
        for (row, to) in series.iter_mut().enumerate() {
            if gear[row] * side < 0.0 {
                side = -side;
                crossed = 0.0;
            }
            *to = if crossed < gap { -gear[row] } else { 0.0 };
            crossed += motion.rates[joint][row].abs() * step;
        }
    }
    motion.at_joints(joint, series)
}
