//! `joulepath lint`: wasted energy in RAPID programs.

mod cache;

use std::fs;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::{Args, ValueEnum};
use serde::Serialize;
use similar::TextDiff;

use self::cache::Cache;
use super::backup::{self, is_shared};
use super::common::{self, CellArgs, note};
use super::input::{self, Input};
use super::output;
use crate::arm::effects;
use crate::arm::robot::Model;
use crate::rapid::diagnostics::Paint;
use crate::rapid::text::{FileId, SourceFile, is_encoded_module};
use crate::tool::config::Config;
use crate::tool::lint::{self, Applicability, Fixed, Group, Programs, Report, Settings, System};
use crate::tool::report;
use crate::tool::report::lint::top::Year;

/// Entries of the list of things to fix first, unless `--top` says otherwise.
const TOP: usize = 10;
/// Price of a kilowatt hour for industry in euros, rounded, unless `--price` says otherwise.
const PRICE: f64 = 0.2;

/// Find wasted energy in RAPID programs.
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of the command line")]
#[derive(Debug, Default, Args)]
#[command(
    after_help = "Without --robot, only rules that need no robot run, and findings have no joules. \
    joulepath rule CODE explains a finding; a comment `! joulepath: ignore CODE reason` takes one \
    back.\n\nExit codes: 0, 1 where more is wasted than --max-waste allows, 2 where nothing can \
    be read.\n\nExample: joulepath lint fixtures/pick_place --robot IRB1600-10/1.45"
)]
pub(super) struct LintArgs {
    /// What is run, and where.
    #[command(flatten)]
    pub(super) cell: CellArgs,

    /// Only these rules: codes, starts of codes, names or families.
    #[arg(long, value_name = "RULES", value_delimiter = ',')]
    pub(super) select: Vec<String>,

    /// Not these rules.
    #[arg(long, value_name = "RULES", value_delimiter = ',')]
    pub(super) ignore: Vec<String>,

    /// Least saving that is reported, J.
    #[arg(long, value_name = "JOULES", allow_negative_numbers = true)]
    pub(super) threshold: Option<f64>,

    /// How the result is written.
    #[arg(long, value_enum, default_value_t = LintFormat::Full)]
    pub(super) format: LintFormat,

    /// Apply safe fixes in place.
    #[arg(long)]
    pub(super) fix: bool,

    /// Apply unsafe fixes too.
    #[arg(long)]
    pub(super) unsafe_fixes: bool,

    /// Print what the fixes would change as a unified diff, and write nothing.
    #[arg(long)]
    pub(super) diff: bool,

    /// Count findings by rule, on standard error.
    #[arg(long)]
    pub(super) statistics: bool,

    /// Most entries of the list of things to fix first.
    #[arg(long, value_name = "N", default_value_t = TOP)]
    pub(super) top: usize,

    /// Hours in which the cell works in a year; otherwise those of joulepath.toml, or 4000.
    #[arg(long, value_name = "HOURS", allow_negative_numbers = true)]
    pub(super) hours: Option<f64>,

    /// Price of a kilowatt hour, in any currency.
    #[arg(long, value_name = "PRICE", default_value_t = PRICE, allow_negative_numbers = true)]
    pub(super) price: f64,

    /// Exit with 1 where the findings waste more: 500J, or 3% of the cycle.
    #[arg(long, value_name = "500J|3%", allow_hyphen_values = true)]
    pub(super) max_waste: Option<String>,

    /// Keep the findings in a folder, and lint only changed programs. The folder can be deleted at any time.
    #[arg(
        long,
        value_name = "FOLDER",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = ".joulepath_cache"
    )]
    pub(super) cache: Option<PathBuf>,

    /// A file of known findings, which are not reported.
    #[arg(long, value_name = "FILE")]
    pub(super) baseline: Option<PathBuf>,

    /// Write all findings into a baseline.
    #[arg(long, value_name = "FILE")]
    pub(super) write_baseline: Option<PathBuf>,
}

/// Forms of the result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum LintFormat {
    /// With the source.
    #[default]
    Full,
    /// One line each.
    Concise,
    /// For programs.
    Json,
    /// For code scanning.
    Sarif,
    /// Commands of a GitHub workflow.
    Github,
    /// A Code Quality report of GitLab.
    Gitlab,
    /// A test report.
    Junit,
}

