//! Draws faults of the drives: torque constants, delays, filters, observers.

use super::fault::{Action, Fault, Ground};
use super::sensor::{Kind, Sensor};
use crate::examine::worlds::model::MAX;
use crate::examine::worlds::random::Rng;

/// Ids drawn here.
pub(super) const IDS: [&str; 7] = [
    "torque_constant",
    "current_saturation",
    "flux_weakening",
    "current_sign",
    "time_delay",
    "filter_lag",
    "apparent_torque",
];

/// Draws a fault of an id.
pub(super) fn draw(id: &str, ground: &Ground, rng: &mut Rng) -> Fault {
    match id {
        "torque_constant" => constant(ground, rng),
        "current_saturation" => saturation(ground, rng),
        "flux_weakening" => weakening(ground, rng),
        "current_sign" => sign(ground, rng),
        "apparent_torque" => apparent(ground, rng),
        _ => late(id, ground, rng),
    }
}

/// Begins a fault of the path; `make` gives the parameters of a joint.
pub(super) fn of_path(
    id: &str,
    form: (&str, Kind),
    g: &Ground,
    joints: &[usize],
    make: &mut dyn FnMut(usize) -> [f64; 3],
) -> Fault {
    let mask = g.mask(joints);
    let mut p = [[0.0; 3]; MAX];
    for (i, place) in p.iter_mut().enumerate() {
        if mask[i] {
            *place = make(i);
        }
    }
    Fault::new(id, form.0, joints, Action::Sensor(Sensor::new(form.1, mask, p)))
}

/// Reports parameters of each joint: names with the place in the law's parameters.
fn report(mut fault: Fault, names: &[(&str, usize, bool)]) -> Fault {
    if let Action::Sensor(sensor) = fault.action.clone() {
        for (i, p) in sensor.p.iter().enumerate() {
            for (name, place, graded) in names {
                if sensor.joints[i] {
                    fault = fault.parameter(name, Some(i), p[*place], *graded);
                }
            }
        }
    }
    fault
}

fn constant(g: &Ground, rng: &mut Rng) -> Fault {
    let all = rng.chance(0.12);
    let joints = if all { (0..g.n()).collect() } else { g.joints(3, rng) };
    let warming = rng.chance(0.5);
    let mut error = rng.sign() * rng.log_between(0.03, 0.4);
    let mut make = |i: usize| {
        if !all {
            error = rng.sign() * rng.log_between(0.03, 0.4);
        }
        if warming {
            [error, rng.between(0.05, 0.2), 0.7 * g.length]
        } else {
            [error, rng.sign() * 0.15 * error, 0.3 * g.scale.torque[i]]
        }
    };
    let form = if warming {
        ("gain that drifts as magnets warm", Kind::WarmingGain)
    } else {
        ("gain that depends a little on the sign", Kind::SidedGain)
    };
    let fault = of_path("torque_constant", form, g, &joints, &mut make);
    let fault = if all { fault.like(&["link_parameters"]) } else { fault };
    report(fault, &[("error", 0, true)])
}

fn saturation(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(3, rng);
    let form = [
        ("fourth power and square", Kind::Fourth),
        ("knee", Kind::Knee),
        ("tangent", Kind::Tangent),
    ][rng.below(3)];
    let mut make = |i: usize| {
        let peak = g.scale.peak[i];
        match form.1 {
            Kind::Fourth => [rng.log_between(0.06, 0.8), peak, 0.0],
            Kind::Knee => [rng.log_between(0.15, 1.5), rng.between(0.3, 0.55) * peak, 0.0],
            _ => [0.0, peak / rng.log_between(0.45, 1.15), 0.0],
        }
    };
    let fault = of_path("current_saturation", form, g, &joints, &mut make);
    report(fault, &[("error", 0, false)])
}

fn weakening(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(3, rng);
    let base = rng.chance(0.5);
    let form = if base {
        ("speed over base speed", Kind::BaseSpeed)
    } else {
        ("voltage ellipse", Kind::Ellipse)
    };
    let mut make =
        |i: usize| [rng.log_between(0.15, 1.0), g.scale.speed[i] * rng.between(0.25, 0.5), 0.0];
    let fault = of_path("flux_weakening", form, g, &joints, &mut make);
    report(fault, &[("error", 0, false), ("velocity", 1, base)])
}

fn sign(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(2, rng);
    let gain = rng.chance(0.5);
    let form = if gain {
        ("turned sign and another gain", Kind::Flipped)
    } else {
        ("turned sign and a zero of the sensor", Kind::FlippedZero)
    };
    let mut make = |i: usize| {
        let value = if gain { 0.04 } else { 0.03 * g.scale.torque[i] };
        [value * rng.normal(), 0.0, 0.0]
    };
    let mut fault = of_path("current_sign", form, g, &joints, &mut make);
    for i in joints {
        fault = fault.graded("flipped", Some(i), 1.0);
    }
    fault
}

/// Delays below this look like lags of a filter \[s\].
const SHORT: f64 = 0.012;

fn late(id: &str, g: &Ground, rng: &mut Rng) -> Fault {
    let joints = if rng.chance(0.7) { Vec::new() } else { vec![rng.below(g.n())] };
    let time = rng.log_between(0.004, 0.045);
    let (forms, name, other) = if id == "time_delay" {
        let forms = [
            ("all-pass of first order", Kind::AllPass, true),
            ("sample and hold", Kind::Hold, true),
            ("wandering", Kind::Wander, true),
        ];
        (forms, "delay", "filter_lag")
    } else {
        let forms = [
            ("two poles", Kind::TwoPoles, true),
            ("moving average", Kind::Average, false),
            ("Butterworth of second order", Kind::Butterworth, false),
        ];
        (forms, "lag", "time_delay")
    };
    let (form, kind, graded) = forms[rng.below(3)];
    let period = g.period * rng.between(0.6, 1.7);
    let mut make = |_: usize| match kind {
        Kind::TwoPoles => [0.85 * time, 0.15 * time, 0.0],
        Kind::Butterworth => [time / std::f64::consts::SQRT_2, 0.0, 0.0],
        _ => [time, 0.25, period],
    };
    let only = joints.first().map_or(0.0, |i| (i + 1) as f64);
    let mut fault = of_path(id, (form, kind), g, &joints, &mut make);
    if time < SHORT {
        fault = fault.like(&[other]);
    }
    fault.parameter(name, None, time, graded).graded("only_joint", None, only)
}

fn apparent(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(2, rng);
    let smooth = rng.chance(0.5);
    let form = if smooth {
        ("smoothed observer", Kind::Observer)
    } else {
        ("observer that saturates", Kind::BoundedObserver)
    };
    let mut make = |i: usize| {
        let size = g.torque(i, rng);
        let inertia = rng.sign() * size / g.scale.acceleration[i];
        let viscous = rng.sign() * 0.5 * size / g.scale.rate[i];
        [inertia, viscous, if smooth { 0.006 } else { 4.0 * size }]
    };
    let fault = of_path("apparent_torque", form, g, &joints, &mut make);
    report(fault, &[("inertia", 0, smooth), ("viscous", 1, smooth)])
}
