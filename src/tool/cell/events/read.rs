//! Reads a log of events.

use csv::{ByteRecord, ReaderBuilder, Trim};

use super::error::EventsError;
use super::event::{Event, Place, What};
use super::order;

/// The mark of a note of the recorder.
const NOTE: u8 = b'#';
/// The columns that a log of events must have.
const NEEDED: [&str; 4] = ["t", "cycle", "event", "line"];
/// The delimiters that spreadsheets write.
const DELIMITERS: [u8; 3] = *b",;\t";

/// What a recorder wrote.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// Hash of the program, if the log has it.
    pub program: Option<String>,
    /// One for each start of the recorder.
    pub sessions: Vec<Session>,
    /// Unusable rows: line of the file and what is wrong.
    pub rejected: Vec<(u64, String)>,
    /// Number of events that the recorder lost.
    pub lost: u64,
}

/// What a recorder wrote from one start to the next.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Session {
    /// Date and time of the start, as the controller shows them.
    pub started: Option<String>,
    /// In the order of their times.
    pub events: Vec<Event>,
}

/// Whether a file is a log of events: its first row that is no note has a column `event`.
#[must_use]
pub fn is_event_log(bytes: &[u8]) -> bool {
    let mut rows = bytes.split(|byte| *byte == b'\n').filter(|row| !is_note(row));
    rows.next().is_some_and(|row| names(row).iter().any(|name| name == "event"))
}

/// Reads a log of events.
///
/// # Errors
/// No log of events, two programs or two robots in it, a clock that jumps, or more unusable rows than
/// usable ones.
pub fn read(bytes: &[u8]) -> Result<Recording, EventsError> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let mut reading = Reading::default();
    let ends_whole = bytes.ends_with(b"\n");
    let count = bytes.split(|byte| *byte == b'\n').count() as u64;
    for (number, row) in (1..).zip(bytes.split(|byte| *byte == b'\n')) {
        let row = row.strip_suffix(b"\r").unwrap_or(row);
        if is_note(row) {
            reading.note(number, &String::from_utf8_lossy(row))?;
        } else if reading.columns.is_empty() || reading.is_header(row) {
            reading.header(row)?;
        } else if !ends_whole && number == count {
            let reason = "the file ends within the row".to_owned();
            reading.recording.rejected.push((number, reason));
        } else {
            match reading.event(row) {
                Ok(event) => reading.rows.push((number, event)),
                Err(reason) => reading.recording.rejected.push((number, reason)),
            }
        }
    }
    reading.finish()
}

fn is_note(row: &[u8]) -> bool {
    let first = row.iter().find(|byte| !byte.is_ascii_whitespace());
    first.is_none_or(|byte| *byte == NOTE)
}

/// The delimiter of a header.
fn delimiter(row: &[u8]) -> u8 {
    let count = |mark: &u8| memchr::memchr_iter(*mark, row).count();
    DELIMITERS.into_iter().rev().max_by_key(count).unwrap_or(b',')
}

/// The fields of a row.
fn fields(row: &[u8], delimiter: u8) -> ByteRecord {
    let mut record = ByteRecord::new();
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .delimiter(delimiter)
        .trim(Trim::All)
        .from_reader(row);
    // Reading from memory does not fail; a row without fields stays empty.
    let _ = reader.read_byte_record(&mut record);
    record
}

/// The names of the columns, lower-case.
fn names(row: &[u8]) -> Vec<String> {
    let fields = fields(row, delimiter(row));
    fields.iter().map(|field| String::from_utf8_lossy(field).to_lowercase()).collect()
}

/// A file that is being read.
#[derive(Default)]
struct Reading {
    recording: Recording,
    columns: Vec<String>,
    delimiter: u8,
    /// The events of the current session with their lines.
    rows: Vec<(u64, Event)>,
    /// Start of the current session.
    started: Option<String>,
}

impl Reading {
    fn header(&mut self, row: &[u8]) -> Result<(), EventsError> {
        self.columns = names(row);
        self.delimiter = delimiter(row);
        let missing: Vec<String> = NEEDED
            .into_iter()
            .filter(|name| !self.columns.iter().any(|column| column == name))
            .map(|name| format!("`{name}`"))
            .collect();
        if missing.is_empty() {
            return Ok(());
        }
        Err(EventsError::NoEvents { missing: missing.join(", ") })
    }

