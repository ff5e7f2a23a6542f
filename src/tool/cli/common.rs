//! Options that several commands share.

use std::collections::BTreeMap;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressDrawTarget};
use serde_json::Value;

use super::backup::motion_configuration;
use super::choice::{self, Choice};
use super::input::{self, Input, InputFile, Unreadable};
use super::streams::Streams;
use crate::arm::effects;
use crate::arm::kinematics::limits_ok;
use crate::arm::robot::{self, Model};
use crate::rapid::text::{self, FileId, SourceFile, is_encoded_module};
use crate::retime::motion::{Options, Simulation};
use crate::tool::config::{self, Config};
use crate::tool::retrofit::{Cell, Source};

/// Message for robots with another number of joints.
pub(super) const RUN_SIX_JOINTS: &str =
    "RAPID programs are run for robots with 6: name another with --robot";

/// A program, its robot, and what is known of its cell.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct CellArgs {
    /// Module files, folders, .pgf programs or controller backups.
    #[arg(required = true)]
    pub(super) paths: Vec<PathBuf>,

    /// The robot: a name (joulepath robots list) or a robot file.
    #[arg(long, value_name = "NAME|FILE")]
    pub(super) robot: Option<String>,

    /// Configuration; otherwise the nearest joulepath.toml above the program.
    #[arg(long, value_name = "FILE")]
    pub(super) config: Option<PathBuf>,

    /// The procedure that starts the program.
    #[arg(long)]
    pub(super) entry: Option<String>,

    /// Where the robot stands at first, axes in degrees.
    #[arg(long, value_name = "DEG,…", allow_hyphen_values = true)]
    pub(super) start: Option<String>,

    /// When an input comes, such as diPart=2.5 (s after the start or the last wait for it).
    #[arg(long = "input", value_name = "SIGNAL=SECONDS")]
    pub(super) inputs: Vec<String>,

    /// The level of an input that the program asks for, such as di1=1; otherwise 0. The answer of an
    /// operator, such as nCount=3.
    #[arg(long = "assume", value_name = "SIGNAL=LEVEL")]
    pub(super) levels: Vec<String>,

    /// No notes on standard error.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

/// Options of commands that run a program.
#[derive(Debug, Default, Args)]
pub(super) struct ProgramArgs {
    /// What is run, and where.
    #[command(flatten)]
    pub(super) cell: CellArgs,

    /// Override of all speeds in %, as on the operator's panel.
    #[arg(long = "speed-override", value_name = "PERCENT", allow_negative_numbers = true)]
    pub(super) speed_override: Option<f64>,

    /// Take the robot's estimated numbers as they are, without plausible others and their intervals.
    #[arg(long = "point-estimate")]
    pub(super) point_estimate: bool,

    /// How often the loop that never ends runs.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) passes: Option<u32>,

    /// End the simulation after this time, s.
    #[arg(long = "max-time", value_name = "SECONDS", allow_negative_numbers = true)]
    pub(super) max_time: Option<f64>,

    /// How the result is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(super) format: Format,
}

/// Forms of a result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// For people.
    #[default]
    Text,
    /// For programs.
    Json,
}

/// A program ready to run.
pub(super) struct Job {
    /// All files that were read.
    pub(super) input: Input,
    /// The files of the program; their ids count from 0.
    pub(super) files: Vec<Source>,
    /// The existing streams of the program, if they are replaced.
    pub(super) streams: Streams,
    /// The robot.
    pub(super) model: Model,
    /// The configuration.
    pub(super) config: Config,
    /// The routine that starts the program.
    pub(super) entry: String,
    /// Options of the simulation.
    pub(super) options: Options,
    /// The inputs of the options, as the user wrote them.
    pub(super) inputs: Vec<String>,
    /// The files and folders that were named, and the configuration file.
    pub(super) named: Vec<PathBuf>,
}

impl Job {
    /// Whether existing streams of the program are replaced.
    pub(super) fn is_refreshed(&self) -> bool {
        !self.streams.modules.is_empty()
    }

