//! `joulepath optimize`: retrofits a program.

use std::io::IsTerminal;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::bail;
use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};

use super::common::{self, Format, Job, ProgramArgs};
use super::keep_outs::keep_outs;
use super::program_output::{
    diff, refuse_nested_output, whole_backup, write_folder, write_in_place,
};
use super::{backinfo, input, listing, output, signals, slack, streams, suggest, undo};
use crate::retime::optimize::cost::Cost;
use crate::retime::optimize::freedom::{Bound, Freedom};
use crate::retime::optimize::resting::IdleState;
use crate::retime::optimize::retime::SLOWEST;
use crate::tool::cell::slack::Planned;
use crate::tool::config::{Config, Idle};
use crate::tool::emit::Layout;
use crate::tool::report::{self, place::Places};
use crate::tool::retrofit::{
    Budget, CLOSEST_S, Form, Objective, SPACING_S, Settings, declared_in, freed, is_streams,
    retrofit, written_in,
};
use crate::tool::suggest::Applied;

/// Retrofit a program: the same work with less energy in no more time.
#[derive(Debug, Default, Args)]
#[command(
    after_help = "Example: joulepath optimize fixtures/pick_place --robot IRB1600-10/1.45 --out optimized"
)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the command line")]
pub(super) struct OptimizeArgs {
    #[command(flatten)]
    pub(super) program: ProgramArgs,

    /// Write the complete program into this folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Print the changes as a unified diff.
    #[arg(long)]
    diff: bool,

    /// Change the files themselves. The originals go to a folder beside that of the program (of a
    /// backup: beside the backup), with `.joulepath-undo` appended to its name.
    #[arg(long)]
    in_place: bool,

    /// Take back what --in-place did to the program at this path: restore the files that it
    /// changed, delete those that it added, and remove the folder with the originals.
    #[arg(long, conflicts_with_all = ["in_place", "out", "diff", "report"])]
    undo: bool,

    /// Write a report as one HTML file.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,

    /// What is minimised.
    #[arg(long, value_enum, default_value_t = ObjectiveArg::Energy)]
    objective: ObjectiveArg,

    /// The cost function on each path. Joules, bounds and the sharing of time stay electrical.
    #[arg(long, value_enum, default_value_t = EnergyArg::Electrical)]
    energy: EnergyArg,

    /// Add the curves of least energy over time of the cycle and of each segment (so many points), and
    /// the saving over --spacing, to the JSON and the report.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=200), hide_default_value = true)]
    pareto: u16,

    /// Time for the cycle, s; otherwise no run takes longer than before.
    #[arg(
        long,
        value_name = "SECONDS",
        conflicts_with = "time_factor",
        allow_negative_numbers = true
    )]
    takt: Option<f64>,

    /// Each run takes this many times as long as before, at most 10.
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    time_factor: Option<f64>,

    /// Least time between two points of a stream, s (0.05; 0.04 where the straight ways between them
    /// would leave the path too far).
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    spacing: Option<f64>,

    /// What is written.
    #[arg(long, value_enum, default_value_t = EmitArg::Absj)]
    emit: EmitArg,

    /// How the points of streams are written.
    #[arg(long, value_enum, default_value_t = LayoutArg::Auto)]
    layout: LayoutArg,

    /// Let lines and arcs be faster than programmed.
    #[arg(long)]
    allow_faster_tcp: bool,

    /// Let joints, and the tool in joint movements, be faster than in the original movements.
    #[arg(long)]
    allow_faster_joints: bool,

    /// Rewrite movements whose target stands in the movement itself: nobody may change such a target
    /// by `ModPos` afterwards, because no guard sees it.
    #[arg(long)]
    inline_targets: bool,

    /// No task that is not given reads the PERS data of this program: a run may then go on behind a
    /// statement that writes such data. A whole backup has all tasks.
    #[arg(long)]
    only_task: bool,

    /// Let joint movements leave their path, and lines and arcs whose statement has the comment
    /// `! joulepath: free` on its line.
    #[arg(long)]
    free_path: bool,

    /// How far a free movement may leave its path, mm.
    #[arg(long, value_name = "MM", requires = "free_path", allow_negative_numbers = true)]
    deviation: Option<f64>,

    /// Spend waits of stated length at a pose nearby where holding takes less, no joint farther
    /// away than this, degrees. A wait after an output of the same place stays, unless its line
    /// has the comment `! joulepath: free`. Only the keep-outs of joulepath.toml are known to
    /// stand in the way.
    #[arg(
        long,
        value_name = "DEG",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "15"
    )]
    dwell_pose: Option<f64>,

    /// List changes that a person has to approve, each simulated in the whole cycle: zones, joint
    /// movements for lines, heights, speeds, points on the way. Nothing is written.
    #[arg(long, conflicts_with_all = ["out", "diff", "in_place", "report", "apply"])]
    suggest: bool,

    /// Make these suggestions (their numbers, or all) before the retrofit, as far as each saves energy
    /// beside the others and the cycle takes no longer.
    #[arg(long, value_name = "N,…|all")]
    apply: Option<String>,

    /// Use up the slack of recorded waits (joulepath waits), between the event from which the machine's
    /// time counts and the wait.
    #[arg(long, value_name = "waits.toml")]
    waits: Option<PathBuf>,

    /// Share of cycles that may become longer by that.
    #[arg(long, value_name = "SHARE", requires = "waits", default_value = slack::RISK)]
    risk: String,

    /// Exit with 1 if some movement was refused.
    #[arg(long)]
    strict: bool,
}

