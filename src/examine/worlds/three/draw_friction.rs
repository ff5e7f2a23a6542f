//! Random faults of friction and rotors.

use super::fault::{Act, Fault, Place, some_joints};
use super::friction::{FrictionForm, FrictionLaw};
use crate::examine::worlds::random::Rng;
use std::f64::consts::TAU;

/// A law for each joint.
fn each(joints: &[usize], mut law: impl FnMut(usize) -> ([f64; 2], FrictionForm)) -> Vec<Act> {
    let act = |i: &usize| {
        let (sizes, form) = law(*i);
        Act::Friction(*i, FrictionLaw { sizes, form })
    };
    joints.iter().map(act).collect()
}

/// A fault of friction or rotors; sizes are those of usual wear, to be scaled.
pub(super) fn draw(id: &'static str, place: &Place, rng: &mut Rng) -> Option<Fault> {
    match id {
        "friction_level" => Some(level(place, rng)),
        "stribeck" => Some(stribeck(place, rng)),
        "nonlinear_viscous" => Some(nonlinear(place, rng)),
        "viscous_asymmetry" => Some(asymmetry(place, rng)),
        "load_friction" => Some(loaded(place, rng)),
        "gear_efficiency" => Some(efficiency(place, rng)),
        "warm_up" => Some(warm_up(place, rng)),
        "position_friction" => Some(position(place, rng)),
        "presliding" => Some(presliding(place, rng)),
        "brake_drag" => Some(brake(place, rng)),
        "rotor_inertia" => Some(rotor(place, rng)),
        _ => None,
    }
}

