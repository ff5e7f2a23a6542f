//! Motions that excite a robot's dynamic parameters.
//!
//! [`design()`] optimises Fourier series for their information within all limits. Friction plateaus
//! and the settings of [`Design`] give smaller experiments.

mod blend;
mod design;
mod error;
mod feasible;
mod information;
mod plateaus;
mod search;
mod separate;
mod series;
mod stream_log;
mod stream_test;

pub use blend::{Blend, blends};
#[cfg(feature = "internals")]
pub use design::random_feasible;
pub use design::{Design, Designed, Focus, design};
pub use error::ExciteError;
pub use feasible::{Checked, Ratios, check};
pub use information::{Information, information};
pub use plateaus::{Plateaus, friction_plateaus, wrist_plateaus};
pub use separate::{STEP, design_for};
pub use series::{Series, State};
pub use stream_log::{Finding, Measured, Rows, measured};
pub use stream_test::{StreamTest, stream_tests};
