//! Measured logs: what a robot did, as columns of numbers. Knows no robot.

mod bandwidth;
mod channel;
mod columns;
mod csv;
mod differentiate;
mod error;
mod low_pass;
mod marks;
mod motion;
#[cfg(feature = "parquet")]
mod parquet;
mod periods;
mod rows;
mod three_phase;
mod uniform;
mod utf16;

use std::io::Read;

pub use bandwidth::bandwidth;
pub use channel::Channel;
pub use columns::ColumnMap;
pub use csv::read_csv;
pub use differentiate::derivatives;
pub use error::LogError;
pub use low_pass::LowPass;
pub use marks::{Aligned, aligned, are_halves};
pub use motion::Motion;
pub use periods::{Averaged, Periods, averaged, find_periods};
pub use three_phase::{Signed, Vectors, coherence, signed, vectors};
pub use uniform::{Section, interpolated, median_step, sections};

use channel::Family;

/// A log needs this many usable rows.
pub const MIN_ROWS: usize = 10;

/// A log, SI units and radians; its rows are in the order of time.
#[derive(Clone, Debug, PartialEq)]
pub struct Log {
    /// What is in which column of `values`.
    pub channels: Vec<Channel>,
    /// A column for each channel, all of the same length.
    pub values: Vec<Vec<f64>>,
    /// Line of the file of each usable row; the header is 1.
    pub rows: Vec<u64>,
    /// Rows that were left out.
    pub rejected: Vec<Rejected>,
    /// Angles that the file had in degrees.
    pub degrees: Vec<Channel>,
}

/// A row that can't be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rejected {
    /// Line of the file; the header is 1.
    pub row: u64,
    /// Why.
    pub reason: String,
}

/// So many bytes tell what a file is; a header is shorter.
const HEAD: u64 = 1 << 16;

/// The log in the bytes of a file, CSV or Parquet by its content.
///
/// # Errors
/// Columns that can't be understood, fewer than [`MIN_ROWS`] usable rows, a damaged file.
pub fn read(bytes: &[u8], map: &ColumnMap) -> Result<Log, LogError> {
    read_from(bytes, map)
}

/// The same from a stream. Of a CSV only the recognised columns stay in memory.
///
/// # Errors
/// As of [`read`], and a stream that breaks off.
pub fn read_from(mut stream: impl Read, map: &ColumnMap) -> Result<Log, LogError> {
    let broken = |error: std::io::Error| LogError::Stream { reason: error.to_string() };
    let mut head = Vec::new();
    stream.by_ref().take(HEAD).read_to_end(&mut head).map_err(broken)?;
    let parquet = head.starts_with(b"PAR1");
    if !parquet && !utf16::is_utf16(&head) {
        if let Some(what) = no_text(&head) {
            return Err(LogError::NoText { what });
        }
        return csv::read_rows(&head, stream, map);
    }
    stream.read_to_end(&mut head).map_err(broken)?;
    if !parquet {
        return read_csv(utf16::decoded(&head).as_bytes(), map);
    }
    #[cfg(feature = "parquet")]
    return parquet::read_parquet(&head, map);
    #[cfg(not(feature = "parquet"))]
    Err(LogError::Parquet { reason: "this build does not read them".into() })
}

/// What a file is that begins so and is no text.
fn no_text(head: &[u8]) -> Option<&'static str> {
    const PACKED: [&[u8]; 4] =
        [&[0x1f, 0x8b], b"PK\x03\x04", b"\xfd7zXZ", &[0x28, 0xb5, 0x2f, 0xfd]];
    if PACKED.iter().any(|magic| head.starts_with(magic)) {
        return Some("packed");
    }
    let mut header = head.split(|byte| *byte == b'\n');
    header.next().is_some_and(|row| row.contains(&0)).then_some("no text")
}

impl Log {
    /// Times \[s\].
    #[must_use]
    pub fn time(&self) -> &[f64] {
        self.column(Channel::Time).unwrap_or(&[])
    }

    /// The same with some rows only, by their places.
    #[must_use]
    pub fn of_rows(&self, kept: &[usize]) -> Log {
        let of = |x: &Vec<f64>| kept.iter().map(|row| x[*row]).collect();
        Log {
            channels: self.channels.clone(),
            values: self.values.iter().map(of).collect(),
            rows: kept.iter().map(|row| self.rows[*row]).collect(),
            rejected: self.rejected.clone(),
            degrees: self.degrees.clone(),
        }
    }

    /// Number of joints whose positions are logged.
    #[must_use]
    pub fn joints(&self) -> usize {
        self.channels.iter().filter(|channel| channel.family() == Family::Position).count()
    }

    /// A column, where there is one.
    #[must_use]
    pub fn column(&self, channel: Channel) -> Option<&[f64]> {
        let index = self.channels.iter().position(|known| *known == channel)?;
        Some(&self.values[index])
    }

    /// The columns that `channel` names for each joint, in order; `None` where one is
    /// missing.
    #[must_use]
    pub fn of_joints(&self, channel: fn(usize) -> Channel) -> Option<Vec<&[f64]>> {
        (0..self.joints()).map(|joint| self.column(channel(joint))).collect()
    }
}
