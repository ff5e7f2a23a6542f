//! Which waits are slack (`docs/cell.md`).

mod density;
mod error;
mod evidence;
mod reference;
mod samples;
mod shift;
mod slope;
mod spread;
mod verdict;
#[cfg(test)]
mod tests;

pub use error::WaitsError;
pub use reference::{Kind, Level, Reference};
pub use samples::{Candidate, Key, Sample, Samples, samples};
pub use shift::{Log, Shift};
pub use slope::Slope;
pub use verdict::{Reason, Verdict, WaitKind, verdict};
