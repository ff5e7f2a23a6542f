//! `joulepath parse`: syntax errors and statistics.

use std::io::{IsTerminal, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use rayon::prelude::*;
use serde::Serialize;

use super::backup::Backup;
use super::common::{self, Format};
use super::input::{self, InputFile, Place};
use crate::rapid::builtins::is_of_move_family;
use crate::rapid::diagnostics::{self, Diagnostic, Label, Paint};
use crate::rapid::syntax::{self, NodeKind, Parse, SyntaxError};
use crate::rapid::text::{self, FileId, SourceFile, Span};

/// Parse RAPID and report its syntax errors.
#[derive(Debug, Args)]
#[command(after_help = "Movements are the calls of instructions of the Move, Trigg and \
    Search families, wherever they stand: also in handlers and in routines that nothing \
    calls, not in comments and strings.\n\n\
    Example: joulepath parse backup/RAPID --format json")]
pub(super) struct ParseArgs {
    /// Module files, folders, .pgf programs or controller backups.
    #[arg(required = true)]
    pub(super) paths: Vec<PathBuf>,

    /// How the result is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(super) format: Format,

    /// Print the syntax tree of each file.
    #[arg(long)]
    pub(super) tree: bool,
}

/// Runs the command: the result goes to standard output, notes to standard error.
pub(super) fn run(args: &ParseArgs) -> anyhow::Result<ExitCode> {
    let input = input::read(&args.paths)?;
    common::note_unreadable(false, &input);
    let ansi = args.format == Format::Text && std::io::stdout().is_terminal();
    let paint = if ansi { Paint::Ansi } else { Paint::Plain };
    // Each tree is dropped with its file, so that memory holds only the largest files.
    let (files, texts): (Vec<FileReport>, Vec<String>) = input
        .files
        .par_iter()
        .map(|file| {
            let parse = syntax::parse(&file.source.bytes);
            let tree = if args.tree { tree(file, &parse) } else { String::new() };
            let text = match args.format {
                Format::Json => tree,
                Format::Text => tree + &errors(file, &parse, paint),
            };
            (report(file, &parse, &input.backups), text)
        })
        .unzip();
    let totals = totals(&files);
    let failed = totals.errors > 0;
    let backups: Vec<BackupReport<'_>> = input
        .backups
        .iter()
        .map(|(path, backup)| BackupReport { path: path.to_string_lossy().into_owned(), backup })
        .collect();

    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    match args.format {
        Format::Json => {
            let trees = args.tree.then_some(texts);
            serde_json::to_writer(&mut out, &Report { files, totals, backups, trees })?;
            writeln!(out)?;
        }
        Format::Text => {
            for (text, report) in texts.iter().zip(&files) {
                writeln!(out, "{text}{}", summary(report))?;
            }
            for BackupReport { path, backup } in &backups {
                writeln!(out, "{path}: {}", backup.summary())?;
            }
            if files.len() > 1 {
                writeln!(out, "{}", totals_line(&totals))?;
            }
        }
    }
    out.flush()?;
    Ok(ExitCode::from(u8::from(failed)))
}

#[derive(Serialize)]
struct Report<'a> {
    files: Vec<FileReport>,
    totals: Totals,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    backups: Vec<BackupReport<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    trees: Option<Vec<String>>,
}

/// The controller backup of some files.
#[derive(Serialize)]
struct BackupReport<'a> {
    path: String,
    #[serde(flatten)]
    backup: &'a Backup,
}

#[derive(Serialize)]
struct FileReport {
    path: String,
    /// Name of the task of a backup's module.
    #[serde(skip_serializing_if = "Option::is_none")]
    task: Option<String>,
    bytes: usize,
    lines: u32,
    encoding: &'static str,
    bom: bool,
    encoded: bool,
    lossless: bool,
    errors: Vec<ErrorReport>,
    routines: usize,
    statements: usize,
    movements: usize,
    tolerances: Vec<ToleranceReport>,
}

#[derive(Serialize)]
struct ErrorReport {
    line: u32,
    column: u32,
    message: String,
}

#[derive(Serialize)]
struct ToleranceReport {
    name: &'static str,
    count: usize,
}

#[derive(Serialize)]
struct Totals {
    files: usize,
    bytes: usize,
    errors: usize,
    files_with_errors: usize,
    lossless: usize,
}

