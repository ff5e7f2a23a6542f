//! Whether the next experiment decides: each sealed case whose diagnosis leaves a question open gets the
//! motion of `diagnose --next`, its robot runs it, and all logs are diagnosed together: `cargo build
//! --release && cargo run --release --example next_experiment -- FOLDER [SEED [CASES]]`.
#![expect(clippy::unwrap_used, reason = "a failed set-up stops the example")]
#![expect(clippy::print_stdout, reason = "an example prints")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use joulepath::examine::blind::{self, Kind, Label, Settings};
use serde_json::Value;

/// Seed of the development cases, and their number.
const SEED: u64 = 501;
const CASES: usize = 40;
/// Every so many rows of the written table one is simulated: 1 ms and 2 ms.
const EVERY: usize = 2;

fn main() {
    let mut given = std::env::args().skip(1);
    let folder = PathBuf::from(given.next().unwrap());
    let mut numbers = given.map(|x| x.parse::<u64>().unwrap());
    let settings = Settings::new(numbers.next().unwrap_or(SEED));
    let cases = numbers.next().map_or(CASES, |count| count as usize);
    let (mut asked, mut decided) = (0, 0);
    for number in 1..=cases {
        let case = blind::case(&settings, number).unwrap();
        let label = &case.label;
        if matches!(label.kind, Kind::Motion | Kind::Power) || label.trust.is_empty() {
            continue;
        }
        let at = folder.join(&case.name);
        for (name, text) in &case.files {
            let path = at.join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        let has_baseline = at.join("baseline-1.csv").exists();
        let logs = ["log-1.csv".to_owned(), "log-2.csv".to_owned()];
        let before = diagnose(&at, label, &logs, has_baseline, true);
        let Some(states) = states(&at.join("next/excitation.csv")) else { continue };
        let Some(cycles) = repetitions(&before) else { continue };
        let Some(log) = blind::further(&settings, number, &states, cycles) else { continue };
        fs::write(at.join("next/log.csv"), log).unwrap();
        let all = [&logs[..], &["next/log.csv".to_owned()]].concat();
        let after = diagnose(&at, label, &all, has_baseline, false);
        let [first, then] = [&before, &after].map(|of| is_right(of, label));
        asked += 1;
        decided += usize::from(then);
        let truth: Vec<&str> = label.effects.iter().map(|of| of.id.as_str()).collect();
        println!(
            "{number:>4} {:<30} {:<34} {} -> {:<34} {}",
            truth.join(" + "),
            said(&before),
            if first { "right" } else { "open" },
            said(&after),
            if then { "right" } else { "open or wrong" }
        );
    }
    println!("{decided} of {asked} questions are decided as they should be");
}

/// The JSON of a diagnosis, with the next experiment or without.
fn diagnose(at: &Path, label: &Label, logs: &[String], has_baseline: bool, next: bool) -> Value {
    let beside = std::env::current_exe().unwrap();
    let program = beside.parent().unwrap().parent().unwrap().join("joulepath");
    let mut command = Command::new(program);
    command.current_dir(at).args(["diagnose", "--robot", "nominal.toml", "--trust", &label.trust]);
    command.args(["--heldout", "heldout.csv", "--format", "json", "--quiet", "--log"]).args(logs);
    if has_baseline {
        command.args(["--baseline", "baseline-1.csv"]);
    }
    if next {
        command.args(["--next", "next"]);
    }
    let output = command.output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() != Some(2), "{}: {message}", at.display());
    serde_json::from_slice(&output.stdout).unwrap()
}

/// One repetition of a written motion; `None` where none was written.
fn states(table: &Path) -> Option<Vec<[[f64; 7]; 3]>> {
    let text = fs::read_to_string(table).ok()?;
    let mut lines = text.lines();
    let dof = (lines.next()?.split(',').count() - 1) / 4;
    let state = |line: &str| {
        let row: Vec<f64> = line.split(',').map(|x| x.parse().unwrap_or(0.0)).collect();
        [0, 1, 2].map(|order| {
            std::array::from_fn(
                |joint| if joint < dof { row[1 + order * dof + joint] } else { 0.0 },
            )
        })
    };
    Some(lines.step_by(EVERY).map(state).collect())
}

fn repetitions(found: &Value) -> Option<usize> {
    found["next_experiment"]["cycles"].as_u64().map(|cycles| cycles as usize)
}

fn said(found: &Value) -> String {
    let effects = found["effects"].as_array().into_iter().flatten();
    let ids: Vec<String> = effects
        .map(|of| {
            of["class"]
                .as_array()
                .unwrap()
                .iter()
                .map(|id| id.as_str().unwrap())
                .collect::<Vec<_>>()
                .join("|")
        })
        .collect();
    if ids.is_empty() { found["verdict"].as_str().unwrap().to_owned() } else { ids.join(" + ") }
}

/// Whether the true effects, and no others, are named, each alone.
fn is_right(found: &Value, label: &Label) -> bool {
    let effects = found["effects"].as_array().unwrap();
    let is_true = |of: &Value, id: &str| of["id"] == id;
    let known = |of: &Value| {
        label.effects.iter().any(|truth| {
            is_true(of, &truth.id) || truth.equivalents.iter().any(|id| is_true(of, id))
        })
    };
    let wanted = if label.kind == Kind::Outside || label.kind == Kind::ParametersOnly {
        0
    } else {
        label.effects.len()
    };
    effects.len() == wanted
        && effects
            .iter()
            .all(|of| known(of) && of["class"].as_array().is_some_and(|of| of.len() == 1))
}
