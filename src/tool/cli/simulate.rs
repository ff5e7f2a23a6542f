//! `joulepath simulate`: runs a program on the virtual controller.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::bail;
use clap::Args;

use super::common::{self, Format, ProgramArgs};
use super::{output, signals};
use crate::retime::energy::account;
use crate::retime::energy::plausible::plausibility;
use crate::retime::energy::trajectory::{STEP, trajectory};
use crate::retime::motion;
use crate::tool::report::html::simulate_report;
use crate::tool::report::place::Places;
use crate::tool::report::simulated::Simulated;
use crate::tool::report::{self};
use crate::tool::retrofit::read_program;

/// Run a program on the virtual controller: time and energy of each move.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: joulepath simulate fixtures/pick_place --robot IRB1600-10/1.45 --input diMcReady=20"
)]
pub(super) struct SimulateArgs {
    #[command(flatten)]
    program: ProgramArgs,

    /// Write the planned motion as CSV, at most 2 ms apart.
    #[arg(long, value_name = "FILE.csv")]
    trajectory: Option<PathBuf>,

    /// Write a report as one HTML file: the cycle over time, power, joints, the source with joules.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
}

/// Maximum number of trajectory rows in memory.
const MAX_ROWS: f64 = 5e6;

pub(super) fn run(args: &SimulateArgs) -> anyhow::Result<ExitCode> {
    let job = common::prepare(&args.program)?;
    output::refuse_inputs(
        &[("--trajectory", args.trajectory.as_ref()), ("--report", args.report.as_ref())],
        job.read_paths(),
    )?;
    let (program, entry) = read_program(&job.files, &job.entry)?;
    signals::check(&args.program.cell, &job.options.levels, &program)?;
    let simulation = motion::simulate(&program, entry, &job.model, &job.options);
    let account = account(&job.model, &simulation);
    let sources = job.sources();
    let places = Places::new(&sources);
    let plausible = if args.program.point_estimate {
        None
    } else {
        plausibility(&job.model, &simulation, &account)
    };
    let simulated = Simulated {
        model: &job.model,
        entry: &job.entry,
        simulation: &simulation,
        account: &account,
        plausible: plausible.as_ref(),
    };
    if args.trajectory.is_some() || args.report.is_some() {
        let rows = simulation.cycle_s / STEP;
        if rows > MAX_ROWS {
            bail!(
                "the cycle of {:.0} s has {rows:.0} rows of trajectory, more than {MAX_ROWS:.0}: \
                 end it earlier with --max-time, or leave --trajectory and --report out",
                simulation.cycle_s
            );
        }
        let samples = trajectory(&job.model, &simulation);
        if let Some(path) = &args.trajectory {
            output::write(path, report::trajectory::csv(places, &samples).as_bytes())?;
        }
        if let Some(path) = &args.report {
            let page = simulate_report(simulated, &samples, &sources)?;
            output::write(path, page.as_bytes())?;
        }
    }
    let mut notes = job.unused_inputs(&simulation);
    notes.extend(signals::unused_levels(&args.program.cell, &simulation));
    let quiet = args.program.cell.quiet;
    common::notes(quiet, &notes);
    if args.program.format == Format::Text {
        common::notes(quiet, report::text::notes(&job.model, places, &simulation));
    }
    common::print(
        args.program.format,
        || report::json::simulation(simulated, places, &notes),
        || report::text::simulation(simulated, places),
    )
}
