//! A program with a recorder.

use std::collections::BTreeSet;

use super::check::check;
use super::cost::{Cost, Recorded, Samplings, cost};
use super::error::InstrumentError;
use super::hash::program_hash;
use super::insert::{before, behind};
use super::remove::is_recorder;
use super::sites::{Site, SiteKind, Stop, sites};
use super::watched::{Watched, watched};
use crate::arm::robot::Model;
use crate::rapid::ir::signals::signals;
use crate::rapid::text::{Edit, SourceFile, Span, charset};
use crate::retime::motion::timeline::What;
use crate::retime::motion::{Options, Simulation, simulate};
use crate::tool::emit::{
    self, Names, RecordedSignal, RecordedSite, Recorder, Sampling, end_of_line, log_name,
};
use crate::tool::retrofit::{
    OutputFile, Source, file_and_line, is_streams, prefix, read_program, with_edits,
};

/// Maximum length of a place in a string of the recorder, characters.
const LONGEST_PLACE: usize = 70;
/// Largest extra time that is asked for, ms for each movement.
const BUDGET_MS: f64 = 5.0;

/// What is recorded beside movements and waits.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Request {
    /// Signals; `None` for the digital inputs for which the program waits.
    pub signals: Option<Vec<String>>,
    /// Samples of the joints.
    pub samples: Option<Samples>,
    /// A movement that begins later in every second cycle.
    pub late: Option<Late>,
}

/// Samples of the joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// Axes with speed and torque, from 1.
    pub axes: Vec<u32>,
    /// Number in a second.
    pub rate: f64,
}

/// A wait to which the robot comes later in every second cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct Late {
    /// End of the path of its file.
    pub file: String,
    /// Its line.
    pub line: u32,
    /// s.
    pub seconds: f64,
}

