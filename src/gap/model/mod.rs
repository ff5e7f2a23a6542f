//! The model with what was found: parameters that a robot can have, and effects.

mod body_near;
mod fitted;
mod improved;
mod possible;
mod written;

pub use fitted::Fitted;
pub use improved::Improved;
pub(in crate::gap) use written::written;