    /// The program and its robot.
    pub(super) fn cell(&self) -> Cell<'_> {
        Cell { files: &self.files, entry: &self.entry, model: &self.model, options: &self.options }
    }

    /// The files that were read: modules, the files of the robot and of the configuration.
    pub(super) fn read_paths(&self) -> impl Iterator<Item = &Path> {
        let modules = self.input.files.iter().map(|file| file.source.path.as_str());
        let files = modules.chain(self.model.file.as_deref()).map(Path::new);
        files.chain(self.named.iter().map(PathBuf::as_path))
    }

    /// The files that belong to other tasks.
    pub(super) fn others(&self) -> impl Iterator<Item = &SourceFile> {
        let is_own = |path: &str| self.files.iter().any(|own| own.file.path == path);
        let all = self.input.files.iter().map(|file| &file.source);
        all.filter(move |source| !is_own(&source.path))
    }

    /// The source files for reports.
    pub(super) fn sources(&self) -> Vec<SourceFile> {
        self.files.iter().map(|source| source.file.clone()).collect()
    }

    /// Notes on given inputs for which the simulated cycle does not wait.
    pub(super) fn unused_inputs(&self, simulation: &Simulation) -> Vec<String> {
        let asked = &simulation.inputs_asked;
        let unused = self.inputs.iter().filter(|name| !asked.contains(&name.to_lowercase()));
        unused
            .map(|name| {
                let known = asked.iter().map(String::as_str);
                let meant = robot::nearest(name, known)
                    .map_or_else(String::new, |near| format!("; did you mean {near}?"));
                format!("the cycle does not wait for the input {name}: its time is not used{meant}")
            })
            .collect()
    }
}

/// Reads program, configuration and robot.
pub(super) fn prepare(program: &ProgramArgs) -> anyhow::Result<Job> {
    prepare_read(program, input::read(&program.cell.paths)?)
}

/// Prepares a program that was read.
pub(super) fn prepare_read(program: &ProgramArgs, input: Input) -> anyhow::Result<Job> {
    let args = &program.cell;
    note_unreadable(args.quiet, &input);
    let choice = choice::choose(&input)?;
    notes(args.quiet, &choice.notes);
    for file in choice.files.iter().filter(|file| is_encoded_module(&file.source.bytes)) {
        let path = &file.source.path;
        note(args.quiet, &format!("'{path}' is an encoded module: what it declares is not known"));
    }
    let (config, folder) = configuration(args)?;
    let of_task = choice.task.and_then(|task| task.robot.as_deref());
    let name = robot_name(args, &config, &folder).or_else(|| of_task.map(str::to_owned));
    let name = name.with_context(robot_needed)?;
    let of_backup = args.robot.is_none() && config.robot.is_none();
    let model = effects::load_estimated(&name).map_err(|error| {
        if of_backup {
            anyhow::anyhow!("the robot of the backup is a {name}: {error}; name yours with --robot")
        } else {
            error.into()
        }
    })?;
    let model = match choice.backup.filter(|_| of_backup) {
        Some(backup) => with_backup_configuration(backup, model, args.quiet),
        None => model,
    };
    if of_backup {
        note(args.quiet, &format!("the robot is {}, as the backup says ({name})", model.name));
    }
    require_six_joints(&model, RUN_SIX_JOINTS)?;
    let of_task = choice.task.and_then(|task| task.entry.clone());
    let entry = args.entry.clone().or_else(|| config.entry.clone()).or(of_task);
    let entry = entry.unwrap_or_else(|| "main".into());
    let (options, inputs) = simulation_options(args, &config, Some(&model))?;
    let options = with_overrides(program, options)?;
    let files = sources(&choice);
    let streams = Streams::default();
    let named = named_paths(args);
    Ok(Job { input, files, streams, model, config, entry, options, inputs, named })
}

/// The files of the program.
pub(super) fn sources(choice: &Choice<'_>) -> Vec<Source> {
    let source = |(index, file): (usize, &&InputFile)| Source {
        file: SourceFile { id: FileId(index as u32), ..file.source.clone() },
        relative: file.relative.clone(),
    };
    choice.files.iter().enumerate().map(source).collect()
}

/// The options of the simulation, and the inputs with stated times as the user wrote them.
pub(super) fn simulation_options(
    args: &CellArgs,
    config: &Config,
    model: Option<&Model>,
) -> anyhow::Result<(Options, Vec<String>)> {
    let mut times: Vec<(String, f64)> =
        config.inputs.iter().map(|(name, t)| (name.clone(), *t)).collect();
    for text in &args.inputs {
        let (name, seconds) = input_time(text)?;
        times.retain(|(known, _)| known.to_lowercase() != name.to_lowercase());
        times.push((name, seconds));
    }
    if let Some((name, t)) = times.iter().find(|(_, t)| !(t.is_finite() && *t >= 0.0)) {
        bail!("the input {name} comes after {t} s; give a time of 0 or more");
    }
    let mut levels = config.assume.clone();
    let mut stated = BTreeMap::new();
    for text in &args.levels {
        let (name, level) = input_level(text)?;
        let key = name.to_lowercase();
        if stated.insert(key.clone(), level).is_some_and(|before| before != level) {
            bail!("--assume states two levels of {name}; give one");
        }
        levels.retain(|known, _| known.to_lowercase() != key);
        levels.insert(name, level);
    }
    let options = Options {
        levels: levels.iter().map(|(name, level)| (name.to_lowercase(), *level)).collect(),
        start: args.start.as_deref().map(|text| start(model, text)).transpose()?,
        inputs: times.iter().map(|(name, t)| (name.to_lowercase(), *t)).collect(),
        ..Options::default()
    };
    let inputs = times.into_iter().map(|(name, _)| name).collect();
    Ok((options, inputs))
}

