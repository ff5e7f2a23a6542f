//! Gears: backlash, elasticity, ripple, rotors, coupled wrist gears.
//!
//! M. Spong, "Modeling and control of elastic joint robots", ASME JDSMC 109, 1987; M. Nordin,
//! P.-O. Gutman, "Controlling mechanical systems with backlash: a survey", Automatica 38, 2002;
//! K. Hunt, F. Crossley, "Coefficient of restitution interpreted as damping in vibroimpact",
//! J. Appl. Mech. 42, 1975.
#![expect(clippy::unnecessary_wraps, reason = "the laws of all effects are drawn alike")]

use std::f64::consts::TAU;

use super::arm::Arm;
use super::law::Law;
use super::motion::Joints;
use super::series::driven;
use crate::arm::dynamics::{Data, Load, crba};
use crate::arm::robot::MAX_DOF;
use crate::examine::blind::random::Random;

/// Least and largest gap at a joint \[rad\].
const GAPS: [f64; 2] = [5e-4, 0.01];
/// Natural frequencies of a soft joint \[Hz\].
const FREQUENCIES_HZ: [f64; 2] = [5.0, 40.0];
/// Largest frequency of a ripple at the usual rate \[Hz\], and over the rate of the rows.
const RIPPLE_HZ: f64 = 8.0;
const SAMPLED: f64 = 0.12;
/// Orders of a ripple, per turn of the joint.
const ORDERS: [f64; 2] = [5.0, 80.0];
/// Least and largest change of a rotor over the identified one: the least is beyond three standard
/// deviations of a commissioned robot (3 % each).
const ROTORS: [f64; 2] = [0.12, 2.0];
/// Joints of the wrist, from 0.
const WRIST: [usize; 2] = [4, 5];

/// Mean inertia of the bodies that a joint turns \[kg m²\].
fn inertia(arm: &Arm, joint: usize) -> f64 {
    let mut bodies = arm.model.clone();
    bodies.motors = None;
    let mut data = Data::new();
    let n = arm.dof();
    // The inertia changes slowly.
    let looks = arm.motion.q.iter().step_by(10);
    let count = looks.len();
    let of = |q: &Joints| crba(&bodies, &mut data, &Load::none(), &q[..n])[(joint, joint)];
    looks.map(of).sum::<f64>() / count as f64
}

/// Change of the torques if a link stays behind its motor by `behind` \[δ, δ̇\] at the rows.
fn behind(arm: &Arm, joint: usize, behind: &[[f64; 2]]) -> Vec<Joints> {
    let motion = &arm.motion;
    let last = motion.rows() - 1;
    arm.moved(|row| {
        let [mut q, mut qd, mut qdd] = [motion.q[row], motion.qd[row], motion.qdd[row]];
        let (before, after) = (row.saturating_sub(1), (row + 1).min(last));
        // As a sensor that averages over two rows shows it.
        let acceleration =
            (behind[after][1] - behind[before][1]) / (motion.t[after] - motion.t[before]);
        q[joint] -= behind[row][0];
        qd[joint] -= behind[row][1];
        qdd[joint] -= acceleration;
        [q, qd, qdd]
    })
}

/// A gap in the gear: the link falls to its other side when the torque changes its sign, onto
/// Hertzian contacts, or with the lag of the grease and some hysteresis.
pub(super) fn backlash<'a>(arm: &'a Arm, joint: usize, random: &mut Random) -> Option<Law<'a>> {
    let (form, name) = random.form(["hertz_contact", "sticky_play"]);
    let load = arm.gear(joint);
    let (usual, inertia) = (arm.gear_rms(joint), inertia(arm, joint));
    let pressed = random.between(0.05, 0.15);
    let lag = random.between(0.01, 0.02);
    let torques = move |gap: f64| {
        let (mut off, mut rate, mut side) = (0.5 * gap * load[0].signum(), 0.0, load[0].signum());
        // Contact: F = stiffness p^1.5 (1 + damping ṗ), pressed by a share of the gap at rms torque.
        let stiffness = usual / (pressed * gap).powf(1.5);
        let damping = (inertia / (usual * gap)).sqrt();
        let frequency = (1.5 * usual / (pressed * gap * inertia)).sqrt();
        let longest = if form == 0 { 0.1 / frequency } else { 0.05 * lag };
        let found = driven(&arm.motion.t, &load, longest, |h, load| {
            let acceleration = if form == 0 {
                let into = off.abs() - 0.5 * gap;
                let force = if into > 0.0 {
                    (stiffness * into.powf(1.5) * (1.0 + damping * rate * off.signum())).max(0.0)
                } else {
                    0.0
                };
                (load - force * off.signum()) / inertia
            } else {
                if load * side < -0.1 * usual {
                    side = -side;
                }
                (0.5 * gap * side - off) / (lag * lag) - 2.0 * rate / lag
            };
            rate += h * acceleration;
            off += h * rate;
            [off, rate]
        });
        behind(arm, joint, &found)
    };
    let law = Law::new("backlash", name, &[joint], GAPS, torques);
    Some(law.with(|size| vec![("gap", size, false)]))
}

