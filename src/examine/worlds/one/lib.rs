//! World one: prescribed motion of the links, Lagrange's equations in closed form, dynamic friction and
//! gear states integrated along the motion. Its emphasis is industrial arms with RV gears.

// Counts are small and times positive: casts lose nothing. Joints index several rows at once, and
// equations have letters.
#![allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::needless_range_loop,
    clippy::many_single_char_names,
    clippy::similar_names
)]

pub mod api;
mod arm;
mod bench;
mod case;
pub mod check;
mod controller;
mod design;
mod dynamics;
mod everyday;
mod faults;
mod friction;
mod law;
mod logger;
mod motion;
mod motion_case;
mod nominal;
mod plant;
mod power_case;
mod profile;
mod rng;
mod torque_case;
mod truth;

/// The case of a seed and a number: the same arguments give the same bytes.
#[must_use]
pub fn case(seed: u64, number: usize) -> api::Case {
    case::case(seed, number)
}
