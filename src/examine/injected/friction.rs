//! Friction: effects that follow speed, load, position, time and distance.
//!
//! B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit, Automatica 30, 1994; C. Canudas de Wit,
//! H. Olsson, K. J. Åström, P. Lischinsky, "A new model for control of systems with friction", IEEE
//! T-AC 40, 1995 (`LuGre`); W. D. Iwan, "A distributed-element model for hysteresis", J. Appl. Mech.
//! 33, 1966.
#![expect(clippy::unnecessary_wraps, reason = "the laws of all effects are drawn alike")]

use std::f64::consts::{PI, TAU};

use super::arm::Arm;
use super::law::{Law, at, gate, signs, usual_friction, window};
use super::motion::Joints;
use super::series::driven;
use crate::examine::blind::random::Random;

/// Least and largest changes of friction over its identified value: the least is beyond three
/// standard deviations of a commissioned robot (5 % each).
const LEVELS: [f64; 2] = [0.2, 1.5];
/// Largest amplitude of a friction law over the usual friction of the joint.
const LARGEST: f64 = 1.2;
/// Least amplitude over the usual friction.
const LEAST: f64 = 0.01;
/// Bounds of the loss in a gear over its torque.
const LOSSES: [f64; 2] = [0.01, 0.4];
/// Least and largest distances in which friction builds up \[rad\].
const DISTANCES: [f64; 2] = [1e-3, 0.05];
/// Number of elastic elements of an Iwan model.
const ELEMENTS: usize = 5;
/// Least and largest velocities of a Stribeck curve \[rad/s\].
const SLOW: [f64; 2] = [0.05, 0.8];
/// Largest torque of bent viscous friction over the usual friction: it replaces other friction.
const BENT: f64 = 3.0;
/// Least range of a joint for friction over the position \[rad\].
const RANGE: f64 = 1.0;

/// Amplitudes of a friction law at a joint \[Nm\].
fn amplitudes(arm: &Arm, joint: usize) -> [f64; 2] {
    [LEAST, LARGEST].map(|share| share * usual_friction(arm, joint))
}

/// Coulomb and viscous friction change by different shares; the sign is a hyperbolic tangent.
pub(super) fn friction_level<'a>(
    arm: &'a Arm,
    joint: usize,
    random: &mut Random,
) -> Option<Law<'a>> {
    let friction = &arm.model.friction;
    let more = random.between(0.6, 1.0);
    let (coulomb, viscous) = if random.chance(0.5) { (1.0, more) } else { (more, 1.0) };
    let (coulomb, viscous) = (coulomb * friction.coulomb[joint], viscous * friction.viscous[joint]);
    let signs = signs(arm, joint);
    let law = Law::scaled(["friction_level", "tanh"], arm, joint, LEVELS, |row| {
        coulomb * signs[row] + viscous * arm.motion.qd[row][joint]
    });
    let values =
        move |size| vec![("coulomb", size * coulomb, true), ("viscous", size * viscous, true)];
    Some(law.with(values))
}

/// Friction that falls with speed, after Lorentz or as a hyperbolic secant.
pub(super) fn stribeck<'a>(arm: &'a Arm, joint: usize, random: &mut Random) -> Option<Law<'a>> {
    let (form, name) = random.form(["lorentzian", "sech"]);
    let usual = arm.motion.rms_rate(joint);
    let velocity = (random.log_between(0.06, 0.3) * usual).clamp(SLOW[0], SLOW[1]);
    let signs = signs(arm, joint);
    let law = Law::scaled(["stribeck", name], arm, joint, amplitudes(arm, joint), |row| {
        let x = arm.motion.qd[row][joint] / velocity;
        signs[row] * if form == 0 { 1.0 / (1.0 + x * x) } else { 1.0 / x.cosh() }
    });
    Some(law.with(move |size| vec![("stiction", size, false), ("velocity", velocity, false)]))
}

