//! Logs without torques: the motion of a program alone.

use std::ops::Range;

use anyhow::bail;

use super::super::logs::{CheckedLog, HELD_OUT, RawLog, Reader, hold_out, refuse_same};
use super::channels::run;
use crate::gap::Run;
use crate::learn::log::Channel;

/// Runs to be compared.
pub(super) struct Logged {
    /// Those of the robot as it is now.
    pub(super) now: Vec<Run>,
    /// Those that only grade.
    pub(super) held: Vec<Run>,
    /// Those of the baseline.
    pub(super) before: Vec<Run>,
    /// The kind of held-out data: `file`, `trajectory` or `cycles`.
    pub(super) heldout: &'static str,
    /// Paths of the held-out logs.
    pub(super) graded: Vec<String>,
}

/// Whether logs tell nothing but the motion of a program.
pub(super) fn is_alone(logs: &[RawLog]) -> bool {
    logs.iter().all(|read| {
        let has = |channel: Channel| read.log.column(channel).is_some();
        let driven = [Channel::Torque(0), Channel::Current(0), Channel::PhaseCurrent(0, 0)];
        has(Channel::Command) && !driven.into_iter().any(has)
    })
}

/// The runs in the logs of the robot as it is now, the held-out ones and those of the baseline.
/// Without held-out logs, the last log or the last part of a single one is held out.
///
/// # Errors
/// A log does not mark its movements, or is given in two roles.
pub(super) fn logged(reader: &mut Reader<'_>, logs: [Vec<RawLog>; 3]) -> anyhow::Result<Logged> {
    let mut marked = |raw: Vec<RawLog>| -> anyhow::Result<Vec<(CheckedLog, Run)>> {
        raw.into_iter().map(|read| marked(reader.checked(read)?)).collect()
    };
    let [train, held, baseline] = logs;
    let (mut train, mut held, baseline) = (marked(train)?, marked(held)?, marked(baseline)?);
    let [now, others] =
        [&train, &held].map(|logs| logs.iter().map(|(of, _)| &of.record).collect::<Vec<_>>());
    refuse_same(&now, &others)?;
    let heldout = hold_out(&mut train, &mut held);
    let graded = if held.is_empty() { &train } else { &held };
    let graded = graded.iter().map(|(of, _)| of.record.path.clone()).collect();
    let [mut now, mut held, before]: [Vec<Run>; 3] =
        [train, held, baseline].map(|logs| logs.into_iter().map(|(_, run)| run).collect());
    if heldout == "cycles" {
        (now, held) = now.iter().map(parts).unzip();
    }
    Ok(Logged { now, held, before, heldout, graded })
}

/// A log with the movements that it marks.
fn marked(log: CheckedLog) -> anyhow::Result<(CheckedLog, Run)> {
    let Some(run) = run(&log.log) else {
        bail!(
            "{}: no column cmd: log the number of the movement that runs, from 1 in each cycle and 0 \
             for none, or say by --map cmd=COLUMN which one it is",
            log.record.path
        );
    };
    Ok((log, run))
}

/// The first part of a run, and the last one.
fn parts(run: &Run) -> (Run, Run) {
    let rows = run.t.len();
    let at = ((1.0 - HELD_OUT) * rows as f64) as usize;
    let part = |rows: Range<usize>| Run {
        t: run.t[rows.clone()].to_vec(),
        q: run.q.iter().map(|q| q[rows.clone()].to_vec()).collect(),
        command: run.command[rows].to_vec(),
    };
    (part(0..at), part(at..rows))
}
