//! How much of the moving time of `fixtures/cells` becomes streams, and why the rest stays:
//! `cargo run --release --example reach`. `docs/reach.md` contains the table.
#![expect(clippy::unwrap_used, reason = "a failed set-up stops the example")]
#![expect(clippy::print_stdout, reason = "an example prints")]

#[path = "../tests/support/cells.rs"]
mod cells;
#[path = "../tests/support/mod.rs"]
mod support;

use std::collections::{BTreeMap, BTreeSet};

use cells::{Cell, cells};
use joulepath::tool::retrofit::{Figures, Retrofit, SegmentKind, Settings, retrofit};
use rayon::prelude::*;
use support::irb1600;

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

fn retrofitted(cell: &Cell, settings: &Settings) -> Retrofit {
    let settings = Settings { options: cell.options(), ..settings.clone() };
    let result = retrofit(&cell.files, &irb1600(), &settings, &|_, _| ());
    let result = result.unwrap_or_else(|error| panic!("{}: {error}", cell.name));
    assert!(result.verification.passed, "{}", cell.name);
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
