//! The logs of one side of a campaign, and what speaks against using them.

use super::error::ProveError;
use super::stamp::Stamp;
use crate::learn::log::{Log, Scan};
use crate::tool::cell::events::Recording;

/// The logs of one period.
#[derive(Clone, Debug, Default)]
pub struct Side {
    /// Logs of power, in the order of their recording.
    pub logs: Vec<PowerLog>,
    /// Logs of events of the same time.
    pub events: Vec<EventLog>,
}

/// A log of power, or of the torques and rates of joints.
#[derive(Clone, Debug)]
pub struct PowerLog {
    /// Its path as given.
    pub shown: String,
    /// Its usable rows.
    pub log: Log,
    /// What its rows tell in the order of the file.
    pub scan: Scan,
    /// Its notes.
    pub stamp: Stamp,
}

/// A log of events.
#[derive(Clone, Debug)]
pub struct EventLog {
    /// Its path as given.
    pub shown: String,
    /// What the recorder wrote.
    pub recording: Recording,
}

/// Jump back of a clock that no recorder causes by disorder of its rows, s.
const BACK_S: f64 = 60.0;
/// Share of unusable rows from which on a log is refused.
const UNUSABLE: f64 = 0.1;
/// An hour and a day, by which clocks of the day jump, and the tolerance, s.
const HOUR_S: f64 = 3600.0;
const DAY_S: f64 = 86_400.0;
const NEAR_S: f64 = 120.0;

impl Side {
    /// The hash of the program that ran, if a log has it.
    ///
    /// # Errors
    /// The logs are of several versions of the program.
    pub(super) fn program(&self) -> Result<Option<String>, ProveError> {
        let notes = self.logs.iter().flat_map(|log| {
            log.stamp.programs.iter().map(|(line, hash)| (&log.shown, *line, hash))
        });
        let events = self.events.iter();
        let events = events.filter_map(|of| Some((&of.shown, 0, of.recording.program.as_ref()?)));
        let mut first: Option<(&String, &String)> = None;
        for (shown, line, hash) in notes.chain(events) {
            match first {
                Some((other, known)) if known != hash => {
                    return Err(ProveError::TwoPrograms {
                        file: shown.clone(),
                        line: line.max(1),
                        hash: hash.clone(),
                        other: other.clone(),
                        known: known.clone(),
                    });
                }
                None => first = Some((shown, hash)),
                _ => {}
            }
        }
        Ok(first.map(|(_, hash)| hash.clone()))
    }

    /// Dates of the recordings, as the controller shows them.
    pub(super) fn dates(&self) -> Vec<&str> {
        let logs = self.logs.iter().flat_map(|log| &log.stamp.sessions).map(String::as_str);
        let events = self.events.iter().flat_map(|of| &of.recording.sessions);
        logs.chain(events.filter_map(|session| session.started.as_deref())).collect()
    }

    /// Refuses logs whose rows contradict each other.
    pub(super) fn check(&self) -> Result<(), ProveError> {
        self.logs.iter().try_for_each(PowerLog::check)
    }
}

impl PowerLog {
    fn check(&self) -> Result<(), ProveError> {
        let file = || self.shown.clone();
        if self.scan.alternates {
            return Err(ProveError::TwoRobots { file: file(), line: 2 });
        }
        let (rejected, usable) = (self.log.rejected.len(), self.log.rows.len());
        let is_corrupt = rejected as f64 > UNUSABLE * (rejected + usable) as f64;
        if let Some((line, back_s)) = self.scan.back.filter(|(_, s)| *s >= BACK_S || is_corrupt) {
            return Err(ProveError::ClockBack { file: file(), line, back_s, cause: cause(back_s) });
        }
        match self.log.rejected.first() {
            Some(first) if is_corrupt => Err(ProveError::Corrupt {
                file: file(),
                line: first.row,
                rejected,
                rows: rejected + usable,
                reason: first.reason.clone(),
            }),
            _ => Ok(()),
        }
    }
}

/// What a jump back of this length usually is.
fn cause(back_s: f64) -> &'static str {
    if (back_s - HOUR_S).abs() < NEAR_S {
        ", as clocks of the day do when summer time ends"
    } else if (back_s - DAY_S).abs() < NEAR_S {
        ", as clocks of the day do at midnight"
    } else {
        ""
    }
}

/// What a gap of this length usually is.
pub(super) fn gap_cause(gap_s: f64) -> &'static str {
    if (gap_s - HOUR_S).abs() < NEAR_S {
        " (clocks of the day jump so when summer time begins)"
    } else {
        ""
    }
}
