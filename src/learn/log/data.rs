//! A log as columns of numbers.

use super::channel::{Channel, Family};

/// A log needs this many usable rows.
pub const MIN_ROWS: usize = 10;

/// A log in SI units and radians; time ascends from row to row.
#[derive(Clone, Debug, PartialEq)]
pub struct Log {
    /// What is in which column of `values`.
    pub channels: Vec<Channel>,
    /// A column for each channel, all of the same length.
    pub values: Vec<Vec<f64>>,
    /// Line of the file of each usable row; the header is 1.
    pub rows: Vec<u64>,
    /// Rows that were left out.
    pub rejected: Vec<Rejected>,
    /// Angles that the file had in degrees.
    pub degrees: Vec<Channel>,
}

/// A row that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rejected {
    /// Line of the file; the header is 1.
    pub row: u64,
    /// Why.
    pub reason: String,
}

impl Log {
    /// Times \[s\].
    #[must_use]
    pub fn time(&self) -> &[f64] {
        self.column(Channel::Time).unwrap_or(&[])
    }

    /// The log with only the rows of these indices.
    #[must_use]
    pub fn of_rows(&self, kept: &[usize]) -> Log {
        let of = |x: &Vec<f64>| kept.iter().map(|row| x[*row]).collect();
        Log {
            channels: self.channels.clone(),
            values: self.values.iter().map(of).collect(),
            rows: kept.iter().map(|row| self.rows[*row]).collect(),
            rejected: self.rejected.clone(),
            degrees: self.degrees.clone(),
        }
    }

    /// Number of joints whose positions are logged.
    #[must_use]
    pub fn joints(&self) -> usize {
        self.channels.iter().filter(|channel| channel.family() == Family::Position).count()
    }

    /// The column of a channel, if the log has it.
    #[must_use]
    pub fn column(&self, channel: Channel) -> Option<&[f64]> {
        let index = self.channels.iter().position(|known| *known == channel)?;
        Some(&self.values[index])
    }

    /// The columns that `channel` names for each joint, in order; `None` where one is
    /// missing.
    #[must_use]
    pub fn of_joints(&self, channel: fn(usize) -> Channel) -> Option<Vec<&[f64]>> {
        (0..self.joints()).map(|joint| self.column(channel(joint))).collect()
    }
}
