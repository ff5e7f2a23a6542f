//! The original source with the energy of each line.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};

use super::format::joules;
use crate::rapid::text::{SourceFile, Span};
use crate::retime::energy::EnergyParts;
use crate::retime::motion::timeline::What;
use crate::tool::retrofit::Retrofit;

/// Number of lines shown around lines with costs.
const CONTEXT: u32 = 3;
/// Maximum number of shown characters of a line.
const MAX_CHARACTERS: usize = 300;

/// Energies of the lines of a file, J.
#[derive(Default)]
struct Costs {
    before: BTreeMap<u32, f64>,
    after: BTreeMap<u32, f64>,
    /// Rewritten lines by first line: last line and energy after the retrofit.
    streams: BTreeMap<u32, (u32, f64)>,
}

impl Costs {
    /// Adds lines that run as a stream, with its energy. Streams with common lines share a cell.
    fn add_stream(&mut self, mut first: u32, mut last: u32, mut energy: f64) {
        while let Some((other, (end, joules))) =
            self.streams.range(..=last).next_back().map(|(k, v)| (*k, *v))
            && end >= first
        {
            self.streams.remove(&other);
            (first, last, energy) = (first.min(other), last.max(end), energy + joules);
        }
        self.streams.insert(first, (last, energy));
    }

    /// Adds the energy of a movement or wait that is no stream to its line, or to the streams there.
    fn add_other(&mut self, line: u32, energy: f64) {
        match self.streams.range_mut(..=line).next_back().filter(|(_, (end, _))| line <= *end) {
            Some((_, (_, joules))) => *joules += energy,
            None => *self.after.entry(line).or_default() += energy,
        }
    }
}

/// The files with costs, in order, for the template.
pub(super) fn sources(retrofit: &Retrofit, files: &[SourceFile]) -> Vec<Value> {
    let mut all: Vec<Costs> = files.iter().map(|_| Costs::default()).collect();
    streams(retrofit, files, &mut all);
    moves_and_waits(retrofit, files, &mut all);
    files
        .iter()
        .zip(&all)
        .filter(|(_, costs)| !costs.before.is_empty())
        .map(|(file, costs)| annotated(file, costs))
        .collect()
}

fn streams(retrofit: &Retrofit, files: &[SourceFile], all: &mut [Costs]) {
    for segment in retrofit.segments.iter().filter(|segment| segment.rewritten) {
        // The stream is at the last piece.
        for (rest, piece) in segment.pieces.iter().rev().enumerate() {
            let Some((costs, [first, last])) = at_span(files, all, *piece) else { continue };
            costs.add_stream(first, last, if rest == 0 { segment.energy_after_j } else { 0.0 });
        }
    }
}

fn moves_and_waits(retrofit: &Retrofit, files: &[SourceFile], all: &mut [Costs]) {
    let (before, after) = (&retrofit.before.1.events, &retrofit.after.1.events);
    let rewritten = retrofit.segments.iter().filter(|segment| segment.rewritten);
    let counted: BTreeSet<usize> = rewritten.flat_map(|it| it.events.iter().copied()).collect();
    for (i, event) in retrofit.before.0.events.iter().enumerate() {
        let spans: Vec<Span> = match &event.what {
            What::Run(run) => run.moves.iter().map(|record| record.movement.span).collect(),
            What::Wait(wait) => vec![wait.wait.span],
            What::Output(..) | What::Left(_) => continue,
        };
        for (k, span) in spans.into_iter().enumerate() {
            let Some((costs, [line, _])) = at_span(files, all, span) else { continue };
            let energy = |events: &[Vec<EnergyParts>]| {
                events.get(i).and_then(|parts| parts.get(k)).map_or(0.0, EnergyParts::energy_j)
            };
            *costs.before.entry(line).or_default() += energy(before);
            if !counted.contains(&i) {
                costs.add_other(line, energy(after));
            }
        }
    }
}

/// The costs of the file of a span, and the first and the last line of the span.
pub(super) fn at_span<'c, T>(
    files: &[SourceFile],
    costs: &'c mut [T],
    span: Span,
) -> Option<(&'c mut T, [u32; 2])> {
    let index = span.file.0 as usize;
    let (file, costs) = (files.get(index)?, costs.get_mut(index)?);
    let last = span.end.max(span.start + 1) - 1;
    Some((costs, [file.position(span.start).line, file.position(last).line]))
}

