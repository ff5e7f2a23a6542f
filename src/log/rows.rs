//! Rows as they are read, good ones and others.

use super::channel::Channel;
use super::columns::Column;
use super::error::LogError;
use super::{Log, MIN_ROWS, Rejected};

/// A log that is being read.
pub(super) struct Rows {
    log: Log,
    time: usize,
}

impl Rows {
    pub(super) fn new(columns: &[Column]) -> Rows {
        let log = Log {
            channels: columns.iter().map(|column| column.named.channel).collect(),
            values: vec![Vec::new(); columns.len()],
            rows: Vec::new(),
            rejected: Vec::new(),
        };
        let time = log.channels.iter().position(|channel| *channel == Channel::Time).unwrap_or(0);
        Rows { log, time }
    }

    /// Adds the values of a row, or says why it has none; time has to go on.
    pub(super) fn push(&mut self, row: u64, values: Result<&[f64], String>) {
        let last = self.log.values[self.time].last().copied();
        let checked = values.and_then(|values| later(values[self.time], last).map(|()| values));
        match checked {
            Ok(values) => {
                for (column, value) in self.log.values.iter_mut().zip(values) {
                    column.push(*value);
                }
                self.log.rows.push(row);
            }
            Err(reason) => self.log.rejected.push(Rejected { row, reason }),
        }
    }

    /// The log.
    ///
    /// # Errors
    /// Fewer than [`MIN_ROWS`] usable rows.
    pub(super) fn finish(self) -> Result<Log, LogError> {
        let usable = self.log.rows.len();
        if usable < MIN_ROWS {
            let why = self.log.rejected.first().map_or_else(String::new, |first| {
                let count = self.log.rejected.len();
                format!("; {count} were left out, row {}: {}", first.row, first.reason)
            });
            return Err(LogError::Short { usable, needed: MIN_ROWS, why });
        }
        Ok(self.log)
    }
}

/// Whether time goes on.
fn later(time: f64, last: Option<f64>) -> Result<(), String> {
    match last {
        Some(last) if time == last => Err(format!("the time {time} s is there twice")),
        Some(last) if time < last => Err(format!("the time goes back from {last} s to {time} s")),
        _ => Ok(()),
    }
}
