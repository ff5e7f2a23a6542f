//! `joulepath prove`: what a retrofit saved, measured.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, anyhow, bail};
use clap::Args;

use super::common::{self, Format};
use super::output;
use crate::learn::log::{ColumnMap, read, scan};
use crate::tool::cell::events;
use crate::tool::cell::prove::{EventLog, PowerLog, Settings, Side, Verdict, plan, prove, stamp};
use crate::tool::report::html::prove_report;
use crate::tool::report::prove as report;

/// Prove a saving by measured energy before and after.
#[derive(Debug, Args)]
#[command(
    after_help = "Logs of power: CSV or Parquet with t and power (W or kW) and, where there are any, cycle, part, \
    payload and temp1; without power, tau1… with qd1… or q1…. Logs of events by the recorder of the cell may be \
    given beside them. Cycles that made the same are compared, at the same cycle time and temperature. Without \
    --after: how many cycles are needed.\n\n\
    Example: joulepath prove --before monday.csv --after tuesday.csv --report proof.html"
)]
pub(super) struct ProveArgs {
    /// Logs before the retrofit, in the order of their recording.
    #[arg(long, value_name = "LOG", required = true, num_args = 1..)]
    before: Vec<PathBuf>,

    /// Logs after the retrofit.
    #[arg(long, value_name = "LOG", num_args = 1..)]
    after: Vec<PathBuf>,

    /// The saving that the campaign has to be able to show.
    #[arg(long, value_name = "PERCENT", default_value = "3%")]
    effect: String,

    /// The saving that `optimize` promised: says by how much the measurement differs.
    #[arg(long, value_name = "PERCENT", allow_hyphen_values = true)]
    promised: Option<String>,

    /// Columns under other names, such as `power=P_total,part=Article`.
    #[arg(long, value_name = "CHANNEL=COLUMN,…", default_value = "", hide_default_value = true)]
    map: String,

    /// Write a report as one HTML file.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,

    /// Exit code 1 unless the verdict is `saves`.
    #[arg(long)]
    strict: bool,

    /// How the result is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,

    /// No notes on standard error.
    #[arg(long, short)]
    quiet: bool,
}

pub(super) fn run(args: &ProveArgs) -> anyhow::Result<ExitCode> {
    let effect = percent("--effect", &args.effect)?;
    if !(effect > 0.0 && effect < 0.9) {
        bail!("--effect {}: give a saving between 0 and 90 %, such as 3%", args.effect);
    }
    let promised = args.promised.as_deref().map(|text| percent("--promised", text)).transpose()?;
    if promised.is_some_and(|share| share.abs() >= 1.0) {
        bail!("--promised: give a saving between -100 and 100 %, such as 7.5%");
    }
    let settings = Settings { effect, promised };
    let map = ColumnMap::parse(&args.map)?.with_products();
    let paths = || args.before.iter().chain(&args.after);
    output::refuse_inputs(&[("--report", args.report.as_ref())], paths().map(PathBuf::as_path))?;
    for (index, path) in paths().enumerate() {
        if paths().take(index).any(|other| output::is_same_file(other, path)) {
            bail!("{}: this log is given twice; give each log once", path.display());
        }
    }
    let before = side(&args.before, &map, args.quiet)?;
    if args.after.is_empty() {
        if args.report.is_some() {
            bail!("--report shows a comparison: give the logs of --after, too");
        }
        let plan = plan(&before, settings)?;
        common::notes(args.quiet, &plan.notes);
        return common::print(
            args.format,
            || report::plan_json(&plan),
            || report::plan_text(&plan),
        );
    }
    let after = side(&args.after, &map, args.quiet)?;
    let proof = prove(&before, &after, settings)?;
    common::notes(args.quiet, &proof.notes);
    let command = report::diagnose_command(&shown(&args.before), &shown(&args.after));
    if let Some(path) = &args.report {
        output::write(path, prove_report(&proof, &command)?.as_bytes())?;
        if args.format == Format::Text {
            common::note(args.quiet, &format!("wrote {}", path.display()));
        }
    }
    let code = common::print(
        args.format,
        || report::json(&proof, &command),
        || report::text(&proof, &command),
    )?;
    let fails = args.strict && proof.verdict != Verdict::Saves;
    Ok(if fails { ExitCode::from(1) } else { code })
}

fn shown(paths: &[PathBuf]) -> Vec<String> {
    paths.iter().map(|path| path.display().to_string()).collect()
}

/// A share from a text such as `3%` or `3`.
fn percent(option: &str, text: &str) -> anyhow::Result<f64> {
    let number = text.trim().trim_end_matches('%').trim();
    let value: Option<f64> = number.parse().ok().filter(|x: &f64| x.is_finite());
    let value = value.with_context(|| format!("{option} {text}: give a percentage, such as 3%"))?;
    Ok(value / 100.0)
}

/// Maximum number of rejected rows that are listed individually.
const MAX_LISTED_ROWS: usize = 3;

/// Reads the logs of a side, of power and of events.
fn side(paths: &[PathBuf], map: &ColumnMap, quiet: bool) -> anyhow::Result<Side> {
    let mut side = Side::default();
    for path in paths {
        let shown = path.display().to_string();
        let bytes = bytes(path)?;
        let (rejected, lines): (usize, Vec<String>) = if events::is_event_log(&bytes) {
            let recording = events::read(&bytes).with_context(|| shown.clone())?;
            let rejected = recording.rejected.iter().take(MAX_LISTED_ROWS);
            let lines = rejected.map(|(line, reason)| format!("line {line} is left out: {reason}"));
            let found = (recording.rejected.len(), lines.collect());
            side.events.push(EventLog { shown: shown.clone(), recording });
            found
        } else {
            let log = read(&bytes, map)
                .map_err(|error| anyhow!("{shown}: line 1: {}", printable(&error.to_string())))?;
            let rejected = log.rejected.iter().take(MAX_LISTED_ROWS);
            let lines = rejected.map(|of| format!("line {} is left out: {}", of.row, of.reason));
            let found = (log.rejected.len(), lines.collect());
            let (scan, stamp) = (scan(&bytes, map), stamp(&bytes));
            side.logs.push(PowerLog { shown: shown.clone(), log, scan, stamp });
            found
        };
        common::notes(quiet, lines.iter().map(|line| format!("{shown}: {}", printable(line))));
        if rejected > MAX_LISTED_ROWS {
            let more = rejected - MAX_LISTED_ROWS;
            common::note(quiet, &format!("{shown}: {more} more rows are left out"));
        }
    }
    Ok(side)
}

/// A text that quotes a file, which may be binary: without what a terminal would obey or could not show.
fn printable(text: &str) -> String {
    let is_plain = |c: char| !c.is_control() && c != char::REPLACEMENT_CHARACTER;
    let shown = |c: char| if is_plain(c) { c.to_string() } else { c.escape_default().to_string() };
    text.chars().map(shown).collect()
}

fn bytes(path: &Path) -> anyhow::Result<Vec<u8>> {
    let shown = path.display();
    if path.is_dir() {
        bail!("{shown}: this is a folder; give the log files in it one by one");
    }
    std::fs::read(path)
        .with_context(|| format!("cannot read '{shown}'; check the path and its permissions"))
}
