//! The note on dwells at which brakes would save energy.

use std::collections::BTreeMap;

use super::files::{OutputFile, Source, read_again};
use crate::arm::robot::Model;
use crate::rapid::ir::number::number;
use crate::rapid::text::Span;
use crate::retime::optimize::idle::Dwell;
use crate::tool::emit;

/// The file with the note on brakes.
pub const BRAKE_NOTE: &str = "joulepath_brakes.txt";

/// Adds a note on dwells of the emitted program at which brakes save energy.
pub(super) fn add_brake_note(outputs: &mut Vec<OutputFile>, model: &Model, dwells: &[Dwell]) {
    let paying = dwells.iter().filter(|dwell| dwell.potential_j > 0.0);
    let mut by_place: BTreeMap<Span, Vec<&Dwell>> = BTreeMap::new();
    for dwell in paying {
        by_place.entry(dwell.span).or_default().push(dwell);
    }
    if by_place.is_empty() {
        return;
    }
    let files = read_again(outputs);
    let list: Vec<emit::BrakeDwell> =
        by_place.iter().map(|(span, dwells)| brake_dwell(&files, *span, dwells)).collect();
    let shortest = by_place
        .values()
        .flatten()
        .filter_map(|dwell| dwell.break_even_s)
        .fold(f64::INFINITY, f64::min);
    let Ok(text) = emit::brake_note(&model.name, &list, &number(shortest, 1)) else { return };
    outputs.push(OutputFile::added(BRAKE_NOTE.to_owned(), text));
}

/// The dwells of one place: figures of the longest, potential of all.
fn brake_dwell(files: &[Source], span: Span, dwells: &[&Dwell]) -> emit::BrakeDwell {
    let file = &files[span.file.0 as usize];
    let longest = dwells
        .iter()
        .max_by(|a, b| a.duration.total_cmp(&b.duration))
        .unwrap_or_else(|| unreachable!("a place has dwells"));
    let times = if dwells.len() > 1 { format!(" ({} times)", dwells.len()) } else { String::new() };
    emit::BrakeDwell {
        place: format!("{} {}{times}", file.relative, file.file.position(span.start).line),
        duration: number(longest.duration, 2),
        holding: number(longest.holding_w.iter().sum(), 1),
        break_even: number(longest.break_even_s.unwrap_or(0.0), 2),
        potential: number(dwells.iter().map(|dwell| dwell.potential_j).sum(), 1),
    }
}
