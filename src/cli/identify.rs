//! `joulepath identify`: a dynamic model from measured logs.

use std::fs::File;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::{Args, ValueEnum};
use sha2::{Digest, Sha256};

use super::{common, output};
use crate::cli::common::Format;
use crate::effects;
use crate::identify::{
    Free, Grade, Hints, Identified, Samples, Settings, Source, Weighting, by_descent, check_angles,
    check_torques, cleaned, identify, prepare, torques,
};
use crate::log::{self, Channel, ColumnMap, Log, MIN_ROWS, aligned, are_halves};
use crate::report::html::{Traces, identify_report};
use crate::report::identify as report;
use crate::robot::Model;

/// A dynamic model with standard errors from measured logs.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: joulepath identify --robot IRB1600-10/1.45 --log run1.csv run2.csv --validate other.csv --out model.toml"
)]
pub struct IdentifyArgs {
    /// The robot: a name (joulepath robots list) or a robot file, TOML or URDF.
    #[arg(long, value_name = "NAME|FILE")]
    robot: String,

    /// Logs, CSV or Parquet: `t`, `q1…` and `tau1…`, `i1…` or `ia1,ib1,ic1…`. One with the
    /// positions and one with the currents are brought together by their `sync` columns.
    #[arg(long, value_name = "FILE", required = true, num_args = 1..)]
    log: Vec<PathBuf>,

    /// Logs that are only predicted, to tell how good the model is.
    #[arg(long, value_name = "FILE", num_args = 1..)]
    validate: Vec<PathBuf>,

    /// What is identified; the rest stays as the robot has it.
    #[arg(long, value_enum, default_value_t = FreeArg::All)]
    free: FreeArg,

    /// How joints are weighted: by their residuals, or alike.
    #[arg(long, value_enum, default_value_t = Method::Weighted)]
    method: Method,

    /// Columns under other names, such as `q1_deg=J1,tau1=Torque_1`.
    #[arg(long, value_name = "CHANNEL=COLUMN,…", default_value = "", hide_default_value = true)]
    map: String,

    /// Duration of a repetition, seconds; otherwise it is found.
    #[arg(long, value_name = "SECONDS")]
    period: Option<f64>,

    /// When the logs were recorded, for the model's record.
    #[arg(long, value_name = "DATE")]
    date: Option<String>,

    /// Also fits masses, centres and moments by descent from the robot file, as the paper did,
    /// for comparison: not convex, no standard errors.
    #[arg(long)]
    descent: bool,

    /// Where the model goes, Robot TOML.
    #[arg(long, value_name = "MODEL.toml")]
    out: Option<PathBuf>,

    /// A page with curves, tables and what could not be determined.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,

    /// How the result is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,

    /// No notes on standard error.
    #[arg(long, short)]
    quiet: bool,
}

/// What may be identified.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum FreeArg {
    /// Rigid bodies, rotors, friction, offsets.
    All,
    /// Friction and offsets.
    Friction,
    /// What is fixed to the flange.
    Payload,
}

/// How joints are weighted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Method {
    /// Each by the deviation of its residuals.
    Weighted,
    /// All alike: ordinary least squares.
    Ordinary,
}

/// A log that was read.
struct Read {
    shown: String,
    hash: String,
    log: Log,
}

/// A log ready to be used.
struct Ready {
    record: (String, String, usize, usize),
    samples: Samples,
    origin: String,
}

