//! Logs as Parquet files with one column of numbers for each channel.

use std::panic::{AssertUnwindSafe, catch_unwind};

use bytes::Bytes;
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::{Field, Row};

use super::columns::{Column, ColumnMap, check, recognised};
use super::data::Log;
use super::error::LogError;
use super::rows::Rows;

/// Line of the first row, counted as in a CSV file with a header.
const FIRST_ROW: u64 = 2;

/// The log in the bytes of a Parquet file.
///
/// # Errors
/// The errors of [`read_csv`](super::read_csv), and a damaged file.
pub(super) fn read_parquet(bytes: &[u8], map: &ColumnMap) -> Result<Log, LogError> {
    // The decoders of the crate may panic on a damaged page.
    let read = catch_unwind(AssertUnwindSafe(|| read(bytes, map)));
    read.unwrap_or_else(|_| Err(LogError::Parquet("it is damaged".into())))
}

fn read(bytes: &[u8], map: &ColumnMap) -> Result<Log, LogError> {
    let reader = SerializedFileReader::new(Bytes::copy_from_slice(bytes)).map_err(|e| wrong(&e))?;
    let schema = reader.metadata().file_metadata().schema();
    let names: Vec<String> =
        schema.get_fields().iter().map(|field| field.name().to_owned()).collect();
    let columns = recognised(&names, map);
    check(&columns, &names, map)?;
    let mut rows = Rows::new(&columns);
    for (index, row) in reader.get_row_iter(None).map_err(|e| wrong(&e))?.enumerate() {
        let row = row.map_err(|e| wrong(&e))?;
        let value =
            |column: &Column| Ok(number(&row, column.index, &column.name)? * column.named.unit);
        rows.push(FIRST_ROW + index as u64, columns.iter().map(value).collect());
    }
    rows.finish()
}

/// The number in a column of a row.
fn number(row: &Row, index: usize, name: &str) -> Result<f64, String> {
    let Some((_, field)) = row.get_column_iter().nth(index) else {
        return Err(format!("{name} is not there"));
    };
    let value = match field {
        Field::Null => return Err(format!("{name} is empty")),
        Field::Bool(value) => f64::from(u8::from(*value)),
        Field::Byte(value) => f64::from(*value),
        Field::Short(value) => f64::from(*value),
        Field::Int(value) => f64::from(*value),
        Field::Long(value) => *value as f64,
        Field::UByte(value) => f64::from(*value),
        Field::UShort(value) => f64::from(*value),
        Field::UInt(value) => f64::from(*value),
        Field::ULong(value) => *value as f64,
        Field::Float16(value) => f64::from(*value),
        Field::Float(value) => f64::from(*value),
        Field::Double(value) => *value,
        other => other.to_string().parse().unwrap_or(f64::NAN),
    };
    if value.is_finite() { Ok(value) } else { Err(format!("{name} is '{field}', not a number")) }
}

fn wrong(error: &ParquetError) -> LogError {
    LogError::Parquet(error.to_string())
}
