//! Places as editors count them: lines from 0, UTF-16 units in them.

use serde_json::{Value, json};

use crate::rapid::text::{SourceFile, Span};

/// The byte of a place; the end of its line where the line is shorter.
pub(super) fn offset_of(file: &SourceFile, position: &Value) -> Option<u32> {
    let line = u32::try_from(position["line"].as_u64()?).ok()?;
    let units = position["character"].as_u64()?;
    offset(file, line, units)
}

fn offset(file: &SourceFile, line: u32, units: u64) -> Option<u32> {
    if line >= file.lines.count() {
        return Some(file.bytes.len() as u32);
    }
    let range = file.lines.range(line + 1);
    let bytes = file.bytes.get(range.start as usize..range.end as usize)?;
    let text = String::from_utf8_lossy(bytes);
    let mut left = units;
    let mut at = range.start;
    for sign in text.trim_end_matches(['\r', '\n']).chars() {
        let width = sign.len_utf16() as u64;
        if left < width {
            break;
        }
        left -= width;
        at += sign.len_utf8() as u32;
    }
    Some(at.min(range.end))
}

/// The place of a byte.
fn position_of(file: &SourceFile, offset: u32) -> Value {
    let line = file.position(offset).line;
    let start = file.lines.range(line).start.min(offset);
    let bytes = file.bytes.get(start as usize..offset as usize).unwrap_or_default();
    let units: usize = String::from_utf8_lossy(bytes).chars().map(char::len_utf16).sum();
    json!({ "line": line - 1, "character": units })
}

/// The range of a span.
pub(super) fn range_of(file: &SourceFile, span: Span) -> Value {
    json!({ "start": position_of(file, span.start), "end": position_of(file, span.end) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rapid::text::FileId;

    #[test]
    fn places_are_counted_in_utf16() {
        let text = "! 🙂ü x\r\ny\n";
        let file = SourceFile::new(FileId(0), "a".into(), text.as_bytes().to_vec());
        for (line, units, byte) in [(0, 0, 0), (0, 4, 6), (0, 5, 8), (0, 99, 10), (1, 1, 13)] {
            assert_eq!(offset(&file, line, units), Some(byte), "{line}:{units}");
        }
        assert_eq!(offset(&file, 9, 0), Some(text.len() as u32));
        assert_eq!(position_of(&file, 8), json!({ "line": 0, "character": 5 }));
    }
}