/// Runs the command.
///
/// # Errors
/// A log or a robot that can't be used, or output that can't be written.
pub fn run(args: &IdentifyArgs) -> anyhow::Result<ExitCode> {
    let model = effects::load(&args.robot)?;
    let map = ColumnMap::parse(&args.map)?;
    if let Some(period) = args.period.filter(|p| !(p.is_finite() && *p > 0.0)) {
        bail!("--period {period}: give the duration of a repetition in seconds, more than 0");
    }
    let hints = Hints { period: args.period, cutoff: None };
    let mut basis = report::Basis { date: args.date.clone(), ..report::Basis::default() };
    let mut training = Vec::new();
    for read in read_all(&args.log, &map)? {
        training.push(ready(args, &model, read, hints, &mut basis)?);
    }
    // One filter for all: what is compared has to have the same band.
    let cutoff = training.iter().find_map(|ready| match ready.samples.source {
        Source::Filtered { cutoff } => Some(cutoff),
        _ => None,
    });
    let mut validation = Vec::new();
    let held_out = Hints { period: args.period, cutoff };
    for read in read_all(&args.validate, &map)? {
        let ready = ready(args, &model, read, held_out, &mut basis)?;
        basis.validation.push(ready.record);
        validation.push(ready.samples);
    }
    basis.torque = training.first().map_or_else(String::new, |ready| ready.origin.clone());
    basis.logs = training.iter().map(|ready| ready.record.clone()).collect();
    let samples = joined(training)?;
    for joint in &samples.resting {
        let text = format!("joint {} does not move: nothing of it is determined", joint + 1);
        tell(args, &mut basis, text);
    }
    for (joint, share) in samples.share_at_limits().into_iter().enumerate() {
        if share > 0.0 {
            let text = format!(
                "joint {}: the torque stands at a limit for {:.2} % of the time while the joint \
                 changes its speed: left out, for that joint",
                joint + 1,
                100.0 * share
            );
            tell(args, &mut basis, text);
        }
    }
    let files: Vec<&str> = basis.logs.iter().map(|log| log.0.as_str()).collect();
    let when = args.date.as_ref().map_or_else(String::new, |date| format!(", {date}"));
    let settings = Settings {
        free: match args.free {
            FreeArg::All => Free::All,
            FreeArg::Friction => Free::Friction,
            FreeArg::Payload => Free::Payload,
        },
        weighting: match args.method {
            Method::Weighted => Weighting::Joint,
            Method::Ordinary => Weighting::Ordinary,
        },
        source: format!("joulepath identify, {}{when}", files.join(", ")),
    };
    let found = identify(&model, &samples, &validation, &settings)?;
    if let Some(coupling) = found.coupling {
        let text = format!(
            "the wrist is coupled: motor 6 turns {coupling:.3} times with axis 5; the robot did not \
             state it"
        );
        tell(args, &mut basis, text);
    }
    if found.quality.grade == Grade::None {
        bail!(
            "no robot that can be has such torques ({}): check their signs, their time and that \
             robot and log are the same",
            found.quality.sentence()
        );
    }
    if found.quality.grade == Grade::Poor {
        tell(args, &mut basis, format!("the model is {}", found.quality.sentence()));
    }
    for text in doubts(&found) {
        tell(args, &mut basis, text);
    }
    if args.descent {
        basis.descent = by_descent(&model, &found);
        if basis.descent.is_none() {
            bail!("--descent compares fits of all parameters: leave out --free");
        }
    }
    if let Some(path) = &args.report {
        let (shown, title) = match (validation.first(), basis.validation.first()) {
            (Some(samples), Some(log)) => (samples, log.0.clone()),
            _ => (&samples, "the data of the fit".to_owned()),
        };
        let page = identify_report(&found, &basis, &traces(&found, &model, shown, title))?;
        output::write(path, page.as_bytes())?;
    }
    write(args, &found, &basis)
}

/// Torques and powers for the plots.
fn traces(found: &Identified, model: &Model, samples: &Samples, title: String) -> Traces {
    let n = model.dof;
    let mut traces = Traces {
        title,
        measured: vec![Vec::new(); n],
        predicted: vec![Vec::new(); n],
        ..Traces::default()
    };
    for (t, [measured, predicted, rate]) in found.traces(model, samples) {
        traces.t.push(t);
        let mut power = [0.0; 2];
        for joint in 0..n {
            traces.measured[joint].push(measured[joint]);
            traces.predicted[joint].push(predicted[joint]);
            // A joint at rest has no power.
            if measured[joint].is_finite() {
                power[0] += measured[joint] * rate[joint];
                power[1] += predicted[joint] * rate[joint];
            }
        }
        traces.power[0].push(power[0]);
        traces.power[1].push(power[1]);
    }
    traces
}

