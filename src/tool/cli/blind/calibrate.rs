//! `joulepath blind calibrate`: how often effects are there that `diagnose` names.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::bail;
use clap::Args;
use rayon::prelude::*;

use super::super::common::{self, Format};
use super::super::output;
use super::cases::{diagnosis_of_case, known_diagnosis, labels};
use crate::examine::blind::{self, Stated};
use crate::gap::Calibration;

/// Count in sealed cases how often effects are there that diagnose asserts or considers.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: joulepath blind calibrate cases other --out src/gap/decision/calibration.json"
)]
pub(super) struct CalibrateArgs {
    /// Folders that `blind generate` wrote, of development cases.
    #[arg(value_name = "DIR", required = true)]
    cases: Vec<PathBuf>,

    /// Where the counts come from, such as "world A, seeds 1 to 3".
    #[arg(long, value_name = "TEXT")]
    origin: String,

    /// Where the counts go, JSON; otherwise standard output.
    #[arg(long, value_name = "FILE.json")]
    out: Option<PathBuf>,

    /// No progress on standard error.
    #[arg(long, short)]
    quiet: bool,
}

/// Diagnoses that are there already are used.
const DIAGNOSIS: &str = "diagnosis.json";

pub(super) fn run(args: &CalibrateArgs) -> anyhow::Result<ExitCode> {
    let mut all = Vec::new();
    for folder in &args.cases {
        all.extend(labels(folder)?.into_iter().map(|label| (folder.join(&label.case), label)));
    }
    if all.is_empty() {
        bail!("the folders have no cases; name those that joulepath blind generate wrote");
    }
    let progress = common::progress(args.quiet, Some(all.len() as u64));
    let one = |(case, label): &(PathBuf, blind::Label)| -> anyhow::Result<Vec<Stated>> {
        let known = case.join(DIAGNOSIS);
        let found = if known.exists() {
            known_diagnosis(&known)?
        } else {
            diagnosis_of_case(case, DIAGNOSIS, &[])?
        };
        progress.inc(1);
        Ok(blind::stated(label, &found)?)
    };
    let stated: Vec<Vec<Stated>> = all.par_iter().map(one).collect::<anyhow::Result<_>>()?;
    progress.finish_and_clear();
    let of = |is_asserted: bool| -> Vec<(f64, bool)> {
        let all = stated.iter().flatten().filter(|of| of.is_asserted == is_asserted);
        all.map(|of| (of.evidence, of.is_there)).collect()
    };
    let counted = Calibration::counted(args.origin.clone(), all.len(), [&of(true), &of(false)]);
    let text = format!("{}\n", serde_json::to_string_pretty(&counted)?);
    if let Some(path) = &args.out {
        output::write(path, text.as_bytes())?;
        return Ok(ExitCode::SUCCESS);
    }
    common::print(Format::Json, || serde_json::json!(counted), String::new)
}