/// What is minimised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum ObjectiveArg {
    /// Energy in the time that there is.
    #[default]
    Energy,
    /// Time.
    Time,
}

/// What is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum EmitArg {
    /// Streams of joint targets in place of movements.
    #[default]
    Absj,
    /// The movements with other speeds; lines and arcs not faster than programmed.
    Retime,
    /// The program as it is, and positions for externally guided motion in the folder egm.
    Egm,
}

/// How the points of streams are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum LayoutArg {
    /// An instruction for each point.
    Plain,
    /// Constant arrays and a loop.
    Array,
    /// Arrays for long streams.
    #[default]
    Auto,
}

/// The cost function.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum EnergyArg {
    /// What the robot takes from the grid.
    #[default]
    Electrical,
    /// The same with all braking energy lost.
    ElectricalNoRegeneration,
    /// Mechanical work, as if braking gave everything back.
    Mechanical,
    /// Squares of the joint speeds.
    Velocity,
    /// Squares of the joint torques.
    Torque,
}

/// Minimum spacing, s.
const LEAST_SPACING_S: f64 = 0.004;
/// Maximum spacing, s.
const LARGEST_SPACING_S: f64 = 1.0;

/// Default deviation of a free movement from its path, mm.
const DEVIATION_MM: f64 = 50.0;
/// Maximum deviation, mm.
const LARGEST_DEVIATION_MM: f64 = 1000.0;

/// Maximum joint displacement to a waiting pose, degrees.
const LARGEST_DWELL_POSE_DEG: f64 = 90.0;

pub(super) fn run(args: &OptimizeArgs) -> anyhow::Result<ExitCode> {
    if args.undo {
        return undo_in_place(args);
    }
    let mut job = common::prepare(&args.program)?;
    signals::check_job(&args.program.cell, &job)?;
    let slack = args.waits.as_ref().map(|path| slack::use_waits(&mut job, path, &args.risk));
    let slack = slack.transpose()?;
    if args.suggest {
        return suggest::list(&args.program, &job);
    }
    let numbers = args.apply.as_ref();
    let applied =
        numbers.map(|numbers| suggest::apply(&args.program, &job, numbers)).transpose()?;
    let extras = Extras { applied: applied.as_ref(), slack: slack.as_ref() };
    match &applied {
        None => optimize_job(args, &job, &job, extras),
        Some(applied) => {
            let (files, options) = (applied.files.clone(), job.options.clone());
            let changed = Job { files, options, ..common::prepare(&args.program)? };
            optimize_job(args, &changed, &job, extras)
        }
    }
}

/// What is done beside the retrofit.
#[derive(Clone, Copy, Default)]
struct Extras<'a> {
    applied: Option<&'a Applied>,
    slack: Option<&'a Planned>,
}

/// Optimises a program that already has streams and replaces these.
pub(super) fn refresh(args: &OptimizeArgs) -> anyhow::Result<ExitCode> {
    if args.undo {
        bail!("refresh cannot undo changes; use joulepath optimize --undo");
    }
    if args.suggest || args.apply.is_some() || args.waits.is_some() {
        bail!(
            "refresh changes streams alone; use joulepath optimize --suggest, --apply or --waits"
        );
    }
    let mut input = input::read(&args.program.cell.paths)?;
    let streams = streams::remove_streams(&mut input)?;
    let job = common::prepare_read(&args.program, input)?;
    let job = Job { streams, ..job };
    optimize_job(args, &job, &job, Extras::default())
}