fn tell(args: &IdentifyArgs, basis: &mut report::Basis, text: String) {
    common::note(args.quiet, &text);
    basis.notes.push(text);
}

/// Share of a torque that no good model misses.
const MISSED: f64 = 0.35;
/// Share of a torque that is as good as nothing.
const NOTHING: f64 = 1e-3;

/// What a reader should not overlook.
fn doubts(found: &Identified) -> Vec<String> {
    let mut texts = Vec::new();
    let (with, without) = match (&found.validation, &found.unconstrained_validation) {
        (Some(with), Some(without)) => (&with.rms, &without.rms),
        _ => (&found.training.rms, &found.fit.rms),
    };
    for (joint, (with, without)) in with.iter().zip(without).enumerate() {
        let relative = found.training.relative[joint];
        if relative > MISSED {
            texts.push(format!(
                "joint {}: the model misses {:.0} % of the torque: are the columns of one time and \
                 one robot?",
                joint + 1,
                100.0 * relative
            ));
        }
        if with / without > 1.02 && relative > NOTHING {
            texts.push(format!(
                "joint {}: residuals of the physically consistent model are {:.1} % larger than \
                 those of the free fit",
                joint + 1,
                100.0 * (with / without - 1.0)
            ));
        }
    }
    for joint in &found.quality.giving_power {
        texts.push(format!(
            "joint {}: its friction would give power: has its torque the wrong sign?",
            joint + 1
        ));
    }
    let poor = found.fit.condition.scaled;
    if poor > 100.0 {
        texts.push(format!(
            "the motion excites little: scaled condition {poor:.0}; joulepath excite designs a \
             better one"
        ));
    }
    texts
}

/// Reads logs; halves of one run become one.
fn read_all(paths: &[PathBuf], map: &ColumnMap) -> anyhow::Result<Vec<Read>> {
    let mut logs: Vec<Read> = Vec::new();
    for path in paths {
        let read = read(path, map)?;
        let half = logs
            .iter_mut()
            .find(|other| are_halves(&other.log, &read.log) || are_halves(&read.log, &other.log));
        let Some(other) = half else {
            logs.push(read);
            continue;
        };
        let (positions, currents) = if are_halves(&other.log, &read.log) {
            (&other.log, &read.log)
        } else {
            (&read.log, &other.log)
        };
        let both = aligned(positions, currents)
            .with_context(|| format!("{} and {}", other.shown, read.shown))?;
        other.log = both;
        other.shown = format!("{} + {}", other.shown, read.shown);
        other.hash = format!("{} + {}", other.hash, read.hash);
    }
    Ok(logs)
}

fn read(path: &Path, map: &ColumnMap) -> anyhow::Result<Read> {
    let shown = path.display().to_string();
    let file = File::open(path)
        .with_context(|| format!("cannot read '{shown}'; check the path and its permissions"))?;
    let mut stream = Hashed { stream: file, hash: Sha256::new() };
    let log = log::read_from(&mut stream, map).with_context(|| shown.clone())?;
    let hash = format!("{:x}", stream.hash.finalize());
    Ok(Read { shown, hash, log })
}

/// A stream whose bytes are hashed as they are read.
struct Hashed {
    stream: File,
    hash: Sha256,
}

impl io::Read for Hashed {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.stream.read(buffer)?;
        self.hash.update(&buffer[..count]);
        Ok(count)
    }
}

