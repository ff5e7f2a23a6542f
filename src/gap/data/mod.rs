//! Logs as records: mean motions with their torques and the noise of these.

mod noise;
mod record;
mod sharpness;
mod spectrum;
mod units;
mod used;

pub(in crate::gap) use record::REST;
pub use record::{Record, RecordKind};
pub use units::common_factor;
