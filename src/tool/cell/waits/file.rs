//! `waits.toml`: what `waits` writes and `optimize` reads.

use serde::{Deserialize, Serialize};

/// Version of the form.
pub const FORMAT: u32 = 1;

/// Waits of a program, with the cycles in which they were recorded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WaitsFile {
    /// [`FORMAT`].
    pub format: u32,
    /// Hash of the program.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub program: Option<String>,
    /// Number of cycles that were recorded from start to end.
    pub cycles: usize,
    /// The waits, in the order of the program's text.
    #[serde(default)]
    pub wait: Vec<WaitEntry>,
    /// The ways through the program, the most frequent first.
    #[serde(default)]
    pub way: Vec<WayEntry>,
}

/// A wait.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WaitEntry {
    /// Path of the file, as the recorder has it.
    pub file: String,
    /// Line, from 1.
    pub line: u32,
    /// The signal that it waits for, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub signal: Option<String>,
    /// Its kind.
    pub kind: KindEntry,
    /// Why, a word of `docs/cell.md`.
    pub reason: String,
    /// Number of visits.
    pub n: usize,
    /// Number of cycles that were compared.
    pub compared: usize,
    /// ln of the odds of slack against process.
    pub log_odds: f64,
    /// How much later it ends for each second that the robot comes later: value, low, high.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slope: Option<[f64; 3]>,
    /// Quantiles of its length at 5, 25, 50, 75 and 95 %, s; none without visits.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub quantiles_s: Option<[f64; 5]>,
    /// Whether the robot sets an output where it waits, which the machine may answer.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub request: bool,
    /// From where the machine's time counts: of slack alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub after: Option<After>,
}

/// Kinds of waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum KindEntry {
    /// Arriving later shortens it.
    Slack,
    /// It keeps its length.
    Process,
    /// Neither is proved.
    Unknown,
}

/// The last event of its kind before the robot comes to the wait.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct After {
    /// What happens.
    pub event: EventEntry,
    /// Whether it happens in the cycle before.
    pub before: bool,
    /// Where the program does it, if it does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// See `file`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<u32>,
    /// Signal of an output or a signal.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub signal: Option<String>,
    /// Its new level.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<f64>,
}

/// Events from which a time counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum EventEntry {
    /// The cycle starts.
    Cycle,
    /// A movement starts.
    Start,
    /// A movement ends at a stop point.
    Arrive,
    /// A wait ends in which the robot has waited.
    End,
    /// The program sets an output.
    Output,
    /// A signal changes.
    Signal,
}

/// A way through the program, with its complete cycles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WayEntry {
    /// Share of all cycles that took it.
    pub share: f64,
    /// Duration of each cycle, s.
    pub cycle_s: Vec<f64>,
    /// The waits of each cycle, in the order in which the program comes to them.
    #[serde(default)]
    pub record: Vec<RecordEntry>,
}

/// One execution of a wait in each cycle of its way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordEntry {
    /// The statement.
    pub file: String,
    /// See `file`.
    pub line: u32,
    /// Which execution in the cycle, from 0.
    pub occurrence: usize,
    /// When the robot came, s: after `after` of a slack, else after the start of the cycle.
    pub came_s: Vec<f64>,
    /// When what it waits for was there, s, from the same moment. Where it was there before the robot
    /// and its signal is not recorded, the time at which the robot came.
    pub signal_s: Vec<f64>,
}

