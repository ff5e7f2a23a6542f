//! Positions of the protocol: lines from 0, and units of the agreed encoding within a line.

use gen_lsp_types::{Position, PositionEncodingKind, Range};

use crate::rapid::text::{SourceFile, Span};

/// Bytes of a byte order mark, which no editor counts.
const MARK: u32 = 3;

/// What the columns of positions count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Units {
    /// UTF-16 units, which every client knows.
    #[default]
    Utf16,
    /// Bytes of the text as UTF-8.
    Utf8,
}

impl Units {
    pub(super) fn kind(self) -> PositionEncodingKind {
        match self {
            Units::Utf16 => PositionEncodingKind::UTF16,
            Units::Utf8 => PositionEncodingKind::UTF8,
        }
    }

    fn of(self, sign: char) -> u32 {
        match self {
            Units::Utf16 => sign.len_utf16() as u32,
            Units::Utf8 => sign.len_utf8() as u32,
        }
    }

    /// The length of a text.
    pub(super) fn length(self, text: &str) -> u32 {
        text.chars().map(|sign| self.of(sign)).sum()
    }
}

/// Converts between the bytes and the positions of a file.
#[derive(Clone, Copy)]
pub(super) struct Positions<'f> {
    file: &'f SourceFile,
    units: Units,
}

impl<'f> Positions<'f> {
    pub(super) fn new(file: &'f SourceFile, units: Units) -> Positions<'f> {
        Positions { file, units }
    }

    /// The byte at a position; the line end if the line is shorter, the file end if there is no such
    /// line. A position inside a character is its start.
    pub(super) fn byte(self, position: Position) -> u32 {
        let lines = &self.file.lines;
        if position.line >= lines.count() {
            return self.file.bytes.len() as u32;
        }
        let mut at = self.start(position.line + 1);
        let end = lines.range(position.line + 1).end;
        let mut left = position.character;
        for (bytes, sign) in self.file.charset.characters(self.bytes(at, end)) {
            let width = self.units.of(sign);
            if left < width || matches!(sign, '\r' | '\n') {
                break;
            }
            left -= width;
            at += bytes as u32;
        }
        at
    }

    /// The position of a byte.
    pub(super) fn position(self, byte: u32) -> Position {
        let line = self.file.position(byte).line;
        let before = self.bytes(self.start(line), byte);
        let character = if before.is_ascii() {
            before.len() as u32
        } else {
            self.file.charset.characters(before).map(|(_, sign)| self.units.of(sign)).sum()
        };
        Position { line: line - 1, character }
    }

    pub(super) fn range(self, span: Span) -> Range {
        Range { start: self.position(span.start), end: self.position(span.end) }
    }

    /// The bytes between two positions.
    pub(super) fn span(self, range: &Range) -> Span {
        let start = self.byte(range.start);
        Span { file: self.file.id, start, end: self.byte(range.end).max(start) }
    }

    /// The first byte of a line, from 1, behind a byte order mark.
    fn start(self, line: u32) -> u32 {
        let start = self.file.lines.range(line).start;
        if start == 0 && self.file.charset.bom { MARK } else { start }
    }

    fn bytes(self, start: u32, end: u32) -> &'f [u8] {
        self.file.bytes.get(start as usize..end as usize).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rapid::text::FileId;

    fn file(bytes: &[u8]) -> SourceFile {
        SourceFile::new(FileId(0), "a".into(), bytes.to_vec())
    }

    #[test]
    fn positions_count_the_agreed_units() {
        let text = "! 🙂ü x\r\ny\n";
        let file = file(text.as_bytes());
        let end = text.len() as u32;
        let utf16 =
            [(0, 0, 0), (0, 3, 2), (0, 4, 6), (0, 5, 8), (0, 99, 10), (1, 1, 13), (9, 0, end)];
        let utf8 =
            [(0, 0, 0), (0, 3, 2), (0, 6, 6), (0, 8, 8), (0, 99, 10), (1, 1, 13), (9, 0, end)];
        for (units, cases) in [(Units::Utf16, utf16), (Units::Utf8, utf8)] {
            let positions = Positions::new(&file, units);
            for (line, character, byte) in cases {
                let position = Position { line, character };
                assert_eq!(positions.byte(position), byte, "{units:?} {line}:{character}");
            }
        }
        let position = |units| Positions::new(&file, units).position(8).character;
        assert_eq!((position(Units::Utf16), position(Units::Utf8)), (5, 8));
    }

    #[test]
    fn positions_count_characters_of_other_encodings() {
        // The end of the line, where `ü` is one byte in windows-1252 and two of UTF-8.
        let latin = file(b"! f\xFCr\nx");
        let utf8 = file("\u{FEFF}! für\nx".as_bytes());
        for (file, byte) in [(&latin, 5), (&utf8, 9)] {
            for (units, character) in [(Units::Utf16, 5), (Units::Utf8, 6)] {
                let positions = Positions::new(file, units);
                let position = Position { line: 0, character };
                assert_eq!((positions.byte(position), positions.position(byte)), (byte, position));
            }
        }
    }
}
