//! Files of a program, as they are read and as they are written.

use crate::rapid::text::{FileId, SourceFile};

/// A file of the program.
#[derive(Clone, Debug)]
pub struct Source {
    /// Its bytes and path as given.
    pub file: SourceFile,
    /// Its path below the input.
    pub relative: String,
}

/// What an output file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputKind {
    /// A file of the input, as it was.
    Unchanged,
    /// A file of the input with other text.
    Changed,
    /// A new file.
    New,
}

/// A file of the complete program.
#[derive(Clone, Debug)]
pub struct OutputFile {
    /// Path below the output folder, with `/`.
    pub path: String,
    /// What it is.
    pub kind: OutputKind,
    /// Its content.
    pub bytes: Vec<u8>,
    /// For a changed file, which of the input's it is.
    pub input: Option<usize>,
}

impl OutputFile {
    /// A file that the input does not have.
    pub(in crate::tool) fn added(path: String, text: String) -> OutputFile {
        OutputFile { path, kind: OutputKind::New, bytes: text.into_bytes(), input: None }
    }

    /// A file of the input with other bytes.
    pub(super) fn changed(index: usize, source: &Source, bytes: Vec<u8>) -> OutputFile {
        let path = source.relative.clone();
        OutputFile { path, kind: OutputKind::Changed, bytes, input: Some(index) }
    }
}

/// The files of a program as they were.
pub(super) fn unchanged(files: &[Source]) -> Vec<OutputFile> {
    let file = |(index, source): (usize, &Source)| OutputFile {
        path: source.relative.clone(),
        kind: OutputKind::Unchanged,
        bytes: source.file.bytes.clone(),
        input: Some(index),
    };
    files.iter().enumerate().map(file).collect()
}

/// The files as a reader of the emitted program finds them.
pub fn read_again(outputs: &[OutputFile]) -> Vec<Source> {
    let file = |(i, output): (usize, &OutputFile)| Source {
        file: SourceFile::new(FileId(i as u32), output.path.clone(), output.bytes.clone()),
        relative: output.path.clone(),
    };
    outputs.iter().enumerate().map(file).collect()
}
