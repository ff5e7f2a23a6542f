//! Random faults of motors, of reported values, of the signal path and of couplings: their laws, from
//! the torque at the motor to the logged one, and usual sizes.

use super::fault::{Act, Fault, Place, some_joints};
use super::friction::{carreau, load_boundary};
use super::law::{MotorLaw, Parameter, softplus};
use super::signal::{SignalForm, SignalLaw};
use crate::examine::worlds::random::Rng;
use std::f64::consts::TAU;

/// A law for each joint; the first size is an error as a share, a torque \[Nm\] or an inertia \[kg m²\].
fn each(joints: &[usize], mut law: impl FnMut(usize) -> MotorLaw) -> Vec<Act> {
    joints.iter().map(|i| Act::Report(*i, law(*i))).collect()
}

/// The first size, and another parameter.
fn told(name: &'static str, graded: bool, other: Parameter) -> impl Fn([f64; 2]) -> Vec<Parameter> {
    move |[e, _]| vec![(name, e, graded), other]
}

/// A fault of drives; sizes are usual ones, to be scaled.
pub(super) fn draw(id: &'static str, place: &Place, rng: &mut Rng) -> Option<Fault> {
    match id {
        "torque_offset" => Some(offset(place, rng)),
        "torque_constant" => Some(constant(place, rng)),
        "current_saturation" => Some(saturation(place, rng)),
        "flux_weakening" => Some(weakening(place, rng)),
        "current_sign" => Some(sign(place, rng)),
        "ripple" => Some(ripple(place, rng)),
        "apparent_torque" => Some(apparent(place, rng)),
        "time_delay" => Some(delay(place, rng)),
        "filter_lag" => Some(lag(place, rng)),
        "wrist_coupling" if place.arm.axes() == 6 => Some(coupling(place, rng)),
        _ => None,
    }
}

/// Torque while it moves only, the same both ways, as asymmetric friction; a sensor's zero.
fn offset(place: &Place, rng: &mut Rng) -> Fault {
    let joints = some_joints(place.arm, rng);
    let side = rng.sign();
    let asymmetric = rng.chance(0.4);
    let time = if asymmetric { 0.0 } else { rng.between(20.0, 120.0) };
    let acts = each(&joints, |i| {
        let sizes = [side * 0.05 * place.arm.usual[i], 0.0];
        MotorLaw::new(
            sizes,
            |[e, _]| vec![("offset", e, true)],
            move |x, [e, _], _| {
                if asymmetric {
                    x.torque + e * (x.w / 0.01).tanh().powi(2)
                } else {
                    x.torque + e * (1.0 + 0.15 * (TAU * x.now.time / time).sin())
                }
            },
        )
    });
    let name = if asymmetric { "asymmetric friction" } else { "zero that wanders" };
    Fault::new("torque_offset", name, &joints, acts, [0.2, 10.0])
}

/// Magnets warmer than believed, and magnets of which a part is weak.
fn constant(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let every = rng.chance(0.12);
    let joints = if every { (0..arm.axes()).collect() } else { some_joints(arm, rng) };
    // Weaker magnets need more current: the reported torque is too large. The other sign: exchanged
    // motors.
    let side = if rng.chance(0.7) { 1.0 } else { -1.0 };
    let bounds = if side > 0.0 { [0.15, 8.0] } else { [0.15, 5.0] };
    let warm = rng.chance(0.5);
    let time = if warm { rng.log_between(20.0, 300.0) } else { 0.0 };
    let acts = each(&joints, |i| {
        let order = (arm.ratio[i] / 4.0).round().min(30.0);
        let sizes = [side * 0.08, 0.0];
        MotorLaw::new(
            sizes,
            |[e, _]| vec![("error", e, true)],
            move |x, [e, _], _| {
                if warm {
                    x.torque * (1.0 + e * (0.9 + 0.2 * (1.0 - (-x.now.time / time).exp())))
                } else {
                    x.torque * (1.0 + e * (1.0 + 0.2 * (order * x.q).cos()))
                }
            },
        )
    });
    let name = if warm { "warm magnets" } else { "weak magnets of some poles" };
    let fault = Fault::new("torque_constant", name, &joints, acts, bounds);
    if every { fault.like(&["link_parameters"]) } else { fault }
}

