//! Positions of the protocol: lines from 0, UTF-16 units within a line.

use gen_lsp_types::{Position, Range};

use crate::rapid::text::{SourceFile, Span};

/// The byte at a position; the line end if the line is shorter, the file end if there is no such
/// line.
pub(super) fn offset_of(file: &SourceFile, position: Position) -> u32 {
    let end = file.bytes.len() as u32;
    if position.line >= file.lines.count() {
        return end;
    }
    let range = file.lines.range(position.line + 1);
    let bytes = file.bytes.get(range.start as usize..range.end as usize).unwrap_or_default();
    let text = String::from_utf8_lossy(bytes);
    let mut left = position.character as usize;
    let mut at = range.start;
    for sign in text.trim_end_matches(['\r', '\n']).chars() {
        let width = sign.len_utf16();
        if left < width {
            break;
        }
        left -= width;
        at += sign.len_utf8() as u32;
    }
    at.min(range.end)
}

fn position_of(file: &SourceFile, offset: u32) -> Position {
    let line = file.position(offset).line;
    let start = file.lines.range(line).start.min(offset);
    let bytes = file.bytes.get(start as usize..offset as usize).unwrap_or_default();
    let units: usize = String::from_utf8_lossy(bytes).chars().map(char::len_utf16).sum();
    Position { line: line - 1, character: units as u32 }
}

pub(super) fn range_of(file: &SourceFile, span: Span) -> Range {
    Range { start: position_of(file, span.start), end: position_of(file, span.end) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rapid::text::FileId;

    #[test]
    fn positions_are_counted_in_utf16() {
        let text = "! 🙂ü x\r\ny\n";
        let file = SourceFile::new(FileId(0), "a".into(), text.as_bytes().to_vec());
        for (line, character, byte) in
            [(0, 0, 0), (0, 4, 6), (0, 5, 8), (0, 99, 10), (1, 1, 13), (9, 0, text.len() as u32)]
        {
            let position = Position { line, character };
            assert_eq!(offset_of(&file, position), byte, "{line}:{character}");
        }
        assert_eq!(position_of(&file, 8), Position { line: 0, character: 5 });
    }
}