pub(super) fn run(args: &LintArgs) -> anyhow::Result<ExitCode> {
    let mut setup = Setup::new(args)?;
    let read = setup.programs.files.iter().map(|file| Path::new(&file.path));
    let named = common::named_paths(&args.cell);
    let robot = setup.programs.model.as_ref().and_then(|model| model.file.as_deref());
    output::refuse_inputs(
        &[("--write-baseline", args.write_baseline.as_ref())],
        read.chain(robot.map(Path::new)).chain(named.iter().map(PathBuf::as_path)),
    )?;
    let mut report = if args.fix || args.unsafe_fixes || args.diff {
        let report = fix(args, &mut setup.programs)?;
        if args.diff {
            return Ok(ExitCode::SUCCESS);
        }
        report
    } else {
        lint_again(args, &setup.programs)
    };
    note_syntax_errors(args, &setup.programs.files, &report);
    if let Some(path) = &args.write_baseline {
        let prints = report::lint::fingerprints(&report.findings, &setup.programs.files);
        let text = serde_json::to_string_pretty(&prints)? + "\n";
        output::write(path, text.as_bytes())?;
    }
    if let Some(path) = &setup.baseline {
        drop_known(&mut report, &setup.programs.files, path)?;
    }
    write(args, &setup, &report)?;
    over_limit(&setup, &report)
}

/// The report of all programs, with a cache only of the changed ones.
fn lint_again(args: &LintArgs, programs: &Programs) -> Report {
    let job = programs.job();
    match args.cache.as_deref().map(Cache::open) {
        Some(Ok(cache)) => return lint::lint_changed(&job, &cache),
        Some(Err(error)) => note(args.cell.quiet, &format!("{error:#}: there is no cache")),
        None => {}
    }
    lint::lint(&job)
}

