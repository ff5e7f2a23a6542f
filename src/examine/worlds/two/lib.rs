//! World two: arms in closed loop. Forward dynamics of rigid links with motors, a cascaded controller
//! with feed-forward, friction with bristles, and a drive that reports filtered torques.

// Counts of rows and joints are far below 2^52, and indices come from positive times.
#![allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap
)]

pub mod api;
mod arm;
mod body_faults;
mod drive_faults;
mod everyday;
mod fault;
mod friction_faults;
mod logger;
mod model_file;
mod motion;
mod motion_case;
mod outside;
mod power;
mod power_case;
mod program;
mod rigid;
mod rng;
mod robot;
mod sample;
mod sensor;
mod setup;
mod sim;
mod state;
mod structure;
mod terms;
#[cfg(test)]
mod tests;
mod torque_case;
mod truth;

use api::{Case, Kind};
use rng::Rng;

/// Kinds with their shares \[%\].
const SHARES: [(Kind, f64); 7] = [
    (Kind::Healthy, 20.0),
    (Kind::ParametersOnly, 6.0),
    (Kind::One, 34.0),
    (Kind::Two, 10.0),
    (Kind::Outside, 12.0),
    (Kind::Power, 8.0),
    (Kind::Motion, 10.0),
];

/// Makes a case: the same arguments give the same bytes.
pub fn case(seed: u64, number: usize) -> Case {
    let mut rng = Rng::new(seed, number, "kind");
    let mut place = rng.range(0.0, 100.0);
    let mut kind = Kind::Healthy;
    for (own, share) in SHARES {
        if place >= 0.0 {
            kind = own;
        }
        place -= share;
    }
    match kind {
        Kind::Power => power_case::case(seed, number),
        Kind::Motion => motion_case::case(seed, number),
        _ => torque_case::case(seed, number, kind, None),
    }
}
