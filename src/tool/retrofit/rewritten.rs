//! A rewritten program with its verification.

use std::collections::BTreeSet;

use super::candidate::Candidate;
use super::figures::{LowerLimits, Verification};
use super::outputs::Outputs;
use super::relocated_waits::RelocatedWait;
use super::simulated::Simulated;
use crate::rapid::text::Span;

/// A rewritten program; no candidate is pending.
pub(super) struct Rewritten {
    pub(super) candidates: Vec<Candidate>,
    pub(super) waits: Vec<RelocatedWait>,
    /// Sites with other speeds.
    pub(super) respeeded: BTreeSet<Span>,
    pub(super) outputs: Outputs,
    /// The emitted program, with the waits at their original places.
    pub(super) simulated: Simulated,
    pub(super) verification: Verification,
    pub(super) lower_limits: Vec<LowerLimits>,
}
