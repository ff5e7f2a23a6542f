//! Reads and prepares measured logs for `identify` and `diagnose`.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use sha2::{Digest, Sha256};

use super::common;
use crate::arm::robot::Model;
use crate::learn::identify::{
    Hints, Samples, Source, beyond_range, check_angles, check_torques, cleaned, prepare,
    synchronised, torques, weight_factor,
};
use crate::learn::log::{self, Channel, ColumnMap, Log, MIN_ROWS, Rejected, aligned, are_halves};
use crate::tool::report::identify::LogRecord;

/// Share of a single log that is held out.
pub(super) const HELD_OUT: f64 = 0.3;
/// With at most this many repetitions, none is held out as a whole.
const MIN_CYCLES: usize = 3;

/// A log that was read.
pub(super) struct RawLog {
    /// Its path as given.
    pub(super) shown: String,
    /// SHA-256.
    pub(super) hash: String,
    /// The log.
    pub(super) log: Log,
    /// Quality of the synchronisation of its two halves, if it has two.
    clocks: Option<String>,
}

/// A log whose positions are plausible.
pub(super) struct CheckedLog {
    /// The record of its origin.
    pub(super) record: LogRecord,
    /// The valid rows.
    pub(super) log: Log,
}

/// A log prepared for use.
pub(super) struct PreparedLog {
    /// The record of its origin.
    pub(super) record: LogRecord,
    /// The samples.
    pub(super) samples: Samples,
    /// Origin of the torques.
    pub(super) origin: String,
    /// The valid rows.
    pub(super) log: Log,
    /// Ratio of the logged torques to the weight of the robot file's masses, if implausible.
    pub(super) weight: Option<f64>,
}

/// Reads the logs of one robot.
pub(super) struct Reader<'a> {
    /// The robot.
    pub(super) model: &'a Model,
    /// Whether to suppress notes on standard error.
    pub(super) quiet: bool,
    /// Notes on the logs, for the result.
    pub(super) notes: Vec<String>,
}

impl Reader<'_> {
    fn tell(&mut self, text: String) {
        common::note_once(self.quiet, &mut self.notes, text);
    }

    /// Checks a log and extracts its samples.
    pub(super) fn prepared(&mut self, read: RawLog, hints: Hints) -> anyhow::Result<PreparedLog> {
        let model = self.model;
        let CheckedLog { record, log } = self.checked(read)?;
        let shown = record.path.clone();
        let torque = torques(model, &log).with_context(|| shown.clone())?;
        check_torques(model, &log, &torque.tau).with_context(|| shown.clone())?;
        let weight = weight_factor(model, &log, &torque.tau);
        let strange = weight.map(|(factor, joint)| weight_note(factor, joint));
        for text in strange.into_iter().chain(torque.notes) {
            self.tell(format!("{shown}: {text}"));
        }
        if let Some(text) = unused_columns_note(&log) {
            self.tell(format!("{shown}: {text}"));
        }
        let samples = prepare(&log, &torque.tau, hints).with_context(|| shown.clone())?;
        if let Some(text) = period_note(hints.period, &samples.source) {
            self.tell(format!("{shown}: {text}"));
        }
        Ok(PreparedLog {
            record,
            samples,
            origin: torque.origin,
            log,
            weight: weight.map(|(factor, _)| factor),
        })
    }

    /// Checks what a log says of the positions.
    pub(super) fn checked(&mut self, read: RawLog) -> anyhow::Result<CheckedLog> {
        let model = self.model;
        let RawLog { shown, hash, log, clocks } = read;
        check_joints(&shown, &log, model)?;
        let (log, impossible) = cleaned(&log);
        for text in summed_up(log.rejected.iter().chain(&impossible)) {
            common::note(self.quiet, &format!("{shown}: {text}"));
        }
        let left_out = log.rejected.len() + impossible.len();
        let usable = log.time().len();
        if usable < MIN_ROWS || left_out > usable {
            let first = log.rejected.iter().chain(&impossible).next();
            let why = first.map_or_else(String::new, |first| {
                format!("; the first is row {}: {}", first.row, first.reason)
            });
            bail!("{shown}: {left_out} rows can't be used and {usable} can{why}");
        }
        check_angles(model, &log).with_context(|| shown.clone())?;
        for (joint, q) in beyond_range(model, &log) {
            let [low, high] = model.limits.position[joint].map(f64::to_degrees);
            self.tell(format!(
                "{shown}: q{} goes to {:.1} deg, beyond the range of {} ({low:.1} to {high:.1}): is it \
                 the log of another robot?",
                joint + 1,
                q.to_degrees(),
                model.name
            ));
        }
        if let Some(text) = clocks {
            self.tell(format!("{shown}: {text}"));
        }
        Ok(CheckedLog { record: LogRecord { path: shown, hash, rows: usable, left_out }, log })
    }
}

/// Refuses a log of a robot with another number of joints.
pub(super) fn check_joints(shown: &str, log: &Log, model: &Model) -> anyhow::Result<()> {
    let (joints, Model { name, dof, .. }) = (log.joints(), model);
    if joints != *dof {
        bail!(
            "{shown}: positions of {joints} joints are logged, {name} has {dof}; give a log with q1 to \
             q{dof}, or another --robot"
        );
    }
    Ok(())
}

