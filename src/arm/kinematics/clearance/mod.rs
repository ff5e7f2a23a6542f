//! Clearance of the arm: its capsules against planes, boxes and each other.

mod body;
mod capsule;
mod obstacle;

pub use body::Body;
pub use capsule::Capsule;
pub use obstacle::{KeepOut, Obstacle, Plane};
