//! Source text: files, byte spans, line index, encodings, edits.

mod edit;
mod encoding;
mod lines;
mod source;
mod span;

pub use edit::{Edit, EditError, apply};
pub use encoding::{Charset, Decoded, charset, decode, is_encoded_module};
pub use lines::{LineIndex, Position};
pub use source::SourceFile;
pub use span::{FileId, Span};
