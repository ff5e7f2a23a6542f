//! Source text: files, byte spans, line index, encodings, edits.

mod span;

pub use span::{FileId, Span};
