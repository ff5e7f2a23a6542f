//! Draws faults of friction.

use super::fault::{Action, Fault, Ground};
use super::structure::Bristle;
use super::terms::{FLANK, Seen, Term, window};
use crate::examine::worlds::random::Rng;
use std::f64::consts::{FRAC_2_PI, PI, TAU};

/// Ids drawn here.
pub(super) const IDS: [&str; 11] = [
    "friction_level",
    "stribeck",
    "nonlinear_viscous",
    "viscous_asymmetry",
    "load_friction",
    "gear_efficiency",
    "warm_up",
    "position_friction",
    "presliding",
    "brake_drag",
    "torque_offset",
];

/// Draws a fault of an id.
pub(super) fn draw(id: &str, ground: &Ground, rng: &mut Rng) -> Fault {
    match id {
        "friction_level" => level(ground, rng),
        "stribeck" => stribeck(ground, rng),
        "nonlinear_viscous" => nonlinear(ground, rng),
        "viscous_asymmetry" => asymmetry(ground, rng),
        "load_friction" => load(ground, rng),
        "gear_efficiency" => efficiency(ground, rng),
        "warm_up" => warm_up(ground, rng),
        "position_friction" => position(ground, rng),
        "presliding" => presliding(ground, rng),
        "brake_drag" => brake(ground, rng),
        _ => offset(ground, rng),
    }
}

/// Friction of the healthy gear, scaled; a tanh; a level that grows with the logarithm of the speed.
fn level(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(3, rng);
    let form = rng.below(3);
    let name = ["scaled friction of the worn gear", "tanh", "logarithm of the speed"][form];
    Fault::terms("friction_level", name, &joints, |i| {
        let whole = g.torque(i, rng);
        let share = rng.between(0.2, 0.8);
        let dry = whole * share;
        let wet = whole * (1.0 - share) / if form == 2 { 1.8 } else { g.scale.rate[i] };
        let slow = 0.1 * g.scale.speed[i];
        let term = match form {
            0 => Term::new(i, move |x, _| (dry * x.dry, wet * x.wet * x.v)),
            1 => Term::smooth(i, move |x| dry * (x.v / 0.012).tanh() + wet * x.v),
            _ => Term::level(i, move |x| dry + wet * (x.v.abs() / slow).ln_1p()),
        };
        (term, vec![("coulomb", dry, form != 2), ("viscous", wet, form != 2)])
    })
}

/// A. Tustin 1947; D. Hess, A. Soom 1990; C. Makkar et al. 2005.
fn stribeck(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(2, rng);
    let form = rng.below(3);
    let name = ["Tustin exponential", "Hess and Soom", "Makkar's difference of tanh"][form];
    Fault::terms("stribeck", name, &joints, |i| {
        let speed = (g.scale.speed[i] * rng.log_between(0.02, 0.15)).clamp(0.005, 0.6);
        let (size, fast) = (2.5 * g.torque(i, rng), 0.08 * speed);
        let term = match form {
            0 => Term::level(i, move |x| size * (-x.v.abs() / speed).exp()),
            1 => Term::level(i, move |x| size / (1.0 + (x.v / speed).powi(2))),
            _ => Term::smooth(i, move |x| size * ((x.v / fast).tanh() - (x.v / speed).tanh())),
        };
        (term, vec![("stiction", size, form != 2), ("velocity", speed, form == 0)])
    })
}

/// P. Carreau 1972, H. Eyring 1936, and churning of oil above a speed.
fn nonlinear(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(3, rng);
    let form = rng.below(3);
    let name = ["Carreau shear thinning", "Eyring asinh", "churning above a speed"][form];
    Fault::terms("nonlinear_viscous", name, &joints, |i| {
        let (size, top) = (1.4 * g.torque(i, rng), g.scale.speed[i]);
        let bend = top * rng.between(0.04, 0.15);
        let (size, term) = match form {
            0 => {
                let (size, power) = (size / bend * 0.6, 0.5 * (rng.between(0.15, 0.45) - 1.0));
                let law = move |x: &Seen| size * x.v * (1.0 + (x.v / bend).powi(2)).powf(power);
                (size, Term::smooth(i, law))
            }
            1 => {
                let size = size / (0.5 * top / bend).asinh();
                (size, Term::smooth(i, move |x| size * (x.v / bend).asinh()))
            }
            _ => {
                let (size, from) = (2.0 * size / (0.5 * top).powi(2), 0.25 * top);
                (size, Term::level(i, move |x| size * (x.v.abs() - from).max(0.0).powi(2)))
            }
        };
        (term, vec![("coefficient", size, false)])
    })
}

