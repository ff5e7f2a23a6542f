//! `joulepath calibrate`: narrows a robot's estimate by measured power.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::Args;

use super::common::{self, ProgramArgs};
use super::logs::{self, RawLog};
use super::{output, signals};
use crate::arm::robot::{Model, to_toml};
use crate::learn::calibrate::calibrate;
use crate::learn::identify::per_ampere;
use crate::learn::log::{Channel, ColumnMap, Log};
use crate::retime::motion;
use crate::tool::report::calibrate as report;
use crate::tool::retrofit::read_program;

/// The robot's estimated dynamics narrowed by the cabinet's power in the running program.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: joulepath calibrate fixtures/pick_place --robot IRB2600-20/1.65 --log power.csv --out cell.toml\n         then: joulepath optimize fixtures/pick_place --robot cell.toml"
)]
pub(super) struct CalibrateArgs {
    #[command(flatten)]
    program: ProgramArgs,

    /// The log, CSV or Parquet: `t`, `power` of the cabinet (W or kW), and where there are any `cycle`,
    /// `cmd`, `tau1…` or `i1…`.
    #[arg(long, value_name = "FILE")]
    log: PathBuf,

    /// Columns under other names, such as `power=P_total`.
    #[arg(long, value_name = "CHANNEL=COLUMN,…", default_value = "", hide_default_value = true)]
    map: String,

    /// Where the robot goes, Robot TOML.
    #[arg(long, value_name = "CELL.toml")]
    out: PathBuf,
}

pub(super) fn run(args: &CalibrateArgs) -> anyhow::Result<ExitCode> {
    if args.program.point_estimate {
        bail!(
            "--point-estimate leaves nothing to calibrate: a log narrows the plausible robots; leave it out"
        );
    }
    let job = common::prepare(&args.program)?;
    let inputs = job.read_paths().chain([args.log.as_path()]);
    output::refuse_inputs(&[("--out", Some(&args.out))], inputs)?;
    let (program, entry) = read_program(&job.files, &job.entry)?;
    signals::check(&args.program.cell, &job.options.levels, &program)?;
    let quiet = args.program.cell.quiet;
    let RawLog { shown, log, .. } = logs::read(&args.log, &ColumnMap::parse(&args.map)?)?;
    for rejected in log.rejected.iter().take(MAX_LISTED_ROWS) {
        common::note(
            quiet,
            &format!("{shown}: row {} is left out: {}", rejected.row, rejected.reason),
        );
    }
    if log.rejected.len() > MAX_LISTED_ROWS {
        let more = log.rejected.len() - MAX_LISTED_ROWS;
        common::note(quiet, &format!("{shown}: {more} more rows are left out"));
    }
    if log.column(Channel::Power).is_none() {
        bail!(
            "{shown}: there is no column `power`: log the cabinet's power in W or kW, or name its column \
             with --map power=NAME"
        );
    }
    let (torques, said) = torques(&job.model, &log);
    if let Some(said) = said {
        common::note(quiet, &format!("{shown}: {said}"));
    }
    let simulation = motion::simulate(&program, entry, &job.model, &job.options);
    let found = calibrate(&job.model, &simulation, &log, torques.as_deref())
        .with_context(|| shown.clone())?;
    let head = format!(
        "# {} calibrated by joulepath with the power of {} cycles of {}.\n",
        job.model.name, found.found.cycles, job.entry
    );
    output::write(&args.out, (head + &to_toml(&found.model)).as_bytes())?;
    let path = args.out.display().to_string();
    common::print(
        args.program.format,
        || report::json(&found, &path),
        || report::text(&found, &path),
    )
}

/// Maximum number of rejected rows that are listed individually.
const MAX_LISTED_ROWS: usize = 3;

/// Torques of all joints, logged or from currents, and why currents are not usable.
fn torques(model: &Model, log: &Log) -> (Option<Vec<Vec<f64>>>, Option<String>) {
    let of = |channel: fn(usize) -> Channel| -> Option<Vec<&[f64]>> {
        (0..model.dof).map(|joint| log.column(channel(joint))).collect()
    };
    if let Some(tau) = of(Channel::Torque) {
        return (Some(tau.into_iter().map(<[f64]>::to_vec).collect()), None);
    }
    let Some(currents) = of(Channel::Current) else {
        let some = |channel: fn(usize) -> Channel| {
            (0..model.dof).any(|joint| log.column(channel(joint)).is_some())
        };
        let said = "torques or currents of some joints only are not used: all of them are needed";
        let is_part = some(Channel::Torque) || some(Channel::Current);
        return (None, is_part.then(|| said.to_owned()));
    };
    match per_ampere(model) {
        Ok(factors) => {
            let tau = currents.iter().zip(&factors);
            (Some(tau.map(|(i, k)| i.iter().map(|i| i * k).collect()).collect()), None)
        }
        Err(error) => (None, Some(format!("the currents are not used: {error}"))),
    }
}
