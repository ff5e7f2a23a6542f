//! Logs as CSV: delimiter and decimal comma are detected, and rows that can't be
//! used are left out with their number.

use csv::{ByteRecord, ReaderBuilder};

use super::channel::{Channel, Named};
use super::error::LogError;
use super::{Log, MIN_ROWS, Rejected};

/// What may stand between two columns.
const DELIMITERS: [u8; 3] = *b",;\t";

/// A recognised column.
struct Column {
    index: usize,
    name: String,
    named: Named,
}

/// The log in the bytes of a file.
///
/// # Errors
/// A header that can't be understood, or fewer than [`MIN_ROWS`] usable rows.
pub fn read_csv(bytes: &[u8]) -> Result<Log, LogError> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let header = bytes.split(|byte| *byte == b'\n').next().unwrap_or(bytes);
    let header = String::from_utf8_lossy(header).trim_end().to_owned();
    let (delimiter, columns) = DELIMITERS
        .iter()
        .map(|delimiter| (*delimiter, columns(bytes, *delimiter)))
        .max_by_key(|(delimiter, columns)| (columns.len(), *delimiter == b','))
        .unwrap_or_default();
    check(&columns, &header)?;

    let mut log = Log {
        channels: columns.iter().map(|column| column.named.channel).collect(),
        values: vec![Vec::new(); columns.len()],
        rejected: Vec::new(),
    };
    let time = log.channels.iter().position(|channel| *channel == Channel::Time).unwrap_or(0);
    let mut reader = ReaderBuilder::new().delimiter(delimiter).flexible(true).from_reader(bytes);
    let width = reader.byte_headers().map_or(0, ByteRecord::len);
    let mut record = ByteRecord::new();
    let mut row = Vec::with_capacity(columns.len());
    while reader.read_byte_record(&mut record).unwrap_or(false) {
        let line = record.position().map_or(0, csv::Position::line);
        let last = log.values[time].last().copied();
        match numbers(&record, width, &columns, delimiter, &mut row)
            .and_then(|()| later(row[time], last))
        {
            Ok(()) => {
                for (column, value) in log.values.iter_mut().zip(&row) {
                    column.push(*value);
                }
            }
            Err(reason) => log.rejected.push(Rejected { row: line, reason }),
        }
    }
    let usable = log.time().len();
    if usable < MIN_ROWS {
        let why = log.rejected.first().map_or_else(String::new, |first| {
            format!("; {} were left out, row {}: {}", log.rejected.len(), first.row, first.reason)
        });
        return Err(LogError::Short { usable, needed: MIN_ROWS, why });
    }
    Ok(log)
}

/// The recognised columns if `delimiter` stands between them.
fn columns(bytes: &[u8], delimiter: u8) -> Vec<Column> {
    let mut reader = ReaderBuilder::new().delimiter(delimiter).flexible(true).from_reader(bytes);
    let Ok(header) = reader.byte_headers() else { return Vec::new() };
    let name = |field: &[u8]| String::from_utf8_lossy(field).trim().to_owned();
    let column = |(index, field): (usize, &[u8])| {
        let name = name(field);
        Some(Column { index, named: Channel::named(&name)?, name })
    };
    header.iter().enumerate().filter_map(column).collect()
}

fn check(columns: &[Column], header: &str) -> Result<(), LogError> {
    if !columns.iter().any(|column| column.named.channel == Channel::Time) {
        return Err(LogError::NoTime { header: header.chars().take(80).collect() });
    }
    for (i, column) in columns.iter().enumerate() {
        let channel = column.named.channel;
        if let Some(other) = columns[..i].iter().find(|other| other.named.channel == channel) {
            return Err(LogError::Twice { first: other.name.clone(), second: column.name.clone() });
        }
        let Some(joint) = channel.joint() else { continue };
        let of_family = columns.iter().map(|other| other.named.channel);
        let of_family = of_family.filter(|other| other.family() == channel.family());
        let joints: Vec<usize> = of_family.filter_map(Channel::joint).collect();
        if let Some(missing) = (0..joint).find(|before| !joints.contains(before)) {
            return Err(LogError::Gap { found: column.name.clone(), missing: missing + 1 });
        }
    }
    Ok(())
}

/// Reads the recognised columns of one row into `row`.
fn numbers(
    record: &ByteRecord,
    width: usize,
    columns: &[Column],
    delimiter: u8,
    row: &mut Vec<f64>,
) -> Result<(), String> {
    if record.len() != width {
        return Err(format!("{} columns where the header has {width}", record.len()));
    }
    row.clear();
    for column in columns {
        let text = String::from_utf8_lossy(record.get(column.index).unwrap_or_default());
        let text = text.trim();
        let value = if delimiter == b',' {
            text.parse::<f64>()
        } else {
            text.replacen(',', ".", 1).parse()
        };
        match value {
            Ok(value) if value.is_finite() => row.push(value * column.named.unit),
            _ if text.is_empty() => return Err(format!("{} is empty", column.name)),
            _ => return Err(format!("{} is '{text}', not a number", column.name)),
        }
    }
    Ok(())
}

/// Whether time goes on.
fn later(time: f64, last: Option<f64>) -> Result<(), String> {
    match last {
        Some(last) if time == last => Err(format!("the time {time} s is there twice")),
        Some(last) if time < last => Err(format!("the time goes back from {last} s to {time} s")),
        _ => Ok(()),
    }
}
