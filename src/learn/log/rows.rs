//! Checks of the rows of a log during reading.

use super::channel::Channel;
use super::columns::Column;
use super::data::{Log, MIN_ROWS, Rejected};
use super::error::LogError;

/// Limit of valid times \[s\].
const NO_CLOCK: f64 = 1e12;
/// A row whose time leaps by this multiple of the interval between its neighbours is invalid, not
/// the rows after it.
const LEAP: f64 = 100.0;

/// A log during reading.
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
            degrees: columns
                .iter()
                .filter(|column| column.named.unit != 1.0)
                .map(|column| column.named.channel)
                .collect(),
        };
        let time = log.channels.iter().position(|channel| *channel == Channel::Time).unwrap_or(0);
        Rows { log, time }
    }

    /// Adds the values of a row, or the reason of its rejection; times have to ascend.
    pub(super) fn push(&mut self, row: u64, values: Result<&[f64], String>) {
        if let Ok(values) = &values {
            self.drop_leap(values[self.time]);
        }
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

    /// Removes the last row if only its time leapt ahead.
    fn drop_leap(&mut self, time: f64) {
        let [.., before, last] = self.log.values[self.time][..] else { return };
        if time <= before || time >= last || last - before < LEAP * (time - before) {
            return;
        }
        for column in &mut self.log.values {
            column.pop();
        }
        if let Some(row) = self.log.rows.pop() {
            let reason = format!("the time leaps from {before} s to {last} s for one row");
            self.log.rejected.push(Rejected { row, reason });
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

/// Whether the time ascends.
fn later(time: f64, last: Option<f64>) -> Result<(), String> {
    if time.abs() > NO_CLOCK {
        return Err(format!("t is {time:e} s, which no clock shows"));
    }
    match last {
        Some(last) if time == last => Err(format!("the time {time} s is there twice")),
        Some(last) if time < last => Err(format!("the time goes back from {last} s to {time} s")),
        _ => Ok(()),
    }
}
