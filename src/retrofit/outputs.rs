//! The complete program as files.

use std::collections::BTreeMap;

use super::figures::{OutputFile, OutputKind};
use super::work::{RetrofitError, Source, Way, run_of};
use crate::emit::{self, EmittedStream, Layout, Names};
use crate::ir::number::number;
use crate::motion::Simulation;
use crate::optimize::idle::Dwell;
use crate::optimize::site::Site;
use crate::robot::Model;
use crate::text::{self, FileId, SourceFile, Span};

/// What stays the same from one emission to the next.
pub(super) struct Writing<'a> {
    /// The files of the program.
    pub(super) files: &'a [Source],
    /// The same as they are read.
    pub(super) originals: Vec<SourceFile>,
    /// The file beside which new modules lie.
    pub(super) beside: usize,
    /// Names that are free.
    pub(super) names: Names,
    /// How points are written.
    pub(super) layout: Layout,
}

/// Emits the ways that have streams; every other file stays as it was.
pub(super) fn emit(
    writing: &Writing<'_>,
    simulation: &Simulation,
    sites: &[Site],
    ways: &[Way],
) -> Result<Vec<OutputFile>, RetrofitError> {
    let files = writing.files;
    let mut emitted_sites = Vec::new();
    for (index, site) in sites.iter().enumerate() {
        let streams: Vec<EmittedStream> = ways
            .iter()
            .filter(|way| way.site == index)
            .filter_map(|way| stream(files, simulation, sites, way))
            .collect();
        if !streams.is_empty() {
            emitted_sites.push(emit::Site { span: site.span, streams });
        }
    }
    let mut outputs = Vec::new();
    if emitted_sites.is_empty() {
        for (i, source) in files.iter().enumerate() {
            outputs.push(unchanged(i, source));
        }
        return Ok(outputs);
    }
    let emitted = emit::emit(&writing.originals, &writing.names, writing.layout, &emitted_sites)?;
    for (i, source) in files.iter().enumerate() {
        let edits: Vec<text::Edit> =
            emitted.edits.iter().filter(|e| e.span.file.0 as usize == i).cloned().collect();
        if edits.is_empty() {
            outputs.push(unchanged(i, source));
            continue;
        }
        // Insertions at distinct places of the file can't overlap.
        let bytes =
            text::apply(&source.file.bytes, &edits).unwrap_or_else(|_| source.file.bytes.clone());
        outputs.push(OutputFile {
            path: source.relative.clone(),
            kind: OutputKind::Changed,
            bytes,
            input: Some(i),
        });
    }
    let entry_file = &files[writing.beside];
    let folder = entry_file.relative.rsplit_once('/').map_or("", |(folder, _)| folder);
    let end_of_line = emit::end_of_line(&entry_file.file.bytes);
    for (name, text) in emitted.modules {
        let path =
            if folder.is_empty() { format!("{name}.mod") } else { format!("{folder}/{name}.mod") };
        let text = text.replace('\n', end_of_line);
        outputs.push(OutputFile {
            path,
            kind: OutputKind::New,
            bytes: text.into_bytes(),
            input: None,
        });
    }
    Ok(outputs)
}

/// The files as a reader of the emitted program finds them.
pub fn read_again(outputs: &[OutputFile]) -> Vec<Source> {
    let file = |(i, output): (usize, &OutputFile)| Source {
        file: SourceFile::new(FileId(i as u32), output.path.clone(), output.bytes.clone()),
        relative: output.path.clone(),
    };
    outputs.iter().enumerate().map(file).collect()
}

/// A file of the program as it was.
pub(super) fn unchanged(index: usize, source: &Source) -> OutputFile {
    OutputFile {
        path: source.relative.clone(),
        kind: OutputKind::Unchanged,
        bytes: source.file.bytes.clone(),
        input: Some(index),
    }
}

fn stream(
    files: &[Source],
    simulation: &Simulation,
    sites: &[Site],
    way: &Way,
) -> Option<EmittedStream> {
    let retiming = way.outcome.as_ref().ok()?;
    let run = run_of(simulation, sites, way)?;
    let site = &sites[way.site];
    let file = &files[site.span.file.0 as usize];
    let first = file.file.position(site.span.start).line;
    let last = file.file.position(site.span.end).line;
    let lines = if first == last { format!("{first}") } else { format!("{first}-{last}") };
    let variants = site.variants.len();
    let way_text = if variants > 1 {
        format!(", way {} of {variants}", way.variant + 1)
    } else {
        String::new()
    };
    let before: f64 = retiming.energy_before_j;
    Some(EmittedStream {
        start: run.start,
        points: retiming.stream.points().to_vec(),
        intervals: retiming.stream.intervals().to_vec(),
        external: run.moves.first()?.movement.external?,
        locals: site.variants[way.variant].locals.clone(),
        tool: argument(files, run.moves.first()?.movement.tool_span),
        origin: format!("{} {lines}{way_text}", ascii(&file.relative)),
        before: format!("{} s {} J", number(run.duration(), 3), number(before, 1)),
        after: format!(
            "{} s {} J",
            number(retiming.duration_s, 3),
            number(retiming.energy.energy_j(), 1)
        ),
    })
}

/// An argument as the program writes it, to be written again at the same place.
fn argument(files: &[Source], span: Span) -> String {
    let file = &files[span.file.0 as usize].file;
    file.text(span).into_owned()
}

/// Comments are plain ASCII, whatever the file's encoding.
fn ascii(text: &str) -> String {
    text.chars().map(|c| if c.is_ascii_graphic() { c } else { '_' }).collect()
}

/// A note for dwells of the emitted program that pay, with the setting that they need.
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
    outputs.push(OutputFile {
        path: "joulepath_brakes.txt".to_owned(),
        kind: OutputKind::New,
        bytes: text.into_bytes(),
        input: None,
    });
}

/// The dwells of one place: figures of the longest, joules of all.
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
