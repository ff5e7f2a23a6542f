//! What a user may choose.

/// The style of formatted programs; the default is what controllers write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    /// One step of indentation.
    pub indent: Indent,
    /// Case of reserved words.
    pub keywords: KeywordCase,
    /// Largest number of blank lines in a row.
    pub blank_lines: usize,
}

/// One step of indentation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Indent {
    /// This many spaces, at least one: a line that continues a statement has to be indented.
    Spaces(usize),
    /// A tab.
    Tab,
}

/// Case of reserved words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeywordCase {
    /// `IF`.
    Upper,
    /// As written.
    Keep,
}

impl Default for Style {
    fn default() -> Style {
        Style { indent: Indent::Spaces(2), keywords: KeywordCase::Upper, blank_lines: 1 }
    }
}

impl Style {
    /// The white space of this many steps.
    pub(super) fn indentation(&self, steps: usize) -> Vec<u8> {
        match self.indent {
            Indent::Spaces(width) => vec![b' '; width.max(1) * steps],
            Indent::Tab => vec![b'\t'; steps],
        }
    }
}
