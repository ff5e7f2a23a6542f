//! Random faults of friction and rotors, in motor coordinates: their laws and usual sizes.

use super::fault::{Act, Fault, Place, some_joints};
use super::law::{MotorLaw, Parameter, Seen, softplus, step, stop};
use crate::examine::worlds::random::Rng;
use std::f64::consts::{E, FRAC_2_PI, TAU};

/// A law for each joint.
fn each(joints: &[usize], mut law: impl FnMut(usize) -> MotorLaw) -> Vec<Act> {
    joints.iter().map(|i| Act::Friction(*i, law(*i))).collect()
}

/// Names of the sizes, and whether they are graded.
fn dry_and_wet(dry: bool, wet: bool) -> impl Fn([f64; 2]) -> Vec<Parameter> {
    move |[a, b]| vec![("coulomb", a, dry), ("viscous", b, wet)]
}

/// The name of the first size.
fn first(name: &'static str, graded: bool) -> impl Fn([f64; 2]) -> Vec<Parameter> {
    move |[a, _]| vec![(name, a, graded)]
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

/// A mixture of tanh (C. Makkar et al., 2005), and a bristle with grease that thins in shear.
fn level(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let up = if rng.chance(0.75) { 1.0 } else { -1.0 };
    let dry_only = rng.chance(0.3);
    let wet = if dry_only { 0.0 } else { rng.between(0.3, 1.0) };
    let bounds = if up > 0.0 { [0.05, 8.0] } else { [0.05, 1.6] };
    let like: &[&'static str] = if dry_only && up > 0.0 { &["brake_drag"] } else { &[] };
    let fault = if rng.chance(0.5) {
        let (mix, slow) = (rng.between(0.75, 0.95), rng.between(0.03, 0.1));
        let acts = each(&joints, |i| {
            let slow = slow * arm.speed[i];
            let sizes = [up * 0.5 * arm.coulomb[i], up * 0.5 * wet * arm.viscous[i]];
            MotorLaw::new(sizes, dry_and_wet(true, true), move |x, [a, b], _| {
                a * (mix * (x.w / 0.008).tanh() + (1.0 - mix) * (x.w / slow).tanh()) + b * x.w
            })
        });
        Fault::new("friction_level", "tanh mixture", &joints, acts, bounds)
    } else {
        let (knee, distance) = (rng.between(0.2, 0.6), rng.log_between(2e-4, 3e-3));
        let acts = each(&joints, |i| {
            let knee = knee * arm.speed[i];
            let sizes = [up * 0.5 * arm.coulomb[i], up * 0.8 * wet * arm.viscous[i]];
            MotorLaw::new(sizes, dry_and_wet(true, false), move |x, [a, b], memory| {
                memory[0] = stop(memory[0], x.w * x.now.dt / distance);
                a * memory[0] + b * x.w / (1.0 + x.w.abs() / knee).powf(0.4)
            })
        });
        let form = "bristle and shear-thinning grease";
        Fault::new("friction_level", form, &joints, acts, bounds)
    };
    fault.like(like)
}

/// `a s/(1+(|w|/speed)^power)` (D. Hess, A. Soom, J. Tribology 112, 1990) and
/// `a (tanh(w/fast) − tanh(w/slow))` (C. Makkar et al., AIM 2005).
fn stribeck(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let speed = rng.log_between(0.012, 0.15);
    if rng.chance(0.5) {
        let power = rng.between(0.8, 3.0);
        // The speed at which 1/e is left: (speed_e/speed)^power = e − 1.
        let third = speed * (E - 1.0).powf(1.0 / power);
        let acts = each(&joints, |i| {
            let told =
                move |[a, _]: [f64; 2]| vec![("stiction", a, true), ("velocity", third, true)];
            MotorLaw::new([0.5 * arm.coulomb[i], 0.0], told, move |x, [a, _], _| {
                a * x.sign / (1.0 + (x.w.abs() / speed).powf(power))
            })
        });
        Fault::new("stribeck", "rational curve", &joints, acts, [0.1, 4.0])
    } else {
        let (fast, slow) = (speed * rng.between(0.1, 0.3), 2.0 * speed);
        let acts = each(&joints, |i| {
            let told =
                move |[a, _]: [f64; 2]| vec![("stiction", a, false), ("velocity", slow, false)];
            MotorLaw::new([0.7 * arm.coulomb[i], 0.0], told, move |x, [a, _], _| {
                a * ((x.w / fast).tanh() - (x.w / slow).tanh())
            })
        });
        Fault::new("stribeck", "difference of tanh", &joints, acts, [0.1, 4.0])
    }
}

/// Carreau fluid `a w/(1+(w/knee)²)^power`; faults outside the library use it, too.
pub(super) fn carreau(size: f64, knee: f64, power: f64) -> MotorLaw {
    let told = move |[a, _]: [f64; 2]| {
        vec![("coefficient", a, false), ("exponent", 1.0 - 2.0 * power, false)]
    };
    MotorLaw::new([size, 0.0], told, move |x, [a, _], _| {
        a * x.w / (1.0 + (x.w / knee).powi(2)).powf(power)
    })
}

fn nonlinear(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let share = rng.between(0.08, 0.3);
    let ticket = rng.below(3);
    let power = rng.between(0.3, 0.45);
    let name = ["Carreau fluid", "Eyring fluid", "churning above a rate"][ticket];
    let acts = each(&joints, |i| {
        let fastest = arm.speed[i];
        match ticket {
            0 => carreau(0.8 * arm.viscous[i], share * fastest, power),
            1 => {
                let knee = 0.4 * share * fastest;
                let told = move |[a, _]: [f64; 2]| {
                    vec![("coefficient", a * (1.0 / knee).asinh(), false), ("exponent", 0.4, false)]
                };
                MotorLaw::new([0.2 * arm.coulomb[i], 0.0], told, move |x, [a, _], _| {
                    a * (x.w / knee).asinh()
                })
            }
            _ => {
                let (from, width) = ((share + 0.1) * fastest, 0.06 * fastest);
                let told =
                    |[a, _]: [f64; 2]| vec![("coefficient", a, false), ("exponent", 2.0, false)];
                MotorLaw::new([0.2 * arm.coulomb[i], 0.0], told, move |x, [a, _], _| {
                    a * softplus((x.w.abs() - from) / width) * x.sign
                })
            }
        }
    });
    Fault::new("nonlinear_viscous", name, &joints, acts, [0.05, 8.0])
}

/// `a w tanh(w/speed)`, and a seal that drags forwards only.
fn asymmetry(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let side = rng.sign();
    if rng.chance(0.5) {
        let speed = rng.between(0.05, 0.2);
        let acts = each(&joints, |i| {
            let sizes = [side * 0.3 * arm.viscous[i], 0.0];
            MotorLaw::new(sizes, first("asymmetry", true), move |x, [a, _], _| {
                a * x.w * (x.w / speed).tanh()
            })
        });
        Fault::new("viscous_asymmetry", "smooth modulus", &joints, acts, [0.1, 6.0])
    } else {
        let knee = rng.between(0.3, 0.8);
        let acts = each(&joints, |i| {
            let (knee, sizes) = (knee * arm.speed[i], [0.4 * arm.viscous[i], 0.0]);
            MotorLaw::new(sizes, first("asymmetry", false), move |x, [a, _], _| {
                let forwards = x.w.max(0.0);
                2.0 * a * forwards / (1.0 + forwards / knee).powf(0.3)
            })
        });
        Fault::new("viscous_asymmetry", "seal that drags one way", &joints, acts, [0.1, 6.0])
    }
}

/// `a |L| s (1 + share/(1+(|w|/speed)²))` (P. Hamon et al., 2010, with boundary lubrication).
pub(super) fn load_boundary(size: f64, share: f64, speed: f64) -> MotorLaw {
    MotorLaw::new([size, 0.0], first("mu", true), move |x, [a, _], _| {
        a * x.load.abs() * x.sign * (1.0 + share / (1.0 + (x.w / speed).powi(2)))
    })
}

fn loaded(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let fault = if rng.chance(0.5) {
        let (share, speed) = (rng.between(0.1, 0.5), rng.log_between(0.02, 0.2));
        let acts = each(&joints, |_| load_boundary(0.05, share, speed));
        Fault::new("load_friction", "boundary lubrication", &joints, acts, [0.2, 7.0])
    } else {
        let power = rng.between(0.6, 0.85);
        let acts = each(&joints, |i| {
            let reference = arm.usual[i];
            MotorLaw::new([0.05, 0.0], first("mu", false), move |x, [a, _], _| {
                a * reference * (x.load.abs() / reference).powf(power) * x.sign
            })
        });
        Fault::new("load_friction", "Hertz contact", &joints, acts, [0.2, 7.0])
    };
    fault.like(&["gear_efficiency"])
}

/// `(b + (a−b) σ(L w/width)) |L| s`, and a hard change with more loss at low rates.
fn efficiency(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let motoring = rng.between(0.02, 0.08);
    let sizes = [motoring, motoring * rng.between(1.4, 3.0)];
    let told = |graded: bool| {
        move |[a, b]: [f64; 2]| vec![("motoring", a, graded), ("generating", b, graded)]
    };
    if rng.chance(0.5) {
        let width = rng.between(0.005, 0.03);
        let acts = each(&joints, |i| {
            let width = width * arm.usual[i] * arm.speed[i];
            MotorLaw::new(sizes, told(true), move |x, [a, b], _| {
                (b + (a - b) * step(x.load * x.w / width)) * x.load.abs() * x.sign
            })
        });
        let form = "smooth change of the direction of power";
        Fault::new("gear_efficiency", form, &joints, acts, [0.2, 4.0])
    } else {
        let speed = rng.log_between(0.05, 0.3);
        let acts = each(&joints, |_| {
            MotorLaw::new(sizes, told(false), move |x, [a, b], _| {
                let share = if x.load * x.w > 0.0 { a } else { b };
                share * (1.0 + 0.4 / (1.0 + x.w.abs() / speed)) * x.load.abs() * x.sign
            })
        });
        Fault::new("gear_efficiency", "mesh worse at low rates", &joints, acts, [0.2, 4.0])
    }
}

/// A temperature θ̇ = (1−θ)/time, faster when the joint runs, with `e^{−κθ}`; and conduction into a
/// large housing.
fn warm_up(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = if rng.chance(0.4) { (0..arm.axes()).collect() } else { some_joints(arm, rng) };
    let time = place.length * rng.log_between(0.2, 1.2);
    let wet = rng.between(0.5, 1.5);
    let sizes = |i: usize| [0.5 * arm.coulomb[i], 0.5 * wet * arm.viscous[i]];
    let told = |time: f64| {
        move |[a, b]: [f64; 2]| {
            vec![("coulomb", a, true), ("viscous", b, true), ("time_constant", time, false)]
        }
    };
    if rng.chance(0.5) {
        let (kappa, time) = (rng.between(1.0, 3.0), 0.6 * time);
        let acts = each(&joints, |i| {
            let speed = 0.3 * arm.speed[i];
            MotorLaw::new(sizes(i), told(time), move |x, [a, b], memory| {
                let heating = 0.4 + 0.6 * (x.w.abs() / speed).min(1.0);
                memory[0] += (1.0 - memory[0]) * heating * x.now.dt / time;
                let factor = ((-kappa * memory[0]).exp() - (-kappa).exp()) / (1.0 - (-kappa).exp());
                (a * x.sign + b * x.w) * factor
            })
        });
        let form = "heat balance with exponential viscosity";
        Fault::new("warm_up", form, &joints, acts, [0.1, 6.0])
    } else {
        let time = 1.3 * time;
        let acts = each(&joints, |i| {
            MotorLaw::new(sizes(i), told(time), move |x, [a, b], _| {
                (a * x.sign + b * x.w) / (1.0 + x.now.time / time).powf(1.5)
            })
        });
        Fault::new("warm_up", "conduction into the housing", &joints, acts, [0.1, 6.0])
    }
}

/// A tight place (von Mises) and a triangular wave over the turn.
fn position(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let spot = rng.chance(0.5);
    let kappa = rng.log_between(1.5, 12.0);
    let at: Vec<f64> = (0..arm.axes())
        .map(|i| (arm.middle[i] + arm.span[i] * rng.between(-0.7, 0.7)).rem_euclid(TAU))
        .collect();
    let acts = each(&joints, |i| {
        let (phase, sizes) = (at[i], [0.6 * arm.coulomb[i], 0.0]);
        let amplitude = if spot { 0.5 * (1.0 - (-2.0 * kappa).exp()) } else { 1.0 };
        let told = move |[a, _]: [f64; 2]| {
            vec![("amplitude", amplitude * a, !spot), ("phase", phase, true)]
        };
        MotorLaw::new(sizes, told, move |x, [a, _], _| {
            if spot {
                a * (kappa * ((x.q - phase).cos() - 1.0)).exp() * x.sign
            } else {
                a * FRAC_2_PI * (0.999 * (x.q - phase).cos()).asin() * x.sign
            }
        })
    });
    let name = if spot { "tight spot" } else { "triangular wave" };
    Fault::new("position_friction", name, &joints, acts, [0.1, 5.0])
}

/// Three stops of the distances a/2, a, 2a (F. Al-Bender et al., GMS, 2005), and
/// `(1+β) z₁ − β z₂` of the distances a and 5a (P.-A. Bliman, M. Sorine, 1995), each less the sign.
fn presliding(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let slip = rng.chance(0.5);
    let beta = rng.between(0.1, 0.5);
    let acts = each(&joints, |i| {
        let coulomb = arm.coulomb[i];
        let maxwell = move |x: &Seen, a: f64, memory: &mut [f64; 4]| {
            let mut sum = 0.0;
            for (state, factor) in memory.iter_mut().zip([0.5, 1.0, 2.0]) {
                *state = stop(*state, x.w * x.now.dt / (a * factor));
                sum += *state / 3.0;
            }
            coulomb * (sum - x.sign)
        };
        let bliman = move |x: &Seen, a: f64, memory: &mut [f64; 4]| {
            for (state, factor) in memory.iter_mut().zip([1.0, 5.0]) {
                // Exact over the step: z goes to the sign of the rate with e^{−|Δq|/distance}.
                let keep = (-x.w.abs() * x.now.dt / (a * factor)).exp();
                *state = x.w.signum() + (*state - x.w.signum()) * keep;
            }
            coulomb * ((1.0 + beta) * memory[0] - beta * memory[1] - x.sign)
        };
        MotorLaw::new([0.01, 0.0], first("distance", false), move |x, [a, _], memory| {
            if slip { maxwell(x, a, memory) } else { bliman(x, a, memory) }
        })
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

/// A disc with runout, and a lining that glazes.
fn brake(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = rng.choose(&(0..arm.axes()).collect::<Vec<_>>(), 1);
    let windowed = rng.chance(0.6);
    let mut fault = if rng.chance(0.5) {
        let (order, phase) = (arm.ratio[0].round().min(24.0), rng.between(0.0, TAU));
        let acts = each(&joints, |i| {
            let sizes = [0.8 * arm.coulomb[i], 0.0];
            MotorLaw::new(sizes, first("drag", true), move |x, [a, _], _| {
                a * (1.0 + 0.25 * (order * x.q - phase).cos()) * (x.w / 0.02).tanh()
            })
        });
        Fault::new("brake_drag", "disc with runout", &joints, acts, [0.1, 6.0])
    } else {
        let speed = rng.between(0.05, 0.3);
        let acts = each(&joints, |i| {
            let sizes = [0.8 * arm.coulomb[i], 0.0];
            MotorLaw::new(sizes, first("drag", false), move |x, [a, _], _| {
                a * (0.8 + 0.45 / (1.0 + x.w.abs() / speed)) * x.sign
            })
        });
        Fault::new("brake_drag", "lining that grips at low rates", &joints, acts, [0.1, 6.0])
    };
    if windowed {
        fault.window = Some(window(place, rng));
        return fault;
    }
    fault.like(&["friction_level"])
}

/// Another rotor with a little unbalance, and a disc behind a lag.
fn rotor(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joints = some_joints(arm, rng);
    let up = rng.sign();
    let bounds = if up > 0.0 { [0.1, 6.0] } else { [0.1, 2.5] };
    let fault = if rng.chance(0.5) {
        let phase = rng.between(0.0, TAU);
        let acts = each(&joints, |i| {
            let order = (arm.ratio[i] / 3.0).round().min(40.0);
            let sizes = [up * 0.3 * arm.rotor[i], 0.01 * arm.coulomb[i]];
            MotorLaw::new(sizes, first("inertia", true), move |x, [a, b], _| {
                a * x.a + b * (order * x.q + phase).sin()
            })
        });
        Fault::new("rotor_inertia", "rotor with unbalance", &joints, acts, bounds)
    } else {
        let lag = rng.log_between(0.004, 0.015);
        let acts = each(&joints, |i| {
            let sizes = [up * 0.3 * arm.rotor[i], 0.0];
            MotorLaw::new(sizes, first("inertia", false), move |x, [a, _], memory| {
                memory[0] += (x.a - memory[0]) * (1.0 - (-x.now.dt / lag).exp());
                a * memory[0]
            })
        });
        Fault::new("rotor_inertia", "disc on a soft coupling", &joints, acts, bounds)
    };
    // The first two axes' rotors are grouped with the links (M. Gautier, W. Khalil, 1990).
    let fault = fault.like(&["apparent_torque"]);
    if fault.joints.iter().all(|i| *i < 2) { fault.like(&["link_parameters"]) } else { fault }
}