/// Round at rest, and another power in both directions.
fn asymmetry(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(3, rng);
    let round = rng.chance(0.6);
    let name = if round { "hyperbola" } else { "power of the speed" };
    Fault::terms("viscous_asymmetry", name, &joints, |i| {
        let value = rng.sign() * g.torque(i, rng) / g.scale.rate[i];
        let term = if round {
            let corner = 0.05 * g.scale.speed[i];
            Term::smooth(i, move |x| value * ((x.v * x.v + corner * corner).sqrt() - corner))
        } else {
            let power = rng.between(1.25, 1.6);
            Term::smooth(i, move |x| value * x.v.abs().powf(power))
        };
        (term, vec![("asymmetry", value, round)])
    })
}

fn load(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = [g.loaded(rng)];
    let form = rng.below(3);
    let name = ["hyperbola of the load", "Hertzian contact", "saturating"][form];
    let fault = Fault::terms("load_friction", name, &joints, |i| {
        let (size, typical) = (g.torque(i, rng).min(0.3 * g.scale.load[i]), g.scale.load[i]);
        let (mu, term) = match form {
            0 => {
                let (mu, round) = (size / typical, 0.2 * typical);
                (mu, Term::level(i, move |x| mu * (x.load.abs().hypot(round) - round)))
            }
            1 => {
                let mu = size / typical.powf(2.0 / 3.0);
                (mu, Term::level(i, move |x| mu * x.load.abs().powf(2.0 / 3.0)))
            }
            _ => {
                let (mu, full) = (1.3 * size / typical, 1.5 * typical);
                (mu, Term::level(i, move |x| mu * full * (x.load.abs() / full).tanh()))
            }
        };
        (term, vec![("mu", mu, form == 0)])
    });
    fault.like(&["gear_efficiency"])
}

/// A soft change between driving and driven, and gears that lose more at part load.
fn efficiency(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = [g.loaded(rng)];
    let blended = rng.chance(0.5);
    let name = if blended { "logistic in the power" } else { "worse at part load" };
    let mut alike = false;
    let fault = Fault::terms("gear_efficiency", name, &joints, |i| {
        let loss = (g.torque(i, rng) / g.scale.load[i]).min(0.3);
        let driven = (loss * rng.between(0.3, 2.5)).min(0.4);
        alike = (driven / loss - 1.0).abs() < 0.15;
        let width = 0.1 * g.scale.load[i] * g.scale.rate[i];
        let part = 0.4 * g.scale.load[i];
        let term = Term::level(i, move |x| {
            let size = x.load.abs();
            if blended {
                size * (driven + (loss - driven) / (1.0 + (-x.load * x.v / width).exp()))
            } else {
                let share = if x.load * x.v > 0.0 { loss } else { driven };
                size * share * (1.0 + part / (size + part))
            }
        });
        (term, vec![("motoring", loss, blended), ("generating", driven, blended)])
    });
    if alike { fault.like(&["load_friction"]) } else { fault }
}

/// Grease, then housing; a hyperbola; a temperature that the own motion heats.
fn warm_up(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(3, rng);
    let form = rng.below(3);
    let name = ["grease and housing", "hyperbola of time", "heat balance"][form];
    let time = g.length * rng.between(0.25, 0.8);
    Fault::terms("warm_up", name, &joints, |i| {
        let whole = 1.5 * g.torque(i, rng);
        let share = rng.between(0.2, 0.8);
        let (dry, wet) = (whole * share, whole * (1.0 - share) / g.scale.rate[i]);
        let heat = 0.5 / g.scale.rate[i];
        let lag = if form == 0 { 0.4 * time } else { 1.5 * time };
        let term = Term::new(i, move |x, states| {
            let t = x.now.t.max(0.0);
            let left = match form {
                0 => 0.5 * (-t / lag).exp() + 0.5 * (-t / (4.0 * lag)).exp(),
                1 => (1.0 + t / lag).powi(-2),
                _ => {
                    if x.now.t > 0.0 {
                        let warming = heat * x.v.abs() + 1.0 - states[0];
                        states[0] = (states[0] + x.now.dt * warming / lag).min(1.0);
                    }
                    1.0 - states[0]
                }
            };
            (dry * left, wet * x.v * left)
        });
        (term, vec![("coulomb", dry, true), ("viscous", wet, true), ("time_constant", lag, false)])
    })
}

