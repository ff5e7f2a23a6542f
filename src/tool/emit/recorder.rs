//! The RAPID module of a recorder.

use serde::Serialize;
use tera::{Context, Tera};

use super::names::Names;
use crate::rapid::ir::number::{TIME_DECIMALS, number};

const TEMPLATE: &str = include_str!("../../../templates/recorder.mod.tera");
/// Notes of the program in memory.
pub const MOST_NOTES: usize = 3_000;
/// Notes of interrupts in memory.
const MOST_INTERRUPTS: usize = 1_000;
/// Samples in memory.
const MOST_SAMPLES: usize = 3_000;
/// Free disk that is left, MB, and size of a file, bytes, after which the next one begins.
const SPARE_MB: usize = 50;
const LARGEST: usize = 10_000_000;
/// Filling of a block of 1024 bytes from which on it is written: one row more fits.
const BLOCK: usize = 700;
/// Names of the events, in the order of their numbers in the module.
const EVENTS: [&str; 11] = [
    "cycle", "start", "arrive", "wait", "end", "signal", "output", "load", "tool", "flush", "lost",
];
/// Test signals on the arm side: speed (deg/s) and torque (Nm).
const SPEED: u32 = 4001;
const TORQUE: u32 = 4002;
/// Maximum length of a column's name with its comma, so that parts of the header fit into strings.
const HEADER_PART: usize = 70;

/// A statement or signal that is recorded.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct RecordedSite {
    /// File and line with a comma; a comma alone for a signal.
    pub place: String,
    /// The signal, or nothing.
    pub signal: String,
}

/// A signal whose changes are recorded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordedSignal {
    /// Its name.
    pub name: String,
    /// Whether it is an output.
    pub is_output: bool,
    /// Its number among the sites, from 1.
    pub site: usize,
}

/// The samples of joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampling {
    /// Axes whose speed and torque are sampled, from 1. Positions are those of all axes.
    pub axes: Vec<u32>,
    /// Time between samples, s.
    pub interval: f64,
    /// Rows that are written in a cycle.
    pub rows: usize,
}

/// A recorder to emit.
#[derive(Clone, Debug, PartialEq)]
pub struct Recorder<'a> {
    /// Hash of the program.
    pub program: &'a str,
    /// What its calls stand at, by number from 1, then the signals.
    pub sites: Vec<RecordedSite>,
    /// Its signals.
    pub signals: Vec<RecordedSignal>,
    /// Its samples.
    pub sampling: Option<Sampling>,
    /// Whether its calls at movements give the mass of the tool.
    pub tools: bool,
    /// Number of the movement that begins later in every second cycle, and by how much, s.
    pub late: Option<(usize, f64)>,
}

#[derive(Serialize)]
struct Signal<'a> {
    name: &'a str,
    instruction: &'static str,
    level: &'static str,
    site: usize,
}

#[derive(Serialize)]
struct Channel {
    axis: u32,
    signal: u32,
}

#[derive(Serialize)]
struct Samples {
    most: usize,
    interval: String,
    rows: usize,
    channels: Vec<Channel>,
    header: Vec<String>,
}

#[derive(Serialize)]
struct Late {
    movement: usize,
    seconds: String,
}

/// The text of the module.
///
/// # Errors
/// The template does not fit its data.
pub fn recorder(names: &Names, recorder: &Recorder<'_>) -> Result<String, tera::Error> {
    let signals: Vec<Signal<'_>> = recorder
        .signals
        .iter()
        .map(|signal| Signal {
            name: &signal.name,
            instruction: if signal.is_output { "ISignalDO" } else { "ISignalDI" },
            level: if signal.is_output { "DOutput" } else { "DInput" },
            site: signal.site,
        })
        .collect();
    let late = recorder
        .late
        .map(|(movement, seconds)| Late { movement, seconds: number(seconds, TIME_DECIMALS) });
    let mut context = Context::new();
    context.insert("version", env!("CARGO_PKG_VERSION"));
    context.insert("p", &names.prefix);
    context.insert("module", &names.module);
    context.insert("program", recorder.program);
    context.insert("file", &log_name(recorder.program));
    context.insert("spare_mb", &SPARE_MB);
    context.insert("largest", &LARGEST);
    context.insert("sites", &recorder.sites);
    context.insert("events", &EVENTS);
    context.insert("most", &MOST_NOTES);
    context.insert("most_interrupts", &MOST_INTERRUPTS);
    context.insert("block", &BLOCK);
    context.insert("signals", &signals);
    context.insert("sampling", &recorder.sampling.as_ref().map(samples));
    context.insert("tools", &recorder.tools);
    context.insert("late", &late);
    Tera::one_off(TEMPLATE, &context, false)
}

/// The name of the log on the controller, without its extension.
pub fn log_name(program: &str) -> String {
    format!("jr_{}", program.get(..8).unwrap_or(program))
}

fn samples(sampling: &Sampling) -> Samples {
    let channel =
        |signal: u32| sampling.axes.iter().map(move |axis| Channel { axis: *axis, signal });
    let mut header = vec!["t,cycle,cmd".to_owned()];
    let columns = (1..=6).map(|axis| format!(",q{axis}_deg"));
    let speeds = sampling.axes.iter().map(|axis| format!(",qd{axis}_deg"));
    let torques = sampling.axes.iter().map(|axis| format!(",tau{axis}"));
    for column in columns.chain(speeds).chain(torques) {
        match header.last_mut() {
            Some(part) if part.len() + column.len() <= HEADER_PART => part.push_str(&column),
            _ => header.push(column),
        }
    }
    Samples {
        most: MOST_SAMPLES,
        interval: number(sampling.interval, TIME_DECIMALS),
        rows: sampling.rows,
        channels: channel(SPEED).chain(channel(TORQUE)).collect(),
        header,
    }
}
