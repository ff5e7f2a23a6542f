//! Faults of the drive losses.

use std::f64::consts::TAU;

use super::super::action::{Action, BeginPower, PowerChange};
use super::super::fault::Disturbance;
use super::super::random::Random;
use super::super::scale::Scale;

fn power(begin: impl Fn() -> PowerChange + Send + Sync + 'static) -> Action {
    let begin: BeginPower = Box::new(begin);
    Action::Power(begin)
}

pub(super) fn copper_loss(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let typical = scale.rms[joint].max(1e-6);
    let loss = random.log_between(0.03, 0.4) * scale.power / (typical * typical);
    let forms = ["square", "warming_copper", "skin_effect"];
    let form = random.below(forms.len());
    Disturbance::at_joint("copper_loss", forms[form], joint).with("loss", loss).acting(power(
        move || {
            let mut heat = 0.0;
            Box::new(move |m, tau, watts| {
                let x = tau[joint] / typical;
                heat += m.dt / 60.0 * (x * x - heat);
                let grown = match form {
                    1 => x * x * (1.0 + 0.1 * heat),
                    2 => x * x * (1.0 + 0.05 * m.rate[joint].abs()),
                    _ => x * x,
                };
                watts + loss * typical * typical * grown
            })
        },
    ))
}

pub(super) fn inverter_loss(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let typical = scale.rms[joint].max(1e-6);
    let per_current = random.log_between(0.03, 0.4) * scale.power / typical;
    let forms = ["absolute", "rounded", "with_resistance"];
    let form = random.below(forms.len());
    Disturbance::at_joint("inverter_loss", forms[form], joint)
        .with("per_current", per_current)
        .acting(power(move || {
            Box::new(move |_, tau, watts| {
                let current = tau[joint].abs();
                let grown = match form {
                    1 => current.hypot(0.1 * typical) - 0.1 * typical,
                    2 => current * (0.9 + 0.1 * current / typical),
                    _ => current,
                };
                watts + per_current * grown
            })
        }))
}

pub(super) fn iron_loss(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let fastest = scale.fastest[joint].max(1e-3);
    let loss = random.log_between(0.05, 0.6) * scale.power / (fastest * fastest);
    let forms = ["eddy", "steinmetz", "eddy_and_hysteresis"];
    let form = random.below(forms.len());
    Disturbance::at_joint("iron_loss", forms[form], joint).with("loss", loss).acting(power(
        move || {
            Box::new(move |m, _, watts| {
                let x = (m.rate[joint] / fastest).abs();
                let grown = match form {
                    1 => x.powf(1.6),
                    2 => 0.7 * x * x + 0.3 * x,
                    _ => x * x,
                };
                watts + loss * fastest * fastest * grown
            })
        },
    ))
}

pub(super) fn base_load(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let load = random.log_between(0.04, 0.5) * scale.power;
    let forms = ["constant", "fan", "thermostat"];
    let form = random.below(forms.len());
    let phase = random.between(0.0, TAU);
    Disturbance::new("base_load", forms[form], Vec::new())
        .with("power", load)
        .like(&["brake_power"])
        .acting(power(move || {
            Box::new(move |m, _, watts| {
                let share = match form {
                    1 => 1.0 + 0.03 * (0.5 * m.t + phase).sin(),
                    2 => 1.0 + 0.05 * (0.06 * m.t + phase).sin().signum(),
                    _ => 1.0,
                };
                watts + load * share
            })
        }))
}

pub(super) fn brake_power(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let coil = random.log_between(0.04, 0.4) * scale.power;
    let forms = ["constant", "pull_then_hold", "warming"];
    let form = random.below(forms.len());
    Disturbance::new("brake_power", forms[form], Vec::new())
        .with("power", coil)
        .like(&["base_load"])
        .acting(power(move || {
            Box::new(move |m, _, watts| {
                let share = match form {
                    1 => 1.0 + 0.5 * (-m.t / 0.5).exp(),
                    2 => 1.0 - 0.05 * (1.0 - (-m.t / 120.0).exp()),
                    _ => 1.0,
                };
                watts + coil * share
            })
        }))
}

/// No regeneration to the grid, independent of the nominal drive.
pub(super) fn no_regeneration(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let forms = ["resistor", "late_resistor", "capacitor"];
    let form = random.below(forms.len());
    let full = 0.02 * scale.power.max(1.0);
    Disturbance::new("no_regeneration", forms[form], Vec::new()).acting(power(move || {
        let mut stored = 0.0_f64;
        Box::new(move |m, _, watts| match form {
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
    }))
}