/// R. von Mises' bump, a rough half, triangles over the angle.
fn position(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(2, rng);
    let form = rng.below(3);
    let name = ["von Mises bump", "a rough half", "triangles"][form];
    Fault::terms("position_friction", name, &joints, |i| {
        let size = 1.6 * g.torque(i, rng);
        let width = g.scale.width[i];
        let place = g.scale.middle[i] + width * rng.between(-0.6, 0.6);
        let (narrow, waves) = (2.0 / (width * width).clamp(0.1, 2.0), rng.between(1.0, 2.0));
        let term = Term::level(i, move |x| {
            let d = x.q - place;
            match form {
                0 => size * (narrow * (d.cos() - 1.0)).exp(),
                1 => size * (1.0 + (d / (0.25 * width)).tanh()),
                _ => size * FRAC_2_PI * (waves * d).cos().asin(),
            }
        });
        (term, vec![("amplitude", size, false), ("phase", place, form == 0)])
    })
}

/// Angle in which 1/e of the bristle force is left to build up after a reversal \[rad\].
fn reversal(bristle: &Bristle, guess: f64) -> f64 {
    let mut trial = bristle.clone();
    trial.state.fill(-1.0);
    let step = 0.01 * guess;
    let mut way = 0.0;
    for _ in 0..2000 {
        way += step;
        if 0.5 * (1.0 - trial.step(step)) < (-1.0_f64).exp() {
            break;
        }
    }
    way
}

fn presliding(g: &Ground, rng: &mut Rng) -> Fault {
    let joint = rng.below(g.n());
    let distance = rng.log_between(0.004, 0.1).min(0.25 * g.scale.width[joint]);
    let slip = rng.chance(0.5);
    let (name, distances, power) = if slip {
        let list = [0.25, 0.5, 0.9, 1.6, 2.8, 4.5].map(|x| x * distance * 0.6);
        ("Maxwell slip", list.to_vec(), 0.0)
    } else {
        ("Bouc and Wen", vec![distance], rng.between(1.6, 3.0))
    };
    let bristle = Bristle { joint, state: vec![0.0; distances.len()], distances, power };
    let value = reversal(&bristle, distance);
    Fault::new("presliding", name, &[joint], Action::Bristle(bristle)).graded(
        "distance",
        Some(joint),
        value,
    )
}

/// A brake that lets go slowly, one that judders, one that fades with speed.
fn brake(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(1, rng);
    let form = rng.below(3);
    let name = ["slow release", "judder", "fading with speed"][form];
    let from = rng.between(0.1, 0.5) * g.period;
    let to = from + rng.between(0.15, 0.35) * g.period;
    let fault = Fault::terms("brake_drag", name, &joints, |i| {
        let size = 1.5 * g.torque(i, rng);
        let size = if form == 2 { 1.5 * size } else { size };
        let waves = if form == 1 { rng.between(3.0, 12.0) } else { 0.0 };
        let fading = 0.7 * g.scale.speed[i];
        let term = Term::level(i, move |x| match form {
            0 => {
                let w = window(x.now, from, to + 0.15, 0.15);
                size * w * w * (3.0 - 2.0 * w)
            }
            1 => size * (1.0 + 0.4 * (waves * x.q).cos()) * window(x.now, from, to, FLANK),
            _ => size / (1.0 + x.v.abs() / fading) * window(x.now, from, to, FLANK),
        });
        (term, vec![("drag", size, form != 2)])
    });
    let joint = joints.first().copied();
    fault.within(from, to).graded("t_start_s", joint, from).graded("t_end_s", joint, to)
}

/// A slow drift, and Coulomb friction that is not the same in both directions.
fn offset(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(3, rng);
    let drifting = rng.chance(0.5);
    let name = if drifting { "slow drift" } else { "asymmetric Coulomb friction" };
    Fault::terms("torque_offset", name, &joints, |i| {
        let size = rng.sign() * g.torque(i, rng);
        let term = if drifting {
            let rate = TAU / (g.length * rng.between(1.0, 3.0));
            let (share, phase) = (rng.between(0.05, 0.15), rng.between(0.0, PI));
            Term::smooth(i, move |x| size * (1.0 + share * (rate * x.now.t + phase).sin()))
        } else {
            Term::level(i, move |x| size * x.s)
        };
        (term, vec![("offset", size, true)])
    })
}
