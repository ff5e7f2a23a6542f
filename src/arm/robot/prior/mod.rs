//! Estimated dynamics: a prior of the unknown parameters of a robot given the known ones.
//!
//! ABB publishes no dynamics. Known are geometry, total mass, payload and reach, and from other
//! arms the relation of these to link masses, friction, motors and power. So each number that is
//! missing in a robot file has a most likely value and a standard deviation: [`estimated`] fills in
//! the values, [`Spread`] draws plausible robots.
//!
//! Positive numbers are log-normal. Correlated numbers share latent variables: the total mass is
//! more certain than its distribution over the links; friction of all joints has a common part.

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
