//! Logs as CSV. Delimiter and decimal comma are detected; unusable rows are left out with their
//! number.

use std::io::{BufRead, BufReader, Read};

use super::columns::{ColumnMap, check};
use super::data::Log;
use super::error::LogError;
use super::header::Header;
use super::rows::Rows;
use super::text_row::{CutEnd, is_blank};

/// The log in the bytes of a CSV file.
///
/// # Errors
/// An unknown header, or fewer than [`MIN_ROWS`](super::MIN_ROWS) usable rows.
pub fn read_csv(bytes: &[u8], map: &ColumnMap) -> Result<Log, LogError> {
    read_rows(bytes, std::io::empty(), map)
}

/// Reads a file that begins with `head`, which contains the header.
///
/// # Errors
/// The errors of [`read_csv`], and an interrupted stream.
pub(super) fn read_rows(head: &[u8], rest: impl Read, map: &ColumnMap) -> Result<Log, LogError> {
    let header = Header::find(head, map);
    check(&header.columns, &header.names, map)?;
    let notations = header.notations();

    let mut rows = Rows::new(&header.columns);
    let mut end = CutEnd::default();
    let mut stream = BufReader::new(header.below.chain(rest));
    let (mut line, mut bytes) = (header.line, Vec::new());
    loop {
        bytes.clear();
        let count = stream
            .read_until(header.terminator, &mut bytes)
            .map_err(|error| LogError::Stream(error.to_string()))?;
        if count == 0 {
            return rows.finish();
        }
        line += 1;
        let row = bytes.strip_suffix(&[header.terminator]);
        let is_whole = row.is_some();
        let row = row.unwrap_or(&bytes);
        if is_blank(row) {
            continue;
        }
        let values = header.split(row).and_then(|fields| {
            let Some(fields) = fields else { return Ok(None) };
            if header.ends_recognised() {
                end.check(fields[fields.len() - 1], is_whole)?;
            }
            header.numbers(&fields, &notations).map(Some)
        });
        if let Some(values) = values.transpose() {
            rows.push(line, values);
        }
    }
}
