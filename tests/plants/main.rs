//! `waits` on simulated cells, which share no code with it: which waits are slack, which are process.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

use joulepath::examine::plant::{Plant, Script, Step, Truth};
use joulepath::tool::cell::events::read;
use joulepath::tool::cell::waits::{Log, WaitKind, find};

/// Cells, and recorded cycles of each.
const CELLS: u64 = 50;
const CYCLES: usize = 200;
/// Largest share of asserted kinds that are wrong.
const WRONG: f64 = 0.01;
/// Least share of asserted kinds that are right.
const RIGHT: f64 = 0.95;
/// Least share of the waits of a kind that are told without an experiment.
const TOLD: f64 = 0.5;

/// A program of several stations: ways there, an output, a wait, sometimes a time, ways back.
fn script(seed: u64) -> Script {
    let mut draws = fastrand::Rng::with_seed(seed);
    let mut steps = Vec::new();
    let mut line = 10;
    let file = || "main.mod".to_owned();
    for station in 0..draws.usize(3..8) {
        let mut go = |steps: &mut Vec<Step>, draws: &mut fastrand::Rng| {
            for last in [false, true] {
                line += 1;
                let duration_s = 0.4 + 2.5 * draws.f64();
                let energy_j = 60.0 * duration_s * (0.5 + draws.f64());
                steps.push(Step::Move { file: file(), line, duration_s, energy_j, stops: last });
            }
            line += 1;
            line
        };
        let at = go(&mut steps, &mut draws);
        if draws.bool() {
            let signal = format!("doStation{station}");
            steps.push(Step::Output { file: file(), line: at, signal, level: 1 });
        }
        let signal = format!("diStation{station}");
        steps.push(Step::Wait { file: file(), line: at + 1000, signal });
        if draws.bool() {
            let seconds = 0.2 + draws.f64();
            steps.push(Step::Pause { file: file(), line: at + 2000, seconds });
        }
        go(&mut steps, &mut draws);
    }
    Script::single(steps)
}

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
