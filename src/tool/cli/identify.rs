//! `joulepath identify`: a dynamic model from measured logs.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::{Args, ValueEnum};

use super::common::{self, note_once};
use super::logs::{PreparedLog, Reader, read_all};
use super::output;
use crate::arm::effects;
use crate::arm::robot::Model;
use crate::learn::identify::{
    Free, Grade, Hints, Identified, Samples, Settings, Source, Weighting, by_descent, identify,
};
use crate::learn::log::ColumnMap;
use crate::tool::cli::common::Format;
use crate::tool::report::html::{Traces, identify_report};
use crate::tool::report::identify::{self as report, LogRecord};

/// A dynamic model with standard errors from measured logs.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: joulepath identify --robot IRB1600-10/1.45 --log run1.csv run2.csv --validate other.csv --out model.toml"
)]
pub(super) struct IdentifyArgs {
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
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    period: Option<f64>,

    /// When the logs were recorded, as 2026-11-30, for the model's record.
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = date)]
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

/// A valid calendar date.
fn date(text: &str) -> Result<String, String> {
    let wrong = || "give a day as 2026-11-30".to_owned();
    let parts: Vec<&str> = text.split('-').collect();
    let widths = parts.iter().map(|part| part.len());
    let digits = parts.iter().all(|part| part.bytes().all(|b| b.is_ascii_digit()));
    if !widths.eq([4, 2, 2]) || !digits {
        return Err(wrong());
    }
    let [year, month, day] = [0, 1, 2].map(|k| parts[k].parse::<u32>().unwrap_or_default());
    let leap = year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    let last = match month {
        2 if leap => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        1..=12 => 31,
        _ => 0,
    };
    if (1..=last).contains(&day) { Ok(text.to_owned()) } else { Err(wrong()) }
}

pub(super) fn run(args: &IdentifyArgs) -> anyhow::Result<ExitCode> {
    let logs = args.log.iter().chain(&args.validate).map(PathBuf::as_path);
    output::refuse_inputs(
        &[("--out", args.out.as_ref()), ("--report", args.report.as_ref())],
        logs.chain([Path::new(&args.robot)]),
    )?;
    let model = effects::load(&args.robot)?;
    common::notes(args.quiet, model.assumed());
    let map = ColumnMap::parse(&args.map)?;
    if let Some(period) = args.period.filter(|period| !PERIODS.contains(period)) {
        bail!(
            "--period {period:?}: give the duration of a repetition in seconds, more than 0, at most {}",
            PERIODS.end()
        );
    }
    let mut basis = report::Basis { date: args.date.clone(), ..report::Basis::default() };
    let Data { samples, validation, weight } = read_data(args, &model, &map, &mut basis)?;
    let mut found = identify(&model, &samples, &validation, &settings(args, &basis))?;
    if let Some(factor) = weight {
        found.quality.doubt_weight(factor);
    }
    if let Some(coupling) = found.coupling {
        let text = format!(
            "the wrist is coupled: motor 6 turns {coupling:.3} times with axis 5; the robot did not \
             state it"
        );
        note_once(args.quiet, &mut basis.notes, text);
    }
    if found.quality.grade == Grade::None {
        bail!(
            "no physically possible robot has these torques ({}): check their signs and their time, \
             and that the log is of this robot",
            found.quality.sentence()
        );
    }
    if found.quality.grade == Grade::Poor {
        note_once(
            args.quiet,
            &mut basis.notes,
            format!("the model is {}", found.quality.sentence()),
        );
    }
    for text in doubts(&found) {
        note_once(args.quiet, &mut basis.notes, text);
    }
    if args.descent {
        basis.descent = by_descent(&model, &found);
        if basis.descent.is_none() {
            bail!("--descent compares fits of all parameters: leave out --free");
        }
    }
    if let Some(path) = &args.report {
        let (shown, title) = match (validation.first(), basis.validation.first()) {
            (Some(samples), Some(log)) => (samples, log.path.clone()),
            _ => (&samples, "the data of the fit".to_owned()),
        };
        let page = identify_report(&found, &basis, &traces(&found, &model, shown, title))?;
        output::write(path, page.as_bytes())?;
    }
    write(args, &found, &basis)
}

struct Data {
    /// The concatenated logs of the fit.
    samples: Samples,
    validation: Vec<Samples>,
    /// Ratio of the logged torques to the weight of the robot file's masses, if implausible.
    weight: Option<f64>,
}

