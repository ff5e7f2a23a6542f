//! How much of the moving time of `fixtures/cells` becomes streams, and why the rest stays:
//! `cargo run --release --example reach`. `docs/reach.md` contains the table.
#![expect(clippy::unwrap_used, reason = "a failed set-up stops the example")]
#![expect(clippy::print_stdout, reason = "an example prints")]

#[path = "../tests/support/mod.rs"]
mod support;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use joulepath::retime::motion::Options;
use joulepath::tool::retrofit::{Figures, Retrofit, SegmentKind, Settings, retrofit};
use rayon::prelude::*;
use support::{irb1600, module_paths, read};

const FOLDER: &str = "fixtures/cells";

/// A program and the levels of its inputs.
struct Cell {
    paths: Vec<PathBuf>,
    levels: BTreeMap<String, f64>,
}

fn main() {
    let cells = cells();
    for (name, read_elsewhere) in [("default", None), ("--only-task", Some(BTreeSet::new()))] {
        let settings = Settings { read_elsewhere, ..Settings::default() };
        let results: Vec<Retrofit> =
            cells.par_iter().map(|cell| retrofitted(cell, &settings)).collect();
        println!("{name}, {} programs:", results.len());
        report(&results);
    }
}

/// The programs in the table of the README.
fn cells() -> Vec<Cell> {
    let readme = std::fs::read_to_string(Path::new(FOLDER).join("README.md")).unwrap();
    readme.lines().filter_map(cell).collect()
}

/// A row: program, what it does, style, options of the command line.
fn cell(row: &str) -> Option<Cell> {
    let columns: Vec<&str> = row.split('|').map(str::trim).collect();
    let [_, name, _, _, inputs, _] = columns.as_slice() else { return None };
    let name = name.strip_prefix('`')?.strip_suffix('`')?;
    let paths = match name.strip_suffix('/') {
        Some(folder) => module_paths(&format!("cells/{folder}")),
        None => vec![Path::new(FOLDER).join(format!("{name}.mod"))],
    };
    let levels = inputs.trim_matches('`').split("--assume ").filter_map(|option| {
        let (signal, level) = option.trim().split_once('=')?;
        Some((signal.to_lowercase(), level.parse().unwrap()))
    });
    Some(Cell { paths, levels: levels.collect() })
}

fn retrofitted(cell: &Cell, settings: &Settings) -> Retrofit {
    let options = Options { levels: cell.levels.clone(), ..Options::default() };
    let settings = Settings { options, ..settings.clone() };
    let result = retrofit(&read(&cell.paths), &irb1600(), &settings, &|_, _| ());
    let result = result.unwrap_or_else(|error| panic!("{:?}: {error}", cell.paths));
    assert!(result.verification.passed, "{:?}", cell.paths);
    result
}

fn report(results: &[Retrofit]) {
    let mut rewritten = 0.0;
    let mut stays: BTreeMap<&str, f64> = BTreeMap::new();
    let segments = results.iter().flat_map(|result| &result.segments);
    for segment in segments.filter(|segment| segment.kind != SegmentKind::Idle) {
        let share = segment.rewritten_executions as f64 / segment.executions.max(1) as f64;
        rewritten += share * segment.time_before_s;
        if let Some(reason) = &segment.reason {
            *stays.entry(reason.code()).or_default() += (1.0 - share) * segment.time_before_s;
        }
    }
    let all = rewritten + stays.values().sum::<f64>();
    println!(
        "  streams           {rewritten:7.1} s of {all:.1} s, {:.1} %",
        100.0 * rewritten / all
    );
    let mut stays: Vec<(&str, f64)> = stays.into_iter().filter(|(_, time)| *time > 0.05).collect();
    stays.sort_by(|a, b| b.1.total_cmp(&a.1));
    for (code, time) in stays {
        println!("  {code:17} {time:7.1} s, {:.1} %", 100.0 * time / all);
    }
    let saved = |energy: fn(&Figures) -> f64| {
        let sum = |figures: fn(&Retrofit) -> &Figures| -> f64 {
            results.iter().map(|result| energy(figures(result))).sum()
        };
        100.0 * (1.0 - sum(|result| &result.optimized) / sum(|result| &result.original))
    };
    println!(
        "  saved             {:.2} % of the motion energy, {:.2} % of all",
        saved(|it| it.motion_energy_j),
        saved(|it| it.energy_j)
    );
}
