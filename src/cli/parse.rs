//! `joulepath parse`: syntax errors and statistics.

use std::io::{IsTerminal, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, ValueEnum};
use rayon::prelude::*;
use serde::Serialize;

use super::input::{self, InputFile};
use crate::diagnostics::{self, Diagnostic, Label, Paint};
use crate::ir::is_movement;
use crate::syntax::{self, NodeKind, Parse, SyntaxError, ast};
use crate::text::{self, FileId, SourceFile, Span};

/// Parse RAPID and report its syntax errors.
#[derive(Debug, Args)]
#[command(after_help = "Example: joulepath parse backup/RAPID --format json")]
pub struct ParseArgs {
    /// Module files, folders, .pgf programs or controller backups.
    #[arg(required = true)]
    pub paths: Vec<PathBuf>,

    /// How the result is written.
    #[arg(long, value_enum, default_value_t = ParseFormat::Text)]
    pub format: ParseFormat,

    /// Print the syntax tree of each file.
    #[arg(long)]
    pub tree: bool,
}

/// Forms of the result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ParseFormat {
    /// For people.
    Text,
    /// For programs.
    Json,
}

/// Runs the command: standard output gets the result, standard error notes.
///
/// # Errors
/// When nothing can be read, or the output cannot be written.
pub fn run(args: &ParseArgs) -> anyhow::Result<ExitCode> {
    let input = input::read(&args.paths)?;
    let mut notes = std::io::stderr().lock();
    for unreadable in &input.unreadable {
        writeln!(notes, "note: skipped '{}': {}", unreadable.path, unreadable.reason)?;
    }
    let parses: Vec<Parse> =
        input.files.par_iter().map(|file| syntax::parse(&file.source.bytes)).collect();
    let files: Vec<FileReport> =
        input.files.par_iter().zip(&parses).map(|(file, parse)| report(file, parse)).collect();
    let totals = totals(&files);
    let failed = totals.errors > 0;

    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    match args.format {
        ParseFormat::Json => {
            let trees = args.tree.then(|| {
                let pairs = input.files.iter().zip(&parses);
                pairs.map(|(file, parse)| tree(file, parse)).collect()
            });
            serde_json::to_writer(&mut out, &Report { files, totals, trees })?;
            writeln!(out)?;
        }
        ParseFormat::Text => {
            let ansi = std::io::stdout().is_terminal();
            let paint = if ansi { Paint::Ansi } else { Paint::Plain };
            for ((file, parse), report) in input.files.iter().zip(&parses).zip(&files) {
                if args.tree {
                    write!(out, "{}", tree(file, parse))?;
                }
                for error in &parse.errors {
                    let diagnostic = diagnostic(error, file.source.id);
                    writeln!(out, "{}\n", diagnostics::full(&diagnostic, &file.source, paint))?;
                }
                writeln!(out, "{}", summary(report))?;
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
struct Report {
    files: Vec<FileReport>,
    totals: Totals,
    #[serde(skip_serializing_if = "Option::is_none")]
    trees: Option<Vec<String>>,
}

#[derive(Serialize)]
struct FileReport {
    path: String,
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

fn report(file: &InputFile, parse: &Parse) -> FileReport {
    let source = &file.source;
    let mut routines = 0;
    let mut statements = 0;
    let mut movements = 0;
    for node in parse.tree.nodes() {
        let kind = node.kind();
        routines += usize::from(ast::Routine::cast(node).is_some());
        statements += usize::from(kind.is_statement());
        movements += usize::from(kind == NodeKind::CallStatement && is_movement_call(node, source));
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
    FileReport {
        path: source.path.clone(),
        bytes: source.stored(&source.bytes).len(),
        lines: source.lines.count(),
        encoding: source.encoding(),
        bom: source.charset.bom || source.utf16.is_some(),
        encoded: text::is_encoded_module(&source.bytes),
        lossless: is_lossless(parse, &source.bytes),
        errors: errors.collect(),
        routines,
        statements,
        movements,
        tolerances: tolerances.collect(),
    }
}

fn is_movement_call(node: syntax::Node<'_>, source: &SourceFile) -> bool {
    ast::Call::cast(node)
        .and_then(ast::Call::name)
        .is_some_and(|name| is_movement(&String::from_utf8_lossy(name.text(&source.bytes))))
}

/// Whether the tokens of the tree, joined, are the file.
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
        "{}: {}, {} bytes, {} lines, {}, {}, {}, {}",
        file.path,
        counted(file.errors.len(), "error"),
        file.bytes,
        file.lines,
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
