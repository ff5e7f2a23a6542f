//! Which effects explain the logs.

mod search;
mod shape;
mod window;

pub use search::{Candidate, Found, Search};
