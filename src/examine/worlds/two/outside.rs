//! Draws faults that no library of effects has.

use crate::examine::worlds::model::V3;
use std::f64::consts::TAU;

use super::arm::block;
use super::drive_faults::of_path;
use super::fault::{Action, Fault, Ground};
use super::sensor::Kind;
use super::structure::Change;
use super::terms::{Law, Term};
use crate::examine::worlds::random::Rng;

/// Number of different faults.
const COUNT: usize = 14;
/// How many of them are torques at a joint; the others are of the path and of bodies.
const TERMS: usize = 7;

/// Draws one.
pub(super) fn draw(g: &Ground, rng: &mut Rng) -> Fault {
    let which = rng.below(COUNT);
    let i = rng.below(g.n());
    if which < TERMS { term(which, i, g, rng) } else { other(which, i, g, rng) }
}

fn term(which: usize, i: usize, g: &Ground, rng: &mut Rng) -> Fault {
    let size = 1.5 * g.torque(i, rng);
    let other = (i + 1 + rng.below(g.n() - 1)) % g.n();
    let s = g.scale;
    let place = s.middle[other] + 0.4 * s.width[other] * rng.between(-1.0, 1.0);
    let (name, law, p): (&str, Law, Vec<f64>) = match which {
        0 => (
            "friction that depends on another joint's angle",
            Law::CrossFriction,
            vec![size, other as f64, place, 0.2 * s.width[other]],
        ),
        1 => (
            "drag by another joint's speed",
            Law::CrossDrag,
            vec![2.0 * size / s.rate[other], other as f64, s.rate[i]],
        ),
        2 => {
            let wave = TAU * rng.between(4.0, 9.0);
            let inertia = (1.3 * size / s.acceleration[i]).min(2.0 * g.robot.arm.rotor[i]);
            ("oscillator on the link", Law::Mode, vec![inertia, wave, rng.between(0.01, 0.04)])
        }
        3 => {
            let top = 1.8 * s.acceleration[i];
            ("torque of the cubed acceleration", Law::CubedAcceleration, vec![size, top])
        }
        4 => {
            let turn = TAU / rng.pick(&[2.0, 3.0, 4.0, 6.0]);
            let width = rng.between(0.03, 0.08);
            let from = s.middle[i] + 0.5 * s.width[i] * rng.between(-1.0, 1.0);
            ("broken tooth", Law::Tooth, vec![3.0 * size, from, width, turn])
        }
        5 => {
            let time = g.period * rng.between(0.15, 0.6);
            ("friction that switches at random", Law::Telegraph, vec![1.5 * size, time])
        }
        _ => (
            "breakaway that grows with rest",
            Law::Dwell,
            vec![3.0 * size, 0.2, rng.between(0.05, 0.2)],
        ),
    };
    Fault::new("outside", name, &[i], Action::Terms(vec![Term::new(i, law, &p)]))
}

fn other(which: usize, i: usize, g: &Ground, rng: &mut Rng) -> Fault {
    let s = g.scale;
    if which == TERMS {
        return slide(g, rng);
    }
    let share = rng.log_between(0.05, 0.6);
    let (form, p): ((&str, Kind), [f64; 3]) = match which - TERMS {
        1 => (
            ("reported torque is clipped", Kind::Clip),
            [s.peak[i] * (1.0 - 0.2 - share).max(0.25), 0.0, 0.0],
        ),
        2 => (("dead band of the amplifier", Kind::DeadBand), [share * s.torque[i], 0.0, 0.0]),
        3 => (("hum of the supply", Kind::Hum), [0.7 * share, rng.between(0.3, 3.0), 0.0]),
        4 => {
            // The noise is largest a quarter turn further.
            let angle = s.middle[i] + rng.between(-0.5, 0.5) * s.width[i] - 0.25 * TAU;
            (
                ("noise that depends on the angle", Kind::PlacedNoise),
                [share * s.torque[i], angle, 0.0],
            )
        }
        5 => {
            (("hysteresis of the torque sensor", Kind::Play), [0.7 * share * s.torque[i], 0.0, 0.0])
        }
        _ => {
            let time = rng.between(0.1, 0.4);
            (("samples that freeze", Kind::Frozen), [time, rng.between(0.8, 4.0), 0.0])
        }
    };
    let joints = [i];
    of_path("outside", form, g, &joints, &mut |_| p)
}

fn slide(g: &Ground, rng: &mut Rng) -> Fault {
    let link = 1 + rng.below(g.n() - 1);
    let mass = rng.between(0.15, 0.7) * g.robot.size.payload;
    let half = rng.between(0.06, 0.15) * g.robot.size.reach;
    let edge = (mass / 5000.0).cbrt();
    let com = g.robot.arm.bodies.get(link).map_or_else(V3::zeros, |body| body.com);
    let way = rng.normals();
    let change = Change::Slide {
        link,
        body: block(mass, com, V3::repeat(edge)),
        rail: way / way.norm().max(1e-6) * half,
        place: 0.0,
    };
    Fault::new("outside", "mass that slides", &[link], Action::Body(vec![change]))
}
