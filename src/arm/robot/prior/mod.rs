//! Estimated dynamics: a prior of the unknown parameters of a robot, given the known ones.
//!
//! ABB publishes no dynamics. Geometry, total mass, payload and reach of a robot are known, and how
//! they go with masses of links, friction, motors and power in arms of which these are known. So
//! every number that a robot's file leaves out has a most likely value and a standard deviation
//! here; [`estimated`] fills in the values, [`Spread`] draws robots that are as plausible.
//!
//! Positive numbers are log-normal. Correlated numbers have common latent numbers: the total mass is
//! known better than how the links share it, and friction of all joints has a part in common.

mod bodies;
mod fill;
mod hypercube;
mod known;
mod latents;
mod rules;
mod skeleton;
mod spread;

pub use fill::estimated;
pub use hypercube::standard_normals;
pub use known::{check_mass, is_mass_known, type_name};
pub use latents::Latent;
pub use spread::{Draws, Plausible, Spread, check_calibration, check_deviations};
