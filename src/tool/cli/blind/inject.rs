//! `joulepath blind inject`: known effects added to logs of real robots.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::Args;

use super::super::{logs, output};
use super::cases::write_cases;
use crate::arm::effects;
use crate::examine::injected::{Arm, Cases};
use crate::learn::log::ColumnMap;

/// Write cases from logs of real robots: an effect added to the measured torques, the truth sealed
/// beside them.
///
/// Each --robot has one --log and, if the columns have other names, one --map, in the same order.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: joulepath blind inject --out cases --seed 7 --robot arm.urdf --log arm.csv --robot other.toml --log other.csv"
)]
pub(super) struct InjectArgs {
    /// A folder that does not exist yet or has no cases.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,

    /// The same seed gives the same bytes.
    #[arg(long, value_name = "N")]
    seed: u64,

    /// Number of cases; one in five is healthy.
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=9999))]
    count: u32,

    /// A robot, whose model is identified from its log: a name (joulepath robots list) or a robot
    /// file, TOML or URDF.
    #[arg(long, value_name = "NAME|FILE", required = true)]
    robot: Vec<String>,

    /// The log of each robot, CSV or Parquet: `t`, `q1…`, optional `qd1…`, and `tau1…` or currents;
    /// all joints move, without repetitions that are one part of the log each.
    #[arg(long, value_name = "FILE", required = true)]
    log: Vec<PathBuf>,

    /// Columns under other names, for each log: `t=time,q1=J1,tau1=Torque_1`.
    #[arg(long, value_name = "CHANNEL=COLUMN,…")]
    map: Vec<String>,

    /// No notes and no progress on standard error.
    #[arg(long, short)]
    quiet: bool,
}

pub(super) fn run(args: &InjectArgs) -> anyhow::Result<ExitCode> {
    let (robots, logs, maps) = (args.robot.len(), args.log.len(), args.map.len());
    if robots != logs {
        bail!("--robot is given {robots} times, --log {logs} times: give one log for each robot");
    }
    if maps != 0 && maps != logs {
        bail!("--map is given {maps} times, --log {logs} times: give one for each log, or none");
    }
    let inputs = args.log.iter().map(PathBuf::as_path).chain(args.robot.iter().map(Path::new));
    output::refuse_inputs(&[("--out", Some(&args.out))], inputs)?;
    let arms: anyhow::Result<Vec<Arm>> = (0..logs).map(|k| arm(args, k)).collect();
    let cases = Cases::new(arms?, args.seed)?;
    write_cases(&args.out, args.count, args.quiet, |number| Ok(cases.case(number)?))
}

/// The robot with a number, from 0, and its log.
fn arm(args: &InjectArgs, k: usize) -> anyhow::Result<Arm> {
    let bare = effects::load(&args.robot[k])?;
    let map = ColumnMap::parse(args.map.get(k).map_or("", String::as_str))?;
    let read = logs::read(&args.log[k], &map)?;
    logs::check_joints(&read.shown, &read.log, &bare)?;
    Arm::new(&bare, &read.log).context(read.shown)
}
