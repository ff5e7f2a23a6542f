//! The motion channel: runs of a program against runs of a baseline, by the column `cmd`.
//!
//! Each movement has a few features (`features.rs`): how long it takes, how long the robot rests
//! behind it, its speed at half of its way and in its ramps, when it is at half of its way, how far
//! it cuts the corner to the next one. The baseline's path gives the places at which logs are
//! compared (`landmarks.rs`): over the way s a ramp of the acceleration a has the speed √(2 a s),
//! whatever the plateau is. Differences (`changes.rs`) have a standard error of the repetitions and
//! of the sampling. A law (`laws.rs`) says in which ways it may change each movement
//! (`expected.rs`); the search (`search.rs`) finds the laws with the largest evidence, against no
//! change and against a change by anything.

mod changes;
mod expected;
mod features;
mod found;
mod graded;
mod landmarks;
mod laws;
mod run;
mod search;
mod smooth;

pub use found::{RunEffect, RunFound, diagnose_runs};
pub use run::Run;
