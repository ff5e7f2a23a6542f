//! World three: mid-size industrial arms with coupled wrists, their logs and their faults.
//!
//! Recursive Newton-Euler with spatial vectors, friction and rotors in motor coordinates, motors in
//! electrical quantities. Units are SI throughout; the base frame's z points up.

pub mod api;
mod arm;
mod body;
mod build;
#[cfg(test)]
mod check;
mod draw_body;
mod draw_drive;
mod draw_friction;
mod drive;
mod everyday;
mod fault;
mod friction;
mod law;
mod link;
mod logfile;
mod model_file;
mod motion;
mod motion_case;
mod motor;
mod planner;
mod power;
mod power_case;
mod profile;
mod program;
mod report;
mod rng;
mod signal;
mod spatial;
mod torque_case;
mod truth;

use api::Kind;

/// Shares of the kinds of cases in per cent.
const SHARES: [(Kind, usize); 7] = [
    (Kind::Healthy, 20),
    (Kind::ParametersOnly, 6),
    (Kind::One, 34),
    (Kind::Two, 10),
    (Kind::Outside, 12),
    (Kind::Power, 8),
    (Kind::Motion, 10),
];

/// Case `number` of a seed: the same arguments give the same bytes.
#[must_use]
pub fn case(seed: u64, number: usize) -> api::Case {
    let mut ticket = rng::Rng::new(seed, number, "kind").below(100);
    for (kind, share) in SHARES {
        if ticket < share {
            return match kind {
                Kind::Power => power_case::case(seed, number),
                Kind::Motion => motion_case::case(seed, number),
                kind => torque_case::case(seed, number, kind),
            };
        }
        ticket -= share;
    }
    torque_case::case(seed, number, Kind::Healthy)
}
