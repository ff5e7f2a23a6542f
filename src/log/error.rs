//! What makes a log unusable.

use thiserror::Error;

/// A log that can't be read.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum LogError {
    /// No header, or none that is understood.
    #[error(
        "no column t in the header '{header}': the first row names the columns, such as t,q1,q2,tau1,tau2"
    )]
    NoTime {
        /// The first row.
        header: String,
    },
    /// Two columns for one quantity.
    #[error("the columns {first} and {second} are the same quantity: leave one out")]
    Twice {
        /// A name.
        first: String,
        /// Another one.
        second: String,
    },
    /// A joint is missing between others.
    #[error("there is a column {found} but none for joint {missing}: number the joints from 1 on")]
    Gap {
        /// The name that is there.
        found: String,
        /// The joint that is not, from 1.
        missing: usize,
    },
    /// Too few rows to work with.
    #[error("only {usable} usable rows, {needed} are needed{why}")]
    Short {
        /// Rows that can be used.
        usable: usize,
        /// Rows that are needed.
        needed: usize,
        /// What is wrong with the first one left out.
        why: String,
    },
}
