//! Checks of the rows of a log during reading.

use super::channel::Channel;
use super::columns::Column;
use super::data::{Log, MIN_ROWS, Rejected};
use super::error::LogError;
use super::time_order::disordered;

/// Limit of valid times \[s\].
const NO_CLOCK: f64 = 1e12;

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

    /// Adds the values of a row, or the reason of its rejection.
    pub(super) fn push(&mut self, row: u64, values: Result<Vec<f64>, String>) {
        let checked = values.and_then(|values| match values[self.time] {
            time if time.abs() > NO_CLOCK => Err(format!("t is {time:e} s, which no clock shows")),
            _ => Ok(values),
        });
        match checked {
            Ok(values) => {
                for (column, value) in self.log.values.iter_mut().zip(values) {
                    column.push(value);
                }
                self.log.rows.push(row);
            }
            Err(reason) => self.log.rejected.push(Rejected { row, reason }),
        }
    }

    /// The log without rows whose time does not ascend.
    ///
    /// # Errors
    /// Fewer than [`MIN_ROWS`] usable rows.
    pub(super) fn finish(self) -> Result<Log, LogError> {
        let Rows { mut log, time } = self;
        let same = |a: usize, b: usize| log.values.iter().all(|column| column[a] == column[b]);
        let why = disordered(&log.values[time], same);
        let kept: Vec<usize> = (0..why.len()).filter(|row| why[*row].is_none()).collect();
        if kept.len() < why.len() {
            let lines = log.rows.iter().zip(why);
            let of =
                |(row, why): (&u64, Option<String>)| Some(Rejected { row: *row, reason: why? });
            let rejected: Vec<Rejected> = lines.filter_map(of).collect();
            log = log.of_rows(&kept);
            log.rejected.extend(rejected);
            log.rejected.sort_by_key(|rejected| rejected.row);
        }
        let usable = log.rows.len();
        if usable < MIN_ROWS {
            let why = log.rejected.first().map_or_else(String::new, |first| {
                let count = log.rejected.len();
                format!("; left out: {count}, the first is row {}: {}", first.row, first.reason)
            });
            return Err(LogError::Short { usable, needed: MIN_ROWS, why });
        }
        Ok(log)
    }
}
