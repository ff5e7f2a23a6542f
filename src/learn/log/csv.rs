//! Logs as CSV. Delimiter and decimal comma are detected; unusable rows are left out with their
//! number.

use std::io::Read;

use csv::{ByteRecord, ReaderBuilder};

use super::columns::{Column, ColumnMap, check, recognised};
use super::data::Log;
use super::error::LogError;
use super::rows::Rows;

/// Possible delimiters.
const DELIMITERS: [u8; 5] = *b",;\t| ";

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
    let head = head.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(head);
    let (delimiter, names, columns) = DELIMITERS
        .iter()
        .map(|delimiter| {
            let names = names(head, *delimiter);
            let columns = recognised(&names, map);
            (*delimiter, names, columns)
        })
        .max_by_key(|(delimiter, _, columns)| (columns.len(), *delimiter == b','))
        .unwrap_or_default();
    check(&columns, &names, map)?;

    let mut rows = Rows::new(&columns);
    let mut reader =
        ReaderBuilder::new().delimiter(delimiter).flexible(true).from_reader(head.chain(rest));
    let mut record = ByteRecord::new();
    let mut values = Vec::with_capacity(columns.len());
    while reader
        .read_byte_record(&mut record)
        .map_err(|error| LogError::Stream(error.to_string()))?
    {
        let line = record.position().map_or(0, csv::Position::line);
        let read = numbers(&record, names.len(), &columns, &mut values);
        rows.push(line, read.map(|()| values.as_slice()));
    }
    rows.finish()
}

/// The column names with this delimiter.
fn names(bytes: &[u8], delimiter: u8) -> Vec<String> {
    let mut reader = ReaderBuilder::new().delimiter(delimiter).flexible(true).from_reader(bytes);
    let Ok(header) = reader.byte_headers() else { return Vec::new() };
    header.iter().map(|field| String::from_utf8_lossy(field).trim().to_owned()).collect()
}

/// Reads the recognised columns of one row into `row`.
fn numbers(
    record: &ByteRecord,
    width: usize,
    columns: &[Column],
    row: &mut Vec<f64>,
) -> Result<(), String> {
    if record.len() != width {
        // Probably decimal commas between delimiting commas.
        let hint = if record.len() + 1 >= 2 * width {
            "; write decimal points, or another delimiter than the decimal comma"
        } else {
            ""
        };
        return Err(format!("{} columns where the header has {width}{hint}", record.len()));
    }
    row.clear();
    for column in columns {
        let text = String::from_utf8_lossy(record.get(column.index).unwrap_or_default());
        let text = text.trim();
        // A comma in a field is a decimal comma, not a delimiter.
        let value = text.parse::<f64>().or_else(|_| text.replacen(',', ".", 1).parse());
        match value {
            Ok(value) if value.is_finite() => row.push(value * column.named.unit),
            _ if text.is_empty() => return Err(format!("{} is empty", column.name)),
            _ => return Err(format!("{} is '{text}', not a number", column.name)),
        }
    }
    Ok(())
}
