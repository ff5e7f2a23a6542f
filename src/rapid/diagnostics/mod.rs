//! What is said about source text, and how it is shown.

mod concise;
mod diagnostic;
mod full;

pub use concise::concise;
pub use diagnostic::{Diagnostic, Label, Note, Severity};
pub use full::{Paint, full};
