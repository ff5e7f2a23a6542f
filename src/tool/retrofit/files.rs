//! Input and output files of a program.

use std::collections::BTreeMap;

use crate::rapid::text::{Edit, FileId, SourceFile, Span, apply};

/// A file of the program.
#[derive(Clone, Debug)]
pub struct Source {
    /// Bytes and path.
    pub file: SourceFile,
    /// Path relative to the input folder.
    pub relative: String,
}

/// The kind of an output file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputKind {
    /// An unchanged file of the input.
    Unchanged,
    /// A changed file of the input.
    Changed,
    /// A new file.
    New,
}

/// A file of the complete program.
#[derive(Clone, Debug)]
pub struct OutputFile {
    /// Path relative to the output folder, with `/`.
    pub path: String,
    /// The kind.
    pub kind: OutputKind,
    /// Its content.
    pub bytes: Vec<u8>,
    /// Index of the input file; `None` for a new one.
    pub input: Option<usize>,
}

impl OutputFile {
    /// A new file.
    pub(in crate::tool) fn added(path: String, text: String) -> OutputFile {
        OutputFile { path, kind: OutputKind::New, bytes: text.into_bytes(), input: None }
    }

    /// A file of the input with new bytes.
    pub(super) fn changed(index: usize, source: &Source, bytes: Vec<u8>) -> OutputFile {
        let path = source.relative.clone();
        OutputFile { path, kind: OutputKind::Changed, bytes, input: Some(index) }
    }
}

/// File and line of the start of a span, as in messages.
pub(in crate::tool) fn file_and_line(files: &[Source], span: Span) -> String {
    let file = &files[span.file.0 as usize].file;
    format!("{}:{}", file.path, file.position(span.start).line)
}

/// All files of the program, unchanged.
pub(super) fn unchanged(files: &[Source]) -> Vec<OutputFile> {
    let file = |(index, source): (usize, &Source)| OutputFile {
        path: source.relative.clone(),
        kind: OutputKind::Unchanged,
        bytes: source.file.bytes.clone(),
        input: Some(index),
    };
    files.iter().enumerate().map(file).collect()
}

/// Edits by the number of their file.
pub(super) fn by_file(edits: impl IntoIterator<Item = Edit>) -> BTreeMap<usize, Vec<Edit>> {
    let mut all: BTreeMap<usize, Vec<Edit>> = BTreeMap::new();
    for edit in edits {
        all.entry(edit.span.file.0 as usize).or_default().push(edit);
    }
    all
}

/// All files of the program, with these edits; `None` if edits overlap.
pub(in crate::tool) fn with_edits(
    files: &[Source],
    edits: impl Iterator<Item = Edit>,
) -> Option<Vec<OutputFile>> {
    let mut outputs = unchanged(files);
    for (index, edits) in by_file(edits) {
        let bytes = apply(&files[index].file.bytes, &edits).ok()?;
        outputs[index] = OutputFile::changed(index, &files[index], bytes);
    }
    Some(outputs)
}

/// The output files as input of a new read.
pub fn read_again(outputs: &[OutputFile]) -> Vec<Source> {
    let file = |(i, output): (usize, &OutputFile)| Source {
        file: SourceFile::new(FileId(i as u32), output.path.clone(), output.bytes.clone()),
        relative: output.path.clone(),
    };
    outputs.iter().enumerate().map(file).collect()
}
