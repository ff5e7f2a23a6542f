//! From byte offsets to lines and columns.

use super::encoding::Charset;

/// A place as line and column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Position {
    /// Line, from 1.
    pub line: u32,
    /// Column in characters of the decoded text, from 1; an invalid byte counts as one.
    pub column: u32,
}

/// The starts of the lines of a file. CR, LF and CRLF each end a line.
#[derive(Clone, Debug)]
pub struct LineIndex {
    /// First byte of each line.
    starts: Vec<u32>,
    /// Bytes that do not begin a character, ascending.
    inner: Vec<u32>,
    length: u32,
}

impl LineIndex {
    /// Indexes a file of known encoding.
    #[must_use]
    pub fn with_charset(bytes: &[u8], charset: Charset) -> LineIndex {
        let mut starts = vec![0];
        let mut inner = Vec::new();
        if charset.bom {
            inner.extend([0, 1, 2]);
        }
        let mut at = inner.len();
        while let Some(&byte) = bytes.get(at) {
            if byte < 0x80 {
                let ends = byte == b'\n' || (byte == b'\r' && bytes.get(at + 1) != Some(&b'\n'));
                at += 1;
                if ends {
                    starts.push(at as u32);
                }
            } else {
                let width = charset.width(&bytes[at..]);
                inner.extend((at + 1..at + width).map(|i| i as u32));
                at += width;
            }
        }
        LineIndex { starts, inner, length: bytes.len() as u32 }
    }

    /// Line and column of a byte; an offset past the end counts as the end.
    #[must_use]
    pub fn position(&self, offset: u32) -> Position {
        let offset = offset.min(self.length);
        let line = self.starts.partition_point(|&start| start <= offset);
        let start = self.starts[line - 1];
        let inner = self.inner.partition_point(|&i| i < offset)
            - self.inner.partition_point(|&i| i < start);
        Position { line: line as u32, column: offset - start - inner as u32 + 1 }
    }

    /// Number of lines; a line end at the end of the file starts no further line, and an empty file
    /// has none.
    #[must_use]
    pub fn count(&self) -> u32 {
        let last_is_empty = self.starts.last() == Some(&self.length);
        self.starts.len() as u32 - u32::from(last_is_empty)
    }

    /// Byte range of a line (from 1) with its line end; empty for a line past the end.
    #[must_use]
    pub fn range(&self, line: u32) -> std::ops::Range<u32> {
        let index = line.saturating_sub(1) as usize;
        let start = self.starts.get(index).copied().unwrap_or(self.length);
        let end = self.starts.get(index + 1).copied().unwrap_or(self.length);
        start..end
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rapid::text::encoding::charset;

    fn index(bytes: &[u8]) -> LineIndex {
        LineIndex::with_charset(bytes, charset(bytes))
    }

    fn positions(bytes: &[u8]) -> Vec<(u32, u32)> {
        let index = index(bytes);
        (0..=bytes.len() as u32)
            .map(|at| index.position(at))
            .map(|position| (position.line, position.column))
            .collect()
    }

    #[test]
    fn every_kind_of_line_end_ends_one_line() {
        assert_eq!(
            positions(b"a\r\nb\rc\nd"),
            [(1, 1), (1, 2), (1, 3), (2, 1), (2, 2), (3, 1), (3, 2), (4, 1), (4, 2)]
        );
        assert_eq!(index(b"a\r\nb\rc\nd").count(), 4);
        assert_eq!(index(b"a\n").count(), 1);
        assert_eq!(index(b"").count(), 0);
    }

    #[test]
    fn columns_count_characters() {
        assert_eq!(positions("ä€x".as_bytes())[2], (1, 2));
        assert_eq!(positions("ä€x".as_bytes())[5], (1, 3));
        // The same letter in windows-1252, where a byte is a character.
        assert_eq!(positions(b"! f\xFCr\n\xFCx")[7], (2, 2));
        // A byte order mark has no width.
        assert_eq!(positions(b"\xEF\xBB\xBFab")[4], (1, 2));
    }

    #[test]
    fn columns_count_characters_of_two_byte_encodings() {
        let text = "! 机器人回到原点位置，等待信号 x";
        let (bytes, _, _) = encoding_rs::GBK.encode(text);
        let index = index(&bytes);
        let column = index.position(bytes.len() as u32 - 1).column;
        assert_eq!(column as usize, text.chars().count());
    }

    #[test]
    fn lines_tile_the_file() {
        let bytes = b"one\r\n\rthree\n";
        let index = index(bytes);
        let joined: Vec<u8> = (1..=index.count())
            .flat_map(|line| {
                let range = index.range(line);
                bytes[range.start as usize..range.end as usize].to_vec()
            })
            .collect();
        assert_eq!(joined, bytes);
    }
}
