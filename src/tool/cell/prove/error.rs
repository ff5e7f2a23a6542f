//! Unusable campaigns.

/// Why nothing can be said of a campaign.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ProveError {
    /// A side has no log of power.
    #[error(
        "{side}: no log of power is given; a log of events alone has no energy: add a CSV with the columns t \
         and power (W or kW)"
    )]
    NoPower {
        /// The option of the side.
        side: &'static str,
    },
    /// A log without energy.
    #[error(
        "{file}: line 1: no column `power`, and not `tau1…` with `qd1…` or `q1…` either: log the cabinet's \
         power in W or kW, or name its column with --map power=NAME"
    )]
    NoMeasure {
        /// The log.
        file: String,
    },
    /// The sides measure different things.
    #[error(
        "{file}: this log has the {found}, {other} has the {known}: measure the same on both sides"
    )]
    Measures {
        /// The log.
        file: String,
        /// What it has.
        found: &'static str,
        /// Another log.
        other: String,
        /// What that has.
        known: &'static str,
    },
    /// A side has logs of two versions of the program.
    #[error(
        "{file}: line {line}: this log is of the program {hash}, {other} is of {known}: one side is one version \
         of the program; give the logs of the other version on the other side, or leave them out"
    )]
    TwoPrograms {
        /// The log.
        file: String,
        /// Line of the note.
        line: u64,
        /// Its hash.
        hash: String,
        /// Another log.
        other: String,
        /// Its hash.
        known: String,
    },
    /// One file on both sides.
    #[error("{file}: the same log is given as {other}: give each log once")]
    Same {
        /// The log.
        file: String,
        /// The other one.
        other: String,
    },
    /// The clock goes back.
    #[error(
        "{file}: line {line}: the time goes back by {back_s:.3} s{cause}: the column t must go on; divide the \
         file there and give both parts, or add the jump to all later times"
    )]
    ClockBack {
        /// The log.
        file: String,
        /// Line of the row.
        line: u64,
        /// s.
        back_s: f64,
        /// What such a jump usually is, or nothing.
        cause: &'static str,
    },
    /// Two robots have written into a file.
    #[error(
        "{file}: line {line}: two robots or two meters have written into this file, their rows take turns: give \
         each one's log as a file of its own"
    )]
    TwoRobots {
        /// The log.
        file: String,
        /// Line of the row.
        line: u64,
    },
    /// Many rows cannot be used.
    #[error(
        "{file}: line {line}: {rejected} of {rows} rows cannot be used; the first one: {reason}"
    )]
    Corrupt {
        /// The log.
        file: String,
        /// Line of the first one.
        line: u64,
        /// Number of unusable rows.
        rejected: usize,
        /// Number of rows.
        rows: usize,
        /// What is wrong with the first one.
        reason: String,
    },
    /// No cycle is complete.
    #[error(
        "{file}: line 1: no complete cycle is found{why}: log a column `cycle` with the number of the cycle, or \
         give the log of events of the same time, over several cycles"
    )]
    NoCycles {
        /// The log, or the side.
        file: String,
        /// What is there instead.
        why: String,
    },
    /// Rows are rarer than the cycle is short.
    #[error(
        "{file}: line 1: a row every {step_s:.3} s is too rare for cycles of {cycle_s:.3} s: log at least 20 \
         rows a cycle"
    )]
    Rare {
        /// The log.
        file: String,
        /// s.
        step_s: f64,
        /// s.
        cycle_s: f64,
    },
    /// Nothing was made on both sides.
    #[error(
        "another product: before made {before}, after made {after}; nothing was made on both sides: compare \
         logs of the same parts"
    )]
    NoCommon {
        /// What was made before.
        before: String,
        /// What was made after.
        after: String,
    },
    /// Cycles that were found by the power alone are not the same.
    #[error(
        "{file}: line 1: the power repeats every {after_s:.2} s, that of the other side every {before_s:.2} s: \
         these are not the same cycles; log a column `cycle` on both sides"
    )]
    Periods {
        /// The log.
        file: String,
        /// s.
        before_s: f64,
        /// s.
        after_s: f64,
    },
    /// The level of the power differs too much.
    #[error(
        "{file}: line 1: the mean power is {factor:.3} times that before: another unit, meter or robot? Give both \
         in W or kW by the same meter"
    )]
    Level {
        /// The log.
        file: String,
        /// Mean power after over before.
        factor: f64,
    },
    /// The energy is not positive.
    #[error(
        "{file}: line 1: the mean power is {power_w:.1} W: a cabinet takes power; is the sign or the column wrong? \
         Name the column with --map power=NAME"
    )]
    Negative {
        /// The log.
        file: String,
        /// W.
        power_w: f64,
    },
    /// The meter is stuck.
    #[error(
        "{file}: line 1: the power never changes, as it does where a robot moves: check the meter and its column"
    )]
    Constant {
        /// The log.
        file: String,
    },
}
