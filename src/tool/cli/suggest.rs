//! `joulepath optimize --suggest` and `--apply`: changes that a person has to approve.

use std::process::ExitCode;

use anyhow::bail;

use super::common::{self, Format, Job, ProgramArgs};
use crate::arm::robot::{Use, ready};
use crate::tool::report::suggestions::{self as report, Shown};
use crate::tool::suggest::{Applied, Suggestions, suggestions};

/// The word for all suggestions.
const ALL: &str = "all";

/// Lists the suggestions.
pub(super) fn list(args: &ProgramArgs, job: &Job) -> anyhow::Result<ExitCode> {
    let hours_per_year = common::hours_per_year(job.config.hours_per_year)?;
    let found = found(args, job)?;
    common::notes(args.cell.quiet, &found.notes);
    let sources = job.sources();
    let of = Shown { found: &found, hours_per_year, files: &sources };
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
    let found = found(args, job)?;
    let count = found.all.len();
    let numbers: Vec<usize> = if numbers.eq_ignore_ascii_case(ALL) {
        (0..count).collect()
    } else {
        let number = |text: &str| {
            let number = text.trim().parse::<usize>().ok().filter(|n| (1..=count).contains(n));
            number.map(|n| n - 1).ok_or_else(|| text.trim().to_owned())
        };
        match numbers.split(',').map(number).collect() {
            Ok(numbers) => numbers,
            Err(text) => bail!(
                "--apply {text}: give numbers of suggestions from 1 to {count}, or {ALL}; \
                 joulepath optimize --suggest lists them"
            ),
        }
    };
    let applied = found.applied(job.cell(), &numbers);
    if args.format == Format::Text {
        common::note(args.cell.quiet, &report::applied_text(&applied));
    }
    Ok(applied)
}

fn found(args: &ProgramArgs, job: &Job) -> anyhow::Result<Suggestions> {
    ready(&job.model, Use::Optimize)?;
    let bar = common::progress(args.cell.quiet, None);
    let all = suggestions(job.cell(), args.point_estimate, &|done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    });
    bar.finish_and_clear();
    Ok(all?)
}
