//! The model with what was found: parameters that a robot can have, and effects.

mod body_near;
mod fitted;
mod improved;
mod possible;

pub use fitted::Fitted;
pub use improved::Improved;
