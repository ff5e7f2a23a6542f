//! `joulepath predict`: the torques and powers of a logged motion.

mod doubts;

use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::Args;

use self::doubts::doubts;
use super::logs::{check_joints, left_out};
use super::{common, load, output};
use crate::arm::dynamics::{Data, Load, apparent_torques};
use crate::arm::effects;
use crate::arm::robot::{Model, Provenance, Use, ready};
use crate::learn::identify::plausible;
use crate::learn::log::{self, ColumnMap, MIN_ROWS, Motion, Rejected};
use crate::rapid::text::{FileId, SourceFile};
use crate::retime::energy::power::{power_at, supply_w};

/// Byte order marks of spreadsheet exports.
const UTF16_MARKS: [&[u8]; 2] = [b"\xFF\xFE", b"\xFE\xFF"];

/// The reason for a row without prediction.
const NOT_FINITE: &str = "its motion is so large that torque or power is not finite";

/// Torques and powers that a model predicts for a logged motion, as CSV.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: joulepath predict --robot IRB1600-10/1.45 --log motion.csv --out torque.csv"
)]
pub(super) struct PredictArgs {
    /// The robot: a name (joulepath robots list) or a robot file.
    #[arg(long, value_name = "NAME|FILE")]
    robot: String,

    /// The motion, CSV or Parquet: columns `t`, `q1…` (or `q1_deg…`), and `qd1…`, `qdd1…`,
    /// which are differentiated where they are not there.
    #[arg(long, value_name = "FILE")]
    log: PathBuf,

    /// Columns under other names, such as `q1_deg=J1,q2_deg=J2`.
    #[arg(long, value_name = "CHANNEL=COLUMN,…", default_value = "", hide_default_value = true)]
    map: String,

    /// What the flange carries: KG, KG,X,Y,Z (mm) or a loaddata of RAPID.
    #[arg(long, value_name = "LOAD", allow_hyphen_values = true)]
    load: Option<String>,

    /// Where the prediction goes, instead of standard output.
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,

    /// No notes on standard error.
    #[arg(long, short)]
    quiet: bool,
}

pub(super) fn run(args: &PredictArgs) -> anyhow::Result<ExitCode> {
    output::refuse_inputs(
        &[("--out", args.out.as_ref())],
        [args.log.as_path(), Path::new(&args.robot)],
    )?;
    let model = effects::load(&args.robot)?;
    let model = if model.has_dynamics() { model } else { effects::load_estimated(&args.robot)? };
    ready(&model, Use::Predict)?;
    let load = load::from_option(args.load.as_deref())?;
    let map = ColumnMap::parse(&args.map)?;
    let shown = args.log.display().to_string();
    let bytes = fs::read(&args.log)
        .with_context(|| format!("cannot read '{shown}'; check the path and its permissions"))?;
    let bytes = if UTF16_MARKS.iter().any(|mark| bytes.starts_with(mark)) {
        SourceFile::new(FileId(0), shown.clone(), bytes).bytes
    } else {
        bytes
    };
    let log = log::read(&bytes, &map).with_context(|| shown.clone())?;
    check_joints(&shown, &log, &model)?;
    let (log, impossible) = plausible(&log);
    let motion = log.motion();
    if motion.time.len() < MIN_ROWS {
        bail!(
            "{shown}: only {} rows have others near enough to differentiate, {MIN_ROWS} are needed; \
             give a log with qd1… and qdd1…, or one that is sampled more evenly",
            motion.time.len()
        );
    }
    let unused = [&log.rejected, &impossible, &motion.left_out].into_iter().flatten();
    let notes = |rejected: Vec<Rejected>| {
        let texts = left_out(rejected).into_iter().map(|text| format!("{shown}: {text}"));
        common::notes(args.quiet, texts);
    };
    notes(unused.cloned().collect());
    if !motion.differentiated.is_empty() {
        let what = motion.differentiated.join(" and ");
        common::note(args.quiet, &format!("{shown}: {what} are not logged, but differentiated"));
    }
    let estimated = model.count(Provenance::Estimated);
    if estimated > 0 {
        let text = format!(
            "estimated: {estimated} figures of {} follow from its size (joulepath robots show says how well \
             they are known)",
            model.name
        );
        common::note(args.quiet, &text);
    }
    common::notes(args.quiet, model.assumed());
    let doubts = doubts(&model, &motion);
    common::notes(args.quiet, doubts.iter().map(|doubt| format!("{shown}: {doubt}")));
    let (csv, beyond) = prediction(&model, &load, &motion);
    if beyond.len() == motion.time.len() {
        bail!("{shown}: {NOT_FINITE} in every row; give positions in rad, rates in rad/s");
    }
    notes(beyond.into_iter().map(|row| Rejected { row, reason: NOT_FINITE.into() }).collect());
    match &args.out {
        Some(path) => output::write(path, csv.as_bytes())?,
        None => std::io::stdout().lock().write_all(csv.as_bytes())?,
    }
    Ok(ExitCode::SUCCESS)
}

