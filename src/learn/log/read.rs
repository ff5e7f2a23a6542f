//! Reads a log as CSV or Parquet, according to its content.

use std::io::Read;

use super::columns::ColumnMap;
use super::csv::{read_csv, read_rows};
use super::data::Log;
use super::error::LogError;
#[cfg(feature = "parquet")]
use super::parquet::read_parquet;
use super::utf16;

/// Number of bytes that determine the type of a file; a header is shorter.
const HEAD: u64 = 1 << 16;

/// The log in the bytes of a file, CSV or Parquet according to its content.
///
/// # Errors
/// Unknown columns, fewer than [`MIN_ROWS`](super::MIN_ROWS) usable rows, or a damaged file.
pub fn read(bytes: &[u8], map: &ColumnMap) -> Result<Log, LogError> {
    read_from(bytes, map)
}

/// Reads a log from a stream. For CSV only the recognised columns stay in memory.
///
/// # Errors
/// The errors of [`read`], and an interrupted stream.
pub fn read_from(mut stream: impl Read, map: &ColumnMap) -> Result<Log, LogError> {
    let broken = |error: std::io::Error| LogError::Stream(error.to_string());
    let mut head = Vec::new();
    stream.by_ref().take(HEAD).read_to_end(&mut head).map_err(broken)?;
    let parquet = head.starts_with(b"PAR1");
    if !parquet && !utf16::is_utf16(&head) {
        if let Some(what) = no_text(&head) {
            return Err(LogError::NoText(what));
        }
        return read_rows(&head, stream, map);
    }
    stream.read_to_end(&mut head).map_err(broken)?;
    if !parquet {
        return read_csv(utf16::decoded(&head).as_bytes(), map);
    }
    #[cfg(feature = "parquet")]
    return read_parquet(&head, map);
    #[cfg(not(feature = "parquet"))]
    Err(LogError::Parquet("this build does not read them".into()))
}

/// Description of a file that is not text, from its first bytes.
fn no_text(head: &[u8]) -> Option<&'static str> {
    const PACKED: [&[u8]; 4] =
        [&[0x1f, 0x8b], b"PK\x03\x04", b"\xfd7zXZ", &[0x28, 0xb5, 0x2f, 0xfd]];
    if PACKED.iter().any(|magic| head.starts_with(magic)) {
        return Some("packed");
    }
    let mut header = head.split(|byte| *byte == b'\n');
    header.next().is_some_and(|row| row.contains(&0)).then_some("no text")
}
