//! Messages about source text, and their display.

mod concise;
mod diagnostic;
mod full;

pub use concise::concise;
pub use diagnostic::{Diagnostic, Label, Note, Severity};
pub use full::{Paint, full};
