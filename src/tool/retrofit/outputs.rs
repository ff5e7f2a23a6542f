//! The complete program as files.

use std::collections::BTreeMap;

use super::figures::{OutputFile, OutputKind};
use super::guards::Guards;
use super::rests::{self, Resting};
use super::work::{RetrofitError, Source, Way, run_of};
use crate::arm::kinematics::fk;
use crate::arm::robot::Model;
use crate::rapid::ir::movement::{Argument, Movement};
use crate::rapid::ir::number::number;
use crate::rapid::ir::predefined;
use crate::rapid::ir::value::Datum;
use crate::rapid::text::{self, FileId, SourceFile, Span};
use crate::retime::motion::Simulation;
use crate::retime::optimize::idle::Dwell;
use crate::retime::optimize::site::Site;
use crate::tool::emit::{
    self, EmittedStream, Layout, MotionSettings, Names, Parameter, Recorded, Robot,
};
use sha2::{Digest, Sha256};

/// What stays the same from one emission to the next.
pub(super) struct Writing<'a> {
    /// The files of the program.
    pub(super) files: &'a [Source],
    /// The same as they are read.
    pub(super) originals: Vec<SourceFile>,
    /// The file beside which new modules lie.
    pub(super) beside: usize,
    /// What guards compare.
    pub(super) guards: &'a Guards<'a>,
    /// The robot that streams are made for.
    pub(super) robot: Robot,
    /// The operator's speed override that they are made for, %.
    pub(super) override_percent: f64,
    /// What the program writes down for them.
    pub(super) recorded: Recorded,
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
    restings: &[Resting],
) -> Result<Outputs, RetrofitError> {
    let files = writing.files;
    let mut emitted_sites: Vec<emit::Site> = sites
        .iter()
        .enumerate()
        .filter_map(|(index, site)| site_of(writing, simulation, sites, ways, (index, site)))
        .collect();
    emitted_sites
        .extend(restings.iter().filter_map(|rest| rests::emitted(writing, simulation, rest)));
    let mut outputs = Vec::new();
    if emitted_sites.is_empty() {
        for (i, source) in files.iter().enumerate() {
            outputs.push(unchanged(i, source));
        }
        return Ok(Outputs { files: outputs, guards: Vec::new() });
    }
    let program = hash(&writing.originals);
    let emission = emit::Emission {
        files: &writing.originals,
        names: &writing.names,
        layout: writing.layout,
        robot: &writing.robot,
        override_percent: writing.override_percent,
        recorded: &writing.recorded,
        program: &program,
    };
    let emitted = emit::emit(&emission, &emitted_sites)?;
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
    let guards = emitted_sites.iter().map(|site| site.span).zip(emitted.instructions).collect();
    Ok(Outputs { files: outputs, guards })
}

