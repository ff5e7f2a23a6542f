//! A file of a project with what is derived from its bytes alone.

use std::cell::OnceCell;

use memchr::memchr2_iter;

use crate::rapid::names::SourceText;
use crate::rapid::syntax::{self, Parse};
use crate::rapid::text::SourceFile;

/// A file. Its tree is made when it is first needed.
pub(super) struct Module {
    pub(super) file: SourceFile,
    parse: OnceCell<Parse>,
}

impl Module {
    pub(super) fn new(file: SourceFile) -> Module {
        Module { file, parse: OnceCell::new() }
    }

    pub(super) fn parse(&self) -> &Parse {
        self.parse.get_or_init(|| syntax::parse(&self.file.bytes))
    }

    pub(super) fn source(&self) -> SourceText<'_> {
        SourceText { file: &self.file, parse: self.parse() }
    }

    /// Whether a name (in lower case) stands in its text: alone, in another word, or in a comment.
    pub(super) fn mentions(&self, name: &str) -> bool {
        let (Some(first), true) = (name.bytes().next(), name.is_ascii()) else { return true };
        let bytes = &self.file.bytes;
        memchr2_iter(first, first.to_ascii_uppercase(), bytes).any(|at| {
            let word = bytes.get(at..at + name.len());
            word.is_some_and(|word| word.eq_ignore_ascii_case(name.as_bytes()))
        })
    }
}
