//! `joulepath blind sensitivity`: what the chosen numbers of `diagnose` decide.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::bail;
use clap::Args;
use rayon::prelude::*;
use serde::Serialize;
use serde_json::Value;

use super::super::common::{self, Format};
use super::super::diagnose;
use super::cases::{labels, options};
use crate::gap::{Tunable, Tunables};

/// Change each chosen number of diagnose, and count the cases with another verdict.
#[derive(Debug, Args)]
#[command(after_help = "Example: joulepath blind sensitivity cases --count 20 --by 1.5")]
pub(super) struct SensitivityArgs {
    /// The folder that `blind generate` wrote.
    #[arg(value_name = "DIR")]
    cases: PathBuf,

    /// Number of cases, from the first one.
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=9999))]
    count: u32,

    /// Factor by which each number is divided, then multiplied.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.5)]
    by: f64,

    /// How the result is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,

    /// No progress on standard error.
    #[arg(long, short)]
    quiet: bool,
}

/// What changes with one number.
#[derive(Serialize)]
struct Row {
    name: &'static str,
    value: f64,
    unit: &'static str,
    origin: &'static str,
    /// Cases with another verdict if it is less.
    less: usize,
    /// Cases with another verdict if it is more.
    more: usize,
}

pub(super) fn run(args: &SensitivityArgs) -> anyhow::Result<ExitCode> {
    if !(args.by.is_finite() && args.by > 1.0) {
        bail!("--by {}: give a factor above 1", args.by);
    }
    let labels = labels(&args.cases)?;
    let chosen = labels.iter().take(args.count as usize);
    let cases: Vec<PathBuf> = chosen.map(|label| args.cases.join(&label.case)).collect();
    let length = cases.len() * (1 + 2 * Tunables::ALL.len());
    let progress = common::progress(args.quiet, Some(length as u64));
    let all = |tunables: &Tunables| -> anyhow::Result<Vec<Value>> {
        let one = |case: &PathBuf| {
            let said = said(case, tunables);
            progress.inc(1);
            said
        };
        cases.par_iter().map(one).collect()
    };
    let before = all(&Tunables::DEFAULT)?;
    let changed = |of: &Tunable, factor: f64| -> anyhow::Result<usize> {
        let mut tunables = Tunables::DEFAULT;
        *(of.of)(&mut tunables) *= factor;
        let after = all(&tunables)?;
        Ok(before.iter().zip(&after).filter(|(a, b)| a != b).count())
    };
    let row = |of: &Tunable| -> anyhow::Result<Row> {
        Ok(Row {
            name: of.name,
            value: *(of.of)(&mut Tunables::DEFAULT.clone()),
            unit: of.unit,
            origin: of.origin,
            less: changed(of, args.by.recip())?,
            more: changed(of, args.by)?,
        })
    };
    let rows: Vec<Row> = Tunables::ALL.iter().map(row).collect::<Result<_, _>>()?;
    progress.finish_and_clear();
    common::print(args.format, || serde_json::json!(rows), || table(&rows, cases.len(), args.by))
}

/// The verdict on a case, with the effects and their joints.
fn said(case: &Path, tunables: &Tunables) -> anyhow::Result<Value> {
    let found = diagnose::case_with(case, &options(case)?, tunables)?;
    let effects = found["effects"].as_array().into_iter().flatten();
    let effects: Vec<Value> =
        effects.map(|of| serde_json::json!([of["id"], of["joints"]])).collect();
    Ok(serde_json::json!([found["verdict"], effects]))
}

fn table(rows: &[Row], cases: usize, by: f64) -> String {
    let mut text = format!("of {cases} cases, with another verdict if the number is\n");
    let _ = writeln!(text, "{:<20}{:>12} {:<6}{:>8}{:>8}  from", "", "", "", "less", "more");
    for Row { name, value, unit, origin, less, more } in rows {
        let _ = writeln!(text, "{name:<20}{value:>12} {unit:<6}{less:>8}{more:>8}  {origin}");
    }
    let _ = writeln!(text, "less: divided by {by}; more: multiplied by it");
    text
}
