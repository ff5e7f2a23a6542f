//! Plausibility checks of the units of a log.

use crate::arm::dynamics::{Data, Load, rnea};
use crate::arm::robot::Model;
use crate::learn::log::{Channel, Log, derivatives, median_step, quantile, range};

use super::error::IdentifyError;
use super::torque::motor_side;

/// Quantile of the rates that counts as the largest rate.
const FAST: f64 = 0.99;
/// Largest rate of a joint without a known limit \[rad/s\].
const LARGEST: f64 = 15.0;
/// Factor of a joint's range above which a position is not an overshoot.
const FAR: f64 = 2.0;
/// Factor of a joint's rate limit that no rate reaches: robot files have rounded limits.
const FAST_BEYOND: f64 = 8.0;
/// Range \[°\] that a joint exceeds in an exciting motion.
const TINY: f64 = 6.3;
/// Least angle that a moving joint turns, in the unit of its column.
const TURNS: f64 = 0.3;
/// Duration over which rates and positions are compared \[s\].
const WINDOW: f64 = 0.1;
/// Share of the expected change below which a column counts as constant.
const STILL: f64 = 1e-3;
/// Relative tolerance of a factor.
const NEAR: f64 = 1.3;
/// Tolerance factor for motor torques, because the model is only roughly known.
const ROUGHLY: f64 = 3.0;
/// Ratio of measured to modelled weight beyond which the torques are not the model's.
const STRANGE: f64 = 10.0;
/// Least squared correlation of related columns.
const RELATED: f64 = 0.25;
/// Largest interval of rows that resolves rates \[s\].
const SLOWEST: f64 = 0.5;
/// Largest overshoot beyond a position limit \[rad\].
const OVERSHOT: f64 = 0.1;
/// Factor of its limit that no torque reaches.
const BEYOND: f64 = 10.0;
/// Largest number of rows that are evaluated.
const ROWS: usize = 4000;
/// Degrees in one radian.
const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// Checks that angles and rates are in radians.
///
/// # Errors
/// A column seems to be in degrees, or rates differ from those of the positions.
pub fn check_angles(model: &Model, log: &Log) -> Result<(), IdentifyError> {
    let t = log.time();
    let window = ROWS.min(t.len());
    let differentiated = log.of_joints(Channel::Velocity).is_none()
        || log.of_joints(Channel::Acceleration).is_none();
    let step = median_step(t);
    if differentiated && step > SLOWEST {
        return Err(IdentifyError::Slow(step));
    }
    if let Some(reach) = radians_in_degrees(model, log) {
        return Err(IdentifyError::Radians(reach));
    }
    for joint in 0..log.joints() {
        let Some(q) = log.column(Channel::Position(joint)) else { continue };
        let pairs = q.windows(2).zip(t.windows(2));
        let rates = pairs.map(|(q, t)| ((q[1] - q[0]) / (t[1] - t[0])).abs());
        let fast = quantile(rates, FAST);
        let limit = model.limits.velocity.as_ref().map_or(LARGEST, |limits| limits[joint]);
        let reach = q.iter().fold(0.0, |m: f64, q| m.max(q.abs()));
        let [low, high] = model.limits.position[joint];
        let furthest = low.abs().max(high.abs());
        let beyond = |scale: f64| {
            reach * scale > FAR * furthest.max(1.0) || fast * scale > FAST_BEYOND * limit
        };
        if beyond(1.0) && !beyond(1.0 / DEGREES) {
            return Err(IdentifyError::Degrees { joint: joint + 1, reach, fast });
        }
        let qd = log.column(Channel::Velocity(joint));
        let wrong = |of: &[f64], rates: &[f64]| {
            factor(&t[..window], &of[..window], rates)
                .filter(|factor| !(1.0 / NEAR..NEAR).contains(factor))
        };
        if let Some(qd) = qd.filter(|_| range(q) > TURNS)
            && let Some(share) = unrelated(t, q, qd)
        {
            return Err(IdentifyError::Unrelated { joint: joint + 1, share });
        }
        if let Some(factor) = qd.and_then(|qd| wrong(q, qd)) {
            return Err(IdentifyError::Rates { joint: joint + 1, factor });
        }
        let qdd = log.column(Channel::Acceleration(joint));
        if let Some(factor) = qd.zip(qdd).and_then(|(qd, qdd)| wrong(qd, qdd)) {
            return Err(IdentifyError::Accelerations { joint: joint + 1, factor });
        }
        if qdd.is_some_and(|qdd| range(q) > TURNS && range(qdd) == 0.0) {
            return Err(IdentifyError::Accelerations { joint: joint + 1, factor: 0.0 });
        }
    }
    Ok(())
}

/// Travel of the joint that moves most \[rad\], if all angles are declared in degrees and seem to
/// be in radians.
fn radians_in_degrees(model: &Model, log: &Log) -> Option<f64> {
    let mut most = 0.0_f64;
    for joint in 0..log.joints() {
        let channel = Channel::Position(joint);
        let q = log.column(channel).filter(|_| log.degrees.contains(&channel))?;
        let of = |pick: fn(f64, f64) -> f64| q.iter().copied().reduce(pick).unwrap_or(0.0);
        let ends = [of(f64::min), of(f64::max)].map(|q| q * DEGREES);
        let [low, high] = model.limits.position[joint];
        if ends[1] - ends[0] > TINY
            || ends[0] < FAR * low.min(-1.0)
            || ends[1] > FAR * high.max(1.0)
        {
            return None;
        }
        most = most.max(ends[1] - ends[0]);
    }
    (most > TURNS).then_some(most)
}

