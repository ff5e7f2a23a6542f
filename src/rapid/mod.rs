//! The language: RAPID text, its syntax, and what a program does, as far as its text tells.
//!
//! - [`text`]: files, byte spans, encodings, edits;
//! - [`syntax`]: a lexer and parser that never fail and lose no byte;
//! - [`diagnostics`]: messages with their place in the source;
//! - [`format`]: a formatter, which changes white space and the case of keywords only;
//! - [`builtins`]: the table of RAPID's instructions, functions, types and predefined data;
//! - [`names`]: what each identifier of a program names;
//! - [`ir`]: modules, symbols, values, and the execution to movements, waits and outputs.
//!
//! It uses no other wing: it knows no robot.

pub mod builtins;
pub mod check;
pub mod diagnostics;
pub mod format;
pub mod ir;
pub mod names;
pub mod syntax;
pub mod text;