/// Refuses a held-out log with the content of another one.
///
/// # Errors
/// There is one.
pub(super) fn refuse_same(train: &[&LogRecord], held: &[&LogRecord]) -> anyhow::Result<()> {
    let pairs = held.iter().flat_map(|held| train.iter().map(move |of| (held, of)));
    let mut same = pairs.filter(|(held, of)| held.hash == of.hash);
    if let Some((held, same)) = same.next() {
        bail!(
            "--heldout {}: the same log as --log {}; give one that takes no part there, or leave \
             --heldout out",
            held.path,
            same.path
        );
    }
    Ok(())
}

/// Without held-out logs, holds the last of several logs out. The kind of held-out data: `file`,
/// `trajectory`, or `cycles` where a single log is still to be split.
pub(super) fn hold_out<T>(train: &mut Vec<T>, held: &mut Vec<T>) -> &'static str {
    if !held.is_empty() {
        return "file";
    }
    if train.len() < 2 {
        return "cycles";
    }
    held.extend(train.pop());
    "trajectory"
}

/// Splits a log into training and held-out part: the last repetitions, or the last part of the
/// whole.
///
/// # Errors
/// A part is too short.
pub(super) fn held_out(model: &Model, of: &PreparedLog) -> anyhow::Result<[PreparedLog; 2]> {
    let t = of.log.time();
    let (begins, ends) = (t.first().copied().unwrap_or(0.0), t.last().copied().unwrap_or(0.0));
    let (at, period) = match of.samples.source {
        Source::Periodic { period, periods, .. } if periods > MIN_CYCLES => {
            let held = (HELD_OUT * periods as f64) as usize;
            (begins + period * (periods - held.max(1)) as f64, Some(period))
        }
        _ => (ends - HELD_OUT * (ends - begins), None),
    };
    let cutoff = match of.samples.source {
        Source::Filtered { cutoff } => Some(cutoff),
        Source::Periodic { .. } | Source::Logged => None,
    };
    let (first, last): (Vec<usize>, Vec<usize>) = (0..t.len()).partition(|row| t[*row] < at);
    let part = |rows: &[usize]| -> anyhow::Result<PreparedLog> {
        let log = of.log.of_rows(rows);
        let torque = torques(model, &log)?;
        let samples = prepare(&log, &torque.tau, Hints { period, cutoff })?;
        let (record, origin) = (of.record.clone(), of.origin.clone());
        Ok(PreparedLog { record, samples, origin, log, weight: of.weight })
    };
    let shown = &of.record.path;
    Ok([part(&first).with_context(|| shown.clone())?, part(&last).with_context(|| shown.clone())?])
}

/// Gives logs that are filtered the lowest cut-off frequency of all, so that they can be compared.
pub(super) fn filter_alike(model: &Model, logs: [&mut [PreparedLog]; 3]) -> anyhow::Result<()> {
    let cutoff = |of: &PreparedLog| match of.samples.source {
        Source::Filtered { cutoff } => Some(cutoff),
        Source::Periodic { .. } | Source::Logged => None,
    };
    let all = logs.iter().flat_map(|logs| logs.iter());
    let Some(least) = all.filter_map(cutoff).reduce(f64::min) else { return Ok(()) };
    for of in logs.into_iter().flatten().filter(|of| cutoff(of).is_some_and(|own| own > least)) {
        let shown = of.record.path.clone();
        let torque = torques(model, &of.log).with_context(|| shown.clone())?;
        let hints = Hints { period: None, cutoff: Some(least) };
        of.samples = prepare(&of.log, &torque.tau, hints).with_context(|| shown)?;
    }
    Ok(())
}

/// Reads logs and merges the halves of one run.
pub(super) fn read_all(
    paths: &[PathBuf],
    map: &ColumnMap,
    model: &Model,
) -> anyhow::Result<Vec<RawLog>> {
    let mut logs: Vec<RawLog> = Vec::new();
    for path in paths {
        let read = read(path, map)?;
        let half = logs
            .iter_mut()
            .find(|other| are_halves(&other.log, &read.log) || are_halves(&read.log, &other.log));
        let Some(other) = half else {
            logs.push(read);
            continue;
        };
        let (positions, currents) = if are_halves(&other.log, &read.log) {
            (&other.log, &read.log)
        } else {
            (&read.log, &other.log)
        };
        let both = aligned(positions, currents)
            .with_context(|| format!("{} and {}", other.shown, read.shown))?;
        let (both, said) = synchronised(model, both);
        (other.log, other.clocks) = (both, Some(said));
        other.shown = format!("{} + {}", other.shown, read.shown);
        other.hash = format!("{} + {}", other.hash, read.hash);
    }
    Ok(logs)
}

