//! `joulepath diagnose`: which effect separates a model from its robot.

mod args;
mod channels;
mod motion;
mod next;
mod pictures;

pub(super) use args::DiagnoseArgs;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use anyhow::{Context, bail};
use clap::ValueEnum as _;
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::Value;

use self::args::TrustArg;
use super::common::{self, Format};
use super::excite::ExperimentArgs;
use super::input::{self, Input};
use super::logs::{
    PreparedLog, RawLog, Reader, filter_alike, held_out, hold_out, read_all, refuse_same,
};
use super::output::{self, is_same_file};
use crate::arm::effects::{self, ALL, Effect};
use crate::arm::robot::{Model, Use, nearest, ready, to_toml};
use crate::gap::{
    Diagnosis, Logs, Phase, Record, Settings, Trust, Tunables, Verdict, common_factor,
    diagnose_logs, diagnose_power, diagnose_runs,
};
use crate::learn::identify::{Hints, Samples};
use crate::learn::log::{Channel, ColumnMap};
use crate::tool::report::diagnose as report;
use crate::tool::report::html::diagnose_report;

/// Cut-off frequency of the filter for logged program runs \[Hz\].
const RUN_CUTOFF_HZ: f64 = 10.0;
/// Largest number of logs in a part of a case of `blind`.
const MAX_LOGS: usize = 999;
/// Redraw interval of the progress bar.
const TICK: Duration = Duration::from_millis(200);

