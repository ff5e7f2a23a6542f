//! Selection of one branch: by configuration or by distance.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use nalgebra::Isometry3;

use crate::arm::robot::{Coupling, Model};

use super::closed_form::{Branch, Locked, near};
use super::conf::{Conf, conf_of};
use super::error::IkError;
use super::inverse::branches;
use super::limits::limits_ok;
use super::numeric::refine;

/// Accepted distance of an angle from its quarter turn \[rad\]: targets and configurations are
/// rounded separately, and angles at zero are reported on either side.
const EDGE: f64 = 1e-3;
/// Angle differences below which a numerical solution is the nearest one \[rad\]: a step on a path
/// is far smaller, the distance of other branches larger.
const NEAR: f64 = 0.3;
const TURN: f64 = 2.0 * PI;

/// The solution of the pose with this configuration within the position limits. An angle at the
/// edge of a quarter turn belongs to both neighbours.
///
/// # Errors
/// The pose is out of reach; its solution with this configuration exceeds a position limit; no
/// solution has the configuration.
pub fn ik_conf(model: &Model, pose: &Isometry3<f64>, conf: Conf) -> Result<[f64; 6], IkError> {
    let low1 = f64::from(conf.cf1) * FRAC_PI_2;
    let branches = branches(model, pose, 0.0_f64.clamp(low1, low1 + FRAC_PI_2))?;
    let mut best: Option<(f64, [f64; 6])> = None;
    let mut outside = None;
    for branch in &branches {
        let Some((excess, q)) = with_conf(model, branch, conf) else { continue };
        match limits_ok(model, &q) {
            Ok(()) if best.is_none_or(|(least, _)| excess < least) => best = Some((excess, q)),
            Ok(()) => {}
            Err(violation) => outside = outside.or(Some(violation)),
        }
    }
    match (best, outside) {
        (Some((_, q)), _) => Ok(q),
        (None, Some(violation)) => Err(IkError::OutsideLimits(violation)),
        (None, None) => {
            let found = branches
                .iter()
                .map(|branch| into_limits(model, branch.q))
                .filter(|q| limits_ok(model, q).is_ok())
                .map(|q| conf_of(model, &q))
                .collect();
            Err(IkError::ConfigurationNotFound { asked: conf, found })
        }
    }
}

/// The solution nearest to `q_ref` (least sum of squared differences), including full turns; joint
/// 4 is kept in a wrist singularity, and joint 1 with the wrist centre on its axis. It follows a
/// path without jumps if `q_ref` is the previous solution at a small step.
///
/// # Errors
/// The pose is out of reach; the nearest solution exceeds a position limit.
pub fn ik_near(
    model: &Model,
    pose: &Isometry3<f64>,
    q_ref: &[f64; 6],
) -> Result<[f64; 6], IkError> {
    if model.dof == 6
        && model.kinematics.opw.is_none()
        && let Some(q) = refine(model, pose, q_ref)
        && q.iter().zip(q_ref).all(|(a, b)| (a - b).abs() < NEAR)
    {
        limits_ok(model, &q)?;
        return Ok(q);
    }
    let mut best = (f64::INFINITY, *q_ref);
    let mut take = |branch: Branch| {
        let mut q = branch.q;
        if let Some(locked) = branch.locked {
            q[3] = q_ref[3];
            q[5] = locked.offset - locked.slope * q[3];
        }
        let mut distance = 0.0;
        for (angle, reference) in q.iter_mut().zip(q_ref) {
            *angle += TURN * ((reference - *angle) / TURN).round();
            distance += (*angle - reference).powi(2);
        }
        if distance < best.0 {
            best = (distance, q);
        }
        best.0
    };
    match &model.kinematics.opw {
        Some(opw) if model.dof == 6 => near(model, opw, pose, q_ref, take)?,
        _ => {
            for branch in branches(model, pose, q_ref[0])? {
                take(branch);
            }
        }
    }
    limits_ok(model, &best.1)?;
    Ok(best.1)
}

/// The branch rotated by full turns into the configuration, and its distance from it.
fn with_conf(model: &Model, branch: &Branch, conf: Conf) -> Option<(f64, [f64; 6])> {
    let mut excess = 0.0;
    if model.kinematics.coupling == Coupling::None {
        excess += border_distance(conf.cfx & 4 != 0, branch.back, f64::INFINITY)?;
        excess +=
            border_distance(conf.cfx & 2 != 0, branch.elbow.sin() < 0.0, branch.elbow.sin().abs())?;
        excess += border_distance(conf.cfx & 1 != 0, branch.q[4] < 0.0, branch.q[4].abs())?;
    }
    let mut q = into_limits(model, branch.q);
    if let Some(locked) = branch.locked {
        q[3] = locked_fourth(&locked, conf);
        q[5] = locked.offset - locked.slope * q[3];
    }
    for (joint, quarter) in [(0, conf.cf1), (3, conf.cf4), (5, conf.cf6)] {
        let centre = f64::from(quarter) * FRAC_PI_2 + FRAC_PI_4;
        q[joint] += TURN * ((centre - q[joint]) / TURN).round();
        let miss = ((q[joint] - centre).abs() - FRAC_PI_4).max(0.0);
        if miss > EDGE {
            return None;
        }
        excess += miss;
    }
    Some((excess, q))
}

/// In a wrist singularity any q4 solves the pose: the smallest one in its quarter turn with q6 in
/// its own quarter turn, if possible.
fn locked_fourth(locked: &Locked, conf: Conf) -> f64 {
    let [low, low6] = [conf.cf4, conf.cf6].map(|quarter| f64::from(quarter) * FRAC_PI_2);
    let high = low + FRAC_PI_2;
    // The middle of the range of q4 with q6 in its quarter turn, modulo full turns.
    let middle = (locked.offset - low6 - FRAC_PI_4) / locked.slope;
    let turns = ((low + FRAC_PI_4 - middle) / TURN).round();
    let middle = middle + TURN * turns;
    let (from, to) = (low.max(middle - FRAC_PI_4), high.min(middle + FRAC_PI_4));
    if from <= to { 0.0_f64.clamp(from, to) } else { 0.0_f64.clamp(low, high) }
}

/// 0 for equal bits, the distance to the border if it is small, otherwise `None`.
fn border_distance(asked: bool, found: bool, to_border: f64) -> Option<f64> {
    if asked == found { Some(0.0) } else { (to_border <= EDGE).then_some(to_border) }
}

/// Each joint shifted by at most one full turn into its range.
fn into_limits(model: &Model, mut q: [f64; 6]) -> [f64; 6] {
    for joint in 0..q.len() {
        let [low, high] = model.limits.position_at(&q, joint);
        let angle = q[joint];
        let inside =
            [angle, angle - TURN, angle + TURN].into_iter().find(|a| (low..=high).contains(a));
        q[joint] = inside.unwrap_or(angle);
    }
    q
}
