//! Random faults of motors, of reported values, of the signal path and of couplings.

use super::fault::{Act, Fault, Place, some_joints};
use super::friction::{FrictionForm, FrictionLaw};
use super::report::{ReportForm, ReportLaw};
use super::signal::{SignalForm, SignalLaw};
use crate::examine::worlds::random::Rng;
use std::f64::consts::TAU;

/// A law for each joint.
fn each(joints: &[usize], mut law: impl FnMut(usize) -> ([f64; 2], ReportForm)) -> Vec<Act> {
    let act = |i: &usize| {
        let ([size, second], form) = law(*i);
        Act::Report(*i, ReportLaw { size, second, form })
    };
    joints.iter().map(act).collect()
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

fn offset(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let side = rng.sign();
    if rng.chance(0.4) {
        let acts = each(&joints, |i| ([side * 0.05 * arm.usual[i], 0.0], ReportForm::Asymmetry));
        Fault::new("torque_offset", "asymmetric friction", &joints, acts, [0.2, 10.0])
    } else {
        let time = rng.between(20.0, 120.0);
        let acts =
            each(&joints, |i| ([side * 0.05 * arm.usual[i], 0.0], ReportForm::Zero { time }));
        Fault::new("torque_offset", "zero that wanders", &joints, acts, [0.2, 10.0])
    }
}

fn constant(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let every = rng.chance(0.12);
    let joints = if every { (0..arm.axes()).collect() } else { some_joints(arm, rng) };
    // Weaker magnets need more current: the reported torque is too large. The other sign: exchanged motors.
    let side = if rng.chance(0.7) { 1.0 } else { -1.0 };
    let bounds = if side > 0.0 { [0.15, 8.0] } else { [0.15, 5.0] };
    let fault = if rng.chance(0.5) {
        let time = rng.log_between(20.0, 300.0);
        let acts = each(&joints, |_| ([side * 0.08, 0.0], ReportForm::WarmMagnets { time }));
        Fault::new("torque_constant", "warm magnets", &joints, acts, bounds)
    } else {
        let acts = each(&joints, |i| {
            (
                [side * 0.08, 0.0],
                ReportForm::WeakPole { order: (arm.ratio[i] / 4.0).round().min(30.0) },
            )
        });
        Fault::new("torque_constant", "weak magnets of some poles", &joints, acts, bounds)
    };
    if every { fault.like(&["link_parameters"]) } else { fault }
}

fn saturation(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let froelich = rng.chance(0.5);
    let acts = each(&joints, |i| {
        let limit = arm.torque[i];
        if froelich {
            ([0.2, 0.0], ReportForm::Froelich { limit })
        } else {
            ([0.5, 0.0], ReportForm::CrossAxis { limit })
        }
    });
    let name = if froelich { "Froelich curve" } else { "cross-axis current" };
    Fault::new("current_saturation", name, &joints, acts, [0.3, 8.0])
}

fn weakening(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let share = rng.between(0.12, 0.45);
    let quadrature = rng.chance(0.5);
    let acts = each(&joints, |i| {
        let (from, most) = (share * arm.speed[i], arm.speed[i]);
        if quadrature {
            ([0.3, 0.0], ReportForm::Quadrature { from, most })
        } else {
            ([0.3, 0.0], ReportForm::SoftWeakening { from, most, width: 0.08 * most })
        }
    });
    let name = if quadrature { "current in quadrature" } else { "soft start" };
    Fault::new("flux_weakening", name, &joints, acts, [0.2, 7.0])
}

fn sign(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let order = rng.chance(0.5);
    let gain = rng.between(0.95, 1.05);
    let acts = each(&joints, |i| {
        let form = if order {
            ReportForm::PhaseOrder { dead: 0.02 * arm.usual[i] }
        } else {
            ReportForm::Turned { gain }
        };
        ([1.0, 0.0], form)
    });
    let name = if order { "phase order with dead time" } else { "turned transformer" };
    Fault::new("current_sign", name, &joints, acts, [1.0, 1.0])
}

fn ripple(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let waves = rng.chance(0.5);
    let orders: Vec<f64> = (0..arm.axes())
        .map(|i| {
            // Waves that the sampling shows at a third of the top rate.
            let most = (0.3 * place.rate * TAU / (0.33 * arm.speed[i])).clamp(8.0, 600.0);
            let gear = arm.ratio[i] * if rng.chance(0.5) { 2.0 } else { 1.0 };
            if gear < most && rng.chance(0.6) {
                gear.round()
            } else {
                rng.log_between(4.0, most).round()
            }
        })
        .collect();
    let phase = rng.between(0.0, TAU);
    let acts = each(&joints, |i| {
        let order = orders.get(i).copied().unwrap_or(12.0);
        let size = [0.06 * arm.usual[i], 0.0];
        if waves {
            (size, ReportForm::Waves { order, phase })
        } else {
            (size, ReportForm::LoadedWave { order, phase, usual: arm.usual[i] })
        }
    });
    let name = if waves { "two harmonics" } else { "grows with the load" };
    Fault::new("ripple", name, &joints, acts, [0.2, 5.0])
}

fn apparent(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let feed = rng.chance(0.5);
    let lag = rng.log_between(0.003, 0.012);
    let dry = rng.chance(0.3);
    let (side, wet) = (rng.sign(), if dry { 0.0 } else { rng.between(-0.5, 0.5) });
    let acts = each(&joints, |i| {
        let form =
            if feed { ReportForm::Feedforward { lag } } else { ReportForm::Observer { lag } };
        ([side * 0.3 * arm.rotor[i], wet * arm.viscous[i]], form)
    });
    let name = if feed { "feedforward" } else { "speed observer" };
    let fault = Fault::new("apparent_torque", name, &joints, acts, [0.2, 6.0]);
    if dry { fault.like(&["rotor_inertia"]) } else { fault }
}

/// Below this \[s\] a delay and a lag are the same: a tenth of a radian at 2 Hz.
const SMALL_LAG: f64 = 0.008;

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
    let acts = vec![Act::Signal(SignalLaw { size: 0.005, only, form })];
    let joints: Vec<usize> = only.into_iter().collect();
    Fault::new("time_delay", name, &joints, acts, [0.4, 8.0])
}