/// Reads one log.
pub(super) fn read(path: &Path, map: &ColumnMap) -> anyhow::Result<RawLog> {
    let shown = path.display().to_string();
    if path.is_dir() {
        bail!("{shown}: this is a folder; give the log files in it one by one");
    }
    let file = File::open(path)
        .with_context(|| format!("cannot read '{shown}'; check the path and its permissions"))?;
    let mut stream = Hashed { stream: file, hash: Sha256::new() };
    let log = log::read_from(&mut stream, map).with_context(|| shown.clone())?;
    let hash = format!("{:x}", stream.hash.finalize());
    Ok(RawLog { shown, hash, log, clocks: None })
}

/// A stream that hashes its bytes while they are read.
struct Hashed {
    stream: File,
    hash: Sha256,
}

impl io::Read for Hashed {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.stream.read(buffer)?;
        self.hash.update(&buffer[..count]);
        Ok(count)
    }
}

/// Explains torques that do not match the weight of the robot file's masses.
fn weight_note(factor: f64, joint: usize) -> String {
    let times = |times: f64| if times < 10.0 { times } else { times.round() };
    if factor < 1.0 {
        format!(
            "the torques carry {:.0} times less than the masses of the robot file weigh (joint {}): \
             are they those of the motors, before the gear? Then multiply each tau by its ratio",
            times(1.0 / factor),
            joint + 1
        )
    } else {
        format!(
            "the torques carry {:.0} times what the masses of the robot file weigh (joint {}): are \
             they in Nm, and is it this robot?",
            times(factor),
            joint + 1
        )
    }
}

/// A note if the given period does not match the motion.
fn period_note(period: Option<f64>, source: &Source) -> Option<String> {
    let given = period?;
    match source {
        Source::Periodic { period, .. } if (period / given - 1.0).abs() <= OTHER_PERIOD => None,
        Source::Periodic { period, .. } => {
            Some(format!("--period {given}: the motion repeats every {period:.4} s; that was used"))
        }
        Source::Logged => {
            Some(format!("--period {given} is not used: rates and accelerations are logged"))
        }
        Source::Filtered { .. } => Some(format!(
            "--period {given}: the motion does not repeat so; it is differentiated by a filter"
        )),
    }
}

/// Maximum relative difference between given and found period.
const OTHER_PERIOD: f64 = 0.01;

/// Maximum number of rejected rows per reason that are listed individually.
const MAX_LISTED_ROWS: usize = 3;

/// The rejected rows, one text for consecutive rows with the same kind of reason.
pub(super) fn left_out(mut rejected: Vec<Rejected>) -> Vec<String> {
    rejected.sort_by_key(|of| of.row);
    let follows =
        |a: &Rejected, b: &Rejected| b.row == a.row + 1 && kind(&a.reason) == kind(&b.reason);
    let text = |rows: &[Rejected]| match rows {
        [of] => format!("row {} left out: {}", of.row, of.reason),
        [first, .., last] => {
            format!("rows {} to {} left out: {}", first.row, last.row, first.reason)
        }
        [] => String::new(),
    };
    rejected.chunk_by(follows).map(text).collect()
}

/// A reason without its numbers.
fn kind(reason: &str) -> String {
    let mark = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+');
    reason.split(' ').filter(|word| !word.contains(mark)).collect::<Vec<_>>().join(" ")
}

/// The rejected rows; for frequent reasons the first ones and the number of others.
fn summed_up<'a>(rejected: impl Iterator<Item = &'a Rejected>) -> Vec<String> {
    // Reasons that differ only in numbers are of one kind.
    let mut kinds: Vec<(String, u64, usize)> = Vec::new();
    let mut texts = Vec::new();
    for row in rejected {
        let text = format!("row {} left out: {}", row.row, row.reason);
        let kind = kind(&row.reason);
        if let Some((.., count)) = kinds.iter_mut().find(|(known, ..)| *known == kind) {
            *count += 1;
            if *count <= MAX_LISTED_ROWS {
                texts.push(text);
            }
        } else {
            kinds.push((kind, row.row, 1));
            texts.push(text);
        }
    }
    for (_, first, count) in kinds.into_iter().filter(|(.., count)| *count > MAX_LISTED_ROWS) {
        texts.push(format!(
            "{} more rows left out for the same reason as row {first}",
            count - MAX_LISTED_ROWS
        ));
    }
    texts
}

/// A note on logged rates and accelerations that do not cover all joints.
fn unused_columns_note(log: &Log) -> Option<String> {
    let part = |name: &str, channel: fn(usize) -> Channel| {
        let has = |joint: &usize| log.column(channel(*joint)).is_some();
        let (with, without): (Vec<usize>, Vec<usize>) = (0..log.joints()).partition(has);
        let list = |joints: &[usize]| -> String {
            joints.iter().map(|j| format!("{name}{}", j + 1)).collect::<Vec<_>>().join(", ")
        };
        let told = !with.is_empty() && !without.is_empty();
        told.then(|| format!("no column {}: {} not used", list(&without), list(&with)))
    };
    let parts: Vec<String> = [part("qd", Channel::Velocity), part("qdd", Channel::Acceleration)]
        .into_iter()
        .flatten()
        .collect();
    (!parts.is_empty()).then(|| format!("{}; differentiated instead", parts.join("; ")))
}
