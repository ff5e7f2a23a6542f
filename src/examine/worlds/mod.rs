//! Three further simulators of robots with faults: worlds.
//!
//! Each was written from `docs/effects.md` alone. They share random numbers, files and the
//! bookkeeping of the truth; no formula of dynamics, friction, faults or filters, and no constant of
//! physics, is shared by two of them or with the rest of the crate.

mod api;
mod model;
mod one;
#[cfg(feature = "internals")]
mod plain;
mod program;
mod random;
mod table;
mod three;
mod two;

#[cfg(feature = "internals")]
use super::blind::Kind;
use super::blind::{self, Label};
#[cfg(feature = "internals")]
pub use plain::Plain;
use random::Rng;

/// A simulator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum World {
    /// Prescribed motion, states of friction and gears integrated along it.
    A,
    /// Closed loop: forward dynamics and a cascaded controller.
    B,
    /// Recursive Newton-Euler, motors in electrical quantities.
    C,
}

/// Draws of a case, and what other seeds are apart.
const ATTEMPTS: u64 = 8;
const OTHER: u64 = 0x9e37_79b9_7f4a_7c15;

/// Whether all its figures are numbers.
fn is_held(case: &api::Case) -> bool {
    case.heldout.iter().all(|of| (of.torque + of.model + of.left).is_finite())
        && case.files.iter().all(|(_, text)| !text.contains("NaN"))
}

/// The case with a number, from 1: the same arguments give the same bytes.
#[must_use]
pub fn case(world: World, seed: u64, number: usize) -> blind::Case {
    let drawn = |attempt: u64| {
        let seed = seed.wrapping_add(attempt.wrapping_mul(OTHER));
        match world {
            World::A => one::case(seed, number),
            World::B => two::case(seed, number),
            World::C => three::case(seed, number),
        }
    };
    // A robot whose controller loses it is none.
    let made = (0..ATTEMPTS).map(drawn).find(is_held).unwrap_or_else(|| drawn(ATTEMPTS));
    let name = format!("case-{number:04}");
    let mut files = made.files;
    files.push(("case.json".into(), format!("{}\n", made.options)));
    let label = Label {
        case: name.clone(),
        kind: made.kind,
        trust: made.options["trust"].as_str().unwrap_or_default().into(),
        effects: made.effects,
        place: made.place.map(|place| place.0),
        share: made.place.map(|place| place.1),
        lines: made.lines,
        heldout: made.heldout,
    };
    let mut draws = Rng::stream(seed, number, "salt");
    let salt = format!("{:016x}{:016x}", draws.bits(), draws.bits());
    blind::Case { name, files, label, salt }
}

/// A nominal robot of a world, and its torques without faults.
#[cfg(feature = "internals")]
#[must_use]
pub fn plain(world: World, seed: u64) -> Plain {
    match world {
        World::A => one::plain(seed),
        World::B => two::plain(seed),
        World::C => three::plain(seed),
    }
}

/// What the kind of a case may be.
#[cfg(feature = "internals")]
#[must_use]
pub fn kinds(seed: u64, number: usize) -> Vec<Kind> {
    match api::kind(seed, number) {
        Kind::Motion => vec![Kind::Motion, Kind::Healthy],
        kind => vec![kind],
    }
}