/// An unusable `waits.toml`.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WaitsFileError {
    /// Not the form of `waits.toml`.
    #[error("{message}; write the file anew with `joulepath waits`")]
    Form {
        /// What is wrong, with its line.
        message: String,
    },
    /// Another version of the form.
    #[error(
        "format = {found}: this version reads format {FORMAT}; write it anew with `joulepath waits`"
    )]
    Format {
        /// The version of the file.
        found: u32,
    },
    /// Lists that do not belong together.
    #[error(
        "{place}: {list} has {found} numbers, the way has {expected} cycles: write the file anew with \
         `joulepath waits`"
    )]
    Lengths {
        /// The wait.
        place: String,
        /// The list.
        list: &'static str,
        /// Its length.
        found: usize,
        /// The length of `cycle_s`.
        expected: usize,
    },
    /// A number that is none.
    #[error(
        "{place}: {list} has a number that is not finite; write the file anew with `joulepath waits`"
    )]
    NotFinite {
        /// The wait or the way.
        place: String,
        /// The list.
        list: &'static str,
    },
    /// A share that is none.
    #[error("{place}: share = {share}: give a number from 0 to 1")]
    Share {
        /// The way.
        place: String,
        /// The number.
        share: f64,
    },
    /// A slack that counts from nowhere.
    #[error(
        "{place} is slack and has no `after`: state the event from which the machine's time counts, or \
         write kind = \"process\""
    )]
    NoReference {
        /// The wait.
        place: String,
    },
    /// A recorded wait that is not in the list.
    #[error(
        "{place} is recorded in a way, but no [[wait]] has this file and line; add it, or write the file anew with `joulepath waits`"
    )]
    NoWait {
        /// The wait.
        place: String,
    },
}

impl WaitsFile {
    /// The text of the file.
    ///
    /// # Errors
    /// A number that TOML cannot hold.
    pub fn text(&self) -> Result<String, WaitsFileError> {
        let text = toml::to_string(self);
        let text = text.map_err(|error| WaitsFileError::Form { message: error.to_string() })?;
        let head = "# Waits that joulepath found in recorded cycles; `optimize --waits` reads them (docs/cell.md).\n";
        Ok(format!("{head}{text}"))
    }

    /// Reads the text of a file.
    ///
    /// # Errors
    /// Unknown or missing keys, another format, lists of different lengths, a slack without its
    /// reference.
    pub fn parse(text: &str) -> Result<WaitsFile, WaitsFileError> {
        let file: WaitsFile = toml::from_str(text).map_err(|error| form(text, &error))?;
        if file.format != FORMAT {
            return Err(WaitsFileError::Format { found: file.format });
        }
        for wait in &file.wait {
            if wait.kind == KindEntry::Slack && wait.after.is_none() {
                return Err(WaitsFileError::NoReference {
                    place: format!("{}:{}", wait.file, wait.line),
                });
            }
        }
        for (number, way) in file.way.iter().enumerate() {
            let place = format!("way {}", number + 1);
            check_finite(&place, "cycle_s", &way.cycle_s)?;
            if !(0.0..=1.0).contains(&way.share) {
                return Err(WaitsFileError::Share { place, share: way.share });
            }
            for record in &way.record {
                let place = format!("{}:{}", record.file, record.line);
                let is_it = |wait: &WaitEntry| wait.file == record.file && wait.line == record.line;
                if !file.wait.iter().any(is_it) {
                    return Err(WaitsFileError::NoWait { place });
                }
                for (list, values) in [("came_s", &record.came_s), ("signal_s", &record.signal_s)] {
                    let (found, expected) = (values.len(), way.cycle_s.len());
                    if found != expected {
                        return Err(WaitsFileError::Lengths { place, list, found, expected });
                    }
                    check_finite(&place, list, values)?;
                }
            }
        }
        Ok(file)
    }
}

fn check_finite(place: &str, list: &'static str, values: &[f64]) -> Result<(), WaitsFileError> {
    if values.iter().all(|x| x.is_finite()) {
        return Ok(());
    }
    Err(WaitsFileError::NotFinite { place: place.to_owned(), list })
}

/// The message of the reader with the number of the line.
fn form(text: &str, error: &toml::de::Error) -> WaitsFileError {
    let line = error.span().and_then(|span| text.get(..span.start));
    let line = line.map_or(1, |before| before.matches('\n').count() + 1);
    WaitsFileError::Form { message: format!("line {line}: {}", error.message()) }
}
