//! A pick-and-place cycle: moves between stops, and waits.

use super::mechanics::Joints;
use super::motion::{Motion, STEP_S, Sample};
use super::profile::Profile;
use super::random::Random;
use super::workspace::Workspace;
use crate::arm::robot::MAX_DOF;

/// Number of poses in a cycle.
const POSES: usize = 6;
/// Least duration of a move \[s\].
const LEAST_S: f64 = 0.05;
/// Bounds of the share of a cycle in which the robot moves; otherwise it waits.
const SHORTEST_MOVING: f64 = 0.55;
const LONGEST_MOVING: f64 = 0.85;

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
        pairs
            .map(|(from, to, profile)| {
                profile.least_time(workspace, [1.0; 2], from, to).max(LEAST_S)
            })
            .collect()
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
            let mut sample = Sample::ZERO;
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
