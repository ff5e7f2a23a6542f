//! From measured logs to a robot's dynamic model, with standard errors.
mod equations;
mod error;
mod factors;
mod fit;
mod least_squares;
mod noise;
mod prepare;
mod samples;
mod triangle;

pub use equations::{Equations, Layout};
pub use error::IdentifyError;
pub use fit::{Fit, Weighting, fit};
pub use prepare::prepare;
pub use samples::{Block, Samples, Source};
