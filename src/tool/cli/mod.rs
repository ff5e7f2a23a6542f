//! The command line.

mod backinfo;
mod backup;
mod blind;
mod calibrate;
mod campaign;
mod check;
mod choice;
mod common;
mod diagnose;
mod diff;
mod excite;
mod format;
mod generate;
mod identify;
mod input;
mod instrument;
mod keep_outs;
mod lint;
mod listing;
mod load;
mod logs;
#[cfg(feature = "lsp")]
mod lsp;
mod optimize;
mod output;
mod parse;
mod place;
mod predict;
mod program_output;
mod prove;
mod refresh;
mod robots;
mod rule;
mod signals;
mod simulate;
mod slack;
mod standstill;
mod streams;
mod streamtest;
mod suggest;
mod undo;
mod waits;

use std::io::{ErrorKind, Write as _};
use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// A compiler for ABB RAPID programs that saves energy.
#[derive(Debug, Parser)]
#[command(name = "joulepath", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Parse(parse::ParseArgs),
    Check(check::CheckArgs),
    Lint(Box<lint::LintArgs>),
    Diff(Box<diff::DiffArgs>),
    Format(format::FormatArgs),
    Rule(rule::RuleArgs),
    Simulate(simulate::SimulateArgs),
    #[command(alias = "optimise")]
    Optimize(Box<optimize::OptimizeArgs>),
    Refresh(Box<refresh::RefreshArgs>),
    Generate(generate::GenerateArgs),
    Place(Box<place::PlaceArgs>),
    Standstill(standstill::StandstillArgs),
    Instrument(Box<instrument::InstrumentArgs>),
    Campaign(campaign::CampaignArgs),
    Excite(Box<excite::ExciteArgs>),
    Streamtest(streamtest::StreamtestArgs),
    Identify(Box<identify::IdentifyArgs>),
    Calibrate(Box<calibrate::CalibrateArgs>),
    Waits(waits::WaitsArgs),
    Predict(predict::PredictArgs),
    Prove(prove::ProveArgs),
    Diagnose(Box<diagnose::DiagnoseArgs>),
    Blind(blind::BlindArgs),
    Robots(robots::RobotsArgs),
    #[cfg(feature = "lsp")]
    Lsp(lsp::LspArgs),
}

/// Runs the command of the arguments.
#[must_use]
pub fn command_line() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Parse(args) => parse::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Lint(args) => lint::run(&args),
        Command::Diff(args) => diff::run(&args),
        Command::Format(args) => format::run(&args),
        Command::Rule(args) => rule::run(&args),
        Command::Simulate(args) => simulate::run(&args),
        Command::Optimize(args) => optimize::run(&args),
        Command::Refresh(args) => refresh::run(&args),
        Command::Generate(args) => generate::run(&args),
        Command::Place(args) => place::run(&args),
        Command::Standstill(args) => standstill::run(&args),
        Command::Instrument(args) => instrument::run(&args),
        Command::Campaign(args) => campaign::run(&args),
        Command::Excite(args) => excite::run(&args),
        Command::Streamtest(args) => streamtest::run(&args),
        Command::Identify(args) => identify::run(&args),
        Command::Calibrate(args) => calibrate::run(&args),
        Command::Waits(args) => waits::run(&args),
        Command::Predict(args) => predict::run(&args),
        Command::Prove(args) => prove::run(&args),
        Command::Diagnose(args) => diagnose::run(&args),
        Command::Blind(args) => blind::run(&args),
        Command::Robots(args) => robots::run(&args),
        #[cfg(feature = "lsp")]
        Command::Lsp(args) => lsp::run(&args),
    };
    result.unwrap_or_else(|error| {
        if is_closed(&error) {
            return ExitCode::SUCCESS;
        }
        writeln!(std::io::stderr(), "error: {error:#}").unwrap_or_default();
        ExitCode::from(2)
    })
}

/// Whether the reader of standard output has closed it, as `| head` does.
fn is_closed(error: &anyhow::Error) -> bool {
    error.chain().any(|cause| {
        let kind = match cause.downcast_ref::<std::io::Error>() {
            Some(error) => Some(error.kind()),
            None => {
                cause.downcast_ref::<serde_json::Error>().and_then(serde_json::Error::io_error_kind)
            }
        };
        kind == Some(ErrorKind::BrokenPipe)
    })
}
