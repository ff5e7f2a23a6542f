//! What models miss of data that took no part, and where.

mod attribution;
mod bins;
mod budget;
mod heldout;
mod interval;
mod pieces;
mod places;
mod traces;

pub use attribution::{Attribution, Cell, PARAMETERS, attribution};
pub use bins::Quantity;
pub use budget::Budget;
pub(in crate::gap) use budget::budget;
pub use heldout::{JointGap, Shrink, beside_no_jump, predicted, shrink};
pub use interval::Interval;
pub(in crate::gap) use places::{places, places_missed};
pub use traces::{Profile, Shape, Torques, Trace, missed, profile, shapes, trace};