/// Adds speed override, passes and maximum time to the options.
pub(super) fn with_overrides(args: &ProgramArgs, options: Options) -> anyhow::Result<Options> {
    if let Some(percent) = args.speed_override.filter(|x| !(*x > 0.0 && *x <= 100.0)) {
        bail!("--speed-override {percent}: give a percentage above 0 and up to 100");
    }
    if let Some(limit) = args.max_time.filter(|t| !(t.is_finite() && *t > 0.0)) {
        bail!("--max-time {limit}: give a time in seconds above 0");
    }
    Ok(Options {
        speed_override: args.speed_override.map(|percent| percent / 100.0),
        passes: args.passes,
        max_time: args.max_time,
        ..options
    })
}

/// The robot with the configuration of its backup: ranges, base frame, arm loads.
pub(super) fn with_backup_configuration(backup: &Path, model: Model, quiet: bool) -> Model {
    let Some(path) = motion_configuration(backup) else { return model };
    let shown = path.display().to_string();
    let configured =
        fs::read(&path).map_err(|error| format!("{shown}: {error}")).and_then(|bytes| {
            let text = robot::import_moc(&shown, &text::decode(&bytes).text, None);
            let model = text.and_then(|text| robot::from_toml(&shown, &text));
            model.map_err(|error| error.to_string())
        });
    configured.unwrap_or_else(|why| {
        note(quiet, &format!("the robot is used as it comes, not as set up: {why}"));
        model
    })
}

/// The robot from options and configuration, for commands without a program.
pub(super) fn robot(args: &CellArgs) -> anyhow::Result<Model> {
    let (config, folder) = configuration(args)?;
    Ok(effects::load_estimated(&robot_name(args, &config, &folder).with_context(robot_needed)?)?)
}

/// The robot that options or configuration name.
pub(super) fn robot_name(args: &CellArgs, config: &Config, folder: &Path) -> Option<String> {
    let configured = || {
        let name = config.robot.as_ref()?;
        let beside = folder.join(name);
        Some(if beside.is_file() { beside.to_string_lossy().into_owned() } else { name.clone() })
    };
    args.robot.clone().or_else(configured)
}

fn robot_needed() -> String {
    format!(
        "which robot? name it with --robot NAME (joulepath robots list shows the known ones), \
         --robot FILE.toml, or robot = \"…\" in {}",
        config::FILE_NAME
    )
}

/// The configuration, and its folder.
pub(super) fn configuration(args: &CellArgs) -> anyhow::Result<(Config, PathBuf)> {
    let Some(path) = configuration_path(args) else {
        return Ok((Config::default(), PathBuf::new()));
    };
    let shown = path.to_string_lossy().into_owned();
    let text = fs::read_to_string(&path).map_err(|error| config::ConfigError::Unreadable {
        path: shown.clone(),
        reason: error.to_string(),
    })?;
    let folder = path.parent().map_or_else(PathBuf::new, Path::to_path_buf);
    Ok((config::parse(&shown, &text)?, folder))
}

/// The configuration file that is named, else the nearest one.
fn configuration_path(args: &CellArgs) -> Option<PathBuf> {
    if args.config.is_some() {
        return args.config.clone();
    }
    let first = args.paths.first()?;
    let absolute = fs::canonicalize(first).unwrap_or_else(|_| first.clone());
    config::candidates(&absolute).into_iter().find(|path| path.is_file())
}

/// The files and folders that are named, and the configuration file.
pub(super) fn named_paths(args: &CellArgs) -> Vec<PathBuf> {
    args.paths.iter().cloned().chain(configuration_path(args)).collect()
}

/// The initial joint positions \[rad\].
fn start(model: Option<&Model>, text: &str) -> anyhow::Result<[f64; 6]> {
    let q = six_degrees("--start", text)?;
    if let Some(model) = model
        && let Err(error) = limits_ok(model, &q)
    {
        bail!("--start {text}: {error}; give a position that {} can have", model.name);
    }
    Ok(q)
}