/// Reads the logs and adds notes for the reader to `basis`.
fn read_data(
    args: &IdentifyArgs,
    model: &Model,
    map: &ColumnMap,
    basis: &mut report::Basis,
) -> anyhow::Result<Data> {
    let hints = Hints { period: args.period, cutoff: None };
    let mut reader = Reader { model, quiet: args.quiet, notes: Vec::new() };
    let mut training = Vec::new();
    for read in read_all(&args.log, map, model)? {
        training.push(reader.prepared(read, hints)?);
    }
    // One filter for all logs: compared data need the same bandwidth.
    let cutoff = training.iter().find_map(|ready| match ready.samples.source {
        Source::Filtered { cutoff } => Some(cutoff),
        _ => None,
    });
    let mut validation = Vec::new();
    for read in read_all(&args.validate, map, model)? {
        let ready = reader.prepared(read, Hints { cutoff, ..hints })?;
        basis.validation.push(ready.record);
        validation.push(ready.samples);
    }
    basis.notes = reader.notes;
    basis.logs = training.iter().map(|ready| ready.record.clone()).collect();
    for text in repeated(&basis.logs, &basis.validation) {
        note_once(args.quiet, &mut basis.notes, text);
    }
    basis.torque = training.first().map_or_else(String::new, |ready| ready.origin.clone());
    let weight = training.iter().find_map(|ready| ready.weight);
    let samples = joined(training)?;
    for joint in &samples.resting {
        let text = format!("joint {} does not move: nothing of it is determined", joint + 1);
        note_once(args.quiet, &mut basis.notes, text);
    }
    for (joint, share) in samples.share_at_limits().into_iter().enumerate() {
        if share > 0.0 {
            let text = format!(
                "joint {}: the torque stands at a limit for {:.2} % of the time while the joint \
                 changes its speed: left out, for that joint",
                joint + 1,
                100.0 * share
            );
            note_once(args.quiet, &mut basis.notes, text);
        }
    }
    Ok(Data { samples, validation, weight })
}

fn settings(args: &IdentifyArgs, basis: &report::Basis) -> Settings {
    let files: Vec<&str> = basis.logs.iter().map(|log| log.path.as_str()).collect();
    let when = args.date.as_ref().map_or_else(String::new, |date| format!(", {date}"));
    Settings {
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
    }
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

/// Maximum relative residual of a good model.
const MAX_RELATIVE_RESIDUAL: f64 = 0.35;
/// Relative residual that counts as zero.
const NEGLIGIBLE_RESIDUAL: f64 = 1e-3;

/// Maximum plausible mass of a link \[kg\].
const MAX_LINK_MASS: f64 = 1500.0;

/// Warnings on the quality of the result.
fn doubts(found: &Identified) -> Vec<String> {
    let mut texts = Vec::new();
    let (with, without) = match (&found.validation, &found.unconstrained_validation) {
        (Some(with), Some(without)) => (&with.rms, &without.rms),
        _ => (&found.cross_rms, &found.fit.cross_rms),
    };
    for (joint, (with, without)) in with.iter().zip(without).enumerate() {
        let relative = found.training.relative[joint];
        if relative > MAX_RELATIVE_RESIDUAL {
            texts.push(format!(
                "joint {}: the model misses {:.0} % of the torque: are the columns of one time and \
                 one robot?",
                joint + 1,
                100.0 * relative
            ));
        }
        if with / without > 1.02 && relative > NEGLIGIBLE_RESIDUAL {
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
    for (k, link) in found.model.links.iter().enumerate() {
        if link.mass > MAX_LINK_MASS {
            texts.push(format!(
                "link {}: {:.0} kg are no arm's: the motion does not tell masses, only what torques \
                 need of them; start from a robot file with the masses of the drawings",
                k + 1,
                link.mass
            ));
        }
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

/// Notes on logs that were given twice.
fn repeated(training: &[LogRecord], validation: &[LogRecord]) -> Vec<String> {
    let first = |logs: &[LogRecord], log: &LogRecord| {
        logs.iter().find(|known| known.hash == log.hash).map(|known| known.path.clone())
    };
    let mut texts = Vec::new();
    for (k, log) in training.iter().enumerate() {
        if let Some(first) = first(&training[..k], log) {
            texts.push(format!("{} is the same log as {first}: it counts twice", log.path));
        }
    }
    for log in validation {
        if let Some(first) = first(training, log) {
            texts.push(format!(
                "--validate {} is the log {first} that the model was fitted to: it tells nothing of \
                 other motions",
                log.path
            ));
        }
    }
    texts
}

/// Permitted durations of a repetition \[s\].
const PERIODS: RangeInclusive<f64> = 1e-3..=1e5;

/// Concatenates the samples of several logs.
fn joined(logs: Vec<PreparedLog>) -> anyhow::Result<Samples> {
    let mut all = logs.into_iter();
    let Some(first) = all.next() else { bail!("--log: give a log") };
    let mut samples = first.samples;
    for next in all {
        let (shown, next) = (next.record.path, next.samples);
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
        let text = report::toml(found, basis);
        // The output must be a valid robot file.
        effects::from_toml(&path.display().to_string(), &text)
            .context("the identified numbers make no valid robot file; nothing was written")?;
        output::write(path, text.as_bytes())?;
    }
    common::print(args.format, || report::json(found, basis, &path), || report::text(found, basis))
}
