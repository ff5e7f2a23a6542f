//! `joulepath format`: formats RAPID files in place.

use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use rayon::prelude::*;
use similar::TextDiff;

use super::common::{self, CellArgs};
use super::input;
use super::output;
use crate::rapid::format::format;
use crate::rapid::text::{SourceFile, apply, is_encoded_module};

/// Format RAPID files in place: white space and the case of keywords.
#[derive(Debug, Args)]
#[command(
    after_help = "Comments, strings, names, numbers, line ends and encodings stay as they are, and so \
    do lines with syntax errors. The style is in the section [format] of joulepath.toml: indent-width, \
    indent-style, keyword-case, max-blank-lines.\n\n\
    Exit codes: 0, 1 where --check finds a file that is not formatted, 2 where nothing can be read.\n\n\
    Example: joulepath format backup/RAPID --check"
)]
pub(super) struct FormatArgs {
    /// Module files, folders, .pgf programs or controller backups.
    #[arg(required = true)]
    paths: Vec<PathBuf>,

    /// Configuration; otherwise the nearest joulepath.toml above the program.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,

    /// Write nothing; name the files that are not formatted, and exit with 1 if there are any.
    #[arg(long)]
    check: bool,

    /// Write nothing; print what would change as a unified diff.
    #[arg(long)]
    diff: bool,

    /// No notes on standard error.
    #[arg(long, short)]
    quiet: bool,
}

pub(super) fn run(args: &FormatArgs) -> anyhow::Result<ExitCode> {
    let input = input::read(&args.paths)?;
    common::note_unreadable(args.quiet, &input);
    let cell =
        CellArgs { paths: args.paths.clone(), config: args.config.clone(), ..CellArgs::default() };
    let (config, _) = common::configuration(&cell)?;
    let style = config.format.style();
    let files: Vec<&SourceFile> = input.files.iter().map(|file| &file.source).collect();
    let formatted: anyhow::Result<Vec<Vec<u8>>> =
        files.par_iter().map(|file| Ok(apply(&file.bytes, &format(file, &style))?)).collect();
    let formatted = formatted?;
    for file in files.iter().filter(|file| is_encoded_module(&file.bytes)) {
        let path = &file.path;
        common::note(args.quiet, &format!("'{path}' is an encoded module: it stays as it is"));
    }
    let pairs = || files.iter().zip(&formatted).filter(|(file, bytes)| file.bytes != **bytes);
    let count = pairs().count();
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    if args.diff {
        for (file, bytes) in pairs() {
            let (before, after) = (file.charset.decode(&file.bytes), file.charset.decode(bytes));
            let diff = TextDiff::from_lines(&*before, &*after);
            let (from, to) = (format!("a/{}", file.path), format!("b/{}", file.path));
            write!(out, "{}", diff.unified_diff().header(&from, &to))?;
        }
    } else if args.check {
        for (file, _) in pairs() {
            writeln!(out, "{}", file.path)?;
        }
    }
    out.flush()?;
    let plural = if files.len() == 1 { "" } else { "s" };
    if args.check || args.diff {
        let text = format!("{count} of {} file{plural} would change", files.len());
        common::note(args.quiet, &text);
        return Ok(ExitCode::from(u8::from(args.check && count > 0)));
    }
    output::write_all(pairs().map(|(file, bytes)| (&file.path, file.stored(bytes))))?;
    common::note(args.quiet, &format!("{count} of {} file{plural} changed", files.len()));
    Ok(ExitCode::SUCCESS)
}
