//! `joulepath blind`: the sealed examination of `diagnose`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::{Args, Subcommand};
use indicatif::{ProgressBar, ProgressDrawTarget};
use rayon::prelude::*;

use super::{common, output};
use crate::blind::{self, Case, KEY, SEALS, Settings};

/// The sealed examination of diagnose: generate cases, grade what was said of them.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: joulepath blind generate --out cases --seed 7 --count 20\n         \
    joulepath blind grade cases --format json"
)]
pub struct BlindArgs {
    #[command(subcommand)]
    command: BlindCommand,
}

#[derive(Debug, Subcommand)]
enum BlindCommand {
    Generate(GenerateArgs),
}

/// Write cases: nominal models with logs, the truth sealed beside them.
#[derive(Debug, Args)]
#[command(after_help = "Example: joulepath blind generate --out cases --seed 7 --count 20")]
struct GenerateArgs {
    /// A folder that does not exist yet or has no cases.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,

    /// The same seed gives the same bytes.
    #[arg(long, value_name = "N")]
    seed: u64,

    /// Number of cases.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..=9999))]
    count: u32,

    /// Periods in each log.
    #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u32).range(2..=100))]
    cycles: u32,

    /// Length of a period, s.
    #[arg(long, value_name = "S", default_value_t = 10.0)]
    period: f64,

    /// No notes and no progress on standard error.
    #[arg(long, short)]
    quiet: bool,
}

/// Periods that the generator's motions can have \[s\].
const PERIODS_S: [f64; 2] = [2.0, 60.0];

/// Runs the command.
///
/// # Errors
/// Cases that can't be written or read, seals that don't fit.
pub fn run(args: &BlindArgs) -> anyhow::Result<ExitCode> {
    match &args.command {
        BlindCommand::Generate(args) => generate(args),
    }
}

fn generate(args: &GenerateArgs) -> anyhow::Result<ExitCode> {
    let out = &args.out;
    if !(PERIODS_S[0]..=PERIODS_S[1]).contains(&args.period) {
        bail!("--period {}: give {} to {} s", args.period, PERIODS_S[0], PERIODS_S[1]);
    }
    if out.join(KEY).exists() || out.join(SEALS).exists() {
        bail!(
            "'{}' has cases with seals already; name a new folder with --out, or remove that one",
            out.display()
        );
    }
    let settings = Settings {
        seed: args.seed,
        cycles: args.cycles as usize,
        // Whole rows of a log.
        period_s: (args.period * 10.0).round() / 10.0,
    };
    let progress = progress(u64::from(args.count), args.quiet);
    let labels: anyhow::Result<Vec<_>> = (1..=args.count as usize)
        .into_par_iter()
        .map(|number| {
            let case = blind::case(&settings, number)
                .context("the catalogue has none of the robots of the examination")?;
            write_case(out, &case)?;
            progress.inc(1);
            Ok((case.label, case.salt))
        })
        .collect();
    let sealed = blind::seal(&labels?)?;
    output::write(&out.join(KEY), sealed.key.as_bytes())?;
    output::write(&out.join(SEALS), sealed.seals.as_bytes())?;
    progress.finish_and_clear();
    let text = format!("{} cases in '{}', the truth sealed in {KEY}", args.count, out.display());
    common::note(args.quiet, &text);
    Ok(ExitCode::SUCCESS)
}

fn write_case(out: &Path, case: &Case) -> anyhow::Result<()> {
    let folder = out.join(&case.name);
    let files: Vec<(PathBuf, &[u8])> =
        case.files.iter().map(|(name, text)| (PathBuf::from(name), text.as_bytes())).collect();
    output::write_folder(&folder, &files)
}

fn progress(count: u64, quiet: bool) -> ProgressBar {
    let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    ProgressBar::with_draw_target(Some(count), target)
}