/// Squared correlation of a joint's logged rates with its motion, if it is low; over pieces that
/// are long compared with encoder steps.
fn unrelated(t: &[f64], q: &[f64], qd: &[f64]) -> Option<f64> {
    let (mut both, mut own, mut theirs) = (0.0, 0.0, 0.0);
    let mut from = 0;
    for to in 1..t.len() {
        if t[to] - t[from] < WINDOW {
            continue;
        }
        let pieces = (from..to).map(|k| 0.5 * (qd[k] + qd[k + 1]) * (t[k + 1] - t[k]));
        let (turned, said) = (q[to] - q[from], pieces.sum::<f64>());
        both += turned * said;
        own += turned * turned;
        theirs += said * said;
        from = to;
    }
    let share = if theirs > STILL * STILL * own { both * both / (own * theirs) } else { 0.0 };
    (own > 0.0 && share < RELATED).then_some(share)
}

/// Joints, from 0, far beyond the robot's range, with their largest angle \[rad\].
#[must_use]
pub fn beyond_range(model: &Model, log: &Log) -> Vec<(usize, f64)> {
    let furthest = |joint: usize| {
        let q = log.column(Channel::Position(joint))?;
        let [low, high] = model.limits.position[joint];
        let over = q.iter().map(|q| (q - high).max(low - q)).enumerate();
        let (row, over) = over.max_by(|a, b| a.1.total_cmp(&b.1))?;
        (over > OVERSHOT).then_some((joint, q[row]))
    };
    (0..log.joints()).filter_map(furthest).collect()
}

/// Logged rates over those of `x`; `None` if they are hardly correlated.
fn factor(t: &[f64], x: &[f64], logged: &[f64]) -> Option<f64> {
    let (mut both, mut own, mut theirs) = (0.0, 0.0, 0.0);
    for (found, logged) in derivatives(t, x).iter().zip(logged) {
        if let Some([rate, _]) = found {
            both += rate * logged;
            own += rate * rate;
            theirs += logged * logged;
        }
    }
    let related = own > 0.0 && both * both > RELATED * own * theirs;
    related.then(|| both / own)
}

/// Checks that the torques are joint torques, with the limits, the dynamics and the motors of the
/// model.
///
/// # Errors
/// They are constant, far above the limits, or smaller by the gear ratios.
pub fn check_torques(model: &Model, log: &Log, tau: &[Vec<f64>]) -> Result<(), IdentifyError> {
    for (joint, tau) in tau.iter().enumerate() {
        let q = log.column(Channel::Position(joint)).unwrap_or_default();
        let is_one = |x: &[f64]| x.windows(2).all(|pair| pair[0] == pair[1]);
        if is_one(tau) && !is_one(q) {
            return Err(IdentifyError::Dead(joint + 1));
        }
    }
    if let Some(limits) = &model.limits.torque {
        for (joint, (tau, limit)) in tau.iter().zip(limits).enumerate() {
            let reach = quantile(tau.iter().map(|x| x.abs()), 0.5);
            if reach > BEYOND * limit {
                return Err(IdentifyError::Large { joint: joint + 1, reach, limit: *limit });
            }
        }
    }
    let Some(motors) = model.motors.as_ref().filter(|_| model.has_dynamics()) else {
        return Ok(());
    };
    let carried = carried(model, log, tau);
    let on_motor_side = |(joint, factor): &(usize, f64)| {
        let factor = factor * motors.ratio[*joint];
        motors.ratio[*joint] > ROUGHLY * ROUGHLY && factor > 1.0 / ROUGHLY && factor < ROUGHLY
    };
    if let Some(joint) = motor_side(model, log, tau).first() {
        let ratio = motors.ratio[*joint];
        return Err(IdentifyError::OneMotorSide { joint: joint + 1, ratio });
    }
    if !carried.is_empty() && carried.iter().all(on_motor_side) {
        let joint = carried[0].0;
        return Err(IdentifyError::MotorSide { joint: joint + 1, ratio: motors.ratio[joint] });
    }
    Ok(())
}

/// Measured weight over that of the model's masses, if it is far from 1 at all joints that carry
/// weight: the geometric mean, and a joint, from 0.
#[must_use]
pub fn weight_factor(model: &Model, log: &Log, tau: &[Vec<f64>]) -> Option<(f64, usize)> {
    let carried = if model.has_dynamics() { carried(model, log, tau) } else { Vec::new() };
    let (first, _) = carried.first()?;
    let far = |factor: f64| !(1.0 / STRANGE..STRANGE).contains(&factor.abs());
    if !carried.iter().all(|(_, factor)| *factor != 0.0 && far(*factor)) {
        return None;
    }
    let mean = carried.iter().map(|(_, f)| f.abs().ln()).sum::<f64>() / carried.len() as f64;
    far(mean.exp()).then_some((mean.exp(), *first))
}

/// The joints that carry weight, from 0, each with measured over modelled torque.
fn carried(model: &Model, log: &Log, tau: &[Vec<f64>]) -> Vec<(usize, f64)> {
    let q: Vec<&[f64]> = log.of_joints(Channel::Position).unwrap_or_default();
    let every = log.time().len().div_ceil(ROWS).max(1);
    let mut data = Data::new();
    let n = model.dof;
    let (mut both, mut own) = (vec![0.0; n], vec![0.0; n]);
    for row in (0..log.time().len()).step_by(every) {
        let at: Vec<f64> = q.iter().map(|q| q[row]).collect();
        // Gravity alone gives the order of magnitude.
        let expected = rnea(model, &mut data, &Load::none(), &at, &[], &[]);
        for joint in 0..n {
            both[joint] += expected[joint] * tau[joint][row];
            own[joint] += expected[joint] * expected[joint];
        }
    }
    let largest = own.iter().fold(0.0, |m: f64, x| m.max(*x));
    (0..n).filter(|j| own[*j] > 0.01 * largest).map(|j| (j, both[j] / own[j])).collect()
}