/// Frölich's curve of the flux, and the current of the cross axis.
fn saturation(place: &Place, rng: &mut Rng) -> Fault {
    let joints = some_joints(place.arm, rng);
    let froelich = rng.chance(0.5);
    let acts = each(&joints, |i| {
        let limit = place.arm.torque[i];
        let (size, exponent) = if froelich { (0.2, 1.0) } else { (0.5, 4.0) };
        let told = told("error", true, ("exponent", exponent, false));
        MotorLaw::new([size, 0.0], told, move |x, [e, _], _| {
            let load = (x.torque.abs() / limit).min(1.0);
            if froelich {
                x.torque / (1.0 - e / (1.0 + e) * load)
            } else {
                x.torque * (1.0 + ((1.0 + e).powi(2) - 1.0) * load.powi(4)).max(0.01).sqrt()
            }
        })
    });
    let name = if froelich { "Froelich curve" } else { "cross-axis current" };
    Fault::new("current_saturation", name, &joints, acts, [0.3, 8.0])
}

/// Weakening current in quadrature, and a soft start of the weakening.
fn weakening(place: &Place, rng: &mut Rng) -> Fault {
    let joints = some_joints(place.arm, rng);
    let share = rng.between(0.12, 0.45);
    let quadrature = rng.chance(0.5);
    let acts = each(&joints, |i| {
        let most = place.arm.speed[i];
        let (from, width) = (share * most, 0.08 * most);
        let told = told("error", true, ("velocity", from, false));
        MotorLaw::new([0.3, 0.0], told, move |x, [e, _], _| {
            if quadrature {
                let y = ((x.w.abs() - from) / (most - from)).max(0.0);
                x.torque * (1.0 + ((1.0 + e).powi(2) - 1.0) * y * y).max(0.01).sqrt()
            } else {
                let soft = softplus((x.w.abs() - from) / width) / softplus((most - from) / width);
                x.torque * (1.0 + e * soft)
            }
        })
    });
    let name = if quadrature { "current in quadrature" } else { "soft start" };
    Fault::new("flux_weakening", name, &joints, acts, [0.2, 7.0])
}

/// Another phase order, with the inverter's dead time; a turned transformer of another ratio.
fn sign(place: &Place, rng: &mut Rng) -> Fault {
    let joints = some_joints(place.arm, rng);
    let order = rng.chance(0.5);
    let gain = rng.between(0.95, 1.05);
    let acts = each(&joints, |i| {
        let dead = 0.02 * place.arm.usual[i];
        MotorLaw::new(
            [1.0, 0.0],
            |_| vec![("flipped", 1.0, true)],
            move |x, _, _| {
                if order {
                    -x.torque - dead * (0.5 * x.torque / dead).tanh()
                } else {
                    -gain * x.torque
                }
            },
        )
    });
    let name = if order { "phase order with dead time" } else { "turned transformer" };
    Fault::new("current_sign", name, &joints, acts, [1.0, 1.0])
}

/// Two waves of the gear, and a wave that grows with the load.
fn ripple(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let waves = rng.chance(0.5);
    let orders: Vec<f64> = (0..arm.axes())
        .map(|i| {
            // Waves that the sampling shows at a third of the top rate.
            let most = (0.3 * place.rate * TAU / (0.33 * arm.speed[i])).clamp(8.0, 600.0);
            let gear = arm.ratio[i] * if rng.chance(0.5) { 2.0 } else { 1.0 };
            let geared = gear < most && rng.chance(0.6);
            if geared { gear.round() } else { rng.log_between(4.0, most).round() }
        })
        .collect();
    let phase = rng.between(0.0, TAU);
    let acts = each(&joints, |i| {
        let (order, usual) = (orders[i], arm.usual[i]);
        let told = move |[e, _]: [f64; 2]| {
            vec![("amplitude", e, waves), ("order", order, true), ("phase", phase, !waves)]
        };
        MotorLaw::new([0.06 * usual, 0.0], told, move |x, [e, _], _| {
            let turn = order * x.q - phase;
            if waves {
                x.torque + e * (turn.cos() + 0.35 * (2.0 * turn + 1.0).cos())
            } else {
                x.torque + e * (0.7 + 0.3 * x.load.abs() / usual) * turn.cos()
            }
        })
    });
    let name = if waves { "two harmonics" } else { "grows with the load" };
    Fault::new("ripple", name, &joints, acts, [0.2, 5.0])
}

