//! The language: RAPID text, its syntax, and what a program does, as far as its text tells.
//!
//! It uses no other wing: it knows no robot.

pub mod builtins;
pub mod diagnostics;
pub mod ir;
pub mod syntax;
pub mod text;
