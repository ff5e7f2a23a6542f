//! The run with a movement in a line as a stream.

use std::ops::Range;
use std::path::Path;

use anyhow::{Context, bail};

use super::super::common::{self, CellArgs, Job};
use super::super::optimize::{OptimizeArgs, settings};
use super::super::program_output::{input_file, new_first, path_in_tree};
use super::super::{listing, output};
use crate::rapid::text::{LineIndex, Span, charset};
use crate::tool::lsp::ChangedFile;
use crate::tool::retrofit::{Retrofit, SegmentKind, Settings, is_streams, retrofit};

/// The files that change if the run with a movement in a line (from 1) of a file becomes a stream, as the
/// configuration of the program says.
pub(super) fn with_stream(
    cell: CellArgs,
    file: &Path,
    line: u32,
) -> anyhow::Result<Vec<ChangedFile>> {
    let mut args = OptimizeArgs::default();
    args.program.cell = cell;
    let job = common::prepare(&args.program)?;
    if job.files.iter().any(|source| is_streams(&source.file.bytes)) {
        bail!("the program has streams already: joulepath refresh makes them anew");
    }
    let mut sources = job.files.iter().map(|source| &source.file);
    let source = sources.find(|it| output::is_same_file(Path::new(&it.path), file));
    let source = source.with_context(|| format!("the program has no file '{}'", file.display()))?;
    let Range { start, end } = LineIndex::with_charset(&source.bytes, source.charset).range(line);
    let part = Span { file: source.id, start, end };
    let settings = Settings { only: Some(part), ..settings(&args, &job)? };
    let mut result = retrofit(&job.files, &job.model, &settings, &|_, _| ())?;
    let mut segments = result.segments.iter().filter(|it| it.kind != SegmentKind::Idle);
    let own = segments.find(|it| it.pieces.iter().any(|piece| piece.touches(part)));
    match own.map(|own| (own.rewritten, &own.reason)) {
        Some((true, _)) if result.verification.passed => {}
        Some((_, Some(reason))) => bail!("the run stays as it is ({reason})"),
        _ => bail!("line {line} has no movement of the simulated cycle"),
    }
    listing::add(&mut result.outputs, &job.input, &job.files);
    Ok(changed_texts(&job, &result))
}

/// The texts of the changed and the new files, in the user's own tree.
fn changed_texts(job: &Job, result: &Retrofit) -> Vec<ChangedFile> {
    let changed = new_first(&result.outputs).filter_map(|file| {
        let before = input_file(job, file).map(|(_, bytes)| bytes);
        let charset = charset(&file.bytes);
        let text = |bytes: &[u8]| charset.decode(bytes).into_owned();
        (before != Some(&file.bytes)).then(|| ChangedFile {
            path: path_in_tree(job, file),
            before: before.map(text),
            after: text(&file.bytes),
        })
    });
    changed.collect()
}
