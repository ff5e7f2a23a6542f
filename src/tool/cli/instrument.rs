//! `joulepath instrument`: puts a recorder into a program, and takes it out.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::Args;

use super::common::{self, Format, ProgramArgs};
use super::input::{self, Input};
use super::program_output::{refuse_nested_output, whole_backup, write_folder};
use super::{backinfo, listing, signals};
use crate::rapid::text::{FileId, SourceFile};
use crate::tool::cell::instrument::{
    Late, Request, Samples, instrument, is_recorder, program_hash, recorded_program,
    recorder_prefix, without_recorder,
};
use crate::tool::report::instrument as report;
use crate::tool::retrofit::{OutputFile, OutputKind, Source};

/// Samples in a second: the fewest and the most.
const RATES: std::ops::RangeInclusive<f64> = 0.1..=20.0;
/// Default rate, 1/s.
const RATE: f64 = 10.0;
/// Largest delay of a movement, s.
const LARGEST_DELAY_S: f64 = 60.0;
/// Number of axes.
const AXES: u32 = 6;

/// Put a recorder into a program: every original line stays.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples: joulepath instrument fixtures/pick_place --out recorded\n          joulepath instrument recorded --remove --out original"
)]
pub(super) struct InstrumentArgs {
    #[command(flatten)]
    program: ProgramArgs,

    /// Where the complete program goes.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,

    /// Signals whose changes are recorded (digital); otherwise the inputs for which the program waits.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    signals: Option<Vec<String>>,

    /// Sample the positions of all axes, and speed and torque of these axes.
    #[arg(long, value_name = "1,…", value_delimiter = ',')]
    axes: Option<Vec<u32>>,

    /// Samples in a second (10).
    #[arg(long, value_name = "HZ", requires = "axes")]
    rate: Option<f64>,

    /// Come later to this wait in every second cycle, to see what it depends on.
    #[arg(long, value_name = "FILE:LINE=SECONDS")]
    late: Option<String>,

    /// Take the recorder out.
    #[arg(long, conflicts_with_all = ["signals", "axes", "late"])]
    remove: bool,
}

pub(super) fn run(args: &InstrumentArgs) -> anyhow::Result<ExitCode> {
    if args.remove {
        return remove(args);
    }
    let request = Request {
        signals: args.signals.clone(),
        samples: args.axes.as_deref().map(|axes| samples(axes, args.rate)).transpose()?,
        late: args.late.as_deref().map(late).transpose()?,
    };
    let job = common::prepare(&args.program)?;
    signals::check_job(&args.program.cell, &job)?;
    let quiet = args.program.cell.quiet;
    let paths = args.program.cell.paths.as_slice();
    let backup = whole_backup(paths, &job.input);
    if backup.is_none() {
        refuse_nested_output(&args.out, paths)?;
    }
    let mut made = instrument(&job.files, &job.entry, (&job.model, &job.options), &request)?;
    let mut notes = listing::add(&mut made.outputs, &job.input, &job.files);
    if backup.is_some() {
        notes.extend(backinfo::add(&mut made.outputs, &job.input));
    }
    common::notes(quiet, &notes);
    let written = write_folder(&args.out, (&job.files, &[]), &made.outputs, backup)?;
    if args.program.format == Format::Text {
        common::notes(quiet, written.iter().map(|path| format!("wrote {path}")));
    }
    common::print(
        args.program.format,
        || report::json(&made, &job.entry, &written),
        || report::text(&made),
    )
}

/// Writes the program without its recorder.
fn remove(args: &InstrumentArgs) -> anyhow::Result<ExitCode> {
    let paths = args.program.cell.paths.as_slice();
    let input = input::read(paths)?;
    let quiet = args.program.cell.quiet;
    common::note_unreadable(quiet, &input);
    let backup = whole_backup(paths, &input).map(PathBuf::from);
    if backup.is_none() {
        refuse_nested_output(&args.out, paths)?;
    }
    let (files, outputs, modules) = originals(&input)?;
    let recorders = input.files.iter().filter(|file| is_recorder(&file.source.bytes));
    let recorded: Vec<String> =
        recorders.filter_map(|file| recorded_program(&file.source.bytes)).collect();
    let original = |(source, output): (&Source, &OutputFile)| Source {
        file: SourceFile { bytes: output.bytes.clone(), ..source.file.clone() },
        relative: source.relative.clone(),
    };
    let originals: Vec<Source> = files.iter().zip(&outputs).map(original).collect();
    if !recorded.contains(&program_hash(&originals)) {
        common::note(
            quiet,
            "the program has been changed since the recorder was put in: what is left is not the original, look \
             through it",
        );
    }
    let written = write_folder(&args.out, (&files, &modules), &outputs, backup.as_deref())?;
    if args.program.format == Format::Text {
        common::notes(quiet, written.iter().map(|path| format!("wrote {path}")));
    }
    let removed: Vec<String> = modules.iter().map(|path| path.display().to_string()).collect();
    common::print(
        args.program.format,
        || serde_json::json!({ "removed": removed, "outputs": written }),
        || format!("took out {}\n", removed.join(", ")),
    )
}

