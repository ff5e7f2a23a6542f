//! What all logs of a case share.

use super::bench::Stage;
use super::everyday::Day;
use super::logger::Recorder;
use super::motion::Track;
use super::plan::Plan;
use super::plant::Tables;

/// Name of the held-out log.
pub(super) const HELD: &str = "heldout.csv";

/// A log to be made.
pub(super) struct Log {
    pub(super) name: String,
    pub(super) motion: usize,
    pub(super) faulty: bool,
}

/// What all logs of a case share.
pub(super) struct Scene<'a> {
    pub(super) plan: &'a Plan,
    pub(super) stages: Vec<(Tables, Track)>,
    pub(super) days: Vec<Day>,
    pub(super) logs: Vec<Log>,
    pub(super) recorder: Recorder,
}

impl Scene<'_> {
    /// The held-out log; those before it are present ones.
    pub(super) fn held(&self) -> usize {
        self.logs.iter().position(|log| log.name == HELD).unwrap_or(0)
    }

    /// The motion and day of a log.
    pub(super) fn stage(&self, log: usize) -> Stage<'_> {
        let (tables, track) = &self.stages[self.logs[log].motion];
        Stage { track, tables, day: &self.days[log] }
    }
}
