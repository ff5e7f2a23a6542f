//! What the server needs from outside.

use std::path::{Path, PathBuf};

use lsp_server::{Connection, Message};

use super::error::LspError;
use super::options::Options;
use crate::rapid::check::Extent;
use crate::rapid::format::Style;
use crate::rapid::text::SourceFile;
use crate::tool::lint::Programs;

/// Reads files and settings for the server, and has the clock.
pub trait Host {
    /// The modules in a folder and its folders; none if it cannot be read.
    fn project(&self, options: &Options, folder: &Path) -> ProjectFiles;

    /// The programs of a folder for the linter.
    fn programs(&self, options: &Options, folder: &Path) -> Programs;

    /// The style in which a file is formatted.
    ///
    /// # Errors
    /// Its configuration is wrong.
    fn style(&self, file: &Path) -> Result<Style, String>;

    /// The files that change if the run with a movement in a line (from 1) of a file becomes a stream.
    ///
    /// # Errors
    /// Why it stays as it is.
    fn with_stream(
        &self,
        options: &Options,
        file: &Path,
        line: u32,
    ) -> Result<Vec<ChangedFile>, String>;

    /// The next message, or `None` once the user pauses: then diagnostics are made.
    ///
    /// # Errors
    /// The client has closed the connection.
    fn until_pause(&self, connection: &Connection) -> Result<Option<Message>, LspError>;
}

/// A file of the user that changes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChangedFile {
    /// Where it is.
    pub path: PathBuf,
    /// Its text on disk; `None` for a new one.
    pub before: Option<String>,
    /// Its new text.
    pub after: String,
}

/// The modules of a folder.
#[derive(Clone, Debug, Default)]
pub struct ProjectFiles {
    /// The files.
    pub files: Vec<SourceFile>,
    /// Which of them are loaded together. A file may be in several tasks.
    pub tasks: Vec<TaskFiles>,
}

/// The files of a task.
#[derive(Clone, Debug)]
pub struct TaskFiles {
    /// Their numbers.
    pub files: Vec<usize>,
    /// How much of the task they are.
    pub extent: Extent,
    /// The procedure that starts it.
    pub entry: String,
    /// The number of the controller: its tasks share their global persistents.
    pub controller: usize,
}
