//! The text of a log: a CSV with numbered columns.

use std::fmt::Write as _;

/// A CSV that grows by rows.
pub(super) struct Table {
    text: String,
}

impl Table {
    /// A table of times, of groups of `n` numbered columns, and of single columns.
    pub(super) fn new(n: usize, groups: &[&str], single: &[&str]) -> Self {
        let mut text = String::from("t");
        for group in groups {
            for i in 1..=n {
                let _ = write!(text, ",{group}{i}");
            }
        }
        for name in single {
            let _ = write!(text, ",{name}");
        }
        Self { text }
    }

    /// Begins a row with its time \[s\].
    pub(super) fn row(&mut self, time: f64, digits: usize) {
        let _ = write!(self.text, "\n{time:.digits$}");
    }

    /// The next value of the row.
    pub(super) fn value(&mut self, value: f64, digits: usize) {
        let _ = write!(self.text, ",{value:.digits$}");
    }

    /// The text.
    pub(super) fn finish(self) -> String {
        self.text + "\n"
    }
}

/// A value in steps of a quantum; 0 for none.
pub(super) fn quantised(value: f64, quantum: f64) -> f64 {
    if quantum > 0.0 { (value / quantum).round() * quantum } else { value }
}
