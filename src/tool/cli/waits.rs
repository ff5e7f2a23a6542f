//! `joulepath waits`: which waits of the cell are slack.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::Args;

use super::common::{self, Format};
use super::input::{self, Input};
use super::{choice, output};
use crate::rapid::text::decode;
use crate::tool::cell::events::{Place, read};
use crate::tool::cell::program_hash;
use crate::tool::cell::waits::file::WaitsFile;
use crate::tool::cell::waits::{Found, Log, find, record};
use crate::tool::report::html::waits_report;
use crate::tool::report::waits::{self as report, Waits};

/// Find out from recorded cycles which waits are slack: a robot that comes later shortens them.
#[derive(Debug, Args)]
#[command(
    after_help = "A wait is slack if what it waits for counts from an event before the robot's last movement, \
    process if it counts from the robot's coming, unknown if the log does not tell; then an experiment is \
    proposed.\n\n\
    Example: joulepath waits shift.csv --program fixtures/pick_place --out waits.toml --report waits.html"
)]
pub(super) struct WaitsArgs {
    /// Logs of the recorder that joulepath instrument writes, of one version of the program.
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,

    /// The program that ran, without the recorder: its lines are shown.
    #[arg(long, value_name = "PATH")]
    program: Option<PathBuf>,

    /// Where the waits go, for joulepath optimize --waits.
    #[arg(long, value_name = "WAITS.toml")]
    out: PathBuf,

    /// Write a report as one HTML file, with the cycle as a chart.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,

    /// How the result is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,

    /// No notes on standard error.
    #[arg(long, short)]
    quiet: bool,
}

/// Most unusable rows that are told of each log.
const MAX_ROWS: usize = 3;

pub(super) fn run(args: &WaitsArgs) -> anyhow::Result<ExitCode> {
    let read_paths = args.logs.iter().chain(&args.program).map(PathBuf::as_path);
    output::refuse_inputs(
        &[("--out", Some(&args.out)), ("--report", args.report.as_ref())],
        read_paths,
    )?;
    let mut notes = Vec::new();
    let logs: Vec<Log> =
        args.logs.iter().map(|path| read_log(path, &mut notes)).collect::<Result<_, _>>()?;
    let input = args.program.as_ref().map(|path| input::read(std::slice::from_ref(path)));
    let input = input.transpose()?;
    let hash = input.as_ref().map(hash).transpose()?;
    let found = find(&logs, hash.as_deref())?;
    notes.extend(doubts(&found, &logs));
    let lines = match args.program.as_ref().zip(input.as_ref()) {
        Some((program, input)) => lines((program, input), &found, &mut notes),
        None => BTreeMap::new(),
    };
    common::notes(args.quiet, &notes);
    let program =
        args.program.as_ref().map_or("PROGRAM".to_owned(), |path| path.display().to_string());
    let path = args.out.display().to_string();
    let of = Waits { found: &found, lines: &lines, program: &program, path: &path };
    let page = args.report.as_ref().map(|_| waits_report(of, &notes)).transpose()?;
    let written = record(&found).text()?;
    // What optimize could not read is not written.
    WaitsFile::parse(&written)?;
    output::write(&args.out, written.as_bytes())?;
    if let (Some(path), Some(page)) = (&args.report, page) {
        output::write(path, page.as_bytes())?;
    }
    common::print(args.format, || report::json(of, &notes), || report::text(of))
}

fn read_log(path: &PathBuf, notes: &mut Vec<String>) -> anyhow::Result<Log> {
    let name = path.display().to_string();
    if path.is_dir() {
        bail!("{name}: this is a folder; give the log files in it one by one");
    }
    let bytes = std::fs::read(path)
        .with_context(|| format!("cannot read '{name}'; check the path and its permissions"))?;
    let recording = read(&bytes).with_context(|| name.clone())?;
    for (line, reason) in recording.rejected.iter().take(MAX_ROWS) {
        notes.push(format!("{name}: line {line} is left out: {reason}"));
    }
    if recording.rejected.len() > MAX_ROWS {
        let more = recording.rejected.len() - MAX_ROWS;
        notes.push(format!("{name}: {more} more lines are left out"));
    }
    if recording.lost > 0 {
        notes.push(format!(
            "{name}: the recorder lost {} events; their cycles are left out",
            recording.lost
        ));
    }
    Ok(Log { name, recording })
}

/// What should be known before the result is used.
fn doubts(found: &Found, logs: &[Log]) -> Vec<String> {
    let mut doubts = Vec::new();
    if found.waits.is_empty() {
        doubts.push("the cycles have no waits".to_owned());
    }
    for log in logs.iter().filter(|log| log.recording.program.is_none()) {
        doubts.push(format!(
            "{}: the log does not say of which version of the program it is (# program)",
            log.name
        ));
    }
    if found.shift.incomplete > 0 {
        doubts.push(format!("{} cycles are left out: events were lost", found.shift.incomplete));
    }
    doubts
}

/// The lines of the waits in the program.
fn lines(
    (program, input): (&Path, &Input),
    found: &Found,
    notes: &mut Vec<String>,
) -> BTreeMap<Place, String> {
    let mut lines = BTreeMap::new();
    for wait in &found.waits {
        let place = &wait.samples.key.place;
        let is_it = |relative: &str| {
            relative == place.file || relative.ends_with(&format!("/{}", place.file))
        };
        let file = input.files.iter().find(|file| is_it(&file.relative));
        let text = file.and_then(|file| {
            let text = decode(&file.source.bytes).text;
            let line = text.lines().nth(place.line as usize - 1)?;
            Some(line.trim().to_owned())
        });
        match text {
            Some(text) if text.to_lowercase().contains("wait") => {
                lines.insert(place.clone(), text);
            }
            Some(text) => notes.push(format!(
                "{place} is no wait in {} ('{text}'): it is not the version that ran",
                program.display()
            )),
            None => notes.push(format!(
                "{place} is not in {}: it is not the version that ran",
                program.display()
            )),
        }
    }
    lines
}

/// The hash of the program that ran.
fn hash(input: &Input) -> anyhow::Result<String> {
    let choice = choice::choose(input)?;
    Ok(program_hash(&common::sources(&choice)))
}
