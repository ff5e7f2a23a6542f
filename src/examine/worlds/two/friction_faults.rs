//! Draws faults of friction.

use std::f64::consts::{PI, TAU};

use super::fault::{Action, Fault, Ground};
use super::structure::Bristle;
use super::terms::{Law, Term};
use crate::examine::worlds::random::Rng;

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

/// Begins a fault of terms, one for each joint, with parameters by joint.
fn of_terms(id: &str, form: &str, joints: &[usize], make: &mut dyn FnMut(usize) -> Term) -> Fault {
    Fault::new(id, form, joints, Action::Terms(joints.iter().map(|i| make(*i)).collect()))
}

/// Reports parameters of each term: names with the place in the law's parameters.
fn report(mut fault: Fault, names: &[(&str, usize, bool)]) -> Fault {
    let terms = if let Action::Terms(terms) = &fault.action { terms.clone() } else { Vec::new() };
    for term in terms {
        for (name, place, graded) in names {
            let value = term.p.get(*place).copied().unwrap_or(0.0);
            fault = fault.parameter(name, Some(term.joint), value, *graded);
        }
    }
    fault
}

fn level(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(3, rng);
    let form = rng.below(3);
    let law = [Law::Wear, Law::Tanh, Law::Logarithmic][form];
    let name = ["scaled friction of the worn gear", "tanh", "logarithm of the speed"][form];
    let mut make = |i: usize| {
        let whole = g.torque(i, rng);
        let dry = rng.between(0.2, 0.8);
        let wet = whole * (1.0 - dry) / g.scale.rate[i];
        let third = [0.0, 0.012, 0.1 * g.scale.speed[i]][form];
        let second = if form == 2 { whole * (1.0 - dry) / 1.8 } else { wet };
        Term::new(i, law, &[whole * dry, second, third])
    };
    let fault = of_terms("friction_level", name, &joints, &mut make);
    let graded = form != 2;
    report(fault, &[("coulomb", 0, graded), ("viscous", 1, graded)])
}

fn stribeck(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(2, rng);
    let form = rng.below(3);
    let law = [Law::Tustin, Law::Lorentz, Law::Makkar][form];
    let name = ["Tustin exponential", "Hess and Soom", "Makkar's difference of tanh"][form];
    let mut make = |i: usize| {
        let speed = (g.scale.speed[i] * rng.log_between(0.02, 0.15)).clamp(0.005, 0.6);
        Term::new(i, law, &[2.5 * g.torque(i, rng), speed, 0.08 * speed])
    };
    let fault = of_terms("stribeck", name, &joints, &mut make);
    report(fault, &[("stiction", 0, form != 2), ("velocity", 1, form == 0)])
}

fn nonlinear(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(3, rng);
    let form = rng.below(3);
    let law = [Law::Carreau, Law::Eyring, Law::Churning][form];
    let name = ["Carreau shear thinning", "Eyring asinh", "churning above a speed"][form];
    let mut make = |i: usize| {
        let (size, top) = (1.4 * g.torque(i, rng), g.scale.speed[i]);
        let bend = top * rng.between(0.04, 0.15);
        match form {
            0 => Term::new(i, law, &[size / bend * 0.6, bend, rng.between(0.15, 0.45)]),
            1 => Term::new(i, law, &[size / (0.5 * top / bend).asinh(), bend]),
            _ => Term::new(i, law, &[2.0 * size / (0.5 * top).powi(2), 0.25 * top]),
        }
    };
    let fault = of_terms("nonlinear_viscous", name, &joints, &mut make);
    report(fault, &[("coefficient", 0, false)])
}

fn asymmetry(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(3, rng);
    let round = rng.chance(0.6);
    let mut make = |i: usize| {
        let value = rng.sign() * g.torque(i, rng) / g.scale.rate[i];
        if round {
            Term::new(i, Law::RoundAsymmetry, &[value, 0.05 * g.scale.speed[i]])
        } else {
            Term::new(i, Law::PowerAsymmetry, &[value, rng.between(1.25, 1.6)])
        }
    };
    let name = if round { "hyperbola" } else { "power of the speed" };
    let fault = of_terms("viscous_asymmetry", name, &joints, &mut make);
    report(fault, &[("asymmetry", 0, round)])
}

fn load(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = vec![g.loaded(rng)];
    let form = rng.below(3);
    let law = [Law::RoundLoad, Law::HertzLoad, Law::FullLoad][form];
    let name = ["hyperbola of the load", "Hertzian contact", "saturating"][form];
    let mut make = |i: usize| {
        let (size, typical) = (g.torque(i, rng).min(0.3 * g.scale.load[i]), g.scale.load[i]);
        match form {
            0 => Term::new(i, law, &[size / typical, 0.2 * typical]),
            1 => Term::new(i, law, &[size / typical.powf(2.0 / 3.0), 2.0 / 3.0]),
            _ => Term::new(i, law, &[1.3 * size / typical, 1.5 * typical]),
        }
    };
    let fault = of_terms("load_friction", name, &joints, &mut make).like(&["gear_efficiency"]);
    report(fault, &[("mu", 0, form == 0)])
}

