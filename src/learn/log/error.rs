//! Errors of reading a log.

use thiserror::Error;

/// A log that can't be read.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum LogError {
    /// One column for two channels.
    #[error("--map: column {column} is given for {other} and for {name}: leave one out")]
    ColumnTwice {
        /// The column.
        column: String,
        /// Its channel so far.
        other: String,
        /// Its second channel.
        name: String,
    },
    /// No header, or an unknown one.
    #[error(
        "no column t in the header{}: the first row names the columns, such as t,q1,q2,tau1,tau2, or --map says which is which",
        if .0.trim().is_empty() { " (the file is empty)".to_owned() } else { format!(" '{}'", .0) }
    )]
    NoTime(String),
    /// Columns of different lengths.
    #[error("{name} has {rows} values, another column has {count}: give one for each row")]
    Lengths {
        /// The shorter column.
        name: String,
        /// Its values.
        rows: usize,
        /// The values of the longest column.
        count: usize,
    },
    /// An invalid part of a column map.
    #[error("--map {0}: write it as CHANNEL=COLUMN, such as tau1=MotorTorque_1,q1_deg=J1")]
    Map(String),
    /// A column map names an unknown channel.
    #[error(
        "--map {0}=…: no such channel; give t, q1…, qd1…, qdd1… (or q1_deg…), tau1…, i1…, \
         ia1…, ib1…, ic1…, temp1…, power, sync, cycle, line or cmd"
    )]
    UnknownChannel(String),
    /// A column map names a channel twice.
    #[error("--map names {0} twice: leave one out")]
    MappedTwice(String),
    /// A column map names a column that the file does not have.
    #[error(
        "--map {channel}={column}: the file has no column '{column}' but {header}; --map is for all files \
         of a command, which have to name their columns alike"
    )]
    NoColumn {
        /// The channel.
        channel: String,
        /// The requested column.
        column: String,
        /// The existing columns.
        header: String,
    },
    /// A Parquet file that can't be read for this reason.
    #[error("the Parquet file can't be read ({0}): write it again, or as CSV")]
    Parquet(String),
    /// Bytes of this kind instead of text.
    #[error("the file is {0}: give it as CSV or Parquet")]
    NoText(&'static str),
    /// A file that can't be read to its end for this reason.
    #[error("the file can't be read to its end ({0})")]
    Stream(String),
    /// Two columns for one quantity.
    #[error("the columns {first} and {second} are the same quantity: leave one out")]
    Twice {
        /// A name.
        first: String,
        /// Another one.
        second: String,
    },
    /// A joint is missing.
    #[error("there is a column {found} but none for joint {missing}: number the joints from 1 on")]
    Gap {
        /// The name of an existing column.
        found: String,
        /// The missing joint, from 1.
        missing: usize,
    },
    /// Too few usable rows.
    #[error("only {usable} usable rows, {needed} are needed{why}")]
    Short {
        /// Number of usable rows.
        usable: usize,
        /// Required number of rows.
        needed: usize,
        /// Reason of the first rejection.
        why: String,
    },
    /// Two recorders without common marks.
    #[error(
        "the marks (column sync) change {here} times beside the positions and {there} times beside the currents: both need three of the same changes at least"
    )]
    Marks {
        /// Changes in the log with the positions.
        here: usize,
        /// Changes in the log with the currents.
        there: usize,
    },
    /// The marks of two recorders are not of the same run.
    #[error(
        "the marks of the two logs miss each other by up to {worst:.3} s (a row is {step:.4} s): are they of one run?"
    )]
    Unaligned {
        /// Largest distance \[s\].
        worst: f64,
        /// Interval of the slower one \[s\].
        step: f64,
    },
}
