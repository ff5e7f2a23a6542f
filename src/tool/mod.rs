//! What users call and see.
//!
//! - [`emit`], [`retrofit`], [`generate`]: RAPID text from streams, the main job, programs from points;
//! - [`lint`]: wasted energy, with joules and fixes;
//! - [`place`]: where frames should stand;
//! - [`compare`]: what changed in meaning between two programs;
//! - [`cell`]: the recorder in the cell, its logs, and what they prove;
//! - [`suggest`]: changes that a person has to approve;
//! - [`report`]: results as text, JSON and HTML;
//! - [`config`]: `joulepath.toml`;
//! - `lsp`: the language server;
//! - [`cli`]: the commands.
//!
//! It uses all other wings.

pub mod cell;
pub mod cli;
pub mod compare;
pub mod config;
pub mod emit;
pub mod generate;
pub mod lint;
#[cfg(feature = "lsp")]
pub mod lsp;
pub mod place;
pub mod report;
pub mod retrofit;
pub mod suggest;
