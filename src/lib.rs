//! joulepath: a compiler for ABB RAPID programs that saves energy.
//!
//! The layers, lowest first; `docs/architecture.md` is the map of the code.

pub mod cli;
pub mod diagnostics;
pub mod ir;
pub mod syntax;
pub mod text;
