//! The recorder in the controller: its rows, and the log that it writes.

use std::fmt::Write as _;

use super::conditions::Conditions;
use super::random::Random;
use super::script::Place;

/// A row before it is written. Times are those of the plant's clock \[s\].
#[derive(Clone, Debug)]
struct Row {
    t: f64,
    /// Number of the cycle and of the movements in it; of signals known after sorting.
    state: (usize, usize),
    event: &'static str,
    place: Option<Place>,
    value: String,
    signal: String,
}

/// Collects rows.
#[derive(Clone, Debug, Default)]
pub(super) struct Recorder {
    /// Rows of the program in the order of time, by session.
    sessions: Vec<(f64, Vec<Row>)>,
    /// Rows of signals.
    signals: Vec<Row>,
}

/// The event, its value and its signal.
pub(super) type Entry<'a> = (&'static str, String, &'a str);

/// Start of the first session: seconds of its day, and the day, in days from 1970-01-01.
const SHIFT_S: f64 = 6.0 * 3600.0;
const DAY: i64 = 20_514;
const DAY_S: f64 = 86_400.0;
/// Time from a change to its interrupt \[s\].
const INTERRUPT_S: (f64, f64) = (0.001, 0.012);
/// Mean and rare longest time until the interrupt's row is written \[s\].
const WRITTEN_S: f64 = 0.008;
const WRITTEN_LATE: (f64, f64) = (0.01, 0.4);
/// Rows that the recorder keeps before it writes to the disk.
const FLUSH_ROWS: usize = 200;
/// Most rows lost at once.
const LOST_ROWS: usize = 60;

impl Recorder {
    /// A recorder starts, after a restart of the program or at the beginning.
    pub(super) fn session(&mut self, t: f64) {
        self.sessions.push((t, Vec::new()));
    }

    /// The program comes to a statement, in a cycle, after a number of movements.
    pub(super) fn program(
        &mut self,
        t: f64,
        state: (usize, usize),
        place: Option<Place>,
        entry: Entry,
    ) {
        let (event, value, signal) = entry;
        if let Some((_, rows)) = self.sessions.last_mut() {
            rows.push(Row { t, state, event, place, value, signal: signal.to_owned() });
        }
    }

    /// A signal changes.
    pub(super) fn signal(&mut self, t: f64, signal: &str, level: u8) {
        let (place, value, signal) = (None, level.to_string(), signal.to_owned());
        self.signals.push(Row { t, state: (0, 0), event: "signal", place, value, signal });
    }

    /// Starts of the sessions.
    pub(super) fn starts(&self) -> Vec<f64> {
        self.sessions.iter().map(|(start, _)| *start).collect()
    }

    /// The log of events.
    pub(super) fn log(&self, program: &str, of: &Conditions) -> String {
        let mut draws = Random::of(of.seed, "recorder", &[]);
        let mut text = format!("# joulepath recorder 1\n# program {program}\n");
        let mut signals = self.signals.clone();
        signals.sort_by(|a, b| a.t.total_cmp(&b.t));
        for (number, (start, rows)) in self.sessions.iter().enumerate() {
            let _ = writeln!(text, "# session {}", date(of.day, *start));
            if number == 0 {
                text.push_str("t,cycle,cmd,file,line,event,value,signal\n");
            }
            let end = self.sessions.get(number + 1).map_or(f64::INFINITY, |next| next.0);
            let within = signals.iter().filter(|row| row.t >= *start && row.t < end);
            let rows = merged(rows, within, &mut draws);
            written(&rows, *start, of.lost, &mut draws, &mut text);
        }
        text
    }
}

/// The rows of a session in the order in which they are written.
fn merged<'a>(
    program: &[Row],
    signals: impl Iterator<Item = &'a Row>,
    draws: &mut Random,
) -> Vec<Row> {
    let last = program.last().map_or(0.0, |row| row.t);
    let mut rows: Vec<(f64, Row)> = program.iter().map(|row| (row.t, row.clone())).collect();
    for row in signals {
        let t = row.t + draws.between(INTERRUPT_S.0, INTERRUPT_S.1);
        let behind = program.partition_point(|of| of.t <= t);
        let state = behind.checked_sub(1).map_or((1, 0), |at| program[at].state);
        let (rare, late_s) = WRITTEN_LATE;
        let most_s = if draws.chance(rare) { late_s } else { 2.0 * WRITTEN_S };
        let written = t + most_s * draws.unit();
        // What comes after the last row of the program is in no file.
        if written <= last {
            rows.push((written, Row { t, state, ..row.clone() }));
        }
    }
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    rows.into_iter().map(|(_, row)| row).collect()
}

/// Writes the rows of a session that began at `start`.
fn written(rows: &[Row], start: f64, lost: f64, draws: &mut Random, text: &mut String) {
    let (mut kept, mut gone, mut missing) = (0, 0, 0);
    for row in rows {
        if missing > 0 {
            missing -= 1;
            gone += 1;
            continue;
        }
        let clock = |t: f64| format!("{:.3},{},{}", t - start, row.state.0, row.state.1);
        if gone > 0 {
            let _ = writeln!(text, "{},,,lost,{gone},", clock(row.t));
            gone = 0;
        }
        let place = match &row.place {
            Some(place) => format!("{},{}", place.file, place.line),
            None => ",".into(),
        };
        let _ =
            writeln!(text, "{},{place},{},{},{}", clock(row.t), row.event, row.value, row.signal);
        kept += 1;
        // The disk is written to while the cycle begins.
        if kept >= FLUSH_ROWS && row.event == "cycle" {
            let took = draws.log_between(0.01, 0.15);
            let _ = writeln!(text, "{},,,flush,{took:.3},", clock(row.t));
            kept = 0;
        }
        if lost > 0.0 && draws.chance(lost) {
            missing = 1 + draws.below(LOST_ROWS);
        }
    }
}

/// Date and time of a second, on one of the days of the plant's clock (E. Richards, "Calendars", 2013, for the date).
fn date(day: u32, t: f64) -> String {
    let seconds = (SHIFT_S + t).max(0.0);
    let of_day = (seconds % DAY_S) as u64;
    // Julian day number of noon.
    let f = DAY + i64::from(day) + (seconds / DAY_S) as i64 + 2_440_588 + 1401;
    let f = f + (((4 * (f - 1401) + 274_277) / 146_097) * 3) / 4 - 38;
    let e = 4 * f + 3;
    let h = 5 * ((e % 1461) / 4) + 2;
    let day = (h % 153) / 5 + 1;
    let month = (h / 153 + 2) % 12 + 1;
    let year = e / 1461 - 4716 + (14 - month) / 12;
    let (hour, minute, second) = (of_day / 3600, of_day / 60 % 60, of_day % 60);
    format!("{year:04}-{month:02}-{day:02} {hour:02}:{minute:02}:{second:02}")
}
