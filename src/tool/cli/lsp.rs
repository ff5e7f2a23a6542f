//! `joulepath lsp`: the language server.

use std::path::Path;
use std::process::ExitCode;

use clap::Args;

use super::common::CellArgs;
use super::lint::{LintArgs, Setup};
use crate::tool::lint::Programs;
use crate::tool::lsp::{self, Options};

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
    lsp::serve(defaults, programs)?;
    Ok(ExitCode::SUCCESS)
}

/// The programs of a folder; none if it cannot be read or the robot is unknown, so that only open
/// documents are linted.
fn programs(options: &Options, folder: &Path) -> Programs {
    let cell = CellArgs {
        paths: folder.is_dir().then(|| folder.to_path_buf()).into_iter().collect(),
        robot: options.robot.clone(),
        entry: options.entry.clone(),
        inputs: options.inputs.clone(),
        quiet: true,
        ..CellArgs::default()
    };
    let args = LintArgs { cell, ..LintArgs::default() };
    Setup::new(&args).map(|setup| setup.programs).unwrap_or_default()
}
