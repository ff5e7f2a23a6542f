//! Effects beyond rigid bodies, Coulomb and viscous friction: one file per effect with its law,
//! prior and documentation.
//!
//! [`ALL`] is the register. An effect in it can be written in a robot file, is part of every
//! prediction and simulation, and can be found by a diagnosis.

mod applied;
mod controller;
mod effect;
mod friction;
mod measurement;
mod motion;
mod power;
mod register;
mod response;
mod rigid_body;
mod scale;
mod transmission;
mod waves;
mod window;

pub use applied::{
    applied, drawn, from_toml, load, load_estimated, of_the_whole_motion, with_estimates,
};
pub use effect::{
    Acts, Channel, Coordinate, Effect, Form, Nature, OfMotion, Parameter, Published, Role, Scope,
    Subject, Timing, Values, Variable,
};
pub use motion::Motion;
pub use register::{ALL, find};
pub use response::Response;
pub use rigid_body::bodies::added as with_body;
pub use scale::Scale;