/// Retrofits a program. `original`: the program as the files have it, before suggestions.
fn optimize_job(
    args: &OptimizeArgs,
    job: &Job,
    original: &Job,
    extras: Extras<'_>,
) -> anyhow::Result<ExitCode> {
    let settings = settings(args, job)?;
    output::refuse_inputs(&[("--report", args.report.as_ref())], job.read_paths())?;
    let quiet = args.program.cell.quiet;
    // The folder of a single task does not include the controller's module list.
    let paths = args.program.cell.paths.as_slice();
    let backup = whole_backup(paths, &job.input);
    if let (Some(folder), None) = (&args.out, backup) {
        refuse_nested_output(folder, paths)?;
    }
    let lists = backup.is_some() || (args.in_place && args.out.is_none());
    let result = {
        let bar = progress(quiet);
        let result = retrofit(&job.files, &job.model, &settings, &|done, all| {
            bar.set_length(all as u64);
            bar.set_position(done as u64);
        });
        bar.finish_and_clear();
        let mut result = result?;
        result.notes.extend(job.unused_inputs(&result.before.0));
        result.notes.extend(extras.slack.into_iter().flat_map(|it| it.notes.clone()));
        if job.files.iter().any(|source| is_streams(&source.file.bytes)) {
            result.notes.push(
                "the program has streams already, which stay as they are: joulepath refresh makes \
                 them anew from the data of today"
                    .to_owned(),
            );
        }
        job.streams.restore_stated_data(&mut result);
        result.notes.extend(listing::add(&mut result.outputs, &job.input, &job.files));
        if lists {
            result.notes.extend(backinfo::add(&mut result.outputs, &job.input));
        }
        result
    };
    common::notes(quiet, &result.notes);
    let sources = job.sources();
    let places = Places::new(&sources);
    let mut written = Vec::new();
    if let Some(folder) = &args.out {
        written.extend(write_folder(
            folder,
            (&original.files, &original.streams.modules),
            &result.outputs,
            backup,
        )?);
    }
    if args.in_place {
        written.extend(write_in_place(paths, original, &result)?);
    }
    if let Some(path) = &args.report {
        let html = report::html::optimize_report(&result, &job.files, &job.model, &job.entry)?;
        output::write(path, html.as_bytes())?;
        written.push(path.display().to_string());
    }
    if args.program.format == Format::Text {
        common::notes(quiet, report::text::notes(&job.model, places, &result.before.0));
        common::notes(quiet, written.iter().map(|path| format!("wrote {path}")));
    }
    common::print(
        args.program.format,
        || {
            let mut value =
                report::json::retrofit(&job.model, &job.entry, places, &result, &written);
            if let Some(applied) = extras.applied {
                value["applied"] = report::suggestions::applied_json(applied);
            }
            if let Some(planned) = extras.slack {
                value["waits"] = report::slack::json(&job.model, planned, &result);
            }
            value
        },
        || {
            if args.diff || job.is_refreshed() {
                diff(original, &result)
            } else {
                let slack = extras.slack.map(|it| report::slack::text(&job.model, it, &result));
                report::text::retrofit(&job.model, places, &result) + &slack.unwrap_or_default()
            }
        },
    )?;
    let refused = args.strict && result.refused();
    Ok(ExitCode::from(u8::from(refused)))
}

