//! A program with a recorder.

use std::collections::{BTreeMap, BTreeSet};

use super::cost::{Cost, Recorded, Samplings, cost};
use super::insert::{before, behind};
use super::remove::{is_recorder, without_recorder};
use super::sites::{Site, SiteKind, Stop, sites};
use crate::arm::robot::{Model, nearest};
use crate::rapid::builtins::SignalKind;
use crate::rapid::ir::movement::Movement;
use crate::rapid::ir::signals::{Signal, signals};
use crate::rapid::text::{Edit, SourceFile, Span, charset};
use crate::retime::motion::timeline::What;
use crate::retime::motion::{Options, Simulation, simulate};
use crate::tool::cell::program_hash;
use crate::tool::emit::{
    self, Names, RecordedSignal, RecordedSite, Recorder, Sampling, end_of_line, log_name,
};
use crate::tool::retrofit::{
    OutputFile, RetrofitError, Source, file_and_line, is_streams, parses, prefix, read_again,
    read_program, with_edits,
};

/// Signals whose changes are recorded at most: an interrupt each, of the 100 that a controller has.
const MOST_SIGNALS: usize = 40;
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
    /// Rows of samples that a cycle writes.
    pub sample_rows: Option<usize>,
}

/// Why a program gets no recorder.
#[derive(Debug, thiserror::Error)]
pub enum InstrumentError {
    /// The program cannot be read.
    #[error(transparent)]
    Read(#[from] RetrofitError),
    /// It has one.
    #[error(
        "'{0}' is a recorder already: take it out first, with joulepath instrument PROGRAM --remove --out DIR"
    )]
    Recorder(String),
    /// Nothing to record.
    #[error("the program has no movements and no waits that could be recorded")]
    Nothing,
    /// A signal that the program does not name.
    #[error("--signals {name}: the program names no signal '{name}'; {way_out}")]
    UnknownSignal {
        /// Its name.
        name: String,
        /// What to do.
        way_out: String,
    },
    /// A signal without two levels.
    #[error("--signals {0}: only digital signals are recorded; leave it out")]
    NotDigital(String),
    /// Too many signals.
    #[error("{0} signals are too many: name at most {MOST_SIGNALS} with --signals")]
    TooManySignals(usize),
    /// No wait there.
    #[error("--late {place}: {reason}")]
    Late {
        /// File and line.
        place: String,
        /// What is wrong, and the way out.
        reason: &'static str,
    },
    /// The program with the recorder does something else.
    #[error(
        "the program with the recorder would not do the same: {0}; nothing is written, please report this"
    )]
    Differs(String),
    /// A template failed.
    #[error("the template of the recorder failed: {0}")]
    Template(String),
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
    let watched = watched(request, &known, &found.sites)?;
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
        sample_rows: samplings.map(|own| own.rows),
        program: hash,
    })
}

/// A signal that is watched.
struct Watched {
    name: String,
    is_output: bool,
}

/// The signals of the request, or the digital inputs for which the program waits.
fn watched(
    request: &Request,
    known: &BTreeMap<String, Signal>,
    sites: &[Site],
) -> Result<Vec<Watched>, InstrumentError> {
    let outputs: BTreeSet<String> = sites
        .iter()
        .filter_map(|site| match &site.kind {
            SiteKind::Output { signal, .. } => Some(signal.to_lowercase()),
            _ => None,
        })
        .collect();
    let is_output = |name: &str| {
        let name = name.to_lowercase();
        outputs.contains(&name) || name.starts_with("do")
    };
    let is_digital = |signal: &Signal| signal.kind == Some(SignalKind::Digital);
    let mut found: Vec<Watched> = Vec::new();
    match &request.signals {
        Some(names) => {
            for name in names {
                let Some(signal) = known.get(&name.to_lowercase()) else {
                    let names = known.values().map(|signal| signal.name.as_str());
                    let way_out = nearest(name, names).map_or_else(
                        || "correct the name or leave it out".to_owned(),
                        |near| format!("did you mean {near}?"),
                    );
                    return Err(InstrumentError::UnknownSignal { name: name.clone(), way_out });
                };
                if !is_digital(signal) {
                    return Err(InstrumentError::NotDigital(name.clone()));
                }
                let is_new = found.iter().all(|other| other.name != signal.name);
                let watched = Watched { name: signal.name.clone(), is_output: is_output(name) };
                found.extend(is_new.then_some(watched));
            }
        }
        None => {
            let awaited = sites.iter().filter_map(|site| match &site.kind {
                SiteKind::Wait { signal: Some(signal), .. } => known.get(&signal.to_lowercase()),
                _ => None,
            });
            let names: BTreeSet<&str> = awaited
                .filter(|signal| is_digital(signal) && !is_output(&signal.name))
                .map(|signal| signal.name.as_str())
                .collect();
            let names = names.into_iter().take(MOST_SIGNALS);
            found.extend(names.map(|name| Watched { name: name.to_owned(), is_output: false }));
        }
    }
    if found.len() > MOST_SIGNALS {
        return Err(InstrumentError::TooManySignals(found.len()));
    }
    Ok(found)
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
            SiteKind::Wait { flag, .. } => {
                let flag =
                    flag.as_ref().map_or_else(String::new, |flag| format!("\\Timeout:={flag}"));
                [Some(format!("{p}Wait {number}")), Some(format!("{p}End {number}{flag}"))]
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

/// Reads the program with the recorder again: it must do the same, and give back the original.
fn check(
    files: &[Source],
    outputs: &[OutputFile],
    (entry, prefix): (&str, &str),
    (model, options): (&Model, &Options),
    before: &Simulation,
) -> Result<(), InstrumentError> {
    if !parses(files, outputs) {
        return Err(InstrumentError::Differs("it has syntax errors".to_owned()));
    }
    let again = read_again(outputs);
    for (source, output) in files.iter().zip(&again) {
        if without_recorder(&output.file, prefix) != source.file.bytes {
            let path = &source.file.path;
            return Err(InstrumentError::Differs(format!("'{path}' would not come back")));
        }
    }
    let (program, entry) = read_program(&again, entry)?;
    let after = simulate(&program, entry, model, options);
    let (before, after) = (steps(before), steps(&after));
    if before == after {
        return Ok(());
    }
    let differs = before.iter().zip(&after).position(|(a, b)| a != b);
    let at = differs.unwrap_or_else(|| before.len().min(after.len()));
    let text = |list: &[String]| list.get(at).cloned().unwrap_or_else(|| "the end".to_owned());
    Err(InstrumentError::Differs(format!("{} instead of {}", text(&after), text(&before))))
}

/// What a cycle does, in order.
fn steps(simulation: &Simulation) -> Vec<String> {
    let movement = |movement: &Movement| {
        let Movement { instruction, via, target, speed, zone, tool, wobj, .. } = movement;
        format!("{instruction} {via:?} {target:?} {speed:?} {zone:?} {tool:?} {wobj:?}")
    };
    let mut steps = Vec::new();
    for event in &simulation.events {
        match &event.what {
            What::Run(run) => {
                steps.extend(run.moves.iter().map(|record| movement(&record.movement)))
            }
            What::Wait(record) => {
                steps.push(format!("{} {:?}", record.wait.instruction, record.wait.signal));
            }
            What::Output(output, _) => {
                steps.push(format!("{} {} {}", output.instruction, output.signal, output.value));
            }
            What::Left(left) => steps.push(left.reason.clone()),
        }
    }
    steps
}
