//! Measured logs as `identify` and `diagnose` take them.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use sha2::{Digest, Sha256};

use super::common;
use crate::identify::{Hints, Samples, check_angles, check_torques, cleaned, prepare, torques};
use crate::log::{self, Channel, ColumnMap, Log, MIN_ROWS, aligned, are_halves};
use crate::robot::Model;

/// A log that was read.
pub struct Read {
    /// Its path as given.
    pub shown: String,
    /// SHA-256.
    pub hash: String,
    /// The log.
    pub log: Log,
}

/// A log ready to be used.
pub struct Ready {
    /// Path as given, SHA-256, usable rows, rows left out.
    pub record: (String, String, usize, usize),
    /// The instants.
    pub samples: Samples,
    /// Where the torques come from.
    pub origin: String,
    /// The usable rows.
    pub log: Log,
}

/// Reads the logs of one robot.
pub struct Reader<'a> {
    /// The robot.
    pub model: &'a Model,
    /// Columns under other names.
    pub map: &'a ColumnMap,
    /// No notes on standard error.
    pub quiet: bool,
    /// What a reader of the result has to know of the logs.
    pub notes: Vec<String>,
}

impl Reader<'_> {
    fn tell(&mut self, text: String) {
        common::note(self.quiet, &text);
        self.notes.push(text);
    }

    /// Checks a log and makes instants of it.
    ///
    /// # Errors
    /// It is not of this robot, or of no use.
    pub fn ready(&mut self, read: Read, hints: Hints) -> anyhow::Result<Ready> {
        let model = self.model;
        let Read { shown, hash, log } = read;
        if log.joints() != model.dof {
            bail!(
                "{shown}: positions of {} joints are logged, {} has {}; give a log with q1 to q{}, or \
                 another --robot",
                log.joints(),
                model.name,
                model.dof,
                model.dof
            );
        }
        let (log, impossible) = cleaned(&log);
        for rejected in log.rejected.iter().chain(&impossible) {
            let text = format!("{shown}: row {} left out: {}", rejected.row, rejected.reason);
            common::note(self.quiet, &text);
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
        let torque = torques(model, &log).with_context(|| shown.clone())?;
        check_torques(model, &log, &torque.tau).with_context(|| shown.clone())?;
        for text in torque.notes {
            self.tell(format!("{shown}: {text}"));
        }
        if let Some(text) = unused(&log) {
            self.tell(format!("{shown}: {text}"));
        }
        let samples = prepare(&log, &torque.tau, hints).with_context(|| shown.clone())?;
        Ok(Ready { record: (shown, hash, usable, left_out), samples, origin: torque.origin, log })
    }
}

/// Reads logs; halves of one run become one.
///
/// # Errors
/// A log can't be read.
pub fn read_all(paths: &[PathBuf], map: &ColumnMap) -> anyhow::Result<Vec<Read>> {
    let mut logs: Vec<Read> = Vec::new();
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
        other.log = both;
        other.shown = format!("{} + {}", other.shown, read.shown);
        other.hash = format!("{} + {}", other.hash, read.hash);
    }
    Ok(logs)
}

fn read(path: &Path, map: &ColumnMap) -> anyhow::Result<Read> {
    let shown = path.display().to_string();
    let file = File::open(path)
        .with_context(|| format!("cannot read '{shown}'; check the path and its permissions"))?;
    let mut stream = Hashed { stream: file, hash: Sha256::new() };
    let log = log::read_from(&mut stream, map).with_context(|| shown.clone())?;
    let hash = format!("{:x}", stream.hash.finalize());
    Ok(Read { shown, hash, log })
}

/// A stream whose bytes are hashed as they are read.
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

/// Rates and accelerations that are logged, but not of all joints.
fn unused(log: &Log) -> Option<String> {
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
