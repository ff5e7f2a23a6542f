//! A source file.

use std::borrow::Cow;

use super::edit::{Edit, EditError, apply};
use super::encoding::{self, Charset};
use super::lines::{LineIndex, Position};
use super::span::{FileId, Span};
use super::utf16::Utf16;

/// A source file: its bytes are never changed.
#[derive(Clone, Debug)]
pub struct SourceFile {
    /// Its index in the program's list of files.
    pub id: FileId,
    /// Its path as given by the user, with `/`.
    pub path: String,
    /// Its bytes; for a UTF-16 file, its text as UTF-8.
    pub bytes: Vec<u8>,
    /// The detected encoding of `bytes`.
    pub charset: Charset,
    /// Its lines.
    pub lines: LineIndex,
    /// The form of UTF-16, if the file is UTF-16.
    pub utf16: Option<Utf16>,
}

impl SourceFile {
    /// A file with these bytes, of which at most 4 GiB can be addressed.
    #[must_use]
    pub fn new(id: FileId, path: String, bytes: Vec<u8>) -> SourceFile {
        let (utf16, bytes) = match Utf16::read(&bytes) {
            Some((kind, text)) => (Some(kind), text.into_bytes()),
            None => (None, bytes),
        };
        let charset = encoding::charset(&bytes);
        let lines = LineIndex::with_charset(&bytes, charset);
        SourceFile { id, path, bytes, charset, lines, utf16 }
    }

    /// Name of the file's encoding in the WHATWG list.
    #[must_use]
    pub fn encoding(&self) -> &'static str {
        self.utf16.map_or_else(|| self.charset.name(), Utf16::name)
    }

    /// Converts `bytes`, encoded like [`SourceFile::bytes`], to the encoding of the file.
    #[must_use]
    pub fn stored<'b>(&self, bytes: &'b [u8]) -> Cow<'b, [u8]> {
        match self.utf16 {
            Some(kind) => Cow::Owned(kind.write(bytes)),
            None => Cow::Borrowed(bytes),
        }
    }

    /// The file with edits of its bytes.
    ///
    /// # Errors
    /// Edits overlap, or one of them is outside the file.
    pub fn edited(&self, edits: &[Edit]) -> Result<SourceFile, EditError> {
        let bytes = apply(&self.bytes, edits)?;
        let lines = LineIndex::with_charset(&bytes, self.charset);
        Ok(SourceFile { bytes, lines, path: self.path.clone(), ..*self })
    }

    /// Line and column of a byte.
    #[must_use]
    pub fn position(&self, offset: u32) -> Position {
        self.lines.position(offset)
    }

    /// The bytes of a span of this file; empty if it is outside.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn file(bytes: &[u8]) -> SourceFile {
        SourceFile::new(FileId(0), "a.mod".into(), bytes.to_vec())
    }

    #[test]
    fn utf16_is_read_as_utf8_and_written_back() {
        let text = "MODULE a\r\n! Größe 🙂\r\nENDMODULE";
        let units: Vec<u16> = std::iter::once(0xFEFF).chain(text.encode_utf16()).collect();
        let little: Vec<u8> = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
        let big: Vec<u8> = units.iter().flat_map(|unit| unit.to_be_bytes()).collect();
        for (bytes, name) in [(little, "UTF-16LE"), (big, "UTF-16BE")] {
            for bytes in [&bytes[..], &bytes[2..]] {
                let file = file(bytes);
                assert_eq!((file.encoding(), file.lines.count()), (name, 3));
                assert_eq!(file.bytes, text.as_bytes());
                assert_eq!(file.stored(&file.bytes), bytes);
            }
            // A damaged file stays unchanged.
            let cut = &bytes[..bytes.len() - 1];
            assert_eq!(self::file(cut).stored(cut), cut);
            assert_eq!(self::file(cut).bytes, cut);
        }
    }
}
