//! A simulated cell: a robot's program runs cycle after cycle beside machines and people.
//!
//! It writes the logs that a recorder and a meter in the cell would write, and keeps what is true:
//! what makes each wait end, when robot and signals came, what each cycle took. It examines methods that
//! tell slack from process waits and that prove a saving, so it imports nothing of the crate.
//! `docs/cell.md` describes the logs and the draws.

mod campaign;
mod cell;
mod conditions;
mod course;
mod draw;
mod law;
mod layout;
mod ledger;
mod meter;
mod random;
mod recorder;
mod run;
mod script;
mod signal;
mod spread;
#[cfg(test)]
mod tests;
mod timeline;
mod truth;

pub use campaign::{Campaign, Trouble, campaign};
pub use cell::Power;
pub use conditions::Conditions;
pub use law::Kind;
pub use layout::Plant;
pub use meter::{Meter, Unit};
pub use script::{Place, Script, Step, Variant};
pub use truth::{After, CycleTruth, Disturbance, Event, LATER_S, Run, Truth, Visit};
