//! Geometric paths: a run of movements in space and in the joints.
//!
//! A run leads from one stop point to the next. Its legs are straight lines in joint space,
//! straight lines and circular arcs of the TCP, with corner zones between them. The result is a
//! joint path q(s); s is the TCP length in m where the TCP moves.

mod arrival;
mod axiswise;
pub mod blend;
pub mod build;
pub mod curve;
pub mod joint_path;
pub mod leg;

pub use arrival::arrival;
pub use build::build;
pub use joint_path::{Extent, JointPath, Piece, PieceKind};
pub use leg::{Leg, LegKind, PathError};