/// Checks a log and makes instants of it.
fn ready(
    args: &IdentifyArgs,
    model: &Model,
    read: Read,
    hints: Hints,
    basis: &mut report::Basis,
) -> anyhow::Result<Ready> {
    let Read { shown, hash, log } = read;
    if log.joints() != model.dof {
        bail!(
            "{shown}: positions of {} joints are logged, {} has {}; give a log with q1 to q{}, or \
             another --robot",
            log.joints(),
            model.name,
            model.dof,
            model.dof
        );
    }
    let (log, impossible) = cleaned(&log);
    for rejected in log.rejected.iter().chain(&impossible) {
        let text = format!("{shown}: row {} left out: {}", rejected.row, rejected.reason);
        common::note(args.quiet, &text);
    }
    let left_out = log.rejected.len() + impossible.len();
    let usable = log.time().len();
    if usable < MIN_ROWS || left_out > usable {
        let first = log.rejected.iter().chain(&impossible).next();
        let why = first.map_or_else(String::new, |first| {
            format!("; the first is row {}: {}", first.row, first.reason)
        });
        bail!("{shown}: {left_out} rows can't be used and {usable} can{why}");
    }
    check_angles(model, &log).with_context(|| shown.clone())?;
    let torque = torques(model, &log).with_context(|| shown.clone())?;
    check_torques(model, &log, &torque.tau).with_context(|| shown.clone())?;
    for text in torque.notes {
        tell(args, basis, format!("{shown}: {text}"));
    }
    if let Some(text) = unused(&log) {
        tell(args, basis, format!("{shown}: {text}"));
    }
    let samples = prepare(&log, &torque.tau, hints).with_context(|| shown.clone())?;
    Ok(Ready { record: (shown, hash, usable, left_out), samples, origin: torque.origin })
}

/// Rates and accelerations that are logged, but not of all joints.
fn unused(log: &Log) -> Option<String> {
    let part = |name: &str, channel: fn(usize) -> Channel| {
        let has = |joint: &usize| log.column(channel(*joint)).is_some();
        let (with, without): (Vec<usize>, Vec<usize>) = (0..log.joints()).partition(has);
        let list = |joints: &[usize]| -> String {
            joints.iter().map(|j| format!("{name}{}", j + 1)).collect::<Vec<_>>().join(", ")
        };
        let told = !with.is_empty() && !without.is_empty();
        told.then(|| format!("no column {}: {} not used", list(&without), list(&with)))
    };
    let parts: Vec<String> = [part("qd", Channel::Velocity), part("qdd", Channel::Acceleration)]
        .into_iter()
        .flatten()
        .collect();
    (!parts.is_empty()).then(|| format!("{}; differentiated instead", parts.join("; ")))
}

/// The instants of several logs as one.
fn joined(logs: Vec<Ready>) -> anyhow::Result<Samples> {
    let mut all = logs.into_iter();
    let Some(first) = all.next() else { bail!("--log: give a log") };
    let mut samples = first.samples;
    for next in all {
        let (shown, next) = (next.record.0, next.samples);
        let same = match (&samples.source, &next.source) {
            (Source::Logged, Source::Logged) => true,
            (Source::Filtered { .. }, Source::Filtered { .. })
            | (Source::Periodic { .. }, Source::Periodic { .. }) => {
                (samples.step / next.step - 1.0).abs() < 0.01
            }
            _ => false,
        };
        if !same {
            bail!(
                "{shown}: its rate, or how it repeats, is not that of the first log; identify from \
                 logs of one kind"
            );
        }
        samples.blocks.extend(next.blocks);
        samples.resting.retain(|joint| next.resting.contains(joint));
        samples.rest = samples.rest.iter().zip(&next.rest).map(|(a, b)| a.max(*b)).collect();
    }
    Ok(samples)
}

fn write(
    args: &IdentifyArgs,
    found: &Identified,
    basis: &report::Basis,
) -> anyhow::Result<ExitCode> {
    let path = args.out.as_ref().map_or_else(String::new, |path| path.display().to_string());
    if let Some(path) = &args.out {
        output::write(path, report::toml(found, basis).as_bytes())?;
    }
    let mut out = std::io::stdout().lock();
    match args.format {
        Format::Json => writeln!(out, "{:#}", report::json(found, basis, &path))?,
        Format::Text => write!(out, "{}", report::text(found, basis))?,
    }
    Ok(ExitCode::SUCCESS)
}