fn lag(place: &Place, rng: &mut Rng) -> Fault {
    let only = only(place, rng);
    let (name, form) = if rng.chance(0.5) {
        ("two lags in a row", SignalForm::Cascade)
    } else {
        ("moving average", SignalForm::Average)
    };
    let acts = vec![Act::Signal(SignalLaw { size: 0.006, only, form })];
    let joints: Vec<usize> = only.into_iter().collect();
    Fault::new("filter_lag", name, &joints, acts, [0.4, 10.0])
}

/// Delay and lag name each other where they are small.
pub(super) fn small_lag_equivalents(fault: Fault) -> Fault {
    let size = fault
        .acts
        .iter()
        .find_map(|act| if let Act::Signal(law) = act { Some(law.size) } else { None });
    match (fault.id, size) {
        ("time_delay", Some(size)) if size < SMALL_LAG => fault.like(&["filter_lag"]),
        ("filter_lag", Some(size)) if size < SMALL_LAG => fault.like(&["time_delay"]),
        _ => fault,
    }
}

fn coupling(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    // Bevel gears of hollow wrists: one turn of axis 5 turns motor 6 by a fraction to a whole turn.
    let ratio = 0.3 * rng.sign();
    let mut acts = vec![Act::Coupling { from: 4, into: 5, ratio }];
    if rng.chance(0.5) {
        return Fault::new("wrist_coupling", "motor coordinates", &[4, 5], acts, [0.1, 4.0]);
    }
    let form = FrictionForm::LoadBoundary { share: 0.3, speed: 0.2 };
    acts.push(Act::Friction(5, FrictionLaw { sizes: [0.02, 0.0], form }));
    let form = FrictionForm::Carreau { knee: 0.3 * arm.speed[5], power: 0.3 };
    acts.push(Act::Friction(5, FrictionLaw { sizes: [0.05 * arm.viscous[5], 0.0], form }));
    Fault::new("wrist_coupling", "bevel gears with loss", &[4, 5], acts, [0.1, 4.0])
}
