//! Geometric paths: what a run of movements looks like in space and in the joints.
//!
//! A run goes from one stop point to the next. Its legs are straight lines in
//! joint space, straight lines and circular arcs of the TCP; corner zones round
//! the points between them. The result is one twice differentiable joint path
//! q(s); s measures TCP length in m where the TCP moves.

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
