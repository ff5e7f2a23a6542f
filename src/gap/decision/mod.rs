//! Which effects are asserted, and why.

mod calibration;
mod decide;
mod finding;
mod search;
mod shape;
mod trail;
mod window;

pub use calibration::Calibration;
pub(super) use calibration::of_odds;
pub(in crate::gap) use decide::{Decision, decide, may_name_parameters};
pub use finding::{Estimated, Finding, Place, Remainder, Verdict};
pub(in crate::gap) use search::{Candidate, Found, Search, Searched, Tried};
pub use trail::{Entry, Gate};
