//! What a recorder takes in a cycle.
//!
//! ABB publishes no times of instructions. Those here are assumed, and named in the output: an
//! instruction as in the costs of guards, a block of 1 kB and the opening of a file as on a slow
//! memory card.

use super::sites::{Site, SiteKind, Stop};
use crate::rapid::text::Span;
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::What;
use crate::tool::retrofit::INSTRUCTION_MS;

/// Instructions for one note, with those of its call.
const NOTE: f64 = 13.0;
/// Instructions for the count of a movement.
const COUNT: f64 = 4.0;
/// Instructions for the row of one note, when it is written.
const ROW: f64 = 12.0;
/// Time of writing a block of 1 kB, and rows in it, ms.
const BLOCK_MS: f64 = 2.0;
const ROWS_IN_BLOCK: f64 = 15.0;
/// Time of opening and closing a file and asking for sizes, ms.
const FILE_MS: f64 = 15.0;
/// Changes of a signal for which the program waits, for each wait.
const CHANGES: usize = 2;
/// Instructions of one sample, without its numbers, and of each number of its row.
const SAMPLE: f64 = 12.0;
const SAMPLE_ROW: f64 = 4.0;
/// Rows of samples in a block, and the fewest and most that a cycle writes.
const SAMPLE_ROWS_IN_BLOCK: f64 = 7.0;
const LEAST_ROWS: usize = 2;
const MOST_ROWS: usize = 500;

/// Time that a recorder takes, ms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Movements in a cycle.
    pub movements: usize,
    /// Notes in a cycle.
    pub notes: usize,
    /// Time of the notes in a cycle, ms.
    pub notes_ms: f64,
    /// Time of writing at the first stop point of a cycle, ms.
    pub writing_ms: f64,
    /// Share of the interpreter that samples take while they are taken.
    pub sampling_share: f64,
}

impl Cost {
    /// Extra time of a cycle, ms.
    #[must_use]
    pub fn cycle_ms(&self) -> f64 {
        self.notes_ms + self.writing_ms
    }

    /// The same for each movement, ms.
    #[must_use]
    pub fn movement_ms(&self) -> f64 {
        self.cycle_ms() / self.movements.max(1) as f64
    }
}

/// The samples of a recorder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Samplings {
    /// Number in a second.
    pub(super) rate: f64,
    /// Numbers in a row.
    pub(super) columns: usize,
    /// Rows that a cycle writes.
    pub(super) rows: usize,
}

impl Samplings {
    /// Time of a row, ms.
    fn row_ms(&self) -> f64 {
        INSTRUCTION_MS * SAMPLE_ROW * self.columns as f64 + BLOCK_MS / SAMPLE_ROWS_IN_BLOCK
    }

    /// Sets the rows of a cycle so that a movement takes at most `budget_ms` more, but at least some.
    pub(super) fn fill(&mut self, cost: &Cost, budget_ms: f64) {
        let left = budget_ms * cost.movements as f64 - cost.cycle_ms();
        self.rows = ((left / self.row_ms()) as usize).clamp(LEAST_ROWS, MOST_ROWS);
    }
}

/// The cost of a recorder in a simulated cycle.
pub(super) fn cost(
    simulation: &Simulation,
    sites: &[Recorded],
    signals: usize,
    samplings: Option<Samplings>,
) -> Cost {
    let mut notes = 1;
    let mut movements = 0;
    let at = |span: Span| -> usize {
        sites.iter().filter(|site| site.span == span).map(|site| site.notes).sum()
    };
    for event in &simulation.events {
        match &event.what {
            What::Run(run) => {
                movements += run.moves.len();
                // The start from standstill.
                notes += 1;
                notes += run.moves.iter().map(|record| at(record.movement.span)).sum::<usize>();
            }
            What::Wait(record) => {
                let is_watched = signals > 0 && record.wait.signal.is_some();
                notes += at(record.wait.span) + if is_watched { CHANGES } else { 0 };
            }
            What::Output(output, _) => notes += at(output.span),
            What::Left(left) => {
                movements += usize::from(left.moves);
                notes += at(left.span);
            }
        }
    }
    let (count, blocks) = (notes as f64, (notes as f64 / ROWS_IN_BLOCK).ceil());
    let files = if samplings.is_some() { 2.0 } else { 1.0 };
    let sample_ms = samplings.map_or(0.0, |own| own.rows as f64 * own.row_ms());
    Cost {
        movements,
        notes,
        notes_ms: INSTRUCTION_MS * (NOTE * count + COUNT * movements as f64),
        writing_ms: INSTRUCTION_MS * ROW * count + BLOCK_MS * blocks + FILE_MS * files + sample_ms,
        sampling_share: samplings
            .map_or(0.0, |own| 1e-3 * INSTRUCTION_MS * (SAMPLE + own.columns as f64) * own.rate),
    }
}

/// A recorded statement, and how many notes an execution makes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Recorded {
    span: Span,
    notes: usize,
}

impl Recorded {
    pub(super) fn new(site: &Site) -> Recorded {
        let notes = match &site.kind {
            SiteKind::Movement { stop: Stop::Never, .. } | SiteKind::Cycle => 0,
            SiteKind::Wait { .. } => 2,
            SiteKind::Movement { .. } | SiteKind::Output { .. } | SiteKind::Load(_) => 1,
        };
        Recorded { span: site.span, notes }
    }
}
