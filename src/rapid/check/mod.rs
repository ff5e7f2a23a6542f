//! Whether a controller would load a program.
//!
//! [`check`] looks at the modules of one task: names, arguments, types, handlers, attributes. Each
//! kind of fault is one file. An error is reported only for what the given text alone proves; what
//! the text cannot tell (a name that another module may declare, a type that is not known) is left
//! alone or a warning.

mod arguments;
mod context;
mod describe;
mod duplicates;
mod expressions;
mod fault;
mod flow;
mod jumps;
mod modules;
mod parameters;
mod roles;
mod spelling;
mod statements;
mod suggest;
mod syntax_errors;
mod types;
mod unknown;
mod unset;
mod values;

pub use context::{Extent, Task};

use crate::rapid::diagnostics::Diagnostic;
use context::Context;

/// The findings in the modules of a task, in the order of the files.
#[must_use]
pub fn check(task: &Task<'_>) -> Vec<Diagnostic> {
    let context = Context::new(task);
    let mut found = Vec::new();
    for rule in [
        syntax_errors::check,
        modules::check,
        duplicates::check,
        spelling::check,
        unknown::check,
        roles::check,
        arguments::check,
        statements::check,
        flow::check,
        jumps::check,
        unset::check,
    ] {
        rule(&context, &mut found);
    }
    let order = |it: &Diagnostic| (it.span.file, it.span.start, it.span.end, it.code.clone());
    found.sort_by_key(order);
    found.dedup_by(|a, b| a.span == b.span && a.message == b.message);
    found
}
