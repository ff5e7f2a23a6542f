//! The command line.

pub mod input;
pub mod parse;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// A compiler for ABB RAPID programs that saves energy.
#[derive(Debug, Parser)]
#[command(name = "joulepath", version)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Parse(parse::ParseArgs),
}

/// Runs the command that the arguments ask for.
#[must_use]
pub fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Parse(args) => parse::run(&args),
    };
    result.unwrap_or_else(|error| {
        report(&error);
        ExitCode::from(2)
    })
}

#[expect(clippy::print_stderr, reason = "the message of a failed command goes to standard error")]
fn report(error: &anyhow::Error) {
    eprintln!("error: {error:#}");
}
