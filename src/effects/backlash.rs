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
        bounded("stiffness", "Nm/rad", "stiffness of the gear at a side", [0.0, f64::INFINITY]),
    ],
    coordinates: &[
        shape(|_| vec![0.0005, 0.001, 0.003, 0.008, 0.02]),
        Coordinate {
            role: Role::Choice(|of| WIDTHS.map(|width| width * of.torque[0]).to_vec()),
            usual: shaped,
        },
        Coordinate {
            role: Role::Choice(|of| {
                DEFLECTIONS.map(|by| if by > 0.0 { of.torque[0] / by } else { 0.0 }).to_vec()
            }),
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

/// Angles by which the torque bends gears that are tried; 0: they are stiff.
const DEFLECTIONS: [f64; 4] = [0.0, 2.5e-4, 8e-4, 2.5e-3];

fn added(motion: &Motion<'_>, joint: usize, values: &[f64]) -> Vec<(usize, Vec<f64>)> {
    let [gap, width, stiffness] = [values[0], values[1], values[2]];
    if stiffness > 0.0 {
        // There is one way to a side.
        return if width > 0.0 {
            Vec::new()
        } else {
            displaced(motion, joint, &caught(motion, joint, gap, stiffness))
        };
    }
    if width > 0.0 {
        let side = |tau: &f64| 0.5 * gap * (tau / width).tanh();
        let behind: Vec<f64> = motion.gear[joint].iter().map(side).collect();
        return displaced(motion, joint, &behind);
    }
    crossed(motion, joint, gap)
}

/// Share of critical damping of a gear at a side.
const DAMPING: f64 = 0.4;
/// Largest product of eigenfrequency and step of the integration, and steps in a row at most.
const FINEST: f64 = 0.3;
const MOST_STEPS: f64 = 400.0;

/// How far the link is behind \[rad\] that falls through the gap and is caught by a gear that gives.
fn caught(motion: &Motion<'_>, joint: usize, gap: f64, stiffness: f64) -> Vec<f64> {
    let inertia = motion.inertias(joint);
    let load = &motion.gear[joint];
    let rows = motion.len();
    let spring = |x: f64| stiffness * (x - x.clamp(-0.5 * gap, 0.5 * gap));
    let lightest = inertia.iter().copied().fold(f64::INFINITY, f64::min).max(1e-9);
    let steps = ((stiffness / lightest).sqrt() * motion.step() / FINEST).ceil().clamp(1.0, MOST_STEPS);
    let h = motion.step() / steps;
    let at_rest = |tau: f64| tau / stiffness + 0.5 * gap * tau.signum();
    let (mut x, mut v) = (load.first().map_or(0.0, |tau| at_rest(*tau)), 0.0);
    let mut behind = vec![0.0; rows];
    for _ in 0..if motion.closed { 2 } else { 1 } {
        for row in 0..rows {
            behind[row] = x;
            let next = if row + 1 < rows { row + 1 } else if motion.closed { 0 } else { row };
            // What would swing faster than the finest step is heavier.
            let mass = inertia[row].max(stiffness * (h / FINEST).powi(2));
            let damper = 2.0 * DAMPING * (stiffness * mass).sqrt();
            for k in 0..steps as usize {
                let pull = load[row] + (load[next] - load[row]) * k as f64 / steps;
                v = (v + h * (pull - spring(x)) / mass) / (1.0 + h * damper / mass);
                x += h * v;
            }
        }
    }
    behind
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
