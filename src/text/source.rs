//! A file as it was read.

use std::borrow::Cow;

use super::encoding::{self, Charset};
use super::lines::{LineIndex, Position};
use super::{FileId, Span};

/// A source file: its bytes are never changed.
#[derive(Clone, Debug)]
pub struct SourceFile {
    /// Its index in the program's list of files.
    pub id: FileId,
    /// Its path as given by the user, with `/`.
    pub path: String,
    /// Its bytes.
    pub bytes: Vec<u8>,
    /// Its encoding, detected.
    pub charset: Charset,
    /// Its lines.
    pub lines: LineIndex,
}

impl SourceFile {
    /// Takes the bytes of a file; at most 4 GiB of them can be addressed.
    #[must_use]
    pub fn new(id: FileId, path: String, bytes: Vec<u8>) -> SourceFile {
        let charset = encoding::charset(&bytes);
        let lines = LineIndex::with_charset(&bytes, charset);
        SourceFile { id, path, bytes, charset, lines }
    }

    /// Line and column of a byte.
    #[must_use]
    pub fn position(&self, offset: u32) -> Position {
        self.lines.position(offset)
    }

    /// The bytes of a span of this file; empty if it lies outside.
    #[must_use]
    pub fn slice(&self, span: Span) -> &[u8] {
        self.bytes.get(span.start as usize..span.end as usize).unwrap_or_default()
    }

    /// The text of a span of this file.
    #[must_use]
    pub fn text(&self, span: Span) -> Cow<'_, str> {
        self.charset.decode(self.slice(span))
    }
}
