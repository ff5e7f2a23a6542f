//! The examination of `diagnose` on sealed cases, as the page `docs/examination.md`: `cargo build --release
//! && cargo run --release --example examination -- FOLDER SEED CASES > docs/examination.md`. It writes so
//! many cases of each world to the folder, diagnoses those that have no diagnosis yet, and opens the seals.
#![expect(clippy::unwrap_used, reason = "a failed set-up stops the example")]
#![expect(clippy::print_stdout, reason = "an example prints")]

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// Worlds: the letter of `blind generate --world`, nothing for the simulator of `blind` itself.
const WORLDS: [&str; 4] = ["A", "B", "C", ""];

fn main() {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let [folder, seed, cases] = &given[..] else { panic!("give FOLDER SEED CASES") };
    let folder = PathBuf::from(folder);
    let grades: Vec<Value> =
        WORLDS.iter().map(|world| grade(&folder, world, [seed, cases])).collect();
    println!("# Examination of `diagnose`\n");
    println!(
        "Written by `examples/examination.rs`: {cases} cases of each world, seed {seed}. The worlds"
    );
    println!(
        "are in [blind.md](blind.md). Rates have Wilson's 95 % intervals; what is asked is beside them.\n"
    );
    println!("| rate | asked | {} |", WORLDS.map(title).join(" | "));
    println!("|---|---|{}", "---|".repeat(WORLDS.len()));
    for (k, rate) in rates(&grades[0]).iter().enumerate() {
        let cells: Vec<String> = grades.iter().map(|of| cell(&rates(of)[k])).collect();
        let name = rate["name"].as_str().unwrap().replace('_', " ");
        println!("| {name} | {} | {} |", asked(&rate["asked"]), cells.join(" | "));
    }
    let shrinks: Vec<String> = grades.iter().map(|of| number(&of["shrink_of_oracle"])).collect();
    println!("| shrink, of that of an oracle | – | {} |", shrinks.join(" | "));
    println!("\n## Stated probabilities\n");
    println!("| stated | of | there |\n|---|---|---|");
    for bin in 0..grades[0]["reliability"].as_array().unwrap().len() {
        let all = || grades.iter().map(|of| &of["reliability"][bin]);
        let [of, hits] = ["of", "hits"].map(|of| all().filter_map(|x| x[of].as_u64()).sum::<u64>());
        let [from, to] = ["from", "to"].map(|of| number(&grades[0]["reliability"][bin][of]));
        if of > 0 {
            println!("| {from} to {to} | {of} | {} |", percent(hits as f64 / of as f64));
        }
    }
}

/// The grade of a world's cases.
fn grade(folder: &Path, world: &str, [seed, cases]: [&String; 2]) -> Value {
    let at = folder.join(if world.is_empty() { "own" } else { world });
    if !at.join("seals.csv").exists() {
        let mut generate = vec!["generate", "--seed", seed, "--count", cases, "--out"];
        generate.push(at.to_str().unwrap());
        if !world.is_empty() {
            generate.extend(["--world", world]);
        }
        blind(&generate);
    }
    serde_json::from_slice(&blind(&["grade", at.to_str().unwrap(), "--format", "json"])).unwrap()
}

fn blind(args: &[&str]) -> Vec<u8> {
    let beside = std::env::current_exe().unwrap();
    let program = beside.parent().unwrap().parent().unwrap().join("joulepath");
    let output = Command::new(program).arg("blind").args(args).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() != Some(2), "{message}");
    output.stdout
}

fn title(world: &str) -> String {
    if world.is_empty() { "own simulator".to_owned() } else { format!("world {world}") }
}

fn rates(grade: &Value) -> &[Value] {
    grade["rates"].as_array().unwrap()
}

fn cell(rate: &Value) -> String {
    let [hits, of] = ["hits", "of"].map(|key| rate[key].as_u64().unwrap());
    if of == 0 {
        return "–".to_owned();
    }
    let [low, high] = ["low", "high"].map(|key| percent(rate[key].as_f64().unwrap()));
    format!("{hits} of {of} ({low} to {high})")
}

fn asked(of: &Value) -> String {
    let at = |key: &str| of[key].as_f64().map(percent);
    let least = at("at_least").map(|x| format!("≥ {x}"));
    least.or_else(|| at("at_most").map(|x| format!("≤ {x}"))).unwrap_or_default()
}

fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

fn number(of: &Value) -> String {
    of.as_f64().map_or("–".to_owned(), |x| format!("{x:.2}"))
}
