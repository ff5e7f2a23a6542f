//! What users call: the retrofit, linter, emitted RAPID, reports, command line and language server.
//!
//! It uses all other wings.

pub mod cli;
pub mod config;
pub mod emit;
pub mod generate;
pub mod lint;
#[cfg(feature = "lsp")]
pub mod lsp;
pub mod report;
pub mod retrofit;