fn efficiency(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = vec![g.loaded(rng)];
    let blended = rng.chance(0.5);
    let law = if blended { Law::BlendedEfficiency } else { Law::PartLoad };
    let mut likeness = false;
    let mut make = |i: usize| {
        let loss = (g.torque(i, rng) / g.scale.load[i]).min(0.3);
        let driven = (loss * rng.between(0.3, 2.5)).min(0.4);
        likeness = (driven / loss - 1.0).abs() < 0.15;
        let power = g.scale.load[i] * g.scale.rate[i];
        let third = if blended { 0.1 * power } else { 0.4 * g.scale.load[i] };
        Term::new(i, law, &[loss, driven, third])
    };
    let name = if blended { "logistic in the power" } else { "worse at part load" };
    let mut fault = of_terms("gear_efficiency", name, &joints, &mut make);
    if likeness {
        fault = fault.like(&["load_friction"]);
    }
    report(fault, &[("motoring", 0, blended), ("generating", 1, blended)])
}

fn warm_up(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(3, rng);
    let form = rng.below(3);
    let law = [Law::TwoStage, Law::Hyperbolic, Law::HeatBalance][form];
    let name = ["grease and housing", "hyperbola of time", "heat balance"][form];
    let time = g.length * rng.between(0.25, 0.8);
    let mut make = |i: usize| {
        let whole = 1.5 * g.torque(i, rng);
        let dry = rng.between(0.2, 0.8);
        let wet = whole * (1.0 - dry) / g.scale.rate[i];
        match form {
            0 => Term::new(i, law, &[whole * dry, wet, 0.4 * time, 1.6 * time, 0.5]),
            1 => Term::new(i, law, &[whole * dry, wet, 1.5 * time]),
            _ => Term::new(i, law, &[whole * dry, wet, 1.5 * time, 0.5 / g.scale.rate[i]]),
        }
    };
    let fault = of_terms("warm_up", name, &joints, &mut make);
    report(fault, &[("coulomb", 0, true), ("viscous", 1, true), ("time_constant", 2, false)])
}

fn position(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(2, rng);
    let form = rng.below(3);
    let law = [Law::Mises, Law::RoughHalf, Law::Triangle][form];
    let name = ["von Mises bump", "a rough half", "triangles"][form];
    let mut make = |i: usize| {
        let size = 1.6 * g.torque(i, rng);
        let place = g.scale.middle[i] + g.scale.width[i] * rng.between(-0.6, 0.6);
        let narrow = 2.0 / (g.scale.width[i] * g.scale.width[i]).clamp(0.1, 2.0);
        let third = [narrow, 0.25 * g.scale.width[i], rng.between(1.0, 2.0)][form];
        Term::new(i, law, &[size, place, third])
    };
    let fault = of_terms("position_friction", name, &joints, &mut make);
    report(fault, &[("amplitude", 0, false), ("phase", 1, form == 0)])
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
    let i = rng.below(g.n());
    let distance = rng.log_between(0.004, 0.1).min(0.25 * g.scale.width[i]);
    let slip = rng.chance(0.5);
    let bristle = if slip {
        let list = [0.25, 0.5, 0.9, 1.6, 2.8, 4.5].map(|x| x * distance * 0.6).to_vec();
        Bristle { joint: i, state: vec![0.0; list.len()], distances: list, power: 0.0 }
    } else {
        Bristle {
            joint: i,
            distances: vec![distance],
            power: rng.between(1.6, 3.0),
            state: vec![0.0],
        }
    };
    let name = if slip { "Maxwell slip" } else { "Bouc and Wen" };
    let value = reversal(&bristle, distance);
    Fault::new("presliding", name, &[i], Action::Bristle(bristle)).graded(
        "distance",
        Some(i),
        value,
    )
}

fn brake(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(1, rng);
    let form = rng.below(3);
    let law = [Law::Release, Law::Judder, Law::Fade][form];
    let name = ["slow release", "judder", "fading with speed"][form];
    let from = rng.between(0.1, 0.5) * g.period;
    let to = from + rng.between(0.15, 0.35) * g.period;
    let mut make = |i: usize| {
        let size = 1.5 * g.torque(i, rng);
        match form {
            0 => Term::new(i, law, &[size, from, to, 0.05]),
            1 => Term::new(i, law, &[size, from, to, 0.4, rng.between(3.0, 12.0)]),
            _ => Term::new(i, law, &[1.5 * size, from, to, 0.7 * g.scale.speed[i]]),
        }
    };
    let fault = of_terms("brake_drag", name, &joints, &mut make).within(from, to);
    let fault = report(fault, &[("drag", 0, form != 2)]);
    fault.graded("t_start_s", joints.first().copied(), from).graded(
        "t_end_s",
        joints.first().copied(),
        to,
    )
}

fn offset(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(3, rng);
    let drifting = rng.chance(0.5);
    let mut make = |i: usize| {
        let size = rng.sign() * g.torque(i, rng);
        if drifting {
            let rate = TAU / (g.length * rng.between(1.0, 3.0));
            Term::new(
                i,
                Law::DriftingOffset,
                &[size, rng.between(0.05, 0.15), rate, rng.between(0.0, PI)],
            )
        } else {
            Term::new(i, Law::SidedCoulomb, &[size])
        }
    };
    let name = if drifting { "slow drift" } else { "asymmetric Coulomb friction" };
    let fault = of_terms("torque_offset", name, &joints, &mut make);
    report(fault, &[("offset", 0, true)])
}