fn level(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let up = if rng.chance(0.75) { 1.0 } else { -1.0 };
    let dry_only = rng.chance(0.3);
    let wet = if dry_only { 0.0 } else { rng.between(0.3, 1.0) };
    let bounds = if up > 0.0 { [0.05, 8.0] } else { [0.05, 1.6] };
    let like: &[&'static str] = if dry_only && up > 0.0 { &["brake_drag"] } else { &[] };
    if rng.chance(0.5) {
        let (mix, slow) = (rng.between(0.75, 0.95), rng.between(0.03, 0.1));
        let acts = each(&joints, |i| {
            let form = FrictionForm::Mixture { fast: 0.008, slow: slow * arm.speed[i], mix };
            ([up * 0.5 * arm.coulomb[i], up * 0.5 * wet * arm.viscous[i]], form)
        });
        Fault::new("friction_level", "tanh mixture", &joints, acts, bounds).like(like)
    } else {
        let (knee, distance) = (rng.between(0.2, 0.6), rng.log_between(2e-4, 3e-3));
        let acts = each(&joints, |i| {
            let form = FrictionForm::Grease { knee: knee * arm.speed[i], distance };
            ([up * 0.5 * arm.coulomb[i], up * 0.8 * wet * arm.viscous[i]], form)
        });
        Fault::new("friction_level", "bristle and shear-thinning grease", &joints, acts, bounds)
            .like(like)
    }
}

fn stribeck(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let speed = rng.log_between(0.012, 0.15);
    if rng.chance(0.5) {
        let power = rng.between(0.8, 3.0);
        let acts = each(&joints, |i| {
            ([0.5 * arm.coulomb[i], 0.0], FrictionForm::Rational { speed, power })
        });
        Fault::new("stribeck", "rational curve", &joints, acts, [0.1, 4.0])
    } else {
        let fast = speed * rng.between(0.1, 0.3);
        let acts = each(&joints, |i| {
            ([0.7 * arm.coulomb[i], 0.0], FrictionForm::Makkar { fast, slow: 2.0 * speed })
        });
        Fault::new("stribeck", "difference of tanh", &joints, acts, [0.1, 4.0])
    }
}

fn nonlinear(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let share = rng.between(0.08, 0.3);
    let ticket = rng.below(3);
    let power = rng.between(0.3, 0.45);
    let form = |i: usize| {
        let fastest = arm.speed[i];
        match ticket {
            0 => (
                [0.8 * arm.viscous[i], 0.0],
                FrictionForm::Carreau { knee: share * fastest, power },
            ),
            1 => {
                ([0.2 * arm.coulomb[i], 0.0], FrictionForm::Eyring { knee: 0.4 * share * fastest })
            }
            _ => {
                let from = (share + 0.1) * fastest;
                (
                    [0.2 * arm.coulomb[i], 0.0],
                    FrictionForm::Churning { from, width: 0.06 * fastest },
                )
            }
        }
    };
    let name = ["Carreau fluid", "Eyring fluid", "churning above a rate"][ticket];
    let acts = each(&joints, form);
    Fault::new("nonlinear_viscous", name, &joints, acts, [0.05, 8.0])
}

fn asymmetry(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let side = rng.sign();
    if rng.chance(0.5) {
        let speed = rng.between(0.05, 0.2);
        let acts = each(&joints, |i| {
            ([side * 0.3 * arm.viscous[i], 0.0], FrictionForm::Asymmetric { speed })
        });
        Fault::new("viscous_asymmetry", "smooth modulus", &joints, acts, [0.1, 6.0])
    } else {
        let knee = rng.between(0.3, 0.8);
        let acts = each(&joints, |i| {
            ([0.4 * arm.viscous[i], 0.0], FrictionForm::OneWay { knee: knee * arm.speed[i] })
        });
        Fault::new("viscous_asymmetry", "seal that drags one way", &joints, acts, [0.1, 6.0])
    }
}

fn loaded(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let fault = if rng.chance(0.5) {
        let (share, speed) = (rng.between(0.1, 0.5), rng.log_between(0.02, 0.2));
        let acts = each(&joints, |_| ([0.05, 0.0], FrictionForm::LoadBoundary { share, speed }));
        Fault::new("load_friction", "boundary lubrication", &joints, acts, [0.2, 7.0])
    } else {
        let power = rng.between(0.6, 0.85);
        let acts = each(&joints, |i| {
            ([0.05, 0.0], FrictionForm::LoadHertz { reference: arm.usual[i], power })
        });
        Fault::new("load_friction", "Hertz contact", &joints, acts, [0.2, 7.0])
    };
    fault.like(&["gear_efficiency"])
}

fn efficiency(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let motoring = rng.between(0.02, 0.08);
    let generating = motoring * rng.between(1.4, 3.0);
    if rng.chance(0.5) {
        let width = rng.between(0.005, 0.03);
        let acts = each(&joints, |i| {
            let form = FrictionForm::Efficiency { width: width * arm.usual[i] * arm.speed[i] };
            ([motoring, generating], form)
        });
        Fault::new(
            "gear_efficiency",
            "smooth change of the direction of power",
            &joints,
            acts,
            [0.2, 4.0],
        )
    } else {
        let speed = rng.log_between(0.05, 0.3);
        let acts = each(&joints, |_| ([motoring, generating], FrictionForm::Mesh { speed }));
        Fault::new("gear_efficiency", "mesh worse at low rates", &joints, acts, [0.2, 4.0])
    }
}

fn warm_up(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = if rng.chance(0.4) { (0..arm.axes()).collect() } else { some_joints(arm, rng) };
    let time = place.length * rng.log_between(0.2, 1.2);
    let wet = rng.between(0.5, 1.5);
    let sizes = |i: usize| [0.5 * arm.coulomb[i], 0.5 * wet * arm.viscous[i]];
    if rng.chance(0.5) {
        let kappa = rng.between(1.0, 3.0);
        let acts = each(&joints, |i| {
            let speed = 0.3 * arm.speed[i];
            (sizes(i), FrictionForm::Thermal { time: 0.6 * time, kappa, speed })
        });
        Fault::new("warm_up", "heat balance with exponential viscosity", &joints, acts, [0.1, 6.0])
    } else {
        let acts = each(&joints, |i| (sizes(i), FrictionForm::Housing { time: 1.3 * time }));
        Fault::new("warm_up", "conduction into the housing", &joints, acts, [0.1, 6.0])
    }
}

fn position(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let spot = rng.chance(0.5);
    let kappa = rng.log_between(1.5, 12.0);
    let at: Vec<f64> = (0..arm.axes())
        .map(|i| (arm.middle[i] + arm.span[i] * rng.between(-0.7, 0.7)).rem_euclid(TAU))
        .collect();
    let acts = each(&joints, |i| {
        let phase = at.get(i).copied().unwrap_or(0.0);
        let form = if spot {
            FrictionForm::TightSpot { phase, kappa }
        } else {
            FrictionForm::Triangle { phase }
        };
        ([0.6 * arm.coulomb[i], 0.0], form)
    });
    let name = if spot { "tight spot" } else { "triangular wave" };
    Fault::new("position_friction", name, &joints, acts, [0.1, 5.0])
}

fn presliding(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let slip = rng.chance(0.5);
    let beta = rng.between(0.1, 0.5);
    let acts = each(&joints, |i| {
        let coulomb = arm.coulomb[i];
        let form = if slip {
            FrictionForm::MaxwellSlip { coulomb }
        } else {
            FrictionForm::Bliman { coulomb, beta }
        };
        ([0.01, 0.0], form)
    });
    let name = if slip { "generalised Maxwell slip" } else { "Bliman-Sorine of second order" };
    Fault::new("presliding", name, &joints, acts, [0.03, 15.0])
}

/// A window of a period \[s\].
pub(super) fn window(place: &Place, rng: &mut Rng) -> [f64; 2] {
    let length = place.period * rng.between(0.12, 0.4);
    let from = rng.between(0.05, 0.9) * (place.period - length);
    [from, from + length]
}

fn brake(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = rng.choose(&(0..arm.axes()).collect::<Vec<_>>(), 1);
    let windowed = rng.chance(0.6);
    let mut fault = if rng.chance(0.5) {
        let (order, phase) = (arm.ratio[0].round().min(24.0), rng.between(0.0, TAU));
        let acts =
            each(&joints, |i| ([0.8 * arm.coulomb[i], 0.0], FrictionForm::Disc { order, phase }));
        Fault::new("brake_drag", "disc with runout", &joints, acts, [0.1, 6.0])
    } else {
        let speed = rng.between(0.05, 0.3);
        let acts = each(&joints, |i| ([0.8 * arm.coulomb[i], 0.0], FrictionForm::Lining { speed }));
        Fault::new("brake_drag", "lining that grips at low rates", &joints, acts, [0.1, 6.0])
    };
    if windowed {
        fault.window = Some(window(place, rng));
        return fault;
    }
    fault.like(&["friction_level"])
}

fn rotor(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let up = rng.sign();
    let bounds = if up > 0.0 { [0.1, 6.0] } else { [0.1, 2.5] };
    let fault = if rng.chance(0.5) {
        let phase = rng.between(0.0, TAU);
        let acts = each(&joints, |i| {
            let order = (arm.ratio[i] / 3.0).round().min(40.0);
            (
                [up * 0.3 * arm.rotor[i], 0.01 * arm.coulomb[i]],
                FrictionForm::Unbalance { order, phase },
            )
        });
        Fault::new("rotor_inertia", "rotor with unbalance", &joints, acts, bounds)
    } else {
        let lag = rng.log_between(0.004, 0.015);
        let acts =
            each(&joints, |i| ([up * 0.3 * arm.rotor[i], 0.0], FrictionForm::SoftDisc { lag }));
        Fault::new("rotor_inertia", "disc on a soft coupling", &joints, acts, bounds)
    };
    // The first two axes' rotors are grouped with the links (M. Gautier, W. Khalil, 1990).
    let fault = fault.like(&["apparent_torque"]);
    if fault.joints.iter().all(|i| *i < 2) { fault.like(&["link_parameters"]) } else { fault }
}
