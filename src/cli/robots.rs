//! `joulepath robots`: the catalogue.

use std::io::Write;
use std::process::ExitCode;

use clap::{Args, Subcommand};

use crate::robot::{self, Model};

/// List the known robots, or show one.
#[derive(Debug, Args)]
#[command(after_help = "Example: joulepath robots show IRB1600-10/1.45")]
pub struct RobotsArgs {
    #[command(subcommand)]
    command: RobotsCommand,
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
}

/// Runs the command.
///
/// # Errors
/// An unknown robot or a wrong file.
pub fn run(args: &RobotsArgs) -> anyhow::Result<ExitCode> {
    let mut out = std::io::stdout().lock();
    match &args.command {
        RobotsCommand::List => {
            for name in robot::names() {
                writeln!(out, "{name}")?;
            }
        }
        RobotsCommand::Show { robot } => write!(out, "{}", shown(&robot::load(robot)?))?,
    }
    Ok(ExitCode::SUCCESS)
}

fn shown(model: &Model) -> String {
    use std::fmt::Write;
    let mut text = format!("{}, {} joints\n", model.name, model.dof);
    let degrees = |list: &[f64]| {
        list.iter().map(|x| format!("{:.1}", x.to_degrees())).collect::<Vec<_>>().join(" ")
    };
    let ranges: Vec<String> = model
        .limits
        .position
        .iter()
        .map(|[lo, hi]| format!("{:.0}…{:.0}", lo.to_degrees(), hi.to_degrees()))
        .collect();
    let _ = writeln!(text, "position deg: {}", ranges.join(" "));
    for (what, list) in [
        ("speed deg/s", &model.limits.velocity),
        ("acceleration deg/s2", &model.limits.acceleration),
    ] {
        match list {
            Some(list) => writeln!(text, "{what}: {}", degrees(list)),
            None => writeln!(text, "{what}: not known"),
        }
        .unwrap_or_default();
    }
    let dynamics = if model.has_dynamics() { "yes" } else { "no: energies can't be computed" };
    let _ = writeln!(text, "dynamics: {dynamics}");
    let assumed = model.assumed();
    if !assumed.is_empty() {
        let _ = writeln!(text, "\nassumed:");
        for line in assumed {
            let _ = writeln!(text, "  {line}");
        }
    }
    text
}