/// The settings of the retrofit.
pub(super) fn settings(args: &OptimizeArgs, job: &Job) -> anyhow::Result<Settings> {
    let positive = |value: f64, flag: &str| {
        if value.is_finite() && value > 0.0 {
            Ok(value)
        } else {
            bail!("{flag} {value}: give a positive number")
        }
    };
    let takt = args.takt.or(if args.time_factor.is_some() { None } else { job.config.takt_s });
    let budget = match (takt, args.time_factor) {
        (Some(takt), _) => Budget::Takt(positive(takt, "--takt")?),
        (None, Some(factor)) if factor > SLOWEST => {
            bail!("--time-factor {factor}: give at most {SLOWEST}; slower travel saves nothing")
        }
        (None, Some(factor)) => Budget::Factor(positive(factor, "--time-factor")?),
        (None, None) => Budget::AsBefore,
    };
    let asked = args.spacing.or(job.config.spacing_s);
    let spacing_s = spacing(asked)?;
    if args.dwell_pose.is_some() && args.emit != EmitArg::Absj {
        bail!("--dwell-pose needs streams: leave out --emit, or give --emit absj");
    }
    let has_all_tasks =
        args.only_task || whole_backup(&args.program.cell.paths, &job.input).is_some();
    Ok(Settings {
        entry: job.entry.clone(),
        options: job.options.clone(),
        objective: match args.objective {
            ObjectiveArg::Energy => Objective::Energy,
            ObjectiveArg::Time => Objective::Time,
        },
        budget,
        idle: idle_states(&job.config),
        spacing_s,
        closest_s: if asked.is_some() { spacing_s } else { CLOSEST_S },
        freedom: Freedom {
            tcp: bound(args.allow_faster_tcp),
            joints: bound(args.allow_faster_joints),
            loads: None,
            deviation: if args.free_path { deviation(args.deviation)? } else { 0.0 },
            freed: job.files.iter().flat_map(|source| freed(&source.file)).collect(),
            keep_out: keep_outs(&job.config)?,
        },
        only: None,
        inline_targets: args.inline_targets,
        form: match args.emit {
            EmitArg::Absj => Form::Streams,
            EmitArg::Retime => Form::Speeds,
            EmitArg::Egm => Form::Guided,
        },
        layout: match args.layout {
            LayoutArg::Plain => Layout::Plain,
            LayoutArg::Array => Layout::Array,
            LayoutArg::Auto => Layout::Auto,
        },
        cost: match args.energy {
            EnergyArg::Electrical => Cost::Electrical,
            EnergyArg::ElectricalNoRegeneration => Cost::ElectricalWithoutRegeneration,
            EnergyArg::Mechanical => Cost::Mechanical,
            EnergyArg::Velocity => Cost::Velocity,
            EnergyArg::Torque => Cost::Torque,
        },
        point_estimate: args.program.point_estimate,
        dwell_pose: args.dwell_pose.map(dwell_pose).transpose()?,
        pareto: usize::from(args.pareto),
        written_elsewhere: written_in(job.others()),
        read_elsewhere: has_all_tasks.then(|| declared_in(job.others())),
    })
}

/// The idle states of the configuration.
fn idle_states(config: &Config) -> Vec<IdleState> {
    let state = |(name, &Idle { power_w, wake_s, wake_j }): (&String, &Idle)| IdleState {
        name: name.clone(),
        power_w,
        wake_s,
        wake_j,
    };
    config.idle.iter().map(state).collect()
}

/// The bound of a speed that a flag may free.
fn bound(is_free: bool) -> Bound {
    if is_free { Bound::Robot } else { Bound::Original }
}

/// Maximum deviation of free movements from their path, m.
fn deviation(asked: Option<f64>) -> anyhow::Result<f64> {
    let mm = asked.unwrap_or(DEVIATION_MM);
    if !(mm > 0.0 && mm <= LARGEST_DEVIATION_MM) {
        bail!("--deviation {mm}: give more than 0 and at most {LARGEST_DEVIATION_MM} mm");
    }
    Ok(mm * 1e-3)
}

/// Maximum joint displacement to a waiting pose, rad.
fn dwell_pose(degrees: f64) -> anyhow::Result<f64> {
    if !(degrees > 0.0 && degrees <= LARGEST_DWELL_POSE_DEG) {
        bail!(
            "--dwell-pose {degrees}: give more than 0 and at most {LARGEST_DWELL_POSE_DEG} degrees"
        );
    }
    Ok(degrees.to_radians())
}

/// Minimum time between two points of a stream, s.
pub(super) fn spacing(asked: Option<f64>) -> anyhow::Result<f64> {
    let spacing_s = asked.unwrap_or(SPACING_S);
    if !(LEAST_SPACING_S..=LARGEST_SPACING_S).contains(&spacing_s) {
        bail!("--spacing {spacing_s}: give {LEAST_SPACING_S} to {LARGEST_SPACING_S} s");
    }
    Ok(spacing_s)
}

fn progress(quiet: bool) -> ProgressBar {
    if quiet || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(0);
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} runs {elapsed}") {
        bar.set_style(style);
    }
    bar
}

/// Undoes the changes of an earlier run in place.
fn undo_in_place(args: &OptimizeArgs) -> anyhow::Result<ExitCode> {
    let cell = &args.program.cell;
    let mut done = Vec::new();
    for path in &cell.paths {
        done.extend(undo::undo(path)?);
    }
    if args.program.format == Format::Text {
        common::notes(cell.quiet, &done);
    }
    common::print(args.program.format, || serde_json::json!({ "undone": done }), String::new)
}