/// What cannot be read is not linted: the first error of each file is shown.
fn note_syntax_errors(args: &LintArgs, files: &[SourceFile], report: &Report) {
    for (file, errors) in &report.syntax_errors {
        let (file, first) = (&files[*file], &errors[0]);
        let line = file.position(first.start).line;
        let more = match errors.len() - 1 {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let text = format!(
            "{}:{line}: {}{more}: statements with syntax errors are not linted; joulepath parse {} \
             shows all syntax errors",
            file.path, first.message, file.path
        );
        note(args.cell.quiet, &text);
    }
}

/// Applies fixes and reports the remaining findings.
fn fix(args: &LintArgs, programs: &mut Programs) -> anyhow::Result<Report> {
    if programs.model.is_none() {
        note(args.cell.quiet, "without a robot no fix can be tried: only comments are fixed");
    }
    let most = if args.unsafe_fixes { Applicability::Unsafe } else { Applicability::Safe };
    let Fixed { files, applied, withdrawn, report } = lint::fix(&programs.job(), most);
    let pairs = || programs.files.iter().zip(&files).filter(|(old, new)| old.bytes != new.bytes);
    if args.diff {
        let mut out = std::io::stdout().lock();
        for (old, new) in pairs() {
            let text = |file: &SourceFile| file.charset.decode(&file.bytes).into_owned();
            let (before, after) = (text(old), text(new));
            let diff = TextDiff::from_lines(&before, &after);
            let (from, to) = (format!("a/{}", old.path), format!("b/{}", old.path));
            write!(out, "{}", diff.unified_diff().header(&from, &to))?;
        }
        return Ok(report);
    }
    output::write_all(pairs().map(|(old, new)| (&old.path, new.stored(&new.bytes))))?;
    note(args.cell.quiet, &format!("{applied} fixes applied, {withdrawn} taken back"));
    programs.files = files;
    Ok(report)
}

/// The input of a lint run.
pub(super) struct Setup {
    pub(super) programs: Programs,
    baseline: Option<PathBuf>,
    max_waste: Option<Limit>,
    year: Year,
}

impl Setup {
    /// Reads files, configuration and robot.
    pub(super) fn new(args: &LintArgs) -> anyhow::Result<Setup> {
        let input = input::read(&args.cell.paths)?;
        common::note_unreadable(args.cell.quiet, &input);
        for file in input.files.iter().filter(|file| is_encoded_module(&file.source.bytes)) {
            let path = &file.source.path;
            note(args.cell.quiet, &format!("'{path}' is an encoded module: nothing in it is seen"));
        }
        let cell = &args.cell;
        let (config, folder) = common::configuration(cell)?;
        let model = robot(cell, &config, &folder, &input)?;
        let (options, _) = common::simulation_options(cell, &config, model.as_ref())?;
        let mut files: Vec<SourceFile> =
            input.files.iter().map(|file| file.source.clone()).collect();
        let groups = groups(args, &config, &input, &mut files);
        let settings = settings(args, &config)?;
        let beside = |name: &String| folder.join(name);
        let baseline = args.baseline.clone().or_else(|| config.lint.baseline.as_ref().map(beside));
        let limit = args.max_waste.as_ref().or(config.lint.max_waste.as_ref());
        let max_waste = limit.map(|text| Limit::parse(text)).transpose()?;
        let hours = common::hours_per_year(args.hours.or(config.hours_per_year))?;
        let price = args.price;
        if !(price.is_finite() && price >= 0.0) {
            bail!("--price {price}: give a price from 0");
        }
        let year = Year { count: args.top, hours, price };
        let programs = Programs { files, groups, model, options, settings };
        Ok(Setup { programs, baseline, max_waste, year })
    }
}

fn settings(args: &LintArgs, config: &Config) -> anyhow::Result<Settings> {
    let mut settings = config.lint.settings();
    if !args.select.is_empty() {
        settings.select.clone_from(&args.select);
    }
    settings.ignore.extend(args.ignore.iter().cloned());
    if let Some(threshold) = args.threshold {
        settings.threshold_j = threshold;
    }
    let ignored = settings.per_file_ignores.values().flatten();
    let weighed = settings.thresholds_j.keys();
    for selector in settings.select.iter().chain(&settings.ignore).chain(ignored).chain(weighed) {
        if !lint::ALL.iter().any(|rule| rule.is_meant(selector)) {
            bail!(
                "'{selector}' selects no lint: give a code such as EW101, the start of one, a name or \
                 a family; joulepath rule lists them"
            );
        }
    }
    let thresholds = settings.thresholds_j.values().chain([&settings.threshold_j]);
    if let Some(wrong) = thresholds.into_iter().find(|t| !(t.is_finite() && **t >= 0.0)) {
        bail!("a threshold of {wrong} J: give joules from 0");
    }
    Ok(settings)
}

/// The robot, if named; the robot of a backup only if it is in the catalogue.
fn robot(
    args: &CellArgs,
    config: &Config,
    folder: &Path,
    input: &Input,
) -> anyhow::Result<Option<Model>> {
    let model = if let Some(name) = common::robot_name(args, config, folder) {
        Some(effects::load_estimated(&name)?)
    } else {
        let named = input.backups.iter().find_map(|(root, backup)| {
            let name = backup.tasks.iter().find_map(|task| task.robot.clone())?;
            Some((root, effects::load_estimated(&name).ok()?))
        });
        named.map(|(root, model)| common::with_backup_configuration(root, model, args.quiet))
    };
    let Some(model) = model else { return Ok(None) };
    common::require_six_joints(&model, common::RUN_SIX_JOINTS)?;
    Ok(Some(model))
}

/// Groups of files: those of one task with the shared ones, and the rest.
fn groups(
    args: &LintArgs,
    config: &Config,
    input: &Input,
    files: &mut Vec<SourceFile>,
) -> Vec<Group> {
    let stated = args.cell.entry.clone().or_else(|| config.entry.clone());
    let entry_of =
        |of_task: Option<String>| stated.clone().or(of_task).unwrap_or_else(|| "main".to_owned());
    let places =
        || input.files.iter().enumerate().filter_map(|(i, f)| Some((i, f.place.as_ref()?)));
    let mut tasks: Vec<(usize, &str)> = Vec::new();
    for (_, place) in places() {
        let task = (place.backup, place.folder.as_str());
        if !is_shared(&place.folder) && !tasks.contains(&task) {
            tasks.push(task);
        }
    }
    let mut groups = Vec::new();
    for (index, folder) in &tasks {
        let (root, backup) = &input.backups[*index];
        let task = backup.tasks.iter().find(|task| task.folder == *folder);
        let own = places().filter(|(_, place)| {
            place.backup == *index && (place.folder == *folder || is_shared(&place.folder))
        });
        groups.push(Group {
            files: own.map(|(file, _)| file).collect(),
            entry: entry_of(task.and_then(|task| task.entry.clone())),
            system: Some(system(root, files)),
        });
    }
    let rest = input.files.iter().enumerate().filter(|(_, file)| {
        file.place.as_ref().is_none_or(|place| {
            is_shared(&place.folder) && !tasks.iter().any(|(index, _)| *index == place.backup)
        })
    });
    let rest: Vec<usize> = rest.map(|(file, _)| file).collect();
    if !rest.is_empty() {
        groups.push(Group { files: rest, entry: entry_of(None), system: None });
    }
    groups
}

/// The controller description of a backup; its `EIO.cfg` is added to the files.
fn system(root: &Path, files: &mut Vec<SourceFile>) -> System {
    let motion = backup::motion_configuration(root).and_then(|path| fs::read(path).ok());
    let motion = motion.map(|bytes| crate::rapid::text::decode(&bytes).text);
    let path = backup::child(root, "SYSPAR").and_then(|folder| backup::child(&folder, "EIO.cfg"));
    let read = path.and_then(|path| Some((path.clone(), fs::read(path).ok()?)));
    let io = read.map(|(path, bytes)| {
        let path = path.display().to_string();
        if let Some(known) = files.iter().find(|file| file.path == path) {
            return known.id;
        }
        let id = FileId(files.len() as u32);
        files.push(SourceFile::new(id, path, bytes));
        id
    });
    System { io, motion }
}

/// The maximum waste.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Limit {
    /// J.
    Joules(f64),
    /// Share of the cycle's energy.
    Share(f64),
}

