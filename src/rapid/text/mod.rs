//! Source text: files, byte spans, line index, encodings, edits.

mod detect;
mod edit;
mod encoding;
mod lines;
mod source;
mod span;
mod utf16;

pub use edit::{Edit, EditError, apply};
pub use encoding::{Charset, Decoded, charset, decode, is_encoded_module};
pub use lines::{LineIndex, Position};
pub use source::SourceFile;
pub use span::{FileId, Span};
pub use utf16::Utf16;
