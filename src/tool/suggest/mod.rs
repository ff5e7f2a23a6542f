//! Changes that a person has to approve: each one is an edit of the text, simulated in the whole cycle.
//!
//! `levers` proposes, `change` simulates, `swept` compares the space that the arm needs, and `list` ranks
//! and applies. Nothing here is a proof of the process: what a change risks is said with it.

mod accelerations;
mod change;
mod configurations;
mod heights;
mod lever;
mod levers;
mod lines;
mod list;
mod orders;
mod points;
mod search;
mod speeds;
mod swept;
mod zones;

pub use list::{Applied, Suggestion, Suggestions, suggestions};
