//! A log as columns of numbers.

use super::channel::Channel;

/// Least number of usable rows.
pub const MIN_ROWS: usize = 10;

/// A log in SI units and radians with ascending times.
#[derive(Clone, Debug, PartialEq)]
pub struct Log {
    /// The channels of the columns in `values`.
    pub channels: Vec<Channel>,
    /// A column for each channel, all of the same length.
    pub values: Vec<Vec<f64>>,
    /// Line in the file of each usable row; the header is line 1.
    pub rows: Vec<u64>,
    /// Rejected rows.
    pub rejected: Vec<Rejected>,
    /// Channels that the file has in degrees.
    pub degrees: Vec<Channel>,
}

/// A rejected row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rejected {
    /// Line in the file; the header is line 1.
    pub row: u64,
    /// Reason.
    pub reason: String,
}

impl Log {
    /// Times \[s\].
    #[must_use]
    pub fn time(&self) -> &[f64] {
        self.column(Channel::Time).unwrap_or(&[])
    }

    /// The rows of the log with these indices.
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
        self.channels.iter().filter(|channel| matches!(channel, Channel::Position(_))).count()
    }

    /// The column of a channel, if the log has it.
    #[must_use]
    pub fn column(&self, channel: Channel) -> Option<&[f64]> {
        let index = self.channels.iter().position(|known| *known == channel)?;
        Some(&self.values[index])
    }

    /// The columns of `channel` for all joints in order; `None` if one is missing.
    #[must_use]
    pub fn of_joints(&self, channel: fn(usize) -> Channel) -> Option<Vec<&[f64]>> {
        (0..self.joints()).map(|joint| self.column(channel(joint))).collect()
    }
}