/// The torques with the model's laws and effects of the whole motion; `None` if it has none.
fn torques_with_effects(model: &Model, load: &Load, motion: &Motion) -> Option<Vec<Vec<f64>>> {
    if model.laws.is_empty() && model.effects.is_empty() {
        return None;
    }
    let series = [motion.q.clone(), motion.qd.clone(), motion.qdd.clone()];
    // Laws use the time since the start of the log; a warm-up uses the absolute time of all logs,
    // as in `gap::predicted`.
    let warms = model.effects.iter().any(|of| of.id == "warm_up");
    let start = if warms { 0.0 } else { motion.time.first().copied().unwrap_or(0.0) };
    let time = motion.time.iter().map(|t| t - start).collect();
    let moved = effects::Motion::new(model, time, series, &[], false);
    let mut shown = moved.torques_of(model, load);
    for (to, added) in shown.iter_mut().zip(effects::of_the_whole_motion(&moved)) {
        to.iter_mut().zip(added).for_each(|(to, x)| *to += x);
    }
    Some(shown)
}

/// CSV rows `t,tau1..taun,p_mech,p_elec` in shortest round-trip form, and the rows with values that
/// are not finite. Torques are as logged, powers those of the robot.
fn prediction(model: &Model, load: &Load, motion: &Motion) -> (String, Vec<u64>) {
    let n = model.dof;
    let mut csv = String::from("t");
    for joint in 1..=n {
        let _ = write!(csv, ",tau{joint}");
    }
    csv.push_str(",p_mech,p_elec\n");
    let mut data = Data::new();
    let mut beyond = Vec::new();
    let sensors = &model.sensors;
    let effects = torques_with_effects(model, load, motion);
    for (row, t) in motion.time.iter().enumerate() {
        let at = |columns: &[Vec<f64>]| columns.iter().map(|column| column[row]).collect();
        let [mut q, qd, qdd]: [Vec<f64>; 3] = [at(&motion.q), at(&motion.qd), at(&motion.qdd)];
        for (q, offset) in q.iter_mut().zip(&sensors.position_offset) {
            *q += offset;
        }
        let state: [&[f64]; 3] = [&q, &qd, &qdd];
        let power = power_at(model, &mut data, load, state);
        let supply = supply_w(model, &mut data, load, state, &power);
        let apparent = apparent_torques(model, &qd, &qdd);
        let logged = sensors.torque_error.iter().zip(&sensors.torque_offset).zip(apparent);
        let values: Vec<f64> = power
            .tau
            .iter()
            .zip(logged)
            .map(|(tau, ((error, offset), apparent))| tau * (1.0 + error) + offset + apparent)
            .enumerate()
            .map(|(joint, tau)| effects.as_ref().map_or(tau, |of| of[joint][row]))
            .chain([power.mechanical_w(), supply])
            .collect();
        if !values.iter().all(|value| value.is_finite()) {
            beyond.push(motion.rows[row]);
            continue;
        }
        let _ = write!(csv, "{t}");
        for value in values {
            let _ = write!(csv, ",{value}");
        }
        csv.push('\n');
    }
    (csv, beyond)
}
