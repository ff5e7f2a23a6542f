//! Faults of the drive losses.

use std::f64::consts::TAU;

use super::super::fault::Disturbance;
use super::super::random::Random;
use super::super::scale::Scale;

pub(super) fn copper_loss(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let typical = scale.rms[joint].max(1e-6);
    let loss = random.log_between(0.03, 0.4) * scale.power / (typical * typical);
    let (form, name) = random.form(["square", "warming_copper", "skin_effect"]);
    let mut heat = 0.0;
    Disturbance::at_joint("copper_loss", name, joint).with("loss", loss).power(
        move |m, tau, watts| {
            let x = tau[joint] / typical;
            heat += m.dt / 60.0 * (x * x - heat);
            let grown = match form {
                1 => x * x * (1.0 + 0.1 * heat),
                2 => x * x * (1.0 + 0.05 * m.rate[joint].abs()),
                _ => x * x,
            };
            watts + loss * typical * typical * grown
        },
    )
}

pub(super) fn inverter_loss(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let typical = scale.rms[joint].max(1e-6);
    let per_current = random.log_between(0.03, 0.4) * scale.power / typical;
    let (form, name) = random.form(["absolute", "rounded", "with_resistance"]);
    Disturbance::at_joint("inverter_loss", name, joint).with("per_current", per_current).power(
        move |_, tau, watts| {
            let current = tau[joint].abs();
            let grown = match form {
                1 => current.hypot(0.1 * typical) - 0.1 * typical,
                2 => current * (0.9 + 0.1 * current / typical),
                _ => current,
            };
            watts + per_current * grown
        },
    )
}

pub(super) fn iron_loss(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let fastest = scale.fastest[joint].max(1e-3);
    let loss = random.log_between(0.05, 0.6) * scale.power / (fastest * fastest);
    let (form, name) = random.form(["eddy", "steinmetz", "eddy_and_hysteresis"]);
    Disturbance::at_joint("iron_loss", name, joint).with("loss", loss).power(move |m, _, watts| {
        let x = (m.rate[joint] / fastest).abs();
        let grown = match form {
            1 => x.powf(1.6),
            2 => 0.7 * x * x + 0.3 * x,
            _ => x * x,
        };
        watts + loss * fastest * fastest * grown
    })
}

pub(super) fn base_load(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let load = random.log_between(0.04, 0.5) * scale.power;
    let (form, name) = random.form(["constant", "fan", "thermostat"]);
    let phase = random.between(0.0, TAU);
    Disturbance::new("base_load", name, &[]).with("power", load).like(&["brake_power"]).power(
        move |m, _, watts| {
            let share = match form {
                1 => 1.0 + 0.03 * (0.5 * m.t + phase).sin(),
                2 => 1.0 + 0.05 * (0.06 * m.t + phase).sin().signum(),
                _ => 1.0,
            };
            watts + load * share
        },
    )
}

pub(super) fn brake_power(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let coil = random.log_between(0.04, 0.4) * scale.power;
    let (form, name) = random.form(["constant", "pull_then_hold", "warming"]);
    Disturbance::new("brake_power", name, &[]).with("power", coil).like(&["base_load"]).power(
        move |m, _, watts| {
            let share = match form {
                1 => 1.0 + 0.5 * (-m.t / 0.5).exp(),
                2 => 1.0 - 0.05 * (1.0 - (-m.t / 120.0).exp()),
                _ => 1.0,
            };
            watts + coil * share
        },
    )
}

/// No regeneration to the grid, independent of the nominal drive.
pub(super) fn no_regeneration(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let (form, name) = random.form(["resistor", "late_resistor", "capacitor"]);
    let full = 0.02 * scale.power.max(1.0);
    let mut stored = 0.0_f64;
    Disturbance::new("no_regeneration", name, &[]).power(move |m, _, watts| match form {
        1 => watts.max(-0.02 * full),
        2 => {
            // Surplus charges the bus, the next motion discharges it.
            if watts < 0.0 {
                stored = (stored - watts * m.dt).min(full);
                0.0
            } else {
                let used = (watts * m.dt).min(stored);
                stored -= used;
                watts - used / m.dt.max(1e-9)
            }
        }
        _ => watts.max(0.0),
    })
}
