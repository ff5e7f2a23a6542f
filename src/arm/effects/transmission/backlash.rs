//! A gear with a gap, which the motor crosses when the load changes its sign.

use super::elasticity::displaced;
use crate::arm::effects::effect::{
    Acts, Channel, Coordinate, Effect, Form, Nature, Role, Scope, Subject, Variable, bounded,
    every, shape, shaped,
};
use crate::arm::effects::motion::Motion;

pub(in crate::arm::effects) const BACKLASH: Effect = Effect {
    id: "backlash",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::AfterReversals,
    variable: Some(Variable::Reversal),
    title: "Backlash",
    law: "width, stiffness 0: τ = −τ_L until the motor has turned by gap after each change of the sign of τ_L; \
          width > 0: q_link = q − gap/2·tanh(τ_L/width); stiffness k > 0: q_link = q − δ, \
          M·δ̈ = τ_L within the gap, M·δ̈ + 0.8·√(k·M)·δ̇ + k·(δ ∓ gap/2) = τ_L at its sides",
    source: "M. Nordin, P.-O. Gutman, Controlling mechanical systems with backlash: a survey, Automatica 38, 2002",
    parameters: &[
        bounded("gap", "rad", "angle of the gap at the joint", [1e-5, 0.1]),
        bounded("width", "Nm", "torque beyond which the link is at a side", [0.0, f64::INFINITY]),
        bounded("stiffness", "Nm/rad", "stiffness of the gear at a side", [0.0, f64::INFINITY]),
    ],
    coordinates: &[
        shape(|_| vec![0.0007, 0.003, 0.012]),
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
    inspect: "the play of the gear, with the brake closed",
    experiment: ["--variant gravity", "reversals with and without load on the gear"],
    form: Form::Series(added),
};

/// Tried widths, as shares of the torque.
const WIDTHS: [f64; 3] = [0.0, 0.03, 0.12];

/// Tried deflections of gears under the torque \[rad\]; 0 for stiff gears.
const DEFLECTIONS: [f64; 4] = [0.0, 1e-4, 5e-4, 2e-3];

fn added(motion: &Motion<'_>, joint: usize, values: &[f64]) -> Vec<(usize, Vec<f64>)> {
    let [gap, width, stiffness] = [values[0], values[1], values[2]];
    if stiffness > 0.0 {
        // Width and stiffness exclude each other.
        return if width > 0.0 {
            Vec::new()
        } else {
            let gear = Gear { gap, stiffness, step: motion.step(), closed: motion.closed };
            at_joint(
                joint,
                displaced(motion, joint, &gear.caught(&motion.gear[joint], motion.inertias(joint))),
            )
        };
    }
    if width > 0.0 {
        let side = |tau: &f64| 0.5 * gap * (tau / width).tanh();
        let behind: Vec<f64> = motion.gear[joint].iter().map(side).collect();
        return at_joint(joint, displaced(motion, joint, &behind));
    }
    crossed(motion, joint, gap)
}

/// What a link does to its own motor; the other motors feel its jumps through all links and gears
/// between, which damp them.
fn at_joint(joint: usize, mut torques: Vec<(usize, Vec<f64>)>) -> Vec<(usize, Vec<f64>)> {
    torques.retain(|(of, _)| *of == joint);
    torques
}

/// The gear transmits no torque while its gap is crossed.
fn crossed(motion: &Motion<'_>, joint: usize, gap: f64) -> Vec<(usize, Vec<f64>)> {
    let step = motion.step();
    let gear = &motion.gear[joint];
    let mut side = gear.first().map_or(1.0, |tau| tau.signum());
    let mut crossed = gap;
    let mut series = vec![0.0; motion.rows()];
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

/// Damping ratio of a gear in contact.
const DAMPING: f64 = 0.4;
/// Largest product of eigenfrequency and integration step; largest number of steps per row: twice the
/// highest frequency of the rows is followed.
const FINEST: f64 = 0.3;
const MOST_STEPS: f64 = 20.0;

/// A gear with a gap and elastic sides.
struct Gear {
    gap: f64,
    stiffness: f64,
    step: f64,
    closed: bool,
}

impl Gear {
    /// Lag of the link behind the motor \[rad\] through gap and elastic sides, from its load \[Nm\]
    /// and its inertia \[kg m²\].
    fn caught(&self, load: &[f64], inertia: &[f64]) -> Vec<f64> {
        let Gear { gap, stiffness, step, closed } = *self;
        let rows = load.len();
        let spring = |x: f64| stiffness * (x - x.clamp(-0.5 * gap, 0.5 * gap));
        let lightest = inertia.iter().copied().fold(f64::INFINITY, f64::min).max(1e-9);
        let steps = ((stiffness / lightest).sqrt() * step / FINEST).ceil().clamp(1.0, MOST_STEPS);
        let h = step / steps;
        let at_rest = |tau: &f64| tau / stiffness + 0.5 * gap * tau.signum();
        let (mut x, mut v) = (load.first().map_or(0.0, at_rest), 0.0);
        let mut behind = vec![0.0; rows];
        // In a periodic motion the second pass has no transient.
        for _ in 0..if closed { 2 } else { 1 } {
            for row in 0..rows {
                behind[row] = x;
                let last = if closed { 0 } else { row };
                let next = if row + 1 < rows { row + 1 } else { last };
                // Inertias too small for the finest step are enlarged.
                let mass = inertia[row].max(stiffness * (h / FINEST).powi(2));
                let damping = 2.0 * DAMPING * (stiffness * mass).sqrt();
                for k in 0..steps as usize {
                    let pull = load[row] + (load[next] - load[row]) * k as f64 / steps;
                    // The link flies freely from side to side.
                    let damper = if x.abs() > 0.5 * gap { damping } else { 0.0 };
                    v = (v + h * (pull - spring(x)) / mass) / (1.0 + h * damper / mass);
                    x += h * v;
                }
            }
        }
        behind
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    const INERTIA: f64 = 5.0;
    const STIFFNESS: f64 = 2e4;
    const LOAD: f64 = 100.0;

    /// Largest lag under a load with `ratio` times the eigenfrequency of the gear.
    fn furthest(gap: f64, ratio: f64) -> f64 {
        let period = TAU / (ratio * (STIFFNESS / INERTIA).sqrt());
        let (count, cycles) = (4000, 8.0);
        let gear = Gear {
            gap,
            stiffness: STIFFNESS,
            step: cycles * period / f64::from(count),
            closed: true,
        };
        let load: Vec<f64> = (0..count)
            .map(|row| LOAD * (cycles * TAU * f64::from(row) / f64::from(count)).sin())
            .collect();
        let behind = gear.caught(&load, &vec![INERTIA; load.len()]);
        behind.iter().fold(0.0, |most: f64, x| most.max(x.abs()))
    }

    /// Without a gap: a damped oscillator. At low frequency a gap adds half of its width.
    #[test]
    fn links_fall_through_the_gap_and_swing() {
        let still = LOAD / STIFFNESS;
        for ratio in [0.05, 0.5, 1.5] {
            let r2: f64 = ratio * ratio;
            let expected = still / ((1.0 - r2).powi(2) + 4.0 * DAMPING.powi(2) * r2).sqrt();
            let found = furthest(0.0, ratio);
            assert!((found / expected - 1.0).abs() < 0.02, "{ratio}: {found} {expected}");
        }
        let gap = 4e-3;
        let more = furthest(gap, 0.01) - still;
        assert!((more / (0.5 * gap) - 1.0).abs() < 0.02, "{more}");
    }
}
