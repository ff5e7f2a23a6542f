//! Power and motion of logs, in addition to their torques.

use std::path::Path;

use anyhow::Context;

use super::super::common::{self, CellArgs, ProgramArgs};
use super::super::logs::PreparedLog;
use crate::gap::{Diagnosis, Powers, Run, RunFound};
use crate::learn::identify::Source;
use crate::learn::log::{Channel, Log};
use crate::retime::motion::simulate;
use crate::retime::motion::timeline::{MoveRecord, What};
use crate::tool::report::place::Places;
use crate::tool::retrofit::read_program;

/// Mean powers of the motions in logs with power.
pub(super) fn powers(logs: &[PreparedLog]) -> Vec<Powers> {
    logs.iter().filter_map(power).collect()
}

fn power(log: &PreparedLog) -> Option<Powers> {
    let measured = log.log.column(Channel::Power)?;
    let time = log.log.time();
    let samples = &log.samples;
    let [block] = samples.blocks.as_slice() else { return None };
    let (count, period) = match samples.source {
        Source::Periodic { period, periods, .. } => (periods, period),
        Source::Filtered { .. } | Source::Logged => (1, 0.0),
    };
    let mut mean = vec![0.0; block.instants()];
    for repetition in 0..count {
        let mut row = 0;
        for (k, t) in block.t.iter().enumerate() {
            let t = t + period * repetition as f64;
            while row + 2 < time.len() && time[row + 1] <= t {
                row += 1;
            }
            let next = (row + 1).min(time.len() - 1);
            let step = (time[next] - time[row]).max(1e-9);
            let share = ((t - time[row]) / step).clamp(0.0, 1.0);
            mean[k] += (measured[row] * (1.0 - share) + measured[next] * share) / count as f64;
        }
    }
    Some(Powers {
        step: samples.step,
        closed: matches!(samples.source, Source::Periodic { .. }),
        qd: block.qd.clone(),
        tau: block.tau.clone(),
        power: mean,
    })
}

/// Program runs in logs that mark the movements.
pub(super) fn runs(logs: &[PreparedLog]) -> Vec<Run> {
    logs.iter().filter_map(|log| run(&log.log)).collect()
}

/// The program run in a log; `None` if it does not mark the movements.
pub(super) fn run(log: &Log) -> Option<Run> {
    let command = log.column(Channel::Command)?;
    let q = log.of_joints(Channel::Position)?;
    Some(Run {
        t: log.time().to_vec(),
        q: q.into_iter().map(<[f64]>::to_vec).collect(),
        command: command.iter().map(|x| x.max(0.0).round() as usize).collect(),
    })
}

/// File and line of a movement.
pub(super) type ProgramLine = (String, usize);

/// Adds what runs show, with the lines of the movements.
pub(super) fn add_runs(found: &mut Diagnosis, of: &RunFound, lines: &[ProgramLine]) {
    found.add_runs(of);
    for place in &mut found.places {
        let movement = place.movement.and_then(|movement| movement.checked_sub(1));
        place.line = movement.and_then(|movement| lines.get(movement).cloned());
    }
}

/// The line of each movement of a program, if there is one.
pub(super) fn lines(program: Option<&Path>, robot: &str) -> anyhow::Result<Vec<ProgramLine>> {
    let Some(program) = program else { return Ok(Vec::new()) };
    lines_of(program, robot).with_context(|| format!("--program {}", program.display()))
}

fn lines_of(program: &Path, robot: &str) -> anyhow::Result<Vec<ProgramLine>> {
    let cell = CellArgs {
        paths: vec![program.to_path_buf()],
        robot: Some(robot.to_owned()),
        quiet: true,
        ..CellArgs::default()
    };
    let args = ProgramArgs { cell, ..ProgramArgs::default() };
    let job = common::prepare(&args)?;
    let (read, entry) = read_program(&job.files, &job.entry)?;
    let simulation = simulate(&read, entry, &job.model, &job.options);
    let sources = job.sources();
    let places = Places::new(&sources);
    let runs = simulation.events.iter().filter_map(|event| match &event.what {
        What::Run(run) => Some(&run.moves),
        What::Wait(_) | What::Output(..) | What::Left(_) => None,
    });
    let place = |record: &MoveRecord| {
        let place = places.of(record.movement.span);
        (place.file, place.first as usize)
    };
    Ok(runs.flatten().map(place).collect())
}
