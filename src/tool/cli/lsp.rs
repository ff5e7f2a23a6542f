//! `joulepath lsp`: the language server.

mod one_run;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use clap::Args;
use rayon::prelude::*;

use super::check::tasks;
use super::common::{self, CellArgs};
use super::input;
use super::lint::{LintArgs, Setup};
use crate::rapid::format::Style;
use crate::rapid::syntax::{self, Parse};
use crate::tool::lint::Programs;
use crate::tool::lsp::{
    self, ChangedFile, Connection, Host, LspError, Message, Options, ProjectFiles, TaskFiles,
};

/// The procedure that starts a program, where nothing names another one.
const ENTRY: &str = "main";
/// How long the user has to pause before diagnostics are made.
const PAUSE: Duration = Duration::from_millis(100);

/// Serve an editor over standard input and output (Language Server Protocol).
#[derive(Debug, Args)]
#[command(after_help = "Editors give robot, entry and inputs as initializationOptions, or a \
    joulepath.toml does.\n\nExample: joulepath lsp --robot IRB1600-10/1.45")]
pub(super) struct LspArgs {
    /// The robot where the editor names none.
    #[arg(long, value_name = "NAME|FILE")]
    robot: Option<String>,

    /// The procedure that starts the program, where the editor names none.
    #[arg(long)]
    entry: Option<String>,

    /// When an input comes, where the editor says nothing.
    #[arg(long = "input", value_name = "SIGNAL=SECONDS")]
    inputs: Vec<String>,
}

pub(super) fn run(args: &LspArgs) -> anyhow::Result<ExitCode> {
    let LspArgs { robot, entry, inputs } = args;
    let defaults = Options { robot: robot.clone(), entry: entry.clone(), inputs: inputs.clone() };
    lsp::serve(defaults, Disk)?;
    Ok(ExitCode::SUCCESS)
}

/// Files and settings on disk.
struct Disk;

impl Host for Disk {
    fn project(&self, options: &Options, folder: &Path) -> ProjectFiles {
        let cell = CellArgs { paths: existing(folder), ..CellArgs::default() };
        if cell.paths.is_empty() {
            return ProjectFiles::default();
        }
        // A wrong configuration is reported by the commands; here it names no entry.
        let configured = common::configuration(&cell).ok().and_then(|(config, _)| config.entry);
        let entry = options.entry.clone().or(configured).unwrap_or_else(|| ENTRY.to_owned());
        let Ok(input) = input::read(&cell.paths) else { return ProjectFiles::default() };
        let parses: Vec<Parse> =
            input.files.par_iter().map(|file| syntax::parse(&file.source.bytes)).collect();
        let tasks = tasks::tasks(&input, &parses, &entry);
        // All that is in no backup counts as one controller.
        let controller = |file: &usize| {
            let place = input.files[*file].place.as_ref();
            place.map_or(input.backups.len(), |place| place.backup)
        };
        let task = |task: tasks::TaskFiles| {
            let controller = task.files.first().map_or(0, controller);
            let tasks::TaskFiles { files, extent, entry, .. } = task;
            TaskFiles { files, extent, entry, controller }
        };
        let tasks = tasks.into_iter().map(task).collect();
        let files = input.files.into_iter().map(|file| file.source).collect();
        ProjectFiles { files, tasks }
    }

    /// None if the folder cannot be read or the robot is unknown, so that only open documents are
    /// linted.
    fn programs(&self, options: &Options, folder: &Path) -> Programs {
        let args = LintArgs { cell: cell(options, folder), ..LintArgs::default() };
        Setup::new(&args).map(|setup| setup.programs).unwrap_or_default()
    }

    fn style(&self, file: &Path) -> Result<Style, String> {
        let cell = CellArgs { paths: vec![file.to_path_buf()], ..CellArgs::default() };
        let (config, _) = common::configuration(&cell).map_err(|error| format!("{error:#}"))?;
        Ok(config.format.style())
    }

    fn with_stream(
        &self,
        options: &Options,
        file: &Path,
        line: u32,
    ) -> Result<Vec<ChangedFile>, String> {
        let folder = file.parent().map_or_else(PathBuf::new, Path::to_path_buf);
        one_run::with_stream(cell(options, &folder), file, line).map_err(|it| format!("{it:#}"))
    }

    fn until_pause(&self, connection: &Connection) -> Result<Option<Message>, LspError> {
        match connection.receiver.recv_timeout(PAUSE) {
            Ok(message) => Ok(Some(message)),
            Err(error) if error.is_timeout() => Ok(None),
            Err(_) => Err(LspError::Closed),
        }
    }
}

/// The programs of a folder, with the options of the editor.
fn cell(options: &Options, folder: &Path) -> CellArgs {
    CellArgs {
        paths: existing(folder),
        robot: options.robot.clone(),
        entry: options.entry.clone(),
        inputs: options.inputs.clone(),
        quiet: true,
        ..CellArgs::default()
    }
}

/// The folder, if there is one.
fn existing(folder: &Path) -> Vec<PathBuf> {
    folder.is_dir().then(|| folder.to_path_buf()).into_iter().collect()
}
