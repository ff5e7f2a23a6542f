//! Groups of files that form a program.

use super::system::System;

/// Files that may belong together, with their entry.
#[derive(Clone, Debug)]
pub struct Group {
    /// Ids of the files.
    pub files: Vec<usize>,
    /// The routine that starts the program.
    pub entry: String,
    /// The configuration of their controller.
    pub system: Option<System>,
}
