//! A changed program in the place of another one.

use crate::rapid::syntax;
use crate::rapid::text::Edit;
use crate::retime::motion::Simulation;
use crate::tool::lint::process::{Kept, same_process};
use crate::tool::retrofit::{Cell, Simulated, Source};

/// Rounding of a time, s.
const TIME_TOLERANCE: f64 = 1e-6;

/// The files of a program with edits; `None` if these overlap or break the syntax.
pub(super) fn edited(cell: Cell<'_>, edits: &[Edit]) -> Option<Vec<Source>> {
    let files = cell.edited(edits.iter().cloned()).ok()?;
    let errors = |source: &Source| syntax::parse(&source.file.bytes).errors.len();
    let is_sound = |(before, after): (&Source, &Source)| {
        before.file.bytes == after.file.bytes || errors(after) <= errors(before)
    };
    cell.files.iter().zip(&files).all(is_sound).then_some(files)
}

/// The cycle after edits, if it does the same work without new problems in no more time.
pub(super) fn changed(
    cell: Cell<'_>,
    before: &Simulation,
    edits: &[Edit],
    kept: Kept,
) -> Option<Simulated> {
    let files = edited(cell, edits)?;
    let after = Cell { files: &files, ..cell }.simulated().ok()?;
    let is_in_time = after.simulation.cycle_s <= before.cycle_s + TIME_TOLERANCE;
    (is_in_time && same_process(cell.model, before, &after.simulation, kept)).then_some(after)
}
