//! The robot: an immutable [`Model`] of geometry, limits, inertia, friction, motors, drives and
//! brakes, with the origin of every number.
//!
//! A model is loaded from a Robot TOML or URDF file ([`load`]) or found in the embedded catalogue
//! by its name ([`find`]). Units are SI and radians; joint numbers count from 1 in files and
//! messages, from 0 in code.

mod calibration;
mod catalogue;
mod controller;
mod drive;
mod effect;
mod error;
mod fields;
mod friction;
mod geometry;
mod geometry_file;
mod law;
mod limits;
mod link;
mod load;
mod moc;
mod model;
mod motors;
mod names;
mod ortho_parallel;
mod plausibility;
mod pose_acceleration;
pub mod prior;
mod provenance;
mod readiness;
mod sensors;
pub mod system_parameters;
mod toml_text;
mod tree;
mod urdf;
mod wrist;
mod write;

pub use calibration::Calibration;
pub use catalogue::names;
pub use controller::Controller;
pub use drive::{Brakes, Drive, Sharing, Standstill};
pub use effect::{EffectParameters, Given};
pub use error::RobotError;
pub use friction::{Friction, Stribeck};
pub use geometry::{Coupling, GRAVITY, Geometry, Joint, MAX_DOF, OffsetWrist, Opw, Rotations};
pub use law::{Law, LawState};
pub use limits::{Limits, PositionIf};
pub use link::Link;
pub use load::{find, from_toml, load};
pub use moc::import_moc;
pub use model::Model;
pub use motors::Motors;
pub use names::nearest;
pub use plausibility::implausible;
pub use pose_acceleration::{Capability, PoseAcceleration};
pub use provenance::{Origin, Provenance};
pub use readiness::{Lack, NotReady, Use, lacking, ready};
pub use sensors::Sensors;
pub use urdf::import_urdf;
pub use wrist::Wrist;
pub use write::to_toml;