/// Friction that bends with speed: a lubricant that thins, or a fan.
pub(super) fn nonlinear_viscous<'a>(
    arm: &'a Arm,
    joint: usize,
    random: &mut Random,
) -> Option<Law<'a>> {
    let (form, name) = random.form(["asinh", "quadratic_to_linear"]);
    let fast = arm.motion.rate_quantile(joint, 0.95);
    let bend = fast * if form == 0 { random.between(0.05, 0.2) } else { random.between(0.7, 2.0) };
    let law = |v: f64| match form {
        0 => (v / bend).asinh(),
        _ => v * v.abs() / (bend * (v.abs() + bend)),
    };
    let unit = law(fast);
    let sizes = [LEAST, BENT].map(|share| share * usual_friction(arm, joint));
    let law = Law::scaled(["nonlinear_viscous", name], arm, joint, sizes, |row| {
        law(arm.motion.qd[row][joint]) / unit
    });
    Some(law.with(move |size| vec![("torque_when_fast", size, false), ("bend", bend, false)]))
}

/// More viscous friction in one direction: a smooth absolute value, or a smooth ramp forwards.
pub(super) fn viscous_asymmetry<'a>(
    arm: &'a Arm,
    joint: usize,
    random: &mut Random,
) -> Option<Law<'a>> {
    let (form, name) = random.form(["hyperbola", "softplus"]);
    let fast = arm.motion.rate_quantile(joint, 0.95);
    let width = 0.03 * fast;
    let sign = random.sign();
    let sizes = amplitudes(arm, joint).map(|torque| torque / fast);
    let law = Law::scaled(["viscous_asymmetry", name], arm, joint, sizes, |row| {
        let v = sign * arm.motion.qd[row][joint];
        let forwards = v.max(0.0) + width * (-v.abs() / width).exp().ln_1p();
        if form == 0 { sign * (v.hypot(width) - width) } else { 2.0 * forwards }
    });
    let law = law.with(move |size| vec![("asymmetry", sign * size, false)]);
    Some(law)
}

/// Friction that grows with the torque through the gear, slower than in proportion.
pub(super) fn load_friction<'a>(
    arm: &'a Arm,
    joint: usize,
    random: &mut Random,
) -> Option<Law<'a>> {
    let (form, name) = random.form(["power_0_8", "hyperbola"]);
    let usual = arm.gear_rms(joint);
    let signs = signs(arm, joint);
    let law = Law::scaled(["load_friction", name], arm, joint, LOSSES, |row| {
        let load = arm.gears[row][joint].abs();
        let grows = match form {
            0 => load.powf(0.8) * usual.powf(0.2),
            _ => load.hypot(0.3 * usual) - 0.3 * usual,
        };
        grows * signs[row]
    });
    Some(law.with(|size| vec![("mu", size, false)]).like(&["gear_efficiency"]))
}

/// Losses that differ where the motor or the load drives, with a smooth change between both.
pub(super) fn gear_efficiency<'a>(
    arm: &'a Arm,
    joint: usize,
    random: &mut Random,
) -> Option<Law<'a>> {
    let (less, motor_loses_more) = (random.between(0.1, 0.4), random.chance(0.5));
    let (motoring, generating) = if motor_loses_more { (1.0, less) } else { (less, 1.0) };
    let usual = arm.gear_rms(joint) * arm.motion.rms_rate(joint);
    let width = random.between(0.05, 0.2) * usual;
    let signs = signs(arm, joint);
    let law = Law::scaled(["gear_efficiency", "smooth_change"], arm, joint, LOSSES, |row| {
        let load = arm.gears[row][joint];
        let drives = 0.5 * (1.0 + (load * arm.motion.qd[row][joint] / width).tanh());
        load.abs() * signs[row] * (drives * motoring + (1.0 - drives) * generating)
    });
    let values = move |size| {
        vec![("motoring", size * motoring, false), ("generating", size * generating, false)]
    };
    Some(law.with(values))
}

/// Friction of a cold gear that falls while the robot runs.
pub(super) fn warm_up<'a>(arm: &'a Arm, joint: usize, random: &mut Random) -> Option<Law<'a>> {
    let (form, name) = random.form(["hyperbola", "two_exponentials"]);
    let lasts = (random.between(0.08, 0.25) * arm.motion.duration()).max(1.0);
    let friction = &arm.model.friction;
    let usual = usual_friction(arm, joint);
    let coulomb = usual * random.between(0.3, 1.0);
    let viscous = friction.viscous[joint] * random.between(0.5, 1.0);
    let signs = signs(arm, joint);
    let law = Law::scaled(["warm_up", name], arm, joint, [0.1, 3.0], |row| {
        let x = arm.motion.since_start(row) / lasts;
        let cold = match form {
            0 => 1.0 / (1.0 + x),
            _ => 0.6 * (-x / 0.5).exp() + 0.4 * (-x / 2.0).exp(),
        };
        cold * (coulomb * signs[row] + viscous * arm.motion.qd[row][joint])
    });
    let values = move |size| {
        vec![
            ("coulomb", size * coulomb, false),
            ("viscous", size * viscous, false),
            ("time_constant", lasts, false),
        ]
    };
    Some(law.with(values))
}

