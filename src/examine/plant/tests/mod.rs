//! Programs for the tests.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod campaigns;
mod laws;
mod logs;

use super::{Conditions, Meter, Place, Plant, Run, Script, Step, Variant};

const FILE: &str = "Main.mod";

pub(super) fn place(line: usize) -> Place {
    Place { file: FILE.into(), line }
}

fn moves(line: usize, duration_s: f64, stops: bool) -> Step {
    Step::Move { file: FILE.into(), line, duration_s, energy_j: 150.0 * duration_s, stops }
}

fn wait(line: usize, signal: &str) -> Step {
    Step::Wait { file: FILE.into(), line, signal: signal.into() }
}

fn output(line: usize, signal: &str, level: u8) -> Step {
    Step::Output { file: FILE.into(), line, signal: signal.into(), level }
}

/// One wait, `diReady` in line 3, and one departure, in line 4; line 2 leads to the wait.
pub(super) fn one_wait() -> Script {
    Script::single(vec![moves(2, 4.0, true), wait(3, "diReady"), moves(4, 6.0, false)])
}

/// A cell with a gripper, a part to fetch, and a machine to load.
fn steps(mass_kg: f64) -> Vec<Step> {
    vec![
        moves(10, 2.0, false),
        moves(11, 1.5, true),
        wait(12, "diPart"),
        moves(13, 0.8, true),
        output(14, "doGrip", 1),
        wait(15, "diClosed"),
        Step::Load { file: FILE.into(), line: 16, mass_kg },
        moves(17, 3.0, true),
        wait(18, "diDoor"),
        moves(19, 1.0, true),
        output(20, "doGrip", 0),
        wait(21, "diOpen"),
        Step::Load { file: FILE.into(), line: 22, mass_kg: 0.0 },
        moves(23, 1.0, true),
        output(24, "doStart", 1),
        Step::Pause { file: FILE.into(), line: 25, seconds: 0.3 },
        moves(26, 2.0, false),
        moves(27, 1.5, true),
        wait(28, "diFree"),
        output(29, "doStart", 0),
    ]
}

/// A program for two sorts of parts.
pub(super) fn cell() -> Script {
    let mut heavy = steps(6.5);
    heavy.insert(0, moves(9, 1.2, false));
    let variant = |part: &str, frequency, steps| Variant { part: part.into(), frequency, steps };
    Script { variants: vec![variant("light", 0.7, steps(2.4)), variant("heavy", 0.3, heavy)] }
}

/// A run of which only the events matter: the meter hardly writes.
fn events(plant: &Plant, script: &Script, cycles: usize, seed: u64) -> Run {
    let meter = Meter { rate_hz: 0.01, ..Meter::default() };
    plant.run_in(script, &Conditions { meter, ..Conditions::usual(cycles, seed) })
}
