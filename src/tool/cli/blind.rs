//! `joulepath blind`: the sealed examination of `diagnose`.

mod calibrate;
mod cases;
mod family;
mod inject;
mod sensitivity;

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::{Args, Subcommand, ValueEnum};
use serde_json::json;

use self::cases::{diagnosis_of_case, known_diagnosis, labels, write_cases};
use self::family::family;
use super::common::{self, Format};
use super::output;
use crate::examine::blind::{self, Asked, FAMILY, Grades, KEY, Label, SEALS, Settings};
use crate::examine::worlds::{self, World};
use crate::tool::report::html::grades_report;

/// The sealed examination of diagnose: generate cases, grade their diagnoses.
#[derive(Debug, Args)]
#[command(
    after_help = "Example: joulepath blind generate --out cases --seed 7 --count 20\n         \
    joulepath blind grade cases --format json"
)]
pub(super) struct BlindArgs {
    #[command(subcommand)]
    command: BlindCommand,
}

#[derive(Debug, Subcommand)]
enum BlindCommand {
    Generate(GenerateArgs),
    Inject(inject::InjectArgs),
    Grade(GradeArgs),
    Calibrate(calibrate::CalibrateArgs),
    Sensitivity(sensitivity::SensitivityArgs),
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

    /// Another simulator, with robots, motions and logs of its own.
    #[arg(long, value_enum, ignore_case = true, conflicts_with_all = ["cycles", "period"])]
    world: Option<WorldArg>,

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

/// A simulator that shares no formula with the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum WorldArg {
    /// States of friction and gears along a prescribed motion of the links.
    #[value(name = "A")]
    A,
    /// Closed loop of forward dynamics and controller.
    #[value(name = "B")]
    B,
    /// Motors in electrical quantities; coupled wrists.
    #[value(name = "C")]
    C,
}

/// Open the seals and grade the diagnoses of the cases.
#[derive(Debug, Args)]
#[command(after_help = "Example: joulepath blind grade cases --results diagnoses --format json")]
struct GradeArgs {
    /// The folder that `blind generate` wrote.
    #[arg(value_name = "DIR")]
    cases: PathBuf,

    /// Where the diagnoses are, as case-0001/diagnosis.json; otherwise beside the logs.
    #[arg(long, value_name = "DIR")]
    results: Option<PathBuf>,

    /// An effect that the library is without: only its cases are graded, and not to know is
    /// right. `family`: each case with one effect of the torque, without all of its family.
    #[arg(long, value_name = "EFFECT|family")]
    leave_out: Option<String>,

    /// A page with the confusion, the rates and what probabilities are worth.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,