/// The lines in ranges and `margin` lines around them, each with the number of lines left out
/// before it. The ranges are sorted.
pub(super) fn shown_lines(
    file: &SourceFile,
    ranges: impl IntoIterator<Item = (u32, u32)>,
    margin: u32,
) -> Vec<(u32, u32)> {
    let mut shown = Vec::new();
    let mut previous = 0;
    for (first, last) in ranges {
        let from = first.saturating_sub(margin).max(previous + 1);
        for number in from..=(last + margin).min(file.lines.count()) {
            shown.push((number, number - previous - 1));
            previous = number;
        }
    }
    shown
}

fn annotated(file: &SourceFile, costs: &Costs) -> Value {
    let hottest = costs.before.values().copied().fold(0.0, f64::max);
    let ends = costs.streams.iter().map(|(first, (last, _))| (*first, *last));
    let mut ranges: Vec<(u32, u32)> =
        costs.before.keys().map(|line| (*line, *line)).chain(ends).collect();
    ranges.sort_unstable();
    let mut lines = Vec::new();
    let mut covered = 0;
    for (number, gap) in shown_lines(file, ranges, CONTEXT) {
        let before = costs.before.get(&number);
        // The cell of a stream spans several rows.
        let after = if number <= covered {
            None
        } else if let Some((last, energy)) = costs.streams.get(&number) {
            covered = *last;
            let rows = last - number + 1;
            Some(json!({ "rows": rows, "text": joules(*energy), "rewritten": true }))
        } else {
            let text = costs.after.get(&number).map(|x| joules(*x)).unwrap_or_default();
            Some(json!({ "rows": 1, "text": text, "rewritten": false }))
        };
        let heat = before.filter(|x| **x > 0.0).map(|x| format!("{:.0}", 100.0 * x / hottest));
        lines.push(json!({
            "number": number,
            "gap": gap,
            "text": text(file, number),
            "before": before.map(|x| joules(*x)),
            "heat": heat,
            "after": after,
        }));
    }
    let streamed: f64 = costs.streams.values().map(|(_, energy)| energy).sum();
    json!({
        "path": file.path,
        "before": joules(costs.before.values().sum()),
        "after": joules(costs.after.values().sum::<f64>() + streamed),
        "lines": lines,
    })
}

/// A line without line ending and control characters, truncated if very long.
pub(super) fn text(file: &SourceFile, number: u32) -> String {
    let range = file.lines.range(number);
    let span = Span { file: file.id, start: range.start, end: range.end };
    let text = file.text(span);
    let mut characters = text
        .trim_end_matches(['\r', '\n'])
        .chars()
        .map(|c| if c.is_control() && c != '\t' { char::REPLACEMENT_CHARACTER } else { c });
    let mut line: String = characters.by_ref().take(MAX_CHARACTERS).collect();
    if characters.next().is_some() {
        line.push('\u{2026}');
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rapid::text::FileId;

    #[test]
    fn streams_that_share_a_line_share_a_cell() {
        let mut costs = Costs::default();
        for (first, last) in [(10, 12), (20, 21), (12, 12), (13, 19), (19, 20)] {
            costs.add_stream(first, last, 1.0);
        }
        let cells: Vec<_> = costs.streams.iter().map(|(k, v)| (*k, v.0, v.1)).collect();
        assert_eq!(cells, [(10, 12, 2.0), (13, 21, 3.0)]);
        for line in [9, 11, 21, 22] {
            costs.add_other(line, 1.0);
        }
        assert_eq!(costs.after.into_iter().collect::<Vec<_>>(), [(9, 1.0), (22, 1.0)]);
        let cells: Vec<f64> = costs.streams.values().map(|(_, energy)| *energy).collect();
        assert_eq!(cells, [3.0, 4.0]);
    }

    #[test]
    fn lines_are_printable_and_not_endless() {
        let long = "x".repeat(2 * MAX_CHARACTERS);
        let bytes = format!("\ta\0b\u{c}\r\n{long}\n").into_bytes();
        let file = SourceFile::new(FileId(0), "a.mod".into(), bytes);
        assert_eq!(text(&file, 1), "\ta\u{fffd}b\u{fffd}");
        assert_eq!(text(&file, 2).chars().count(), MAX_CHARACTERS + 1);
        assert_eq!(text(&file, 3), "");
    }
}
