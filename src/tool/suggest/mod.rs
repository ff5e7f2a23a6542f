//! Changes that a person has to approve: each one is an edit of the text, simulated in the whole cycle.
//!
//! `levers` proposes, `change` simulates, `swept` compares the space that the arm needs, and `list` ranks
//! and applies. Nothing here is a proof of the process: what a change risks is said with it.

mod change;
mod heights;
mod lever;
mod levers;
mod lines;
mod list;
mod points;
mod speeds;
mod swept;
mod zones;

pub use list::{Applied, Suggestion, Suggestions, suggestions};
