//! The loop in the cell, end to end: recorder, shift, waits, retrofit, shift, proof. The shifts are those of
//! a simulated plant, which shares no code with the methods.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

#[path = "../command/mod.rs"]
mod command;
#[path = "../plants/program.rs"]
mod program;
#[path = "../support/mod.rs"]
mod support;

use std::fs;
use std::path::Path;

use command::{json, number, refused};
use joulepath::arm::robot::Model;
use joulepath::examine::plant::{Conditions, Kind, Plant, Script};
use joulepath::retime::motion::Options;
use joulepath::tool::retrofit::Source;
use program::{retimed, script, standing};
use serde_json::Value;
use support::simulated;

/// Recorded cycles of each shift.
const CYCLES: usize = 120;
/// Cells that are tried, what counts as waiting, s, and cycles in which the machine may be early.
const MOST_PLANTS: u64 = 60;
const LONG_S: f64 = 1.5;
const MOST_EARLY: usize = 1;
/// The machine that makes the robot wait.
const SLACK: (&str, Kind) = ("diMcReady", Kind::Machine);

/// The cycle of a program as steps of the plant.
fn steps(model: &Model, files: &[Source]) -> Script {
    let simulation = simulated(model, files, &Options::default());
    script(model, files, &simulation, standing(model, &simulation))
}

/// The files of a folder as a program.
fn program(folder: &Path) -> Vec<Source> {
    let files = command::files(folder);
    let is_module = |name: &str| [".mod", ".sys"].iter().any(|end| name.ends_with(end));
    let files = files.into_iter().filter(|(name, _)| is_module(name)).enumerate();
    let source = |(index, (name, bytes)): (usize, (String, Vec<u8>))| Source {
        file: joulepath::rapid::text::SourceFile::new(
            joulepath::rapid::text::FileId(index as u32),
            name.clone(),
            bytes,
        ),
        relative: name,
    };
    files.map(source).collect()
}

/// A cell in which the machine makes the robot wait in nearly all cycles.
fn waiting_plant(script: &Script) -> Plant {
    let mut drawn = (0..MOST_PLANTS).map(|seed| Plant::draw_with(seed, script, &[SLACK]).calm());
    let waits = |plant: &Plant| {
        let run = plant.run(script, CYCLES, 1);
        let visits = run.cycles.iter().flat_map(|cycle| &cycle.visits);
        let own: Vec<f64> = visits
            .filter(|visit| visit.signal == SLACK.0)
            .map(|visit| visit.ended_s - visit.arrived_s)
            .collect();
        own.iter().filter(|length| **length > LONG_S).count() + MOST_EARLY >= own.len()
    };
    drawn.find(waits).expect("a cell that makes the robot wait")
}

/// A shift: the logs of events and power, with the hash of the recorded program.
fn shift(plant: &Plant, script: &Script, seed: u64, recorded: &Path, to: &Path) {
    let run = plant.run_in(script, &Conditions::usual(CYCLES, seed));
    let result: Value = serde_json::from_slice(&fs::read(recorded).unwrap()).unwrap();
    let hash = format!("# program {}", result["program"].as_str().unwrap());
    let events: Vec<&str> = run
        .events
        .lines()
        .map(|line| if line.starts_with("# program") { hash.as_str() } else { line })
        .collect();
    fs::create_dir_all(to).unwrap();
    fs::write(to.join("events.csv"), events.join("\n") + "\n").unwrap();
    fs::write(to.join("power.csv"), run.power).unwrap();
}

#[test]
fn the_example_goes_from_its_first_log_to_a_proof() {
    let folder = tempfile::tempdir().unwrap();
    let campaign = folder.path().join("campaign");
    let path = campaign.to_str().unwrap();
    let call =
        |more: &[&str]| json(&[&["campaign", path, "--format", "json", "--quiet"], more].concat());
    let begun = call(&["--program", "fixtures/pick_place"]);
    assert!(begun["next"].as_str().unwrap().contains("recorded"), "{begun}");
    refused(&["campaign", path, "--program", "fixtures/pick_place"], "is a campaign already");

    let model = support::irb1600();
    let original = steps(&model, &program(Path::new("fixtures/pick_place")));
    let plant = waiting_plant(&original);
    shift(&plant, &original, 1, &campaign.join("recorded.json"), &campaign.join("logs/before"));
    let planned = call(&[]);
    assert!(planned["next"].as_str().unwrap().contains("recorded-after"), "{planned}");
    let waits: Value =
        serde_json::from_slice(&fs::read(campaign.join("waits.json")).unwrap()).unwrap();
    let waits = waits["waits"].as_array().unwrap();
    let of_machine = waits.iter().find(|wait| wait["signal"] == SLACK.0);
    assert_eq!(of_machine.unwrap()["kind"], "slack", "{waits:?}");
    let optimized: Value =
        serde_json::from_slice(&fs::read(campaign.join("optimized.json")).unwrap()).unwrap();
    assert!(!optimized["waits"]["used"].as_array().unwrap().is_empty(), "{}", optimized["waits"]);

    let new = retimed(&original, &steps(&model, &program(&campaign.join("optimized")))).unwrap();
    shift(&plant, &new, 1, &campaign.join("recorded-after.json"), &campaign.join("logs/after"));
    let proved = call(&[]);
    assert_eq!(proved["finished"], true, "{proved}");
    let proof: Value =
        serde_json::from_slice(&fs::read(campaign.join("proof.json")).unwrap()).unwrap();
    assert_eq!(proof["verdict"], "saves", "{proof}");
    let [low, high] = ["low", "high"].map(|it| number(&proof["saving_percent"], &format!("/{it}")));
    assert!(low > 0.0 && high < 60.0, "{low} to {high}");
    let page = fs::read_to_string(campaign.join("report.html")).unwrap();
    assert!(page.contains("proof.html") && page.contains("Measured"), "{page}");
}