impl Limit {
    fn parse(text: &str) -> anyhow::Result<Limit> {
        let wrong = || format!("--max-waste {text}: give joules or a share, such as 500J or 3%");
        let trimmed = text.trim();
        let (number, limit): (&str, fn(f64) -> Limit) = match trimmed.strip_suffix('%') {
            Some(number) => (number, |x| Limit::Share(x / 100.0)),
            None => (trimmed.trim_end_matches(['J', 'j']), Limit::Joules),
        };
        let number: f64 = number.trim().parse().ok().with_context(wrong)?;
        if !number.is_finite() || number < 0.0 {
            bail!(wrong());
        }
        Ok(limit(number))
    }
}

fn over_limit(setup: &Setup, report: &Report) -> anyhow::Result<ExitCode> {
    let wasted = report.saving_j();
    let over = match (setup.max_waste, report.cycle_energy_j) {
        (None, _) => false,
        (Some(_), None) => {
            bail!(
                "--max-waste needs a cycle with joules: name a robot with dynamics, and a program \
                 with its entry"
            )
        }
        (Some(Limit::Joules(limit)), Some(_)) => wasted > limit,
        (Some(Limit::Share(limit)), Some(cycle)) => wasted > limit * cycle,
    };
    Ok(ExitCode::from(u8::from(over)))
}

/// Removes the findings of a baseline.
fn drop_known(report: &mut Report, files: &[SourceFile], path: &Path) -> anyhow::Result<()> {
    let shown = path.display();
    let text = fs::read_to_string(path).with_context(|| {
        format!("cannot read the baseline '{shown}'; --write-baseline {shown} makes one")
    })?;
    let known: Vec<String> = serde_json::from_str(&text).with_context(|| {
        format!("'{shown}' is no baseline; --write-baseline {shown} makes a new one")
    })?;
    let known: std::collections::BTreeSet<String> = known.into_iter().collect();
    let prints = report::lint::fingerprints(&report.findings, files);
    let mut prints = prints.iter();
    report.findings.retain(|_| prints.next().is_none_or(|print| !known.contains(print)));
    Ok(())
}

fn pretty(out: &mut impl Write, document: &impl Serialize) -> anyhow::Result<()> {
    serde_json::to_writer_pretty(&mut *out, document)?;
    Ok(writeln!(out)?)
}

fn write(args: &LintArgs, setup: &Setup, report: &Report) -> anyhow::Result<()> {
    let files = &setup.programs.files;
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    match args.format {
        LintFormat::Full => {
            let ansi = std::io::stdout().is_terminal();
            let paint = if ansi { Paint::Ansi } else { Paint::Plain };
            write!(out, "{}", report::lint::text::full(report, files, paint))?;
            write!(out, "{}", report::lint::top::text(report, files, &setup.year))?;
            write!(out, "{}", report::lint::text::summary(report))?;
        }
        LintFormat::Concise => write!(out, "{}", report::lint::text::concise(report, files))?,
        LintFormat::Json => {
            pretty(&mut out, &report::lint::json::json(report, files, &setup.year))?;
        }
        LintFormat::Sarif => pretty(&mut out, &report::lint::sarif::sarif(report, files))?,
        LintFormat::Github => write!(out, "{}", report::lint::github::github(report, files))?,
        LintFormat::Gitlab => pretty(&mut out, &report::lint::gitlab::gitlab(report, files))?,
        LintFormat::Junit => write!(out, "{}", report::lint::junit::junit(report, files))?,
    }
    out.flush()?;
    if args.statistics {
        write!(std::io::stderr().lock(), "{}", report::lint::text::statistics(report))?;
    }
    let alone = report.coverage.without_entry;
    if alone > 0 && setup.programs.model.is_some() {
        let text = format!(
            "{alone} programs lack the routine that starts them (--entry NAME): their procedures are \
             simulated one by one"
        );
        note(args.cell.quiet, &text);
    }
    let why = match &setup.programs.model {
        None => "no robot is named (--robot NAME)".to_owned(),
        Some(model) if !model.has_dynamics() => format!("{} has no dynamics", model.name),
        Some(_) if report.cycle_energy_j.is_none() => {
            "no file, or more than one, has the routine that starts a program (--entry NAME)"
                .to_owned()
        }
        Some(_) => return Ok(()),
    };
    note(args.cell.quiet, &format!("findings have no joules: {why}"));
    Ok(())
}
