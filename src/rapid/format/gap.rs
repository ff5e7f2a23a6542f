//! White space between two tokens.

/// The white space between two tokens, taken apart.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gap<'a> {
    bytes: &'a [u8],
}

impl<'a> Gap<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Gap<'a> {
        Gap { bytes }
    }

    pub(super) fn bytes(self) -> &'a [u8] {
        self.bytes
    }

    pub(super) fn is_empty(self) -> bool {
        self.bytes.is_empty()
    }

    /// Whether it has characters other than blanks, tabs and line ends, which stay.
    pub(super) fn is_unusual(self) -> bool {
        !self.bytes.iter().all(|byte| matches!(byte, b' ' | b'\t' | b'\r' | b'\n' | 0x0C))
    }

    /// Number of line ends; CRLF is one.
    pub(super) fn lines(self) -> usize {
        let ends = |at: usize| match self.bytes[at] {
            b'\n' => true,
            b'\r' => self.bytes.get(at + 1) != Some(&b'\n'),
            _ => false,
        };
        (0..self.bytes.len()).filter(|at| ends(*at)).count()
    }

    /// Its first line end.
    pub(super) fn line_end(self) -> Option<&'a [u8]> {
        let at = self.bytes.iter().position(|byte| matches!(byte, b'\n' | b'\r'))?;
        let is_pair = self.bytes[at] == b'\r' && self.bytes.get(at + 1) == Some(&b'\n');
        Some(&self.bytes[at..at + 1 + usize::from(is_pair)])
    }

    /// Number of bytes up to and including the last line end.
    pub(super) fn before_last_line(self) -> usize {
        self.bytes.iter().rposition(|byte| matches!(byte, b'\n' | b'\r')).map_or(0, |at| at + 1)
    }
}