/// A soft joint: its link swings with the natural frequency of its inertia and the gear.
pub(super) fn elasticity<'a>(arm: &'a Arm, joint: usize, random: &mut Random) -> Option<Law<'a>> {
    let load = arm.gear(joint);
    let inertia = inertia(arm, joint);
    let damping = random.between(0.1, 0.3);
    let compliance = move |hertz: f64| 1.0 / (inertia * (TAU * hertz).powi(2));
    let torques = move |compliance: f64| {
        let frequency = (1.0 / (inertia * compliance)).sqrt();
        let (mut off, mut rate) = (load[0] * compliance, 0.0);
        let found = driven(&arm.motion.t, &load, 0.02 / frequency, |h, load| {
            let towards = frequency * frequency * (load * compliance - off);
            rate += h * (towards - 2.0 * damping * frequency * rate);
            off += h * rate;
            [off, rate]
        });
        behind(arm, joint, &found)
    };
    let sizes = [compliance(FREQUENCIES_HZ[1]), compliance(FREQUENCIES_HZ[0])];
    let law = Law::new("elasticity", "swinging_link", &[joint], sizes, torques);
    Some(law.with(|size| vec![("stiffness", 1.0 / size, false)]))
}

/// Teeth: a sawtooth, or a wave with its second harmonic.
pub(super) fn ripple<'a>(arm: &'a Arm, joint: usize, random: &mut Random) -> Option<Law<'a>> {
    let (form, name) = random.form(["sawtooth", "two_harmonics"]);
    let sampled = SAMPLED * (arm.motion.rows() - 1) as f64 / arm.motion.duration();
    let highest = TAU * RIPPLE_HZ.min(sampled) / arm.motion.rms_rate(joint);
    if highest <= ORDERS[0] {
        return None;
    }
    let order = random.log_between(ORDERS[0], highest.min(ORDERS[1])).round();
    let (phase, second) = (random.between(0.0, TAU), random.between(0.3, 0.6));
    let sizes = [0.01, 0.3].map(|share| share * arm.rms[joint]);
    let law = Law::scaled(["ripple", name], arm, joint, sizes, |row| {
        let angle = order * arm.motion.q[row][joint] + phase;
        match form {
            0 => 2.0 * (angle / TAU).rem_euclid(1.0) - 1.0,
            _ => angle.cos() + second * (2.0 * angle).sin(),
        }
    });
    Some(law.with(move |size| vec![("amplitude", size, false), ("order", order, true)]))
}

/// A heavier or lighter rotor; in one form its acceleration comes late through a soft clutch.
pub(super) fn rotor_inertia<'a>(
    arm: &'a Arm,
    joint: usize,
    random: &mut Random,
) -> Option<Law<'a>> {
    let (form, name) = random.form(["rigid", "soft_clutch"]);
    let rotor = arm.rotor(joint);
    if rotor <= 0.0 {
        return None;
    }
    let (sign, lag) = (random.sign(), 0.004);
    let acceleration: Vec<f64> = arm.motion.qdd.iter().map(|qdd| qdd[joint]).collect();
    let mut state = acceleration[0];
    let late = driven(&arm.motion.t, &acceleration, 0.1 * lag, |h, input| {
        state += h * (input - state) / lag;
        [state]
    });
    // A rotor stays positive.
    let most = if sign < 0.0 { 0.8 } else { ROTORS[1] };
    let sizes = [ROTORS[0] * rotor, most * rotor];
    let law = Law::scaled(["rotor_inertia", name], arm, joint, sizes, |row| {
        sign * if form == 0 { acceleration[row] } else { late[row][0] }
    });
    let law = law.with(move |size| vec![("inertia", sign * size, form == 0)]);
    // The rotors of axes 1 and 2 are parts of their links in the torques.
    Some(if joint < 2 { law.like(&["link_parameters"]) } else { law })
}

/// Motor 6 turns with axis 5: a part of the friction and the rotor of axis 6 is before the gear
/// that couples them. The sign of the friction is algebraic.
pub(super) fn wrist_coupling<'a>(arm: &'a Arm, _: usize, random: &mut Random) -> Option<Law<'a>> {
    let [fifth, sixth] = WRIST;
    if arm.dof() != 6 || arm.model.wrist.coupling != 0.0 {
        return None;
    }
    let coupling = random.sign() * random.between(0.5, 1.0);
    let friction = &arm.model.friction;
    let width = 0.02 * arm.motion.rms_rate(sixth);
    let (coulomb, viscous) = (friction.coulomb[sixth], friction.viscous[sixth]);
    let rotor = arm.rotor(sixth);
    let motor = move |rate: f64, acceleration: f64| {
        coulomb * rate / rate.hypot(width) + viscous * rate + rotor * acceleration
    };
    let torques = move |size: f64| {
        let at_row = |(qd, qdd): (&Joints, &Joints)| {
            let coupled =
                motor(qd[sixth] + coupling * qd[fifth], qdd[sixth] + coupling * qdd[fifth]);
            let mut torque: Joints = [0.0; MAX_DOF];
            torque[sixth] = size * (coupled - motor(qd[sixth], qdd[sixth]));
            torque[fifth] = size * coupling * coupled;
            torque
        };
        arm.motion.qd.iter().zip(&arm.motion.qdd).map(at_row).collect()
    };
    let law = Law::new("wrist_coupling", "algebraic_sign", &WRIST, [0.05, 1.0], torques);
    Some(law.with(move |size| vec![("coupling", coupling, false), ("part", size, false)]))
}
