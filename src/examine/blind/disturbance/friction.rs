//! Faults of friction.

use std::f64::consts::TAU;

use super::super::fault::Disturbance;
use super::super::random::Random;
use super::super::scale::Scale;

/// Width of the smooth transition, as a share of the typical largest power.
const SMOOTH: f64 = 0.05;

pub(super) fn friction_level(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    // More than three standard deviations of the nominal values.
    let least = 3.3 * scale.trust.friction;
    let [coulomb, viscous] = match random.below(3) {
        0 => [random.log_between(least, 4.0 * least), 0.0],
        1 => [0.0, random.log_between(least, 4.0 * least)],
        _ => [random.log_between(least, 3.0 * least), random.log_between(least, 3.0 * least)],
    };
    let sign = if least < 0.3 && random.chance(0.3) { -1.0 } else { 1.0 };
    let bounded = |share: f64| (sign * share).max(-0.8);
    let coulomb = bounded(coulomb) * scale.plant.coulomb[joint];
    let viscous = bounded(viscous) * scale.plant.viscous[joint];
    let (form, name) = random.form(["constant", "smooth_step", "sag_at_speed"]);
    let fastest = scale.fastest[joint].max(1e-3);
    Disturbance::at_joint("friction_level", name, joint)
        // Relative to the nominal model: the usual spread is a part of the change.
        .graded("coulomb", coulomb + scale.plant.coulomb[joint] - scale.nominal.coulomb[joint])
        .graded("viscous", viscous + scale.plant.viscous[joint] - scale.nominal.viscous[joint])
        .motor_torque(joint, move |m| {
            let v = m.rate[joint];
            let dry = match form {
                1 => (v / (0.01 * fastest)).tanh(),
                2 => m.sign[joint] * (1.0 - 0.01 * (v / fastest).abs()),
                _ => m.sign[joint],
            };
            coulomb * dry + viscous * v
        })
}

pub(super) fn stribeck(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let stiction = random.log_between(0.15, 0.8) * scale.plant.coulomb[joint];
    let velocity = random.log_between(0.02, 0.2);
    let (form, name) =
        random.form(["exponential", "gaussian", "lorentzian", "one_minus_tanh", "logistic"]);
    Disturbance::at_joint("stribeck", name, joint)
        .with("stiction", stiction)
        .with("velocity", velocity)
        .motor_torque(joint, move |m| {
            let x = (m.rate[joint] / velocity).abs();
            let left = match form {
                0 => (-x).exp(),
                1 => (-x * x).exp(),
                2 => 1.0 / (1.0 + x * x),
                3 => 1.0 - x.tanh(),
                _ => 1.0 / (1.0 + ((x - 1.0) / 0.25).exp()),
            };
            stiction * left * m.sign[joint]
        })
}

pub(super) fn nonlinear_viscous(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let fastest = scale.fastest[joint].max(1e-3);
    let size = random.log_between(0.15, 1.0) * scale.plant.viscous[joint] * fastest;
    let (form, name) =
        random.form(["power_below_1", "cubic", "windage", "logarithm", "saturating"]);
    let exponent = match form {
        0 => random.between(0.3, 0.7),
        1 => 3.0,
        2 => 2.0,
        _ => random.between(0.05, 0.25),
    };
    let coefficient = size / if form < 3 { fastest.powf(exponent) } else { 1.0 };
    Disturbance::at_joint("nonlinear_viscous", name, joint)
        .with("coefficient", coefficient)
        .with("exponent", exponent)
        .motor_torque(joint, move |m| {
            let x = (m.rate[joint] / fastest).abs();
            let grown = match form {
                3 => (1.0 + x / exponent).ln() / (1.0 + 1.0 / exponent).ln(),
                4 => x / (x + exponent) * (1.0 + exponent),
                _ => x.powf(exponent),
            };
            size * grown * m.sign[joint]
        })
}

pub(super) fn viscous_asymmetry(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let asymmetry = random.sign() * random.log_between(0.04, 0.3) * scale.plant.viscous[joint];
    let fastest = scale.fastest[joint].max(1e-3);
    let (form, name) = random.form(["absolute", "rounded", "square", "forwards_only"]);
    Disturbance::at_joint("viscous_asymmetry", name, joint)
        .with("asymmetry", asymmetry)
        .motor_torque(joint, move |m| {
            let v = m.rate[joint];
            let rounded = 0.05 * fastest;
            asymmetry
                * match form {
                    1 => v.hypot(rounded) - rounded,
                    2 => v * v / fastest,
                    3 => 2.0 * v.max(0.0),
                    _ => v.abs(),
                }
        })
}

