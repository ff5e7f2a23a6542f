//! `joulepath optimize --suggest` and `--apply`: changes that a person has to approve.

use std::process::ExitCode;

use anyhow::bail;

use super::common::{self, Format, Job, ProgramArgs};
use crate::arm::robot::{Use, ready};
use crate::retime::energy::account;
use crate::retime::motion::simulate;
use crate::tool::report::suggestions::{self as report, Suggestions};
use crate::tool::retrofit::read_program;
use crate::tool::suggest::{Applied, Cell, Suggestion, applied, suggestions};

/// Hours in which a cell works in a year, unless the configuration says otherwise: two shifts.
const HOURS_PER_YEAR: f64 = 4000.0;
/// The word for all suggestions.
const ALL: &str = "all";

/// Lists the suggestions.
pub(super) fn list(args: &ProgramArgs, job: &Job) -> anyhow::Result<ExitCode> {
    let all = found(args, job)?;
    let hours_per_year = job.config.hours_per_year.unwrap_or(HOURS_PER_YEAR);
    if !(hours_per_year > 0.0 && hours_per_year <= 8784.0) {
        bail!("hours_per_year = {hours_per_year}: give hours above 0, at most those of a year");
    }
    let (program, entry) = read_program(&job.files, &job.entry)?;
    let simulation = simulate(&program, entry, &job.model, &job.options);
    let sources = job.sources();
    let of = Suggestions {
        all: &all,
        cycle_s: simulation.cycle_s,
        energy: account(&job.model, &simulation).total,
        hours_per_year,
        files: &sources,
    };
    common::note(
        args.cell.quiet,
        &format!(
            "a year has {hours_per_year:.0} h of this cycle (hours_per_year in joulepath.toml)"
        ),
    );
    common::print(args.format, || report::json(of), || report::text(of))
}

/// Applies suggestions by their numbers.
pub(super) fn apply(args: &ProgramArgs, job: &Job, numbers: &str) -> anyhow::Result<Applied> {
    let all = found(args, job)?;
    let numbers: Vec<usize> = if numbers.eq_ignore_ascii_case(ALL) {
        (0..all.len()).collect()
    } else {
        let number = |text: &str| {
            let number = text.trim().parse::<usize>().ok().filter(|n| (1..=all.len()).contains(n));
            number.map(|n| n - 1).ok_or_else(|| text.trim().to_owned())
        };
        match numbers.split(',').map(number).collect() {
            Ok(numbers) => numbers,
            Err(text) => bail!(
                "--apply {text}: give numbers of suggestions from 1 to {}, or {ALL}; \
                 joulepath optimize --suggest lists them",
                all.len()
            ),
        }
    };
    let applied = applied(cell(job), &all, &numbers)?;
    if args.format == Format::Text {
        common::note(args.cell.quiet, &report::applied_text(&applied));
    }
    Ok(applied)
}

fn found(args: &ProgramArgs, job: &Job) -> anyhow::Result<Vec<Suggestion>> {
    ready(&job.model, Use::Optimize)?;
    let bar = common::progress(args.cell.quiet, None);
    let all = suggestions(cell(job), args.point_estimate, &|done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    });
    bar.finish_and_clear();
    Ok(all?)
}

fn cell(job: &Job) -> Cell<'_> {
    Cell { files: &job.files, entry: &job.entry, model: &job.model, options: &job.options }
}
