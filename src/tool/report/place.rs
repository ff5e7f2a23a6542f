//! Spans as file and lines.

use crate::rapid::text::{SourceFile, Span};

/// Converts spans to places.
#[derive(Clone, Copy)]
pub struct Places<'a> {
    files: &'a [SourceFile],
}

/// A place in the source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Path as given.
    pub file: String,
    /// From 1.
    pub first: u32,
    /// From 1.
    pub last: u32,
}

impl<'a> Places<'a> {
    /// Places in these files, indexed by their ids.
    pub fn new(files: &'a [SourceFile]) -> Places<'a> {
        Places { files }
    }

    /// The place of a span.
    pub fn of(&self, span: Span) -> Place {
        match self.files.get(span.file.0 as usize) {
            Some(file) => Place {
                file: file.path.clone(),
                first: file.position(span.start).line,
                last: file.position(span.end.max(span.start + 1) - 1).line,
            },
            None => Place { file: String::new(), first: 0, last: 0 },
        }
    }

    /// The places of the pieces of a run, the first few of many.
    pub fn of_pieces(&self, pieces: &[Span]) -> String {
        let mut file = None;
        let places = pieces.iter().take(MAX_PIECES).map(|piece| {
            let place = self.of(*piece);
            let is_named = file.replace(piece.file) == Some(piece.file);
            if is_named { place.lines() } else { place.to_string() }
        });
        let text = places.collect::<Vec<_>>().join(", ");
        if pieces.len() > MAX_PIECES { text + " …" } else { text }
    }
}

/// Maximum number of pieces that are listed.
const MAX_PIECES: usize = 3;

impl Place {
    fn lines(&self) -> String {
        let Place { first, last, .. } = self;
        if first == last { first.to_string() } else { format!("{first}-{last}") }
    }
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}:{}", self.file, self.lines())
    }
}