pub(super) fn load_friction(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let mu = random.log_between(0.01, 0.15);
    let typical = scale.load[joint].max(1e-3);
    let (form, name) = random.form(["linear", "rounded", "power_below_1"]);
    Disturbance::at_joint("load_friction", name, joint)
        .with("mu", mu)
        .like(&["gear_efficiency"])
        .motor_torque(joint, move |m| {
            let load = m.load[joint].abs();
            let grown = match form {
                1 => load.hypot(0.2 * typical) - 0.2 * typical,
                2 => typical * (load / typical).powf(0.85),
                _ => load,
            };
            mu * grown * m.sign[joint]
        })
}

pub(super) fn gear_efficiency(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let motoring = random.log_between(0.03, 0.25);
    let generating = motoring * random.between(0.1, 0.6);
    let (typical, fastest) = (scale.load[joint].max(1e-3), scale.fastest[joint].max(1e-3));
    let (form, name) = random.form(["switched", "smooth_switch", "saturating_load"]);
    Disturbance::at_joint("gear_efficiency", name, joint)
        .with("motoring", motoring)
        .with("generating", generating)
        .motor_torque(joint, move |m| {
            let (load, v) = (m.load[joint], m.rate[joint]);
            let power = load * v / (typical * fastest);
            let driving = match form {
                1 => 0.5 * (1.0 + (power / SMOOTH).tanh()),
                _ => f64::from(power > 0.0),
            };
            let loss = motoring * driving + generating * (1.0 - driving);
            let through = match form {
                2 => 2.0 * typical * (load.abs() / (2.0 * typical)).tanh(),
                _ => load.abs(),
            };
            loss * through * m.sign[joint]
        })
}

pub(super) fn position_friction(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let amplitude = random.log_between(0.06, 0.4) * scale.plant.coulomb[joint];
    let phase = random.between(0.0, TAU);
    let [low, high] = scale.workspace.range[joint];
    let tight = random.between(low, high);
    let (form, name) = random.form(["cosine", "two_harmonics", "tight_spot", "worn_range"]);
    Disturbance::at_joint("position_friction", name, joint)
        .with("amplitude", amplitude)
        .with("phase", phase)
        .motor_torque(joint, move |m| {
            let q = m.q[joint];
            let here = match form {
                0 => (q + phase).cos(),
                1 => 0.8 * (q + phase).cos() + 0.5 * (2.0 * q - phase).sin(),
                2 => 2.0 * (-((q - tight) / 0.35).powi(2)).exp(),
                _ => ((q - tight) / 0.2).tanh(),
            };
            amplitude * here * m.sign[joint]
        })
}

pub(super) fn warm_up(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let constant = random.log_between(60.0, 600.0);
    let coulomb = random.between(0.0, 0.4) * scale.plant.coulomb[joint];
    let viscous = random.log_between(0.15, 1.0) * scale.plant.viscous[joint];
    let half_speed = (0.5 * scale.fastest[joint]).max(1e-3);
    let (form, name) = random.form(["exponential", "heated_by_friction", "two_masses"]);
    let mut warm: Option<f64> = None;
    Disturbance::at_joint("warm_up", name, joint)
        .with("time_constant", constant)
        .with("coulomb", coulomb)
        .with("viscous", viscous)
        .motor_torque(joint, move |m| {
            let v = m.rate[joint];
            let cold = match form {
                1 => {
                    let warm = warm.get_or_insert_with(|| 1.0 - (-m.t / constant).exp());
                    // Friction heats the joint and the housing cools it; at half the largest speed
                    // the joint reaches the temperature of the others.
                    *warm += m.dt / constant * ((v.abs() / half_speed) - *warm);
                    (-1.5 * *warm).exp()
                }
                2 => 0.6 * (-m.t / constant).exp() + 0.4 * (-4.0 * m.t / constant).exp(),
                _ => (-m.t / constant).exp(),
            };
            cold * (coulomb * m.sign[joint] + viscous * v)
        })
}

pub(super) fn brake_drag(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let drag = random.log_between(0.15, 1.0) * scale.plant.coulomb[joint];
    let start = random.between(0.05, 0.6) * scale.period_s;
    let end = start + random.between(0.1, 0.3) * scale.period_s;
    let (form, name) = random.form(["gated", "fading", "ramp"]);
    Disturbance::at_joint("brake_drag", name, joint)
        .with("drag", drag)
        .with("t_start_s", start)
        .with("t_end_s", end)
        .within([start, end])
        .motor_torque(joint, move |m| {
            if !(start..end).contains(&m.in_period) {
                return 0.0;
            }
            let x = (m.in_period - start) / (end - start);
            let closed = match form {
                1 => (-1.5 * x).exp(),
                2 => (4.0 * x).min(1.0) * (4.0 * (1.0 - x)).min(1.0),
                _ => 1.0,
            };
            drag * closed * m.sign[joint]
        })
}
