//! Logs of a program, and the movements in them.

/// A log of repetitions of a program.
#[derive(Clone, Debug)]
pub struct Run {
    /// Times \[s\].
    pub t: Vec<f64>,
    /// Positions by joint \[rad\].
    pub q: Vec<Vec<f64>>,
    /// Number of the movement that runs, from 1; 0 for none.
    pub command: Vec<usize>,
}

/// A movement once in a log, with the rest behind it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    /// Its number.
    pub number: usize,
    /// Its first row.
    pub from: usize,
    /// The first row of the next movement, or the number of rows.
    pub to: usize,
    /// Whether its first row is where it began, not where the log does.
    pub has_start: bool,
    /// Whether the log goes on behind it.
    pub has_end: bool,
}

impl Span {
    /// Whether the log has all of it.
    pub(super) fn is_whole(&self) -> bool {
        self.has_start && self.has_end
    }
}

impl Run {
    /// Its movements in the order of time.
    pub(super) fn spans(&self) -> Vec<Span> {
        let rows = self.command.len();
        let mut spans: Vec<Span> = Vec::new();
        for row in 0..rows {
            let number = self.command[row];
            let before = row.checked_sub(1).map(|before| self.command[before]);
            if number == 0 || before == Some(number) {
                continue;
            }
            if let Some(last) = spans.last_mut() {
                (last.to, last.has_end) = (row, true);
            }
            let has_start = before.is_some();
            spans.push(Span { number, from: row, to: rows, has_start, has_end: false });
        }
        spans
    }

    /// When the movement with this first row began \[s\]: between that row and the one before.
    pub(super) fn start(&self, row: usize) -> f64 {
        0.5 * (self.t[row] + self.t[row.saturating_sub(1)])
    }
}