/// Feedforward in the reported value, and the washed-out rate of a speed observer.
fn apparent(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let feed = rng.chance(0.5);
    let lag = rng.log_between(0.003, 0.012);
    let dry = rng.chance(0.3);
    let (side, wet) = (rng.sign(), if dry { 0.0 } else { rng.between(-0.5, 0.5) });
    let acts = each(&joints, |i| {
        let sizes = [side * 0.3 * arm.rotor[i], wet * arm.viscous[i]];
        let told = move |[e, b]: [f64; 2]| vec![("inertia", e, feed), ("viscous", b, feed)];
        MotorLaw::new(sizes, told, move |x, [e, b], memory| {
            let gain = 1.0 - (-x.now.dt / lag).exp();
            memory[0] += (if feed { x.a } else { x.w } - memory[0]) * gain;
            if feed {
                x.torque + e * memory[0] + b * x.w
            } else {
                x.torque + e * (x.w - memory[0]) / lag + b * memory[0]
            }
        })
    });
    let name = if feed { "feedforward" } else { "speed observer" };
    let fault = Fault::new("apparent_torque", name, &joints, acts, [0.2, 6.0]);
    if dry { fault.like(&["rotor_inertia"]) } else { fault }
}

/// Below this \[s\] a delay and a lag are the same: a tenth of a radian at 2 Hz.
const SMALL_LAG: f64 = 0.008;

/// A law of the signals of all joints, or of one.
fn signal(size: f64, only: Option<usize>, form: SignalForm) -> (Vec<usize>, Vec<Act>) {
    (only.into_iter().collect(), vec![Act::Signal(SignalLaw { size, only, form })])
}

fn only(place: &Place, rng: &mut Rng) -> Option<usize> {
    rng.chance(0.25).then(|| rng.below(place.arm.axes()))
}

fn delay(place: &Place, rng: &mut Rng) -> Fault {
    let only = only(place, rng);
    let (name, form) = if rng.chance(0.5) {
        ("held by a bus", SignalForm::Bus { cycle: rng.pick(&[0.004, 0.008, 0.012]) })
    } else {
        ("bus slots", SignalForm::Slots)
    };
    let (joints, acts) = signal(0.005, only, form);
    Fault::new("time_delay", name, &joints, acts, [0.4, 8.0])
}

fn lag(place: &Place, rng: &mut Rng) -> Fault {
    let only = only(place, rng);
    let (name, form) = if rng.chance(0.5) {
        ("two lags in a row", SignalForm::Cascade)
    } else {
        ("moving average", SignalForm::Average)
    };
    let (joints, acts) = signal(0.006, only, form);
    Fault::new("filter_lag", name, &joints, acts, [0.4, 10.0])
}

/// Delay and lag name each other where they are small.
pub(super) fn small_lag_equivalents(fault: Fault) -> Fault {
    let small = |act: &Act| matches!(act, Act::Signal(law) if law.size < SMALL_LAG);
    match (fault.id, fault.acts.iter().any(small)) {
        ("time_delay", true) => fault.like(&["filter_lag"]),
        ("filter_lag", true) => fault.like(&["time_delay"]),
        _ => fault,
    }
}

fn coupling(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    // Bevel gears of hollow wrists: one turn of axis 5 turns motor 6 by a fraction to a whole turn.
    let ratio = 0.3 * rng.sign();
    let mut acts = vec![Act::Coupling { from: 4, into: 5, ratio }];
    let mut name = "motor coordinates";
    if !rng.chance(0.5) {
        name = "bevel gears with loss";
        acts.push(Act::Friction(5, load_boundary(0.02, 0.3, 0.2)));
        acts.push(Act::Friction(5, carreau(0.05 * arm.viscous[5], 0.3 * arm.speed[5], 0.3)));
    }
    Fault::new("wrist_coupling", name, &[4, 5], acts, [0.1, 4.0])
}