/// The files of an emitted program.
pub(super) struct Outputs {
    /// All of them.
    pub(super) files: Vec<OutputFile>,
    /// Places with guards, and the RAPID instructions that these run in a cycle.
    pub(super) guards: Vec<(Span, usize)>,
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

/// The robot as guards know it: what its controller calls it, and where a posture that no other
/// robot shares brings its flange.
pub(super) fn robot(model: &Model) -> Robot {
    let place = (model.kinematics.base * fk(model, &POSTURE)).translation.vector;
    Robot { kind: model.type_name().to_owned(), posture: POSTURE, place: place.into() }
}

/// A posture in which every length of an arm counts, rad.
const POSTURE: [f64; 6] = [0.3, 0.2, -0.4, 0.5, 0.7, 0.0];

/// What tells one version of a program from another.
fn hash(files: &[SourceFile]) -> String {
    let mut hasher = Sha256::new();
    for file in files {
        hasher.update((file.bytes.len() as u64).to_le_bytes());
        hasher.update(&file.bytes);
    }
    let digest = hasher.finalize();
    digest.iter().take(HASH_BYTES).fold(String::new(), |text, byte| text + &format!("{byte:02x}"))
}

/// Bytes of a hash that are written.
const HASH_BYTES: usize = 8;

/// A site with its streams; `None` where there is none.
fn site_of(
    writing: &Writing<'_>,
    simulation: &Simulation,
    sites: &[Site],
    ways: &[Way],
    (index, site): (usize, &Site),
) -> Option<emit::Site> {
    let first = ways.iter().find(|way| way.site == index && way.outcome.is_ok())?;
    let run = run_of(simulation, sites, first)?;
    let mut streams: Vec<(Vec<Parameter>, EmittedStream)> = Vec::new();
    let mut order: Vec<(usize, Option<usize>)> = Vec::new();
    for way in ways.iter().filter(|way| way.site == index) {
        let stream = stream(writing, simulation, sites, way);
        let runs = stream.is_some().then_some(streams.len());
        order.extend(site.variants[way.variant].events.iter().map(|event| (*event, runs)));
        streams.extend(stream);
    }
    order.sort_unstable();
    let parameters = streams.first()?.0.clone();
    let movements = || run.moves.iter().map(|record| &record.movement);
    let first = movements().next()?;
    Some(emit::Site {
        span: site.span,
        origin: place(writing.files, site.span),
        parameters,
        settings: MotionSettings {
            fastest: movements().map(|m| 1e3 * m.speed.tcp).fold(0.0, f64::max).min(MOST_SPEED),
            conf_joint: first.settings.conf_joint,
            conf_linear: first.settings.conf_linear,
            lines: movements().any(|movement| movement.line_speed().is_finite()),
        },
        tool: argument(writing.files, first.tool_span),
        streams: streams.into_iter().map(|(_, stream)| stream).collect(),
        order: order.into_iter().map(|(_, runs)| runs).collect(),
    })
}

/// The speed that `VelSet` allows by itself, mm/s: faster programmed speeds are cut there.
const MOST_SPEED: f64 = 5000.0;

/// File and lines of some statements.
pub(super) fn place(files: &[Source], span: Span) -> String {
    let file = &files[span.file.0 as usize];
    let first = file.file.position(span.start).line;
    let last = file.file.position(span.end).line;
    let lines = if first == last { format!("{first}") } else { format!("{first}-{last}") };
    format!("{} {lines}", ascii(&file.relative))
}

fn stream(
    writing: &Writing<'_>,
    simulation: &Simulation,
    sites: &[Site],
    way: &Way,
) -> Option<(Vec<Parameter>, EmittedStream)> {
    let retiming = way.outcome.as_ref().ok()?;
    let run = run_of(simulation, sites, way)?;
    let site = &sites[way.site];
    let variants = site.variants.len();
    let way_text = if variants > 1 {
        format!(", way {} of {variants}", way.variant + 1)
    } else {
        String::new()
    };
    let first = &run.moves.first()?.movement;
    let (parameters, values) = compared(writing, &site.variants[way.variant].arguments, first);
    let before: f64 = retiming.energy_before_j;
    let stream = EmittedStream {
        start: run.start,
        points: retiming.stream.points().to_vec(),
        intervals: retiming.stream.intervals().to_vec(),
        pause: None,
        external: first.external?,
        values,
        origin: format!("{}{way_text}", place(writing.files, site.span)),
        before: format!("{} s {} J", number(run.duration(), 3), number(before, 1)),
        after: format!(
            "{} s {} J",
            number(retiming.duration_s, 3),
            number(retiming.energy.energy_j(), 1)
        ),
    };
    Some((parameters, stream))
}

/// What a guard compares, and with what: arguments, and the load where the program changes it.
pub(super) fn compared(
    writing: &Writing<'_>,
    arguments: &[Argument],
    movement: &Movement,
) -> (Vec<Parameter>, Vec<Datum>) {
    let mut compared = writing.guards.parameters(arguments);
    if writing.recorded.load {
        let load = movement.settings.grip_load_data.clone();
        let load = load.or_else(|| predefined::lookup("load0").map(|value| value.datum));
        let parameter = Parameter {
            text: None,
            label: "GripLoad".to_owned(),
            type_name: "loaddata",
            is_computed: false,
        };
        compared.extend(load.map(|load| (parameter, load)));
    }
    compared.into_iter().unzip()
}

/// An argument as the program writes it, to be written again at the same place.
pub(super) fn argument(files: &[Source], span: Span) -> String {
    let file = &files[span.file.0 as usize].file;
    file.text(span).into_owned()
}

/// Comments are plain ASCII, whatever the file's encoding.
pub(super) fn ascii(text: &str) -> String {
    text.chars().map(|c| if c.is_ascii_graphic() { c } else { '_' }).collect()
}

/// The file with the note on brakes.
pub const BRAKE_NOTE: &str = "joulepath_brakes.txt";

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
        path: BRAKE_NOTE.to_owned(),
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
