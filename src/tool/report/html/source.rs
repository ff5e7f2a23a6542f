//! The original source with the energy of each line.

use std::collections::BTreeMap;

use serde::Serialize;

use super::format::joules;
use crate::rapid::text::{SourceFile, Span};
use crate::retime::energy::EnergyParts;
use crate::retime::motion::timeline::What;
use crate::tool::retrofit::Retrofit;

/// Number of lines shown around lines with costs.
const CONTEXT: u32 = 3;
/// Maximum number of shown characters of a line.
const MAX_CHARACTERS: usize = 300;

/// A file with at least one line with costs.
#[derive(Serialize)]
pub(super) struct Annotated {
    path: String,
    before: String,
    after: String,
    lines: Vec<Line>,
}

/// A shown line.
#[derive(Serialize)]
struct Line {
    /// From 1.
    number: u32,
    /// Number of lines left out before it.
    gap: u32,
    text: String,
    before: Option<String>,
    /// Energy relative to the most expensive line of the file, %.
    heat: Option<String>,
    /// The cell with the energy after the retrofit, unless a cell above spans this row.
    after: Option<Cell>,
}

/// Energy of one or several lines.
#[derive(Serialize)]
struct Cell {
    rows: u32,
    text: String,
    rewritten: bool,
}

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

    /// Whether a line now runs as a stream.
    fn is_streamed(&self, line: u32) -> bool {
        self.streams.range(..=line).next_back().is_some_and(|(_, (end, _))| line <= *end)
    }
}

/// The files with costs, in order.
pub(super) fn sources(retrofit: &Retrofit, files: &[SourceFile]) -> Vec<Annotated> {
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
        let index = segment.span.file.0 as usize;
        let (Some(file), Some(costs)) = (files.get(index), all.get_mut(index)) else { continue };
        let [first, last] = lines(file, segment.span);
        costs.add_stream(first, last, segment.energy_after_j);
    }
}

fn moves_and_waits(retrofit: &Retrofit, files: &[SourceFile], all: &mut [Costs]) {
    let (before, after) = (&retrofit.before.1.events, &retrofit.after.1.events);
    for (i, event) in retrofit.before.0.events.iter().enumerate() {
        let spans: Vec<Span> = match &event.what {
            What::Run(run) => run.moves.iter().map(|record| record.movement.span).collect(),
            What::Wait(wait) => vec![wait.wait.span],
            What::Output(..) | What::Left(_) => continue,
        };
        for (k, span) in spans.into_iter().enumerate() {
            let index = span.file.0 as usize;
            let (Some(file), Some(costs)) = (files.get(index), all.get_mut(index)) else {
                continue;
            };
            let [line, _] = lines(file, span);
            let energy = |events: &[Vec<EnergyParts>]| {
                events.get(i).and_then(|parts| parts.get(k)).map_or(0.0, EnergyParts::energy_j)
            };
            *costs.before.entry(line).or_default() += energy(before);
            if !costs.is_streamed(line) {
                *costs.after.entry(line).or_default() += energy(after);
            }
        }
    }
}

/// First and last line of a span.
fn lines(file: &SourceFile, span: Span) -> [u32; 2] {
    let last = span.end.max(span.start + 1) - 1;
    [file.position(span.start).line, file.position(last).line]
}

fn annotated(file: &SourceFile, costs: &Costs) -> Annotated {
    let count = file.lines.count();
    let hottest = costs.before.values().copied().fold(0.0, f64::max);
    let mut shown: Vec<u32> = Vec::new();
    let ends = costs.streams.iter().map(|(first, (last, _))| (*first, *last));
    let mut ranges: Vec<(u32, u32)> =
        costs.before.keys().map(|line| (*line, *line)).chain(ends).collect();
    ranges.sort_unstable();
    for (first, last) in ranges {
        let from = first.saturating_sub(CONTEXT).max(1).max(shown.last().map_or(1, |n| n + 1));
        shown.extend(from..=(last + CONTEXT).min(count));
    }
    let mut lines = Vec::new();
    let mut previous = 0;
    let mut covered = 0;
    for number in shown {
        let before = costs.before.get(&number);
        let after = if number <= covered {
            None
        } else if let Some((last, energy)) = costs.streams.get(&number) {
            covered = *last;
            Some(Cell { rows: last - number + 1, text: joules(*energy), rewritten: true })
        } else {
            let text = costs.after.get(&number).map(|x| joules(*x)).unwrap_or_default();
            Some(Cell { rows: 1, text, rewritten: false })
        };
        lines.push(Line {
            number,
            gap: number - previous - 1,
            text: text(file, number),
            before: before.map(|x| joules(*x)),
            heat: before.filter(|x| **x > 0.0).map(|x| format!("{:.0}", 100.0 * x / hottest)),
            after,
        });
        previous = number;
    }
    let streamed: f64 = costs.streams.values().map(|(_, energy)| energy).sum();
    Annotated {
        path: file.path.clone(),
        before: joules(costs.before.values().sum()),
        after: joules(costs.after.values().sum::<f64>() + streamed),
        lines,
    }
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
        let streamed: Vec<u32> = (0..30).filter(|line| costs.is_streamed(*line)).collect();
        assert_eq!(streamed, (10..=21).collect::<Vec<u32>>());
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
