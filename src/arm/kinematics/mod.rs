//! Kinematics, independent of RAPID: forward and inverse kinematics, configurations, Jacobians,
//! singularities, position limits, clearance of the arm.
//!
//! Poses are those of tool0 in the base frame: base z up along axis 1, x forward; tool0 z out of
//! the flange, x down at joint angles 0.

mod clearance;
mod closed_form;
mod conf;
mod error;
mod fk;
mod inverse;
mod jacobian;
mod limits;
mod numeric;
mod offset_wrist;
mod radical_inverse;
mod select;
mod singularity;
mod tcp;

pub use clearance::{Body, Capsule, KeepOut, Obstacle, Plane};
pub use conf::{Conf, conf_of};
pub use error::{IkError, LimitViolation, Side};
pub use fk::fk;
pub use inverse::ik_all;
pub use jacobian::jacobian;
pub use limits::limits_ok;
pub use radical_inverse::radical_inverse;
pub use select::{ik_conf, ik_near};
pub use singularity::{Singularity, singularity};
pub use tcp::Tcp;