/// A program with a recorder.
#[derive(Debug)]
pub struct Instrumented {
    /// The complete program.
    pub outputs: Vec<OutputFile>,
    /// Hash of the program without the recorder.
    pub program: String,
    /// Name of the log on the controller, with its extension.
    pub log: String,
    /// The recorded signals.
    pub signals: Vec<String>,
    /// Number of recorded movements, waits and outputs in the text.
    pub recorded: [usize; 3],
    /// Places that are not recorded, and why.
    pub left_out: Vec<(String, &'static str)>,
    /// What it takes.
    pub cost: Cost,
    /// Notes that its memory holds.
    pub memory: usize,
    /// Rows of samples that a cycle writes.
    pub sample_rows: Option<usize>,
}

/// Puts a recorder into a program.
///
/// # Errors
/// See [`InstrumentError`].
pub fn instrument(
    files: &[Source],
    entry: &str,
    (model, options): (&Model, &Options),
    request: &Request,
) -> Result<Instrumented, InstrumentError> {
    if let Some(other) = files.iter().find(|source| is_recorder(&source.file.bytes)) {
        return Err(InstrumentError::Recorder(other.file.path.clone()));
    }
    let (program, entry_id) = read_program(files, entry)?;
    let sources: Vec<SourceFile> = files.iter().map(|source| source.file.clone()).collect();
    let known = signals(&program);
    let runs: Vec<String> = files
        .iter()
        .filter(|source| is_streams(&source.file.bytes))
        .filter_map(|source| Some(format!("{}run", prefix(&source.file.bytes)?.to_lowercase())))
        .collect();
    let is_run = |key: &str| {
        let number = runs.iter().find_map(|run| key.strip_prefix(run.as_str()));
        number.is_some_and(|number| number.parse::<usize>().is_ok())
    };
    let found = sites(&program, entry_id, &sources, &known, &is_run);
    if found.sites.iter().all(|site| matches!(site.kind, SiteKind::Cycle)) {
        return Err(InstrumentError::Nothing);
    }
    let watched = watched(request.signals.as_deref(), &known, &found.sites)?;
    let simulation = simulate(&program, entry_id, model, options);
    let late =
        request.late.as_ref().map(|late| late_movement(late, files, &simulation, &found.sites));
    let late = late.transpose()?;

    let hash = program_hash(files);
    let recorded: Vec<Recorded> = found.sites.iter().map(Recorded::new).collect();
    let mut samplings = request.samples.as_ref().map(|samples| Samplings {
        rate: samples.rate,
        columns: 6 + 2 * samples.axes.len(),
        rows: 0,
    });
    let without_samples = cost(&simulation, &recorded, watched.len(), samplings);
    if let Some(samplings) = &mut samplings {
        samplings.fill(&without_samples, BUDGET_MS);
    }
    let tools = has_tools(&found.sites);
    let recorder = Recorder {
        program: &hash,
        sites: recorded_sites(files, &found.sites, &watched),
        signals: numbered(&watched, found.sites.len()),
        sampling: request.samples.as_ref().zip(samplings).map(|(samples, own)| Sampling {
            axes: samples.axes.clone(),
            interval: 1.0 / samples.rate,
            rows: own.rows,
        }),
        tools,
        late,
    };
    let names = Names::of_recorder(&sources);
    let module = emit::recorder(&names, &recorder)
        .map_err(|error| InstrumentError::Template(error.to_string()))?;
    let mut outputs =
        with_edits(files, edits(&sources, &found.sites, &names.prefix, tools).into_iter())
            .ok_or_else(|| InstrumentError::Differs("two insertions overlap".to_owned()))?;
    let beside = &files[program.modules[entry_id.module].span.file.0 as usize];
    let folder = beside.relative.rsplit_once('/').map_or("", |(folder, _)| folder);
    let separator = if folder.is_empty() { "" } else { "/" };
    outputs.push(OutputFile::added(
        format!("{folder}{separator}{}.mod", names.module),
        module.replace('\n', end_of_line(&beside.file.bytes)),
    ));
    check(files, &outputs, (entry, &names.prefix), (model, options), &simulation)?;
    let count = |is: fn(&SiteKind) -> bool| found.sites.iter().filter(|s| is(&s.kind)).count();
    Ok(Instrumented {
        outputs,
        log: format!("{}.csv", log_name(&hash)),
        signals: watched.into_iter().map(|signal| signal.name).collect(),
        recorded: [
            count(|kind| matches!(kind, SiteKind::Movement { .. })),
            count(|kind| matches!(kind, SiteKind::Wait { .. })),
            count(|kind| matches!(kind, SiteKind::Output { .. })),
        ],
        left_out: found
            .left_out
            .into_iter()
            .map(|(span, why)| (file_and_line(files, span), why))
            .collect(),
        cost: cost(&simulation, &recorded, recorder.signals.len(), samplings),
        memory: emit::MOST_NOTES,
        sample_rows: samplings.map(|own| own.rows),
        program: hash,
    })
}

/// The number of the movement with which the way to a wait begins, and the time by which it begins
/// later, s.
fn late_movement(
    late: &Late,
    files: &[Source],
    simulation: &Simulation,
    sites: &[Site],
) -> Result<(usize, f64), InstrumentError> {
    let place = format!("{}:{}", late.file, late.line);
    let error = |reason| InstrumentError::Late { place: place.clone(), reason };
    let is_it = |span: Span| {
        let source = &files[span.file.0 as usize];
        let line = source.file.position(span.start).line;
        line == late.line && source.relative.to_lowercase().ends_with(&late.file.to_lowercase())
    };
    let mut first = None;
    for event in &simulation.events {
        match &event.what {
            What::Run(run) => first = run.moves.first().map(|record| record.movement.span),
            What::Wait(record) if is_it(record.wait.span) => {
                let first = first.ok_or_else(|| {
                    error("no movement of the cycle comes before this wait: name a later one")
                })?;
                let site = sites.iter().position(|site| {
                    site.span == first && matches!(site.kind, SiteKind::Movement { .. })
                });
                let site = site.ok_or_else(|| {
                    error("the movement before this wait is not recorded: name another wait")
                })?;
                return Ok((site + 1, late.seconds));
            }
            _ => {}
        }
    }
    Err(error("the simulated cycle comes to no wait at this line: name a wait as FILE:LINE"))
}

/// The recorded statements, then the signals.
fn recorded_sites(files: &[Source], sites: &[Site], watched: &[Watched]) -> Vec<RecordedSite> {
    let place = |span: Span| {
        let source = &files[span.file.0 as usize];
        let line = source.file.position(span.start).line;
        let count = source.relative.chars().count();
        let path: String =
            source.relative.chars().skip(count.saturating_sub(LONGEST_PLACE)).collect();
        format!("{},{line}", path.replace(['"', ',', '\\'], "_"))
    };
    let of_site = |site: &Site| RecordedSite {
        place: place(site.span),
        signal: match &site.kind {
            SiteKind::Wait { signal, .. } => signal.clone().unwrap_or_default(),
            SiteKind::Output { signal, .. } => signal.clone(),
            _ => String::new(),
        },
    };
    let of_signal =
        |signal: &Watched| RecordedSite { place: ",".to_owned(), signal: signal.name.clone() };
    sites.iter().map(of_site).chain(watched.iter().map(of_signal)).collect()
}

fn numbered(watched: &[Watched], sites: usize) -> Vec<RecordedSignal> {
    let number = |(index, signal): (usize, &Watched)| RecordedSignal {
        name: signal.name.clone(),
        is_output: signal.is_output,
        site: sites + index + 1,
    };
    watched.iter().enumerate().map(number).collect()
}

/// Whether movements have different tools; with one tool there is nothing to tell.
fn has_tools(sites: &[Site]) -> bool {
    let masses = sites.iter().filter_map(|site| match &site.kind {
        SiteKind::Movement { mass, .. } => mass.as_ref(),
        _ => None,
    });
    masses.collect::<BTreeSet<_>>().len() > 1
}

/// The insertions of all calls. `tools`: whether those at movements give the mass of the tool.
fn edits(files: &[SourceFile], sites: &[Site], p: &str, tools: bool) -> Vec<Edit> {
    let mut edits = Vec::new();
    for (index, Site { span, kind }) in sites.iter().enumerate() {
        let number = index + 1;
        let file = &files[span.file.0 as usize];
        let calls = match kind {
            SiteKind::Cycle => [Some(format!("{p}Cycle")), None],
            SiteKind::Movement { stop, mass } => {
                let mass = mass.as_ref().filter(|_| tools);
                let tool = mass.map_or_else(String::new, |mass| format!("\\Tool:={mass}"));
                let done = match stop {
                    Stop::Never => None,
                    Stop::Always => Some(format!("{p}Done {number}")),
                    Stop::If(text) => Some(format!("{p}Done {number}\\Stops:={text}")),
                };
                [Some(format!("{p}Move {number}{tool}")), done]
            }
            SiteKind::Wait { flag, most, .. } => {
                let limit = match (flag, most) {
                    (Some(flag), _) => format!("\\Timeout:={flag}"),
                    (None, Some(most)) => format!("\\Most:={most}"),
                    (None, None) => String::new(),
                };
                [Some(format!("{p}Wait {number}")), Some(format!("{p}End {number}{limit}"))]
            }
            SiteKind::Output { level, .. } => [None, Some(format!("{p}Out {number},{level}"))],
            SiteKind::Load(mass) => [None, Some(format!("{p}Load {number},{mass}"))],
        };
        let [first, second] = calls;
        edits.extend(first.map(|call| before(file, *span, &call)));
        edits.extend(second.map(|call| behind(file, *span, &call)));
    }
    // The names of the program go into the encoding of its file.
    for edit in &mut edits {
        let charset = charset(&files[edit.span.file.0 as usize].bytes);
        let encoded = std::str::from_utf8(&edit.text).ok().and_then(|text| charset.encode(text));
        edit.text = encoded.unwrap_or_else(|| std::mem::take(&mut edit.text));
    }
    edits
}
