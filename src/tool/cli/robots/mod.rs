//! `joulepath robots`: the catalogue, and the user's own robots.

mod check;
mod import;
mod show;

use std::process::ExitCode;

use clap::{Args, Subcommand};
use serde_json::json;

use super::common::{Format, print};
use crate::arm::robot;

/// List the known robots, show or check one, or import one.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  joulepath robots show IRB1600-10/1.45\n  \
                        joulepath robots check arm.urdf\n  \
                        joulepath robots import backup --out cell.toml")]
pub(super) struct RobotsArgs {
    #[command(subcommand)]
    command: RobotsCommand,

    /// How the result is written.
    #[arg(long, value_enum, default_value_t = Format::Text, global = true)]
    format: Format,
}

#[derive(Debug, Subcommand)]
enum RobotsCommand {
    /// The names of all known robots.
    List,
    /// What is known of a robot, and what of it is assumed.
    Show {
        /// A name or a robot file.
        robot: String,
    },
    /// Whether robots are sound, and what each command would lack.
    Check {
        /// Names or robot files; all known robots if none is given.
        robots: Vec<String>,
    },
    /// A URDF, a MOC.cfg or a backup as Robot TOML.
    Import(import::ImportArgs),
}

pub(super) fn run(args: &RobotsArgs) -> anyhow::Result<ExitCode> {
    match &args.command {
        RobotsCommand::List => list(args.format),
        RobotsCommand::Show { robot } => show::run(robot, args.format),
        RobotsCommand::Import(args) => import::run(args),
        RobotsCommand::Check { robots } => check::run(robots, args.format),
    }
}

fn list(format: Format) -> anyhow::Result<ExitCode> {
    let json = || json!({ "robots": robot::names().collect::<Vec<_>>() });
    print(format, json, || robot::names().flat_map(|name| [name, "\n"]).collect())
}