fn input_level(text: &str) -> anyhow::Result<(String, f64)> {
    let wrong = || format!("--assume {text}: write it as SIGNAL=LEVEL, such as di1=1");
    let (name, level) = text.split_once('=').with_context(wrong)?;
    let level: f64 = level.trim().parse().map_err(|_| anyhow::anyhow!(wrong()))?;
    if !level.is_finite() {
        bail!(wrong());
    }
    Ok((name.trim().to_owned(), level))
}

fn input_time(text: &str) -> anyhow::Result<(String, f64)> {
    let wrong = || format!("--input {text}: write it as SIGNAL=SECONDS, such as diPart=2.5");
    let (name, seconds) = text.split_once('=').with_context(wrong)?;
    let seconds = seconds.trim().trim_end_matches('s').trim();
    let seconds: f64 = seconds.parse().map_err(|_| anyhow::anyhow!(wrong()))?;
    Ok((name.trim().to_owned(), seconds))
}

/// Six axis positions \[rad\] from an option in degrees.
pub(super) fn six_degrees(option: &str, text: &str) -> anyhow::Result<[f64; 6]> {
    let help = "six axis positions in degrees, such as 0,-12,14,0,90,0";
    let degrees = numbers(option, text, f64::INFINITY, help)?;
    Ok(degrees.map(f64::to_radians))
}

/// Numbers of an option, separated by commas, each less than `most`; `help` ends the message.
pub(super) fn numbers<const N: usize>(
    option: &str,
    text: &str,
    most: f64,
    help: &str,
) -> anyhow::Result<[f64; N]> {
    let wrong = || format!("{option} {text}: give {help}");
    let values: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    let values = values.ok().filter(|x| x.iter().all(|x: &f64| x.abs() < most));
    values.and_then(|x| <[f64; N]>::try_from(x).ok()).with_context(wrong)
}

/// Refuses a robot without exactly six joints; `way_out` ends the message.
pub(super) fn require_six_joints(model: &Model, way_out: &str) -> anyhow::Result<()> {
    if model.dof != 6 {
        bail!("{} has {} joints; {way_out}", model.name, model.dof);
    }
    Ok(())
}

/// A progress bar on standard error; a spinner without `length`.
pub(super) fn progress(quiet: bool, length: Option<u64>) -> ProgressBar {
    let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    ProgressBar::with_draw_target(length, target)
}

/// Prints a result on standard output; the exit code is that of a success.
pub(super) fn print(
    format: Format,
    json: impl FnOnce() -> Value,
    text: impl FnOnce() -> String,
) -> anyhow::Result<ExitCode> {
    let mut out = std::io::stdout().lock();
    match format {
        Format::Json => writeln!(out, "{:#}", json())?,
        Format::Text => out.write_all(text().as_bytes())?,
    }
    Ok(ExitCode::SUCCESS)
}

/// Notes on files that could not be read.
pub(super) fn note_unreadable(quiet: bool, input: &Input) {
    let skipped = |it: &Unreadable| format!("skipped '{}': {}", it.path, it.reason);
    notes(quiet, input.unreadable.iter().map(skipped));
}

/// Notes on standard error, unless `quiet`.
pub(super) fn notes(quiet: bool, texts: impl IntoIterator<Item = impl AsRef<str>>) {
    for text in texts {
        note(quiet, text.as_ref());
    }
}

/// A note on standard error unless it is among `known`, to which it is added.
pub(super) fn note_once(quiet: bool, known: &mut Vec<String>, text: String) {
    if !known.contains(&text) {
        note(quiet, &text);
        known.push(text);
    }
}

/// A note on standard error, unless `quiet`.
pub(super) fn note(quiet: bool, text: &str) {
    if !quiet {
        writeln!(std::io::stderr(), "note: {text}").unwrap_or_default();
    }
}

/// Hours in which a cell works in a year, unless the user says otherwise: two shifts.
const HOURS_PER_YEAR: f64 = 4000.0;
/// Hours of a leap year.
const HOURS_OF_A_YEAR: f64 = 8784.0;

/// The stated hours of a year, or the usual ones.
pub(super) fn hours_per_year(stated: Option<f64>) -> anyhow::Result<f64> {
    let hours = stated.unwrap_or(HOURS_PER_YEAR);
    if !(hours > 0.0 && hours <= HOURS_OF_A_YEAR) {
        bail!(
            "{hours} hours a year (--hours or hours_per_year): give hours above 0, at most \
             {HOURS_OF_A_YEAR}"
        );
    }
    Ok(hours)
}
