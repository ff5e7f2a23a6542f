//! Proves that a program with a recorder does the same as without.

use super::error::InstrumentError;
use super::remove::without_recorder;
use crate::arm::robot::Model;
use crate::rapid::ir::movement::Movement;
use crate::retime::motion::timeline::What;
use crate::retime::motion::{Options, Simulation, simulate};
use crate::tool::retrofit::{OutputFile, Source, parses, read_again, read_program};

/// Reads the program with the recorder again: it must do the same, and give back the original.
pub(super) fn check(
    files: &[Source],
    outputs: &[OutputFile],
    (entry, prefix): (&str, &str),
    (model, options): (&Model, &Options),
    before: &Simulation,
) -> Result<(), InstrumentError> {
    if !parses(files, outputs) {
        return Err(InstrumentError::Differs("it has syntax errors".to_owned()));
    }
    let again = read_again(outputs);
    for (source, output) in files.iter().zip(&again) {
        if without_recorder(&output.file, prefix) != source.file.bytes {
            let path = &source.file.path;
            return Err(InstrumentError::Differs(format!("'{path}' would not come back")));
        }
    }
    let (program, entry) = read_program(&again, entry)?;
    let after = simulate(&program, entry, model, options);
    let (before, after) = (steps(before), steps(&after));
    if before == after {
        return Ok(());
    }
    let differs = before.iter().zip(&after).position(|(a, b)| a != b);
    let at = differs.unwrap_or_else(|| before.len().min(after.len()));
    let text = |list: &[String]| list.get(at).cloned().unwrap_or_else(|| "the end".to_owned());
    Err(InstrumentError::Differs(format!("{} instead of {}", text(&after), text(&before))))
}

/// What a cycle does, in order.
fn steps(simulation: &Simulation) -> Vec<String> {
    let movement = |movement: &Movement| {
        let Movement { instruction, via, target, speed, zone, tool, wobj, .. } = movement;
        format!("{instruction} {via:?} {target:?} {speed:?} {zone:?} {tool:?} {wobj:?}")
    };
    let mut steps = Vec::new();
    for event in &simulation.events {
        match &event.what {
            What::Run(run) => {
                steps.extend(run.moves.iter().map(|record| movement(&record.movement)));
            }
            What::Wait(record) => {
                steps.push(format!("{} {:?}", record.wait.instruction, record.wait.signal));
            }
            What::Output(output, _) => {
                steps.push(format!("{} {} {}", output.instruction, output.signal, output.value));
            }
            What::Left(left) => steps.push(left.reason.clone()),
        }
    }
    steps
}
