//! How probable the logs are with some effects, whatever the parameters of the model, the everyday
//! errors and their sizes are.
//!
//! Linear Gaussian model by joint: `y = P θ + L φ + H c + n`. Parameters θ and factors c are common
//! to the joints; everyday errors φ are a joint's own and are marginalised there first. Sizes of the
//! groups of everyday errors maximise the marginal likelihood times their prior (empirical Bayes;
//! D. `MacKay`, Bayesian interpolation, Neural Computation 4, 1992).

mod amplitude;
mod blocked;
mod fit;
mod friction;
mod gain;
mod hypothesis;
mod members;
mod reduced;
mod shares;
mod sizes;
mod start;
mod windows;

pub(in crate::gap) use fit::{Fit, fitted, fitted_as_written};
pub(in crate::gap) use gain::Gains;
pub(in crate::gap) use hypothesis::{Hypothesis, Member};
pub(in crate::gap) use sizes::{MOST_OF_FRICTION, Sizes, TAIL, halfway, usual};
pub(in crate::gap) use start::Start;
pub(in crate::gap) use windows::WindowGains;