/// The files of the program, the outputs without recorders, and the modules of the recorders.
fn originals(input: &Input) -> anyhow::Result<(Vec<Source>, Vec<OutputFile>, Vec<PathBuf>)> {
    let recorders = || input.files.iter().filter(|file| is_recorder(&file.source.bytes));
    let modules: Vec<PathBuf> = recorders().map(|file| PathBuf::from(&file.source.path)).collect();
    let names: Vec<String> = recorders()
        .filter_map(|file| file.relative.rsplit('/').next().map(str::to_owned))
        .collect();
    let prefixes: Vec<String> =
        recorders().filter_map(|file| recorder_prefix(&file.source.bytes)).collect();
    if modules.is_empty() {
        bail!(
            "no recorder is among these files: name the folder that joulepath instrument wrote, \
             with its module"
        );
    }
    let changed = |path: String, before: &[u8], bytes: Vec<u8>, input: Option<usize>| {
        let kind = if bytes == before { OutputKind::Unchanged } else { OutputKind::Changed };
        OutputFile { path, kind, bytes, input }
    };
    let mut files: Vec<Source> = Vec::new();
    let mut outputs = Vec::new();
    for file in input.files.iter().filter(|file| !is_recorder(&file.source.bytes)) {
        let index = files.len();
        let source = SourceFile { id: FileId(index as u32), ..file.source.clone() };
        let bytes = prefixes.iter().fold(source.clone(), |source, prefix| SourceFile {
            bytes: without_recorder(&source, prefix),
            ..source
        });
        outputs.push(changed(file.relative.clone(), &source.bytes, bytes.bytes, Some(index)));
        files.push(Source { file: source, relative: file.relative.clone() });
    }
    for list in &input.listings {
        let bytes = listing::without(&list.bytes, &names);
        outputs.push(changed(list.relative.clone(), &list.bytes, bytes, None));
    }
    for info in &input.information {
        let bytes = backinfo::without(&info.bytes, &names);
        outputs.push(changed(info.relative.clone(), &info.bytes, bytes, None));
    }
    Ok((files, outputs, modules))
}

fn samples(axes: &[u32], rate: Option<f64>) -> anyhow::Result<Samples> {
    if let Some(axis) = axes.iter().find(|axis| !(1..=AXES).contains(*axis)) {
        bail!("--axes {axis}: give axes from 1 to {AXES}");
    }
    let mut axes = axes.to_vec();
    axes.sort_unstable();
    axes.dedup();
    let rate = rate.unwrap_or(RATE);
    if !RATES.contains(&rate) {
        bail!("--rate {rate}: give {} to {} samples in a second", RATES.start(), RATES.end());
    }
    Ok(Samples { axes, rate })
}

fn late(text: &str) -> anyhow::Result<Late> {
    let wrong =
        || format!("--late {text}: write it as FILE:LINE=SECONDS, such as Machine.mod:31=0.5");
    let (place, seconds) = text.rsplit_once('=').with_context(wrong)?;
    let (file, line) = place.rsplit_once(':').with_context(wrong)?;
    let line: u32 = line.trim().parse().ok().with_context(wrong)?;
    let seconds: f64 =
        seconds.trim().trim_end_matches('s').trim().parse().ok().with_context(wrong)?;
    if !(seconds > 0.0 && seconds <= LARGEST_DELAY_S) {
        bail!("--late {text}: give more than 0 and at most {LARGEST_DELAY_S} s");
    }
    Ok(Late { file: file.trim().to_owned(), line, seconds })
}
