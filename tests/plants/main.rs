//! `waits` on simulated cells, which share no code with it: which waits are slack, which are process.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

mod stations;

use joulepath::examine::plant::{Plant, Truth};
use joulepath::tool::cell::events::read;
use joulepath::tool::cell::waits::{Log, WaitKind, find};
use stations::script;

/// Cells, and recorded cycles of each.
const CELLS: u64 = 50;
const CYCLES: usize = 200;
/// Largest share of asserted kinds that are wrong.
const WRONG: f64 = 0.01;
/// Least share of asserted kinds that are right.
const RIGHT: f64 = 0.95;
/// Least share of the waits of a kind that are told without an experiment.
const TOLD: f64 = 0.5;

#[test]
fn slack_is_told_from_process_in_cells_of_another_simulator() {
    // Rows: slack, process, coupled; columns: said to be slack, process, unknown.
    let mut table = [[0_usize; 3]; 3];
    let mut wrong = Vec::new();
    for seed in 0..CELLS {
        let script = script(seed);
        let plant = Plant::draw(seed, &script);
        let run = plant.run(&script, CYCLES, seed);
        let recording = read(run.events.as_bytes()).unwrap();
        let log = Log { name: format!("{seed}"), recording };
        let found = find(&[log], None).unwrap();
        for (place, truth) in plant.truth(&script) {
            let wait =
                found.waits.iter().find(|wait| wait.samples.key.place.line as usize == place.line);
            let Some(wait) = wait else { continue };
            let row = match truth {
                Truth::Slack { .. } => 0,
                Truth::Process => 1,
                Truth::Coupled => 2,
            };
            let column = match wait.verdict.kind {
                WaitKind::Slack => 0,
                WaitKind::Process => 1,
                WaitKind::Unknown => 2,
            };
            table[row][column] += 1;
            if column < 2 && row != column {
                wrong.push(format!("cell {seed}, line {}: {truth:?}, said {column}", place.line));
            }
        }
    }
    // A wait that depends in part on the robot's coming may be said to belong to the process: that is safe.
    let [slack, process, coupled] = table;
    let told = slack[0] + slack[1] + process[0] + process[1];
    let right = slack[0] + process[1];
    let used_up = process[0] + coupled[0];
    let shown = format!("{table:?}\n{}", wrong.join("\n"));
    assert!(right as f64 >= RIGHT * told as f64, "{right} of {told}: {shown}");
    assert!(used_up as f64 <= WRONG * (told + coupled[0] + coupled[1]) as f64, "{shown}");
    assert!(slack[0] as f64 >= TOLD * slack.iter().sum::<usize>() as f64, "{shown}");
    assert!(process[1] as f64 >= TOLD * process.iter().sum::<usize>() as f64, "{shown}");
}
