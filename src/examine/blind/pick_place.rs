//! A pick-and-place cycle: moves between stops, and waits.

use super::mechanics::Joints;
use super::motion::{Motion, STEP_S, Sample};
use super::random::Random;
use super::workspace::Workspace;
use crate::arm::robot::MAX_DOF;

/// Number of poses in a cycle.
const POSES: usize = 6;
/// Bounds of the share of a cycle in which the robot moves; otherwise it waits.
const SHORTEST_MOVING: f64 = 0.55;
const LONGEST_MOVING: f64 = 0.85;

/// Time profile of a move, normalised to distance 1 and duration 1.
#[derive(Clone, Copy)]
enum Profile {
    /// Trapezoidal speed with the share of time of each ramp.
    Trapezoid(f64),
    Quintic,
    /// Half a cosine wave.
    Cosine,
}

impl Profile {
    /// Position, rate and acceleration at the normalised time `x`.
    fn at(self, x: f64) -> [f64; 3] {
        match self {
            Profile::Quintic => [
                x.powi(3) * (10.0 + x * (6.0 * x - 15.0)),
                30.0 * (x * (1.0 - x)).powi(2),
                60.0 * x * (1.0 - x) * (1.0 - 2.0 * x),
            ],
            Profile::Cosine => {
                let (sin, cos) = (std::f64::consts::PI * x).sin_cos();
                let pi = std::f64::consts::PI;
                [0.5 * (1.0 - cos), 0.5 * pi * sin, 0.5 * pi * pi * cos]
            }
            Profile::Trapezoid(ramp) => {
                let top = 1.0 / (1.0 - ramp);
                let push = top / ramp;
                if x < ramp {
                    [0.5 * push * x * x, push * x, push]
                } else if x > 1.0 - ramp {
                    let left = 1.0 - x;
                    [1.0 - 0.5 * push * left * left, push * left, -push]
                } else {
                    [top * (x - 0.5 * ramp), top, 0.0]
                }
            }
        }
    }

    /// Largest rate and acceleration of the normalised move.
    fn peaks(self) -> [f64; 2] {
        match self {
            Profile::Quintic => [1.875, 5.7736],
            Profile::Cosine => [std::f64::consts::FRAC_PI_2, 4.9349],
            Profile::Trapezoid(ramp) => [1.0 / (1.0 - ramp), 1.0 / (ramp * (1.0 - ramp))],
        }
    }
}

/// A cycle of `period_s` within the workspace.
pub(super) fn pick_place(workspace: &Workspace, period_s: f64, random: &mut Random) -> Motion {
    let mut poses: Vec<Joints> = (0..POSES).map(|_| pose(workspace, random)).collect();
    let profiles: Vec<Profile> = (0..POSES)
        .map(|_| match random.below(3) {
            0 => Profile::Trapezoid(random.between(0.25, 0.4)),
            1 => Profile::Quintic,
            _ => Profile::Cosine,
        })
        .collect();
    let moving_s = period_s * random.between(SHORTEST_MOVING, LONGEST_MOVING);
    let shares: Vec<f64> = (0..POSES).map(|_| random.between(0.2, 1.0)).collect();
    let waits_s = period_s - moving_s;
    let sum: f64 = shares.iter().sum();
    let needed = |poses: &[Joints]| -> Vec<f64> {
        let pairs = (0..POSES).map(|i| (&poses[i], &poses[(i + 1) % POSES], profiles[i]));
        pairs.map(|(from, to, profile)| shortest(workspace, from, to, profile)).collect()
    };
    // Poses are contracted until the moves fit into the available time.
    let total: f64 = needed(&poses).iter().sum();
    let factor = (moving_s / total.max(1e-9)).min(1.0).powi(2);
    let centre = poses[0];
    for pose in &mut poses {
        for (angle, middle) in pose.iter_mut().zip(&centre) {
            *angle = middle + factor * (*angle - middle);
        }
    }
    let durations = needed(&poses);
    let total: f64 = durations.iter().sum();
    let mut moves = Vec::new();
    let mut start = 0.0;
    for i in 0..POSES {
        let lasts = durations[i] * moving_s / total.max(1e-9);
        moves.push((start, lasts, i));
        start += lasts + waits_s * shares[i] / sum;
    }
    let count = (period_s / STEP_S).round() as usize;
    let samples = (0..count)
        .map(|k| {
            let t = k as f64 * STEP_S;
            let running = moves.iter().rev().find(|(start, ..)| t >= *start);
            let (start, lasts, i) = running.copied().unwrap_or((0.0, 1.0, 0));
            let (from, to) = (&poses[i], &poses[(i + 1) % POSES]);
            let x = (t - start) / lasts;
            let [s, sd, sdd] = if x < 1.0 { profiles[i].at(x) } else { [1.0, 0.0, 0.0] };
            let mut sample = Sample { q: [0.0; MAX_DOF], qd: [0.0; MAX_DOF], qdd: [0.0; MAX_DOF] };
            for joint in 0..workspace.dof {
                let way = to[joint] - from[joint];
                sample.q[joint] = from[joint] + way * s;
                sample.qd[joint] = way * sd / lasts;
                sample.qdd[joint] = way * sdd / (lasts * lasts);
            }
            sample
        })
        .collect();
    Motion { samples }
}

fn pose(workspace: &Workspace, random: &mut Random) -> Joints {
    let mut q = [0.0; MAX_DOF];
    for (joint, [from, to]) in workspace.range.iter().enumerate().take(workspace.dof) {
        q[joint] = random.between(*from, *to);
    }
    q
}

/// Least duration of a move within the limits \[s\].
fn shortest(workspace: &Workspace, from: &Joints, to: &Joints, profile: Profile) -> f64 {
    let [rate, push] = profile.peaks();
    (0..workspace.dof)
        .map(|joint| {
            let way = (to[joint] - from[joint]).abs();
            let by_rate = rate * way / workspace.velocity[joint];
            by_rate.max((push * way / workspace.acceleration[joint]).sqrt())
        })
        .fold(0.05, f64::max)
}
