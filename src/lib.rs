//! joulepath: a compiler for ABB RAPID programs that saves energy.
//!
//! The layers, lowest first; `docs/architecture.md` is the map of the code.

pub mod blind;
pub mod calibrate;
pub mod cli;
pub mod config;
pub mod diagnostics;
pub mod dynamics;
pub mod effects;
pub mod emit;
pub mod energy;
pub mod excite;
pub mod gap;
pub mod generate;
pub mod identify;
pub mod ir;
pub mod kinematics;
pub mod lint;
pub mod log;
#[cfg(feature = "lsp")]
pub mod lsp;
pub mod motion;
pub mod optimize;
pub mod path;
pub mod report;
pub mod retrofit;
pub mod robot;
pub mod syntax;
pub mod text;
