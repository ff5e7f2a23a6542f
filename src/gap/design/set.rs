//! Logs that are compared with each other.

use crate::gap::data::RecordKind;

/// The set of logs of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Set {
    /// Logs of the robot as it is now.
    Now,
    /// Logs of the baseline.
    Baseline,
    /// How repetitions drift.
    Drift,
}

/// The set to which a record belongs.
pub(super) fn set_of(kind: RecordKind) -> Set {
    match kind {
        RecordKind::Mean => Set::Now,
        RecordKind::Before => Set::Baseline,
        RecordKind::Drift => Set::Drift,
    }
}