/// Friction over the position: a triangle wave per turn, or a worn place.
pub(super) fn position_friction<'a>(
    arm: &'a Arm,
    joint: usize,
    random: &mut Random,
) -> Option<Law<'a>> {
    let (form, name) = random.form(["triangle", "worn_place"]);
    let [low, high] = arm.motion.range(joint);
    if high - low < RANGE {
        return None;
    }
    let centre = low + (high - low) * random.between(0.2, 0.8);
    let width = (high - low) * random.between(0.1, 0.2);
    let signs = signs(arm, joint);
    let sizes = amplitudes(arm, joint);
    let law = Law::scaled(["position_friction", name], arm, joint, sizes, |row| {
        let off = arm.motion.q[row][joint] - centre;
        let over = match form {
            0 => 1.0 - 2.0 * ((off + PI).rem_euclid(TAU) - PI).abs() / PI,
            _ => (-0.5 * (off / width).powi(2)).exp(),
        };
        over * signs[row]
    });
    Some(law.with(move |size| vec![("amplitude", size, false), ("phase", centre, false)]))
}

/// Coulomb friction that builds up over a distance: bristles after `LuGre`, or elements after Iwan.
pub(super) fn presliding<'a>(arm: &'a Arm, joint: usize, random: &mut Random) -> Option<Law<'a>> {
    let (form, name) = random.form(["lugre", "iwan"]);
    let coulomb = arm.model.friction.coulomb[joint];
    if coulomb <= 0.0 {
        return None;
    }
    let rate: Vec<f64> = arm.motion.qd.iter().map(|qd| qd[joint]).collect();
    let damping = random.between(0.005, 0.02);
    let torques = move |distance: f64| {
        let mut bristle = 0.0_f64;
        let mut slips = [0.0_f64; ELEMENTS];
        let found = driven(&arm.motion.t, &rate, 5e-4, |h, rate| {
            let step = rate * h;
            let state = if form == 0 {
                // ż = v − |v| z / distance, and the damping of the bristles.
                let change =
                    (step - step.abs() * bristle / distance) / (1.0 + step.abs() / distance);
                bristle += change;
                let rate = if h > 0.0 { change / h } else { 0.0 };
                (bristle + damping * rate) / distance
            } else {
                let slip = |(k, slip): (usize, &mut f64)| {
                    let reach = distance * (k as f64 + 0.5) / (0.5 * ELEMENTS as f64);
                    *slip = (*slip + step / reach).clamp(-1.0, 1.0);
                    *slip
                };
                slips.iter_mut().enumerate().map(slip).sum::<f64>() / ELEMENTS as f64
            };
            let full = if step == 0.0 { state } else { step.signum() };
            [coulomb * (state - full)]
        });
        found.into_iter().map(|[torque]| at(joint, torque)).collect::<Vec<Joints>>()
    };
    let law = Law::new("presliding", name, &[joint], DISTANCES, torques);
    Some(law.with(|size| vec![("distance", size, false)]))
}

/// A brake that drags for some time.
pub(super) fn brake_drag<'a>(arm: &'a Arm, joint: usize, random: &mut Random) -> Option<Law<'a>> {
    let window = window(arm, [0.3, 0.5], random);
    let signs = signs(arm, joint);
    let sizes = [0.05, 1.5].map(|share| share * usual_friction(arm, joint));
    let law = Law::scaled(["brake_drag", "logistic_edges"], arm, joint, sizes, |row| {
        signs[row] * gate(arm.motion.t[row], window)
    });
    let values = move |size| {
        vec![("drag", size, false), ("t_start_s", window[0], false), ("t_end_s", window[1], false)]
    };
    Some(law.with(values).within(window))
}
