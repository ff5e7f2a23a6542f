//! Which effects are asserted, and why.

mod between;
mod calibration;
mod decide;
mod finding;
mod found;
mod held;
mod search;
mod shape;
mod since;
mod singles;
mod starts;
mod trail;
mod waves;
mod window;

pub use calibration::Calibration;
pub(super) use calibration::of_odds;
pub(in crate::gap) use decide::{Decision, decide, may_name_parameters};
pub use finding::{Estimated, Finding, Place, Remainder, Verdict};
pub(in crate::gap) use found::{Candidate, Found, Searched, Tried};
pub(in crate::gap) use held::polished;
pub(in crate::gap) use search::Search;
pub use trail::{Entry, Gate};
