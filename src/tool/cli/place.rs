//! `joulepath place`: where frames should stand.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::bail;
use clap::Args;

use super::common::{self, Format, Job, ProgramArgs};
use super::keep_outs::keep_outs;
use super::program_output::{refuse_nested_output, whole_backup, write_folder};
use super::{output, signals};
use crate::arm::robot::{Model, Use, ready};
use crate::tool::place::{Bounds, Found, Goal, Placed, place};
use crate::tool::report::html::place_report;
use crate::tool::report::placement::{self, Placements};
use crate::tool::retrofit::{OutputFile, OutputKind};

/// Find where work objects, the base or the tool's mounting should be: the same work with less energy.
#[derive(Debug, Args)]
#[command(
    after_help = "Every candidate that is shown was simulated as a whole: its targets are in reach in \
    their taught configuration, lines keep their distance from singularities, arm and tool stay out of \
    the keep-outs of joulepath.toml, and the cycle takes no longer than today. Only those keep-outs are \
    known to stand in the way.\n\n\
    Example: joulepath place fixtures/pick_place --move wobjMc:x=-200..200,y=-200..200,z=-100..100"
)]
pub(super) struct PlaceArgs {
    #[command(flatten)]
    program: ProgramArgs,

    /// Which frames may move, and how far: mm and degrees in the world frame, such as
    /// wobjMc:x=-200..200,rz=-30..30. NAME is a wobjdata, a tooldata (rz: its angle on the flange) or
    /// base; NAME+NAME moves them together, turning about the first one. May be repeated.
    #[arg(
        long = "move",
        value_name = "NAME:AXIS=LOW..HIGH,…",
        required = true,
        allow_hyphen_values = true
    )]
    moves: Vec<String>,

    /// Number of candidates over the whole range.
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = clap::value_parser!(u32).range(10..=1_000_000))]
    candidates: u32,

    /// Which of the best placements is written, from 1.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
    choose: u16,

    /// Write the complete program with the chosen placement into this folder; where the base moves,
    /// the robot's file, too.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Write all accepted placements as CSV.
    #[arg(long, value_name = "FILE.csv")]
    csv: Option<PathBuf>,

    /// Write a report as one HTML file, with a map.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
}

/// The file of a robot that stands elsewhere.
const ROBOT_FILE: &str = "robot.toml";

pub(super) fn run(args: &PlaceArgs) -> anyhow::Result<ExitCode> {
    let bounds: Vec<Bounds> =
        args.moves.iter().map(|text| Bounds::parse(text)).collect::<Result<_, _>>()?;
    let job = common::prepare(&args.program)?;
    signals::check_job(&args.program.cell, &job)?;
    ready(&job.model, Use::Optimize)?;
    output::refuse_inputs(
        &[("--csv", args.csv.as_ref()), ("--report", args.report.as_ref())],
        job.read_paths(),
    )?;
    let quiet = args.program.cell.quiet;
    let paths = args.program.cell.paths.as_slice();
    let backup = whole_backup(paths, &job.input);
    if let (Some(folder), None) = (&args.out, backup) {
        refuse_nested_output(folder, paths)?;
    }
    let obstacles = keep_outs(&job.config)?;
    let goal = Goal { candidates: args.candidates, point_estimate: args.program.point_estimate };
    let bar = common::progress(quiet, Some(u64::from(args.candidates)));
    let found = place(job.cell(), &obstacles, &bounds, goal, &|done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    });
    bar.finish_and_clear();
    let found = found?;
    let chosen = usize::from(args.choose);
    if chosen > found.best.len() && (args.out.is_some() || chosen > 1) && !found.best.is_empty() {
        bail!("--choose {chosen}: there are {} placements that save energy", found.best.len());
    }
    let notes = notes(&job, &found);
    common::notes(quiet, &notes);
    let of = Placements { robot: &job.model.name, bounds: &bounds, found: &found, chosen };
    let page = args.report.as_ref().map(|_| place_report(of, &job.entry, &notes)).transpose()?;
    let mut written = Vec::new();
    if let Some(folder) = &args.out {
        match found.best.get(chosen - 1) {
            Some(best) => {
                let outputs = outputs(&job, &best.placed)?;
                written.extend(write_folder(folder, (&job.files, &[]), &outputs, backup)?);
            }
            None => common::note(quiet, "nothing is written: no placement saves energy"),
        }
    }
    if let Some(path) = &args.csv {
        output::write(path, placement::csv(of).as_bytes())?;
        written.push(path.display().to_string());
    }
    if let (Some(path), Some(page)) = (&args.report, page) {
        output::write(path, page.as_bytes())?;
        written.push(path.display().to_string());
    }
    if args.program.format == Format::Text {
        common::notes(quiet, written.iter().map(|path| format!("wrote {path}")));
    }
    common::print(
        args.program.format,
        || placement::json(of, &written, &notes),
        || placement::text(of),
    )
}

fn notes(job: &Job, found: &Found) -> Vec<String> {
    let mut notes = Vec::new();
    if job.config.keep_out.is_empty() {
        notes.push(
            "no keep_out is stated in joulepath.toml: nothing is known to stand in the way of arm \
             and tool"
                .to_owned(),
        );
    }
    let clearance_m = found.today.room.clearance_m;
    if clearance_m < 0.0 {
        notes.push(format!(
            "today's program may enter a keep-out by {:.0} mm: candidates are accepted that enter it by no more",
            -1e3 * clearance_m
        ));
    }
    if found.accepted.is_empty() {
        notes.push(
            "no candidate was accepted: allow smaller shifts, other frames, or more time"
                .to_owned(),
        );
    }
    notes
}

/// The files of a placed program.
fn outputs(job: &Job, placed: &Placed) -> anyhow::Result<Vec<OutputFile>> {
    let files = job.files.iter().zip(&placed.files).enumerate();
    let files = files.map(|(index, (before, after))| OutputFile {
        path: before.relative.clone(),
        kind: if before.file.bytes == after.file.bytes {
            OutputKind::Unchanged
        } else {
            OutputKind::Changed
        },
        bytes: after.file.bytes.clone(),
        input: Some(index),
    });
    let mut outputs: Vec<OutputFile> = files.collect();
    if placed.model.kinematics.base != job.model.kinematics.base {
        if outputs.iter().any(|file| file.path == ROBOT_FILE) {
            bail!("the program has a file {ROBOT_FILE}, which the robot's file would replace");
        }
        outputs.push(OutputFile {
            path: ROBOT_FILE.to_owned(),
            kind: OutputKind::New,
            bytes: robot_file(&placed.model)?.into_bytes(),
            input: None,
        });
    }
    Ok(outputs)
}

/// A robot file with another base.
fn robot_file(model: &Model) -> anyhow::Result<String> {
    let extends = match &model.file {
        Some(file) => Path::new(file).canonicalize()?.display().to_string(),
        None => model.name.clone(),
    };
    let base = model.kinematics.base;
    let (roll, pitch, yaw) = base.rotation.euler_angles();
    let origin = base.translation.vector;
    // Without negative zeros.
    let [roll, pitch, yaw] = [roll, pitch, yaw].map(|angle| angle + 0.0);
    let mut text = String::from("# The robot where joulepath place puts its base.\n");
    let _ = writeln!(text, "extends = {}", toml::Value::String(extends));
    let _ = writeln!(
        text,
        "\n[kinematics.base]\norigin = [{:?}, {:?}, {:?}]\nrpy = [{roll:?}, {pitch:?}, {yaw:?}]",
        origin.x, origin.y, origin.z
    );
    Ok(text)
}
