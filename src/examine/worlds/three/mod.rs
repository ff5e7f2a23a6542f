//! World three: mid-size industrial arms with coupled wrists, their logs and their faults.
//!
//! Recursive Newton-Euler with spatial vectors, friction and rotors in motor coordinates, motors in
//! electrical quantities. Units are SI throughout; the base frame's z points up.

mod arm;
mod body;
mod build;
mod catalogue;
mod draw_body;
mod drive;
mod drive_faults;
mod everyday;
mod fault;
mod friction;
mod law;
mod link;
mod logfile;
mod motion;
mod motion_case;
mod motor;
mod outside;
mod planner;
mod power;
mod power_case;
mod profile;
mod program;
mod signal;
mod spatial;
#[cfg(test)]
mod tests;
mod torque_case;
mod truth;

use super::api::{self, Case, Kind};

/// Case `number` of a seed: the same arguments give the same bytes.
pub(super) fn case(seed: u64, number: usize) -> Case {
    match api::kind(seed, number) {
        Kind::Power => power_case::case(seed, number),
        Kind::Motion => motion_case::case(seed, number),
        kind => torque_case::case(seed, number, kind),
    }
}

/// A nominal robot and its torques.
#[cfg(feature = "internals")]
pub(super) fn plain(seed: u64) -> super::plain::Plain {
    let rng = &mut super::random::Rng::stream(seed, 0, "plain");
    let arm = build::nominal(rng, 0, false);
    super::plain::Plain::new(&arm.sheet(), rng, |[q, v, a], rotors| {
        let at = spatial::Point { q: *q, v: *v, a: *a };
        arm.model(&at, rotors == super::plain::Rotors::With)
    })
}
