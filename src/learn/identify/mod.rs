//! A robot's dynamic model from measured logs, with standard errors.
//!
//! [`prepare`] selects instants of a log, [`Equations`] sets up their equations of motion, [`fit`]
//! solves for the base parameters, and [`identify`] returns a physically consistent model.

mod clean;
mod clipped;
mod clocks;
mod consistent;
mod descent;
mod equations;
mod error;
mod essential;
mod factors;
mod fit;
mod guess;
mod identified;
mod least_squares;
mod misses;
mod names;
mod nearest;
mod noise;
mod pipeline;
mod prepare;
mod quality;
mod repetitions;
mod samples;
mod settings;
mod torque;
mod triangle;
mod units;
mod updated;
mod whiteness;
mod wrist;

pub use clean::{cleaned, plausible};
pub use clocks::synchronised;
pub(crate) use consistent::{Piece, Target, consistent};
pub use descent::{Descent, by_descent};
pub use equations::{Equations, Instant, Known, Layout};
pub use error::IdentifyError;
pub use essential::{Collinear, collinear, essential};
pub use factors::Factors;
pub use fit::{Fit, Weighting, fit};
pub use identified::Identified;
pub use least_squares::{Condition, Solution};
pub use misses::Misses;
pub use pipeline::identify;
pub use prepare::{Hints, prepare};
pub use quality::{Grade, Quality};
pub use samples::{Block, Samples, Source};
pub use settings::{Free, Settings};
pub use torque::{Torques, per_ampere, torques};
pub use units::{beyond_range, check_angles, check_torques, weight_factor};
pub use whiteness::Whiteness;
