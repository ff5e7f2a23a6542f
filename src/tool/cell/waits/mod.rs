//! Which waits are slack (`docs/cell.md`).

mod density;
mod error;
mod evidence;
mod experiment;
pub mod file;
mod find;
mod populations;
mod record;
mod reference;
mod samples;
mod shift;
mod signals;
mod slope;
pub mod spread;
#[cfg(test)]
mod tests;
mod trend;
mod verdict;

pub use error::WaitsError;
pub use experiment::Experiment;
pub use find::{Found, SHARES, Wait, find};
pub use populations::Population;
pub use record::record;
pub use reference::{AT_ONCE_S, Kind, Level, Reference};
pub use samples::{Candidate, Key, Sample, Samples, samples};
pub use shift::{Log, Shift};
pub use signals::SignalTime;
pub use slope::Slope;
pub use trend::Trend;
pub use verdict::{Reason, Verdict, WaitKind, verdict};
