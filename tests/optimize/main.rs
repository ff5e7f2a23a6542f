//! The numerical core of the optimiser with analytic cases and a synthetic arm.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

mod analytic;
mod arm;
mod data;
mod energy;
mod reachability;
mod stream;
