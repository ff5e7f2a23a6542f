//! `joulepath lsp`: the language server.

use std::process::ExitCode;

use clap::Args;

use crate::tool::lsp::{self, Options};

/// Serve an editor over standard input and output (Language Server Protocol).
#[derive(Debug, Args)]
#[command(after_help = "Editors give robot, entry and inputs as initializationOptions, or a \
    joulepath.toml does.\n\nExample: joulepath lsp --robot IRB1600-10/1.45")]
pub struct LspArgs {
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

/// Runs the command.
///
/// # Errors
/// The other side does not speak the protocol.
pub fn run(args: &LspArgs) -> anyhow::Result<ExitCode> {
    let LspArgs { robot, entry, inputs } = args;
    lsp::serve(Options { robot: robot.clone(), entry: entry.clone(), inputs: inputs.clone() })?;
    Ok(ExitCode::SUCCESS)
}
