//! What recorded waits allow: how much later the robot may come to which wait.
//!
//! A slack is used up only between the event from which the machine's time counts and the wait, and only
//! so far that few enough of the recorded cycles would have become longer.

mod place;
mod plan;
mod risk;

pub use plan::{Planned, SlackError, Use, plan};
pub use risk::{allowed, needed};
