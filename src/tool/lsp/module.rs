//! A file of a project with what is derived from its bytes alone.

use std::cell::OnceCell;
use std::collections::HashSet;

use crate::rapid::names::SourceText;
use crate::rapid::syntax::{self, Parse, TokenKind};
use crate::rapid::text::SourceFile;

/// A file. Its tree and its words are made when they are first needed.
pub(super) struct Module {
    pub(super) file: SourceFile,
    parse: OnceCell<Parse>,
    words: OnceCell<HashSet<String>>,
}

impl Module {
    pub(super) fn new(file: SourceFile) -> Module {
        Module { file, parse: OnceCell::new(), words: OnceCell::new() }
    }

    pub(super) fn parse(&self) -> &Parse {
        self.parse.get_or_init(|| syntax::parse(&self.file.bytes))
    }

    pub(super) fn source(&self) -> SourceText<'_> {
        SourceText { file: &self.file, parse: self.parse() }
    }

    /// Whether it has an identifier of this name, in lower case.
    pub(super) fn has_word(&self, name: &str) -> bool {
        let words = || {
            let tokens = self.parse().tree.tokens();
            let words =
                (0..tokens.count()).filter(|one| tokens.kind(*one) == TokenKind::Identifier);
            let text = |word| {
                let range = tokens.range(word);
                let bytes = self.file.bytes.get(range.start as usize..range.end as usize);
                self.file.charset.decode(bytes.unwrap_or_default()).to_lowercase()
            };
            words.map(text).collect()
        };
        self.words.get_or_init(words).contains(name)
    }
}
