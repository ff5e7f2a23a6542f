//! Unusable logs of events.

/// Why a log of events cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EventsError {
    /// The header has not the columns of a log of events.
    #[error(
        "no log of events: the columns {missing} are missing; such a log is written by the recorder \
         of `joulepath instrument`"
    )]
    NoEvents {
        /// The names of the missing columns.
        missing: String,
    },
    /// Two programs have written into the file.
    #[error(
        "line {line}: the program changes from {first} to {second}: give the logs of each program as \
         files of their own"
    )]
    TwoPrograms {
        /// Line of the note.
        line: u64,
        /// Hash before.
        first: String,
        /// Hash after.
        second: String,
    },
    /// Two recorders have written into the file at the same time.
    #[error(
        "line {line}: cycle {cycle} goes on after cycle {other} had started: two robots have written \
         into this file; give each robot's log as a file of its own"
    )]
    TwoRobots {
        /// Line of the row.
        line: u64,
        /// The cycle that goes on.
        cycle: u64,
        /// The cycle between.
        other: u64,
    },
    /// The clock goes back.
    #[error(
        "line {line}: the time goes back by {back_s:.3} s{cause}: the column t must be the time since \
         the start of the session; divide the file there, or begin the part with a line `# session`"
    )]
    ClockBack {
        /// Line of the row.
        line: u64,
        /// s.
        back_s: f64,
        /// What such a jump usually is, or nothing.
        cause: &'static str,
    },
    /// The clock jumps forward by an hour.
    #[error(
        "line {line}: the time jumps by {forward_s:.0} s within a cycle in which nothing waits{cause}: \
         leave that cycle out"
    )]
    ClockForward {
        /// Line of the row.
        line: u64,
        /// s.
        forward_s: f64,
        /// What such a jump usually is.
        cause: &'static str,
    },
    /// Most rows cannot be used.
    #[error("{rejected} of {rows} rows cannot be used; the first is line {line}: {reason}")]
    Corrupt {
        /// Number of unusable rows.
        rejected: usize,
        /// Number of rows.
        rows: usize,
        /// Line of the first one.
        line: u64,
        /// What is wrong with it.
        reason: String,
    },
}
