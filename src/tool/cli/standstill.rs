//! `joulepath standstill`: the cost of standing still.

use std::process::ExitCode;

use anyhow::bail;
use clap::Args;

use super::common::{self, Format, ProgramArgs};
use super::{load, signals};
use crate::arm::kinematics::limits_ok;
use crate::arm::robot::{Model, Use, ready};
use crate::retime::motion;
use crate::retime::optimize::idle::dwells;
use crate::retime::optimize::standstill::{Plausible, standing};
use crate::tool::report::json::assumed;
use crate::tool::report::place::Places;
use crate::tool::report::standstill::{self, Pose};
use crate::tool::report::text;
use crate::tool::retrofit::read_program;

/// Holding power at rest, when a brake pays, and the cheapest pose nearby.
#[derive(Debug, Args)]
#[command(
    mut_arg("paths", |paths| paths.required(false)),
    after_help = "Examples: joulepath standstill --robot IRB1600-10/1.45 --pose \"0,90,-90,0,0,0\"\n          joulepath standstill fixtures/pick_place"
)]
pub(super) struct StandstillArgs {
    #[command(flatten)]
    program: ProgramArgs,

    /// A pose, axes in degrees; may be repeated. Without it the dwells of
    /// a program are looked at.
    #[arg(long, value_name = "DEG,…", allow_hyphen_values = true, conflicts_with = "paths")]
    pose: Vec<String>,

    /// What the flange carries at the poses: KG, KG,X,Y,Z (mm) or a loaddata of RAPID.
    #[arg(long, value_name = "LOAD", requires = "pose", allow_hyphen_values = true)]
    load: Option<String>,

    /// How far each joint may go to a better pose, degrees.
    #[arg(long, value_name = "DEG", default_value_t = 15.0)]
    within: f64,
}

pub(super) fn run(args: &StandstillArgs) -> anyhow::Result<ExitCode> {
    if !(args.within.is_finite() && args.within >= 0.0) {
        bail!("--within {}: give a distance of 0 degrees or more", args.within);
    }
    if args.pose.is_empty() && args.program.cell.paths.is_empty() {
        bail!("nothing to look at: give poses with --pose DEG,…, or the PATH of a program");
    }
    let distance = args.within.to_radians();
    let (model, poses, assumed) = if args.pose.is_empty() {
        dwells_of_program(args, distance)?
    } else {
        given_poses(args, distance)?
    };
    if model.brakes.is_none() {
        let text = format!("{} has no [brakes]: nothing is said of when they pay", model.name);
        common::note(args.program.cell.quiet, &text);
    }
    if args.program.format == Format::Text {
        common::notes(args.program.cell.quiet, &assumed);
    }
    common::print(
        args.program.format,
        || standstill::json(&model, &poses, &assumed),
        || standstill::text(&poses),
    )
}

fn given_poses(
    args: &StandstillArgs,
    distance: f64,
) -> anyhow::Result<(Model, Vec<Pose>, Vec<String>)> {
    let model = common::robot(&args.program.cell)?;
    ready(&model, Use::Standstill)?;
    let load = load::from_option(args.load.as_deref())?;
    let plausible = plausible(args, &model);
    let mut poses = Vec::new();
    for text in &args.pose {
        let q = common::six_degrees("--pose", text)?;
        if let Err(violation) = limits_ok(&model, &q) {
            bail!("--pose {text}: {violation}");
        }
        let standing = standing(&model, plausible.as_ref(), &load, &q, distance);
        poses.push(Pose { standing, dwell: None });
    }
    let assumed = model.assumed();
    Ok((model, poses, assumed))
}

fn dwells_of_program(
    args: &StandstillArgs,
    distance: f64,
) -> anyhow::Result<(Model, Vec<Pose>, Vec<String>)> {
    let job = common::prepare(&args.program)?;
    signals::check_job(&args.program.cell, &job)?;
    ready(&job.model, Use::Standstill)?;
    let (program, entry) = read_program(&job.files, &job.entry)?;
    let simulation = motion::simulate(&program, entry, &job.model, &job.options);
    let sources = job.sources();
    let places = Places::new(&sources);
    common::notes(args.program.cell.quiet, text::notes(&job.model, places, &simulation));
    let plausible = plausible(args, &job.model);
    let poses = dwells(&job.model, &simulation)
        .iter()
        .map(|dwell| Pose {
            standing: standing(&job.model, plausible.as_ref(), &dwell.load, &dwell.q, distance),
            dwell: Some((places.of(dwell.span), dwell.duration)),
        })
        .collect();
    let assumed = assumed(&job.model, &simulation);
    Ok((job.model, poses, assumed))
}

fn plausible(args: &StandstillArgs, model: &Model) -> Option<Plausible> {
    if args.program.point_estimate { None } else { Plausible::new(model) }
}