pub(super) fn run(args: &DiagnoseArgs) -> anyhow::Result<ExitCode> {
    let (found, basis) = run_diagnosis(args, &Tunables::DEFAULT)?;
    let text = || {
        let trail = if args.explain { report::trail(&found) } else { String::new() };
        report::text(&found, &basis) + &trail
    };
    common::print(args.format, || report::json(&found, &basis), text)?;
    Ok(if found.verdict == Verdict::NoGap { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

/// The JSON of a case of `blind`, diagnosed without some effects; without omissions, the
/// model is written too.
pub(super) fn diagnose_case(
    case: &Path,
    options: &Value,
    without: &[&str],
) -> anyhow::Result<Value> {
    let args = DiagnoseArgs {
        effects: (!without.is_empty()).then(|| format!("-{}", without.join(","))),
        out: without.is_empty().then(|| case.join("improved.toml")),
        ..of_case(case, options)
    };
    let (found, basis) = run_diagnosis(&args, &Tunables::DEFAULT)?;
    Ok(report::json(&found, &basis))
}

/// The JSON of a case of `blind`, diagnosed with other numbers.
pub(super) fn case_with(
    case: &Path,
    options: &Value,
    tunables: &Tunables,
) -> anyhow::Result<Value> {
    let (found, basis) = run_diagnosis(&of_case(case, options), tunables)?;
    Ok(report::json(&found, &basis))
}

/// What a case of `blind` is diagnosed with.
fn of_case(case: &Path, options: &Value) -> DiagnoseArgs {
    let text = |key: &str| options.get(key).and_then(Value::as_str);
    DiagnoseArgs {
        robot: case.join(text("robot").unwrap_or("nominal.toml")).display().to_string(),
        log: numbered(case, "log"),
        heldout: numbered(case, "heldout"),
        baseline: numbered(case, "baseline"),
        program: text("program").map(|folder| case.join(folder)),
        trust: text("trust").and_then(|trust| TrustArg::from_str(trust, true).ok()),
        effects: None,
        map: String::new(),
        period: options.get("period").and_then(Value::as_f64),
        out: None,
        report: None,
        next: None,
        experiment: ExperimentArgs::default(),
        explain: false,
        format: Format::Json,
        quiet: true,
    }
}

/// The logs of a part of a case: `log.csv` or `log-1.csv`, `log-2.csv`, …
fn numbered(case: &Path, part: &str) -> Vec<PathBuf> {
    let whole = case.join(format!("{part}.csv"));
    if whole.exists() {
        return vec![whole];
    }
    let file = |number: usize| case.join(format!("{part}-{number}.csv"));
    (1..=MAX_LOGS).map(file).take_while(|file| file.exists()).collect()
}

/// Refuses outputs that overwrite an input, and logs that are given twice or in two roles.
fn check_paths(args: &DiagnoseArgs) -> anyhow::Result<()> {
    let within = |path: &Path, files: &[PathBuf]| files.iter().any(|it| is_same_file(it, path));
    let program = args.program.iter().map(|path| input::read(std::slice::from_ref(path)));
    let program: Vec<Input> = program.collect::<Result<_, _>>()?;
    let modules = program.iter().flat_map(|input| &input.files);
    let modules = modules.map(|file| Path::new(&file.source.path));
    let logs = args.log.iter().chain(&args.heldout).chain(&args.baseline).map(PathBuf::as_path);
    output::refuse_inputs(
        &[("--out", args.out.as_ref()), ("--report", args.report.as_ref())],
        logs.chain([Path::new(&args.robot)]).chain(modules),
    )?;
    for (number, path) in args.log.iter().enumerate() {
        if within(path, &args.log[..number]) {
            bail!("--log {}: this file is given twice; give it once", path.display());
        }
    }
    for (option, files) in [("--heldout", &args.heldout), ("--baseline", &args.baseline)] {
        if let Some(path) = files.iter().find(|path| within(path, &args.log)) {
            bail!(
                "{option} {}: this file is in --log too; give a log that takes no part there, or \
                 leave {option} out",
                path.display()
            );
        }
    }
    Ok(())
}

fn run_diagnosis(
    args: &DiagnoseArgs,
    tunables: &Tunables,
) -> anyhow::Result<(Diagnosis, report::Basis)> {
    check_paths(args)?;
    let model = effects::load(&args.robot)?;
    common::notes(args.quiet, model.assumed());
    let map = ColumnMap::parse(&args.map)?;
    if let Some(period) = args.period.filter(|p| !(p.is_finite() && *p > 0.0)) {
        bail!("--period {period}: give the duration of a repetition in seconds, more than 0");
    }
    let wanted = wanted(args.effects.as_deref())?;
    let trust = match args.trust {
        Some(TrustArg::Unknown) => Trust::Unknown,
        Some(TrustArg::Cad) => Trust::Cad,
        None if args.baseline.is_empty() => Trust::Cad,
        Some(TrustArg::Commissioned) | None => Trust::Commissioned,
    };
    let raw = read_all(&args.log, &map, &model)?;
    if motion::is_alone(&raw) {
        return diagnose_motion(args, &model, &map, raw, &wanted);
    }
    ready(&model, Use::Diagnose)?;
    next::check(args, &model)?;
    let Data { train, held, baseline, heldout, notes } = read_data(args, &model, &map, raw, trust)?;
    // These notes were already shown during reading.
    let shown = notes.len();
    let mut basis = report::Basis {
        heldout: heldout.to_owned(),
        graded: held.iter().map(|of| of.record.path.clone()).collect(),
        notes,
        ..report::Basis::default()
    };
    let lines = channels::lines(args.program.as_deref(), &args.robot)?;
    let may = |id: &str| wanted.iter().any(|effect| effect.id == id);
    let [before, now, graded] = [&baseline, &train, &held].map(|logs| channels::powers(logs));
    let of_power = diagnose_power(&model, &before, &now, &graded, &may);
    let [before, now, graded] = [&baseline, &train, &held].map(|logs| channels::runs(logs));
    let of_runs = diagnose_runs(&before, &now, &graded, &may);
    // Checks that the outputs are writable before the long search.
    for path in args.out.iter().chain(&args.report) {
        output::stage(path, &[])?;
    }
    // Without a mean over repetitions there is no noise estimate to weight effects.
    let (of_torque, compared) = if of_runs.is_some() {
        let text = "the logs are runs of a program: torques are not searched for effects";
        basis.notes.push(text.to_owned());
        (Vec::new(), &[][..])
    } else {
        (wanted.clone(), baseline.as_slice())
    };
    let settings = Settings { trust, effects: of_torque, tunables: tunables.clone() };
    let mut found =
        diagnose_with_progress(&model, [&train, &held, compared], &settings, &progress(args.quiet));
    let known = found.before.iter();
    basis.notes.extend(known.map(|of| format!("{}: in the baseline already", report::called(of))));
    if let Some(of) = &of_power {
        found.add_power(of);
    }
    if let Some(of) = &of_runs {
        channels::add_runs(&mut found, of, &lines);
    } else if args.program.is_some() {
        basis.notes.push(
            "--program tells nothing of these logs: give logs and a --baseline whose column `cmd` has \
             the number of the movement that runs"
                .into(),
        );
    }
    // The diagnosis stands without an experiment.
    match next::experiment(args, &model, &train, &found) {
        Ok(next) => basis.next = next,
        Err(error) => basis.notes.push(format!("no experiment is written: {error:#}")),
    }
    let graded = if held.is_empty() { &train } else { &held };
    write(args, &model, graded, &found, &mut basis)?;
    common::notes(args.quiet, &basis.notes[shown..]);
    Ok((found, basis))
}

/// The motion alone of logs without torques.
fn diagnose_motion(
    args: &DiagnoseArgs,
    model: &Model,
    map: &ColumnMap,
    raw: Vec<RawLog>,
    wanted: &[&'static Effect],
) -> anyhow::Result<(Diagnosis, report::Basis)> {
    let shown = args.log[0].display();
    if args.baseline.is_empty() {
        bail!(
            "--log {shown}: no torques are logged, and a motion alone is compared with that of a \
             baseline; give --baseline with a log of the same program from when the robot was right, \
             or logs with tau1… or i1…"
        );
    }
    let mut reader = Reader { model, quiet: args.quiet, notes: Vec::new() };
    let logs = [raw, read_all(&args.heldout, map, model)?, read_all(&args.baseline, map, model)?];
    let motion::Logged { now, held, before, heldout, graded } = motion::logged(&mut reader, logs)?;
    let lines = channels::lines(args.program.as_deref(), &args.robot)?;
    for path in args.out.iter().chain(&args.report) {
        output::stage(path, &[])?;
    }
    let may = |id: &str| wanted.iter().any(|effect| effect.id == id);
    let of_runs = diagnose_runs(&before, &now, &held, &may).with_context(|| {
        format!(
            "--log {shown}: its movements are not those of the baseline; give logs in which the same \
             program runs at least twice, with the number of the movement as cmd"
        )
    })?;
    let mut found = Diagnosis::without_torques(model);
    channels::add_runs(&mut found, &of_runs, &lines);
    let mut basis = report::Basis {
        heldout: heldout.to_owned(),
        graded,
        notes: reader.notes,
        ..report::Basis::default()
    };
    common::note_once(
        args.quiet,
        &mut basis.notes,
        "no torques are logged: only the motion was compared".to_owned(),
    );
    write(args, model, &[], &found, &mut basis)?;
    Ok((found, basis))
}

struct Data {
    train: Vec<PreparedLog>,
    held: Vec<PreparedLog>,
    baseline: Vec<PreparedLog>,
    /// The kind of held-out data: `file`, `trajectory` or `cycles`.
    heldout: &'static str,
    notes: Vec<String>,
}

fn read_data(
    args: &DiagnoseArgs,
    model: &Model,
    map: &ColumnMap,
    raw: Vec<RawLog>,
    trust: Trust,
) -> anyhow::Result<Data> {
    let mut reader = Reader { model, quiet: args.quiet, notes: Vec::new() };
    let mut prepared = |raw: Vec<RawLog>| -> anyhow::Result<Vec<PreparedLog>> {
        let one = |read: RawLog| {
            // Repetitions of a program are never equal to the millisecond.
            let is_run = read.log.column(Channel::Command).is_some();
            let cutoff = is_run.then_some(RUN_CUTOFF_HZ);
            reader.prepared(read, Hints { period: args.period, cutoff })
        };
        raw.into_iter().map(one).collect()
    };
    let mut train = prepared(raw)?;
    let mut held = prepared(read_all(&args.heldout, map, model)?)?;
    let [now, others] =
        [&train, &held].map(|logs| logs.iter().map(|of| &of.record).collect::<Vec<_>>());
    refuse_same(&now, &others)?;
    let heldout = hold_out(&mut train, &mut held);
    if held.is_empty() {
        let [first, last] = held_out(model, &train[0])?;
        (train, held) = (vec![first], vec![last]);
    }
    if let Some(factor) = common_factor(&records(model, &train), trust) {
        bail!(
            "the torques of all joints are {factor:.3} times those of the model: give torques in Nm \
             at the joints, currents as i1… in A, or the --robot that was logged"
        );
    }
    let mut baseline = prepared(read_all(&args.baseline, map, model)?)?;
    filter_alike(model, [&mut train, &mut held, &mut baseline])?;
    Ok(Data { train, held, baseline, heldout, notes: reader.notes })
}

fn records<'a>(model: &'a Model, logs: &[PreparedLog]) -> Vec<Record<'a>> {
    logs.iter().flat_map(|log| Record::all(model, &log.samples)).collect()
}

fn write(
    args: &DiagnoseArgs,
    model: &Model,
    graded: &[PreparedLog],
    found: &Diagnosis,
    basis: &mut report::Basis,
) -> anyhow::Result<()> {
    if let Some(path) = &args.out {
        output::write(path, to_toml(&found.improved.written).as_bytes())
            .with_context(|| path.display().to_string())?;
        basis.model = path.display().to_string();
    }
    if let Some(path) = &args.report {
        let pictures = pictures::pictures(model, &records(model, graded), found);
        let page = diagnose_report(&model.name, found, basis, &pictures)?;
        output::write(path, page.as_bytes()).with_context(|| path.display().to_string())?;
    }
    Ok(())
}

fn diagnose_with_progress(
    model: &Model,
    [train, held, before]: [&[PreparedLog]; 3],
    settings: &Settings,
    progress: &ProgressBar,
) -> Diagnosis {
    let tell = |phase: Phase| {
        let before = Phase::ALL.iter().position(|of| *of == phase);
        progress.set_position(before.unwrap_or(0) as u64);
        progress.set_message(phase.name());
    };
    let [train, held, before]: [Vec<&Samples>; 3] =
        [train, held, before].map(|logs| logs.iter().map(|log| &log.samples).collect());
    let logs = Logs { train: &train, held: &held, before: &before };
    let found = diagnose_logs(model, logs, settings, &tell);
    progress.finish_and_clear();
    found
}

/// A progress bar over the phases of a diagnosis; hidden unless standard error is a terminal.
fn progress(quiet: bool) -> ProgressBar {
    let bar = common::progress(quiet, Some(Phase::ALL.len() as u64));
    let style = ProgressStyle::with_template("{elapsed:>4} {bar:20} {pos}/{len} {msg}");
    if let Ok(style) = style {
        bar.set_style(style);
    }
    bar.enable_steady_tick(TICK);
    bar
}

/// The effects to search for.
fn wanted(list: Option<&str>) -> anyhow::Result<Vec<&'static Effect>> {
    let Some(list) = list else { return Ok(ALL.iter().collect()) };
    let (but, list) = match list.trim().strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, list),
    };
    let mut named = Vec::new();
    for id in list.split(',').map(|id| id.trim().trim_start_matches('-')) {
        if effects::find(id).is_none() {
            let near = nearest(id, ALL.iter().map(|effect| effect.id));
            let meant = near.map_or_else(String::new, |near| format!("; did you mean {near}?"));
            let ids: Vec<&str> = ALL.iter().map(|effect| effect.id).collect();
            bail!("--effects {id}: no effect has this id{meant}; there are {}", ids.join(", "));
        }
        named.push(id);
    }
    Ok(ALL.iter().filter(|effect| named.contains(&effect.id) != but).collect())
}
