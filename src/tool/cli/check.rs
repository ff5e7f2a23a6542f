//! `joulepath check`: would the controller load the program?

pub(super) mod tasks;

use std::io::{IsTerminal, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::bail;
use clap::{Args, ValueEnum};
use rayon::prelude::*;

use self::tasks::TaskFiles;
use super::common::{self, note};
use super::input;
use crate::rapid::check::{Task, check};
use crate::rapid::diagnostics::{Diagnostic, Paint, Severity};
use crate::rapid::names::SourceText;
use crate::rapid::syntax::{self, Parse};
use crate::rapid::text::{SourceFile, is_encoded_module};
use crate::tool::report;

/// Check whether a controller would load a program.
#[derive(Debug, Args)]
#[command(
    after_help = "An error keeps the program from being loaded, or stops it at once. A name that \
    another module may declare is a warning.\n\nExit codes: 0 \
    without errors, 1 with errors, 2 where nothing can be read.\n\nExample: joulepath check \
    fixtures/pick_place"
)]
pub(super) struct CheckArgs {
    /// Module files, folders, .pgf programs or controller backups.
    #[arg(required = true)]
    paths: Vec<PathBuf>,

    /// The procedure that starts the program.
    #[arg(long, default_value = "main")]
    entry: String,

    /// How the result is written.
    #[arg(long, value_enum, default_value_t = CheckFormat::Text)]
    format: CheckFormat,

    /// No notes on standard error.
    #[arg(long, short)]
    quiet: bool,
}

/// Forms of the result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum CheckFormat {
    /// With the source.
    Text,
    /// One line each.
    Concise,
    /// For programs.
    Json,
}

pub(super) fn run(args: &CheckArgs) -> anyhow::Result<ExitCode> {
    let input = input::read(&args.paths)?;
    common::note_unreadable(args.quiet, &input);
    let files: Vec<SourceFile> = input.files.iter().map(|file| file.source.clone()).collect();
    let encoded = files.iter().filter(|file| is_encoded_module(&file.bytes));
    for file in encoded.clone() {
        let path = &file.path;
        note(args.quiet, &format!("'{path}' is an encoded module: what it declares is not known"));
    }
    let checked = files.len() - encoded.count();
    if checked == 0 {
        bail!("only encoded modules: give the modules as text, as the controller saves them");
    }
    let parses: Vec<Parse> = files.par_iter().map(|file| syntax::parse(&file.bytes)).collect();
    let tasks = tasks::tasks(&input, &parses, &args.entry);
    if tasks.iter().all(|task| !task.starts) {
        let text = format!("no given file has the PROC {}, which starts a program", args.entry);
        note(args.quiet, &text);
    }
    let findings = findings(&files, &parses, &tasks);

    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    match args.format {
        CheckFormat::Text => {
            let ansi = std::io::stdout().is_terminal();
            let paint = if ansi { Paint::Ansi } else { Paint::Plain };
            write!(out, "{}", report::check::full(&findings, &files, paint))?;
            write!(out, "{}", report::check::summary(&findings, checked))?;
        }
        CheckFormat::Concise => write!(out, "{}", report::check::concise(&findings, &files))?,
        CheckFormat::Json => {
            writeln!(out, "{:#}", report::check::json(&findings, &files, checked))?;
        }
    }
    out.flush()?;
    let errors = report::check::count(&findings, Severity::Error);
    Ok(ExitCode::from(u8::from(errors > 0)))
}

/// The findings of all tasks. Of a file that several tasks share, only those that all of them have.
fn findings(files: &[SourceFile], parses: &[Parse], tasks: &[TaskFiles]) -> Vec<Diagnostic> {
    let of_task = |task: &TaskFiles| {
        let texts: Vec<SourceText<'_>> = task
            .files
            .iter()
            .map(|index| SourceText { file: &files[*index], parse: &parses[*index] })
            .collect();
        check(&Task { files: &texts, extent: &task.extent, entry: &task.entry })
    };
    let mut all: Vec<Diagnostic> = tasks.par_iter().map(of_task).flatten().collect();
    let key = |it: &Diagnostic| (it.span.file, it.span.start, it.span.end, it.message.clone());
    all.sort_by_key(key);
    let mut kept: Vec<Diagnostic> = Vec::new();
    for same in all.chunk_by(|a, b| key(a) == key(b)) {
        let file = same[0].span.file.0 as usize;
        let sharing = tasks.iter().filter(|task| task.files.contains(&file)).count();
        if same.len() == sharing {
            kept.push(same[0].clone());
        }
    }
    kept
}