    /// How the result is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// Permitted periods of the generated motions \[s\].
const PERIODS_S: [f64; 2] = [2.0, 60.0];

pub(super) fn run(args: &BlindArgs) -> anyhow::Result<ExitCode> {
    match &args.command {
        BlindCommand::Generate(args) => generate(args),
        BlindCommand::Inject(args) => inject::run(args),
        BlindCommand::Grade(args) => grade(args),
        BlindCommand::Calibrate(args) => calibrate::run(args),
        BlindCommand::Sensitivity(args) => sensitivity::run(args),
    }
}

fn generate(args: &GenerateArgs) -> anyhow::Result<ExitCode> {
    let out = &args.out;
    if let Some(world) = args.world {
        let world = match world {
            WorldArg::A => World::A,
            WorldArg::B => World::B,
            WorldArg::C => World::C,
        };
        return write_cases(out, args.count, args.quiet, |number| {
            Ok(worlds::case(world, args.seed, number))
        });
    }
    if !(PERIODS_S[0]..=PERIODS_S[1]).contains(&args.period) {
        bail!("--period {}: give {} to {} s", args.period, PERIODS_S[0], PERIODS_S[1]);
    }
    let settings = Settings {
        cycles: args.cycles as usize,
        // A whole number of log rows.
        period_s: (args.period * 10.0).round() / 10.0,
        ..Settings::new(args.seed)
    };
    write_cases(out, args.count, args.quiet, |number| {
        blind::case(&settings, number)
            .context("the catalogue has none of the robots of the examination")
    })
}

fn grade(args: &GradeArgs) -> anyhow::Result<ExitCode> {
    let labels = labels(&args.cases)?;
    let folders = labels.iter().filter_map(|label| fs::read_dir(args.cases.join(&label.case)).ok());
    let files = folders.flatten().flatten().map(|entry| entry.path());
    let read_files: Vec<PathBuf> =
        files.chain([KEY, SEALS].map(|name| args.cases.join(name))).collect();
    output::refuse_inputs(
        &[("--report", args.report.as_ref())],
        read_files.iter().map(PathBuf::as_path),
    )?;
    if let Some(id) = &args.leave_out
        && !labels.iter().any(|label| blind::is_of(label, id))
    {
        bail!(
            "--leave-out {id}: no case has this effect alone; name one that the examination has, or \
             {FAMILY}"
        );
    }
    let (mut graded, mut diagnoses) = (Vec::new(), Vec::new());
    for label in &labels {
        let without = without(label, args.leave_out.as_deref());
        if args.leave_out.is_some() && without.is_empty() {
            continue;
        }
        // Results of the user are expected to lack the effects that are left out.
        let (beside, name) = match (&args.results, &args.leave_out) {
            (Some(results), _) => (results, "diagnosis.json".to_owned()),
            (None, None) => (&args.cases, "diagnosis.json".to_owned()),
            (None, Some(id)) => (&args.cases, format!("diagnosis-without-{id}.json")),
        };
        let path = beside.join(&label.case).join(&name);
        diagnoses.push(if path.exists() {
            known_diagnosis(&path)?
        } else {
            diagnosis_of_case(&args.cases.join(&label.case), &name, &without)?
        });
        graded.push(label.clone());
    }
    let grades = blind::grade(&graded, &diagnoses, args.leave_out.as_deref())?;
    if let Some(path) = &args.report {
        let page = grades_report(&grades)?;
        output::write(path, page.as_bytes()).with_context(|| path.display().to_string())?;
    }
    common::print(args.format, || json!(grades), || table(&grades))
}

/// The effects that are left out for a case; empty if the case is not graded.
fn without<'a>(label: &'a Label, left_out: Option<&'a str>) -> Vec<&'a str> {
    match left_out {
        Some(id) if !blind::is_of(label, id) => Vec::new(),
        Some(FAMILY) => label.effects.iter().flat_map(|of| family(&of.id)).copied().collect(),
        Some(id) => vec![id],
        None => Vec::new(),
    }
}

fn table(grades: &Grades) -> String {
    let mut text = format!("{} cases", grades.cases);
    if grades.undetectable > 0 {
        let _ = write!(
            text,
            ", {} show too little of their effects to be asked for",
            grades.undetectable
        );
    }
    text.push_str("\n\n");
    let mut columns: Vec<&str> =
        grades.confusion.values().flat_map(|row| row.keys().copied()).collect();
    columns.sort_unstable();
    columns.dedup();
    let title = |name: &&str| format!("{name:>16}");
    let names: String = columns.iter().map(title).collect();
    let _ = writeln!(text, "{:<22}{names}", "truth");
    for (truth, row) in &grades.confusion {
        let count = |column: &&str| format!("{:>16}", row.get(column).copied().unwrap_or(0));
        let _ = writeln!(text, "{truth:<22}{}", columns.iter().map(count).collect::<String>());
    }
    text.push_str("\nrate                          of      %   95 % interval   asked\n");
    for rate in &grades.rates {
        let (sign, asked) = match rate.asked {
            Asked::AtMost(most) => ("<=", most),
            Asked::AtLeast(least) => (">=", least),
        };
        let percent = rate.rate.map_or_else(|| "-".into(), |rate| format!("{:.1}", 100.0 * rate));
        let verdict = match rate.met() {
            Some(true) => "met",
            Some(false) => "missed",
            None => "no cases",
        };
        let _ = writeln!(
            text,
            "{:<26}{:>4}/{:<4}{percent:>6}   {:>5.1} to {:>5.1}   {sign} {:.0} {verdict}",
            rate.name,
            rate.hits,
            rate.of,
            100.0 * rate.low,
            100.0 * rate.high,
            100.0 * asked,
        );
    }
    text.push_str("\nstated probability   mean   there\n");
    for bin in grades.reliability.iter().filter(|bin| bin.of > 0) {
        let _ = writeln!(
            text,
            "{:>6.2} to {:<6.2}     {:>6.3}   {}/{}",
            bin.from, bin.to, bin.stated, bin.hits, bin.of
        );
    }
    if let Some(share) = grades.shrink_of_oracle {
        let _ = writeln!(text, "\nclaimed shrink over an oracle's, median: {share:.2}");
    }
    for wrong in &grades.wrong {
        let _ = writeln!(text, "{}: {} taken for {}", wrong.case, wrong.truth, wrong.said);
    }
    text
}