fn report(file: &InputFile, parse: &Parse, backups: &[(PathBuf, Backup)]) -> FileReport {
    let source = &file.source;
    let mut routines = 0;
    let mut statements = 0;
    let mut movements = 0;
    for node in parse.tree.nodes() {
        let kind = node.kind();
        routines += usize::from(kind.is_routine());
        statements += usize::from(kind.is_statement());
        movements +=
            usize::from(kind == NodeKind::CallStatement && is_of_move_family_call(node, source));
    }
    let errors = parse.errors.iter().map(|error| {
        let position = source.position(error.start);
        let message = error.message.clone();
        ErrorReport { line: position.line, column: position.column, message }
    });
    let tolerances = syntax::Tolerance::ALL.iter().filter_map(|&tolerance| {
        let count = parse.tolerances.iter().filter(|used| used.tolerance == tolerance).count();
        (count > 0).then(|| ToleranceReport { name: tolerance.production(), count })
    });
    let task = |place: &Place| backups[place.backup].1.task_name(&place.folder).to_owned();
    FileReport {
        path: source.path.clone(),
        task: file.place.as_ref().map(task),
        bytes: source.stored(&source.bytes).len(),
        lines: source.lines.count(),
        encoding: source.encoding(),
        bom: source.charset.bom || source.utf16.is_some_and(|utf16| utf16.bom),
        encoded: text::is_encoded_module(&source.bytes),
        lossless: is_lossless(parse, &source.bytes),
        errors: errors.collect(),
        routines,
        statements,
        movements,
        tolerances: tolerances.collect(),
    }
}

fn is_of_move_family_call(node: syntax::Node<'_>, source: &SourceFile) -> bool {
    node.callee()
        .is_some_and(|name| is_of_move_family(&String::from_utf8_lossy(name.text(&source.bytes))))
}

/// Whether the joined tokens of the tree equal the file.
fn is_lossless(parse: &Parse, bytes: &[u8]) -> bool {
    let mut at = 0;
    for token in parse.tree.root().all_tokens() {
        let range = token.range();
        if range.start as usize != at || range.end <= range.start {
            return false;
        }
        at = range.end as usize;
    }
    at == bytes.len()
}

fn totals(files: &[FileReport]) -> Totals {
    Totals {
        files: files.len(),
        bytes: files.iter().map(|file| file.bytes).sum(),
        errors: files.iter().map(|file| file.errors.len()).sum(),
        files_with_errors: files.iter().filter(|file| !file.errors.is_empty()).count(),
        lossless: files.iter().filter(|file| file.lossless).count(),
    }
}

fn tree(file: &InputFile, parse: &Parse) -> String {
    syntax::dump(&parse.tree, &file.source.bytes).to_string()
}

/// The errors of a file with their source, separated by empty lines.
fn errors(file: &InputFile, parse: &Parse, paint: Paint) -> String {
    let shown = parse.errors.iter().map(|error| {
        let diagnostic = diagnostic(error, file.source.id);
        format!("{}\n\n", diagnostics::full(&diagnostic, &file.source, paint))
    });
    shown.collect()
}

fn diagnostic(error: &SyntaxError, file: FileId) -> Diagnostic {
    let mut diagnostic =
        Diagnostic::error(Span { file, start: error.start, end: error.end }, error.message.clone());
    diagnostic.labels.extend(error.related.iter().map(|related| Label {
        span: Span { file, start: related.start, end: related.end },
        message: related.message.clone(),
    }));
    diagnostic
}

fn summary(file: &FileReport) -> String {
    if file.encoded {
        return format!("{}: encoded module, {} bytes, not read", file.path, file.bytes);
    }
    format!(
        "{}: {}, {} bytes, {}, {}, {}, {}, {}",
        file.path,
        counted(file.errors.len(), "error"),
        file.bytes,
        counted(file.lines as usize, "line"),
        file.encoding,
        counted(file.routines, "routine"),
        counted(file.statements, "statement"),
        counted(file.movements, "movement"),
    )
}

fn totals_line(totals: &Totals) -> String {
    format!(
        "{}, {} bytes, {} in {}, {} lossless",
        counted(totals.files, "file"),
        totals.bytes,
        counted(totals.errors, "error"),
        counted(totals.files_with_errors, "file"),
        totals.lossless,
    )
}

fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}
