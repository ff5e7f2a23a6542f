//! Logs without torques: the motion channel alone.

use anyhow::{Context, bail};

use super::super::common;
use super::super::logs::{CheckedLog, HELD_OUT, RawLog, Reader, read_all};
use super::super::output;
use super::channels::{self, add_runs};
use super::{DiagnoseArgs, refuse_same, report, write};
use crate::arm::effects::Effect;
use crate::arm::robot::Model;
use crate::gap::{Diagnosis, Run, diagnose_runs};
use crate::learn::log::{Channel, ColumnMap};

/// Whether logs tell nothing but the motion of a program.
pub(super) fn is_alone(logs: &[RawLog]) -> bool {
    logs.iter().all(|read| {
        let has = |channel: Channel| read.log.column(channel).is_some();
        let driven = [Channel::Torque(0), Channel::Current(0), Channel::PhaseCurrent(0, 0)];
        has(Channel::Command) && !driven.into_iter().any(has)
    })
}

/// Compares the motion of logs with that of a baseline.
///
/// # Errors
/// There is no baseline, a log does not mark its movements, or they share none.
pub(super) fn diagnose(
    args: &DiagnoseArgs,
    model: &Model,
    map: &ColumnMap,
    raw: Vec<RawLog>,
    wanted: &[&'static Effect],
) -> anyhow::Result<(Diagnosis, report::Basis)> {
    if args.baseline.is_empty() {
        bail!(
            "--log {}: no torques are logged, and a motion alone is compared with that of a baseline; \
             give --baseline with a log of the same program from when the robot was right, or logs with \
             tau1… or i1…",
            args.log[0].display()
        );
    }
    let mut reader = Reader { model, quiet: args.quiet, notes: Vec::new() };
    let mut read = |raw: Vec<RawLog>| -> anyhow::Result<Vec<(CheckedLog, Run)>> {
        raw.into_iter().map(|read| marked(reader.checked(read)?)).collect()
    };
    let mut train = read(raw)?;
    let mut held = read(read_all(&args.heldout, map, model)?)?;
    let baseline = read(read_all(&args.baseline, map, model)?)?;
    let records = |logs: &[(CheckedLog, Run)]| -> Vec<_> {
        logs.iter().map(|(of, _)| of.record.clone()).collect()
    };
    refuse_same(records(&train).iter(), records(&held).iter())?;
    let heldout = if !held.is_empty() {
        "file"
    } else if train.len() > 1 {
        held.extend(train.pop());
        "trajectory"
    } else {
        "cycles"
    };
    let graded = if held.is_empty() { records(&train) } else { records(&held) };
    let [before, mut now, mut held]: [Vec<Run>; 3] =
        [baseline, train, held].map(|logs| logs.into_iter().map(|(_, run)| run).collect());
    if heldout == "cycles" {
        (now, held) = halves(&now);
    }
    let lines = channels::lines(args.program.as_deref(), &args.robot)?;
    // Checks that the outputs are writable before the search.
    for path in args.out.iter().chain(&args.report) {
        output::stage(path, &[])?;
    }
    let may = |id: &str| wanted.iter().any(|effect| effect.id == id);
    let of_runs = diagnose_runs(&before, &now, &held, &may).with_context(|| {
        format!(
            "--log {}: its movements are not those of the baseline; give logs in which the same program \
             runs at least twice, with the number of the movement as cmd",
            args.log[0].display()
        )
    })?;
    let mut found = Diagnosis::without_torques(model);
    add_runs(&mut found, &of_runs, &lines);
    let mut basis = report::Basis {
        robot: args.robot.clone(),
        heldout: heldout.to_owned(),
        graded: graded.into_iter().map(|of| of.path).collect(),
        notes: reader.notes,
        ..report::Basis::default()
    };
    let shown = basis.notes.len();
    basis.notes.push("no torques are logged: only the motion was compared".to_owned());
    write(args, model, &[], &found, &mut basis)?;
    common::notes(args.quiet, &basis.notes[shown..]);
    Ok((found, basis))
}

/// A log with the movements that it marks.
fn marked(log: CheckedLog) -> anyhow::Result<(CheckedLog, Run)> {
    let Some(run) = channels::run(&log.log) else {
        bail!(
            "{}: no column cmd: log the number of the movement that runs, from 1 in each cycle and 0 for \
             none, or say by --map cmd=COLUMN which one it is",
            log.record.path
        );
    };
    Ok((log, run))
}

/// The first part of each run, and the last one.
fn halves(runs: &[Run]) -> (Vec<Run>, Vec<Run>) {
    let part = |run: &Run, rows: std::ops::Range<usize>| Run {
        t: run.t[rows.clone()].to_vec(),
        q: run.q.iter().map(|q| q[rows.clone()].to_vec()).collect(),
        command: run.command[rows].to_vec(),
    };
    let at = |run: &Run| ((1.0 - HELD_OUT) * run.t.len() as f64) as usize;
    runs.iter().map(|run| (part(run, 0..at(run)), part(run, at(run)..run.t.len()))).unzip()
}