    /// Whether a row repeats the header: the recorder writes it at each start.
    fn is_header(&self, row: &[u8]) -> bool {
        row.first().is_some_and(u8::is_ascii_alphabetic) && names(row) == self.columns
    }

    fn note(&mut self, line: u64, text: &str) -> Result<(), EventsError> {
        let mut words = text.trim_start_matches(['#', ' ']).splitn(2, ' ');
        let (word, rest) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
        let rest = rest.trim().to_owned();
        match (word, &self.recording.program) {
            ("program", Some(first)) if *first != rest => {
                let first = first.clone();
                return Err(EventsError::TwoPrograms { line, first, second: rest });
            }
            ("program", _) => self.recording.program = Some(rest),
            ("session", _) => {
                self.end_session()?;
                self.started = Some(rest);
            }
            _ => {}
        }
        Ok(())
    }

    /// The event of a row; `Err` holds what is wrong.
    fn event(&self, row: &[u8]) -> Result<Event, String> {
        let fields = fields(row, self.delimiter);
        let text = |name: &str| -> Option<String> {
            let index = self.columns.iter().position(|column| column == name)?;
            let field = String::from_utf8_lossy(fields.get(index)?).trim().to_owned();
            (!field.is_empty()).then_some(field)
        };
        let number = |name: &str| -> Result<Option<f64>, String> {
            let Some(text) = text(name) else { return Ok(None) };
            // Spreadsheets that separate with semicolons write decimal commas.
            let plain = if self.delimiter == b',' { text.clone() } else { text.replace(',', ".") };
            match plain.parse::<f64>() {
                Ok(x) if x.is_finite() => Ok(Some(x)),
                _ => Err(format!("{name} = '{text}' is no number")),
            }
        };
        let count = |name: &str| -> Result<Option<u64>, String> {
            match number(name)? {
                Some(x) if x < 0.0 || x.fract() != 0.0 => {
                    Err(format!("{name} = {x} is no whole number from 0"))
                }
                x => Ok(x.map(|x| x as u64)),
            }
        };
        let needed = |name: &str| format!("the column {name} is empty");
        let t = number("t")?.ok_or_else(|| needed("t"))?;
        let cycle = count("cycle")?.ok_or_else(|| needed("cycle"))?;
        let event = text("event").ok_or_else(|| needed("event"))?;
        let what = What::parse(&event, number("value")?)?;
        let line = count("line")?.filter(|line| *line > 0).and_then(|line| line.try_into().ok());
        let place = line.map(|line| Place { file: text("file").unwrap_or_default(), line });
        if place.is_none() && what.needs_place() {
            return Err(format!("the event '{event}' has no line"));
        }
        let cmd = count("cmd")?.unwrap_or_default();
        Ok(Event { t, cycle, cmd, place, what, signal: text("signal") })
    }

    fn end_session(&mut self) -> Result<(), EventsError> {
        let rows = std::mem::take(&mut self.rows);
        let started = self.started.take();
        if rows.is_empty() {
            return Ok(());
        }
        let lost = rows.iter().map(|(_, event)| match event.what {
            What::Lost(count) => count as u64,
            _ => 0,
        });
        self.recording.lost += lost.sum::<u64>();
        self.recording.sessions.push(Session { started, events: order::ordered(rows)? });
        Ok(())
    }

    fn finish(mut self) -> Result<Recording, EventsError> {
        if self.columns.is_empty() {
            self.header(b"")?;
        }
        self.end_session()?;
        let Recording { sessions, rejected, .. } = &self.recording;
        let usable: usize = sessions.iter().map(|session| session.events.len()).sum();
        match rejected.first() {
            Some((line, reason)) if rejected.len() > usable => Err(EventsError::Corrupt {
                rejected: rejected.len(),
                rows: rejected.len() + usable,
                line: *line,
                reason: reason.clone(),
            }),
            _ => Ok(self.recording),
        }
    }
}
