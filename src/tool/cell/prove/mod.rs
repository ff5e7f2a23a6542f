//! What a retrofit saved, measured: cycles before and after are paired by what they made, corrected for
//! waits and temperature, and compared with an interval (`docs/cell.md`, "Prove the saving").

mod blocks;
mod campaign;
mod doubt;
mod error;
mod estimate;
mod interval;
mod mixture;
mod outliers;
mod periodic;
mod plan;
mod points;
mod proof;
mod rest;
mod series;
mod side;
mod spans;
mod stamp;
mod strata;
mod summary;
#[cfg(test)]
mod tests;
mod unit;
mod units;
mod waiting;

pub use campaign::{plan, prove};
pub use doubt::Doubt;
pub use error::ProveError;
pub use proof::{Adjustment, CycleTime, Estimated, Plan, Proof, Settings, Verdict};
pub use series::Measure;
pub use side::{EventLog, PowerLog, Side};
pub use stamp::{Stamp, stamp};
pub use strata::Stratum;
pub use unit::{LeftOut, Period};
