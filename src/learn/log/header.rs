//! The header of a CSV file, and the form of its rows.

use super::channel::Channel;
use super::columns::{Column, ColumnMap, recognised};
use super::notation::{Notation, notations, number, trimmed};
use super::part::part_number;
use super::text_row::{fields, is_blank};

/// Possible delimiters; the first one is preferred.
const DELIMITERS: [u8; 5] = *b",;\t| ";
/// Marks of comments at the beginning of a line.
const COMMENTS: [u8; 2] = *b"#%";
/// Least number of columns of a header that is a comment.
const IN_COMMENT: usize = 2;

/// The header of a file, and what it says about the rows.
#[derive(Default)]
pub(super) struct Header<'a> {
    /// The names of all columns.
    pub(super) names: Vec<String>,
    /// The recognised ones.
    pub(super) columns: Vec<Column>,
    /// The last byte of a line.
    pub(super) terminator: u8,
    /// Line of the header in the file.
    pub(super) line: u64,
    /// The head of the file below the header.
    pub(super) below: &'a [u8],
    delimiter: u8,
}

impl<'a> Header<'a> {
    /// The header in the head of a file: the first row, or a comment above it if only that names
    /// the columns.
    pub(super) fn find(head: &'a [u8], map: &ColumnMap) -> Header<'a> {
        let mut below = head.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(head);
        let end = below.iter().find(|byte| matches!(byte, b'\r' | b'\n'));
        let is_old = end == Some(&b'\r') && !below.contains(&b'\n');
        let terminator = if is_old { b'\r' } else { b'\n' };
        let mut comment = None;
        for line in 1.. {
            let length = below.iter().position(|byte| *byte == terminator);
            let (row, after) = below.split_at(length.unwrap_or(below.len()));
            below = after.get(1..).unwrap_or_default();
            let text = commented(row);
            let header = Header::of(text.unwrap_or(row), map);
            let header = Header { terminator, line, below, ..header };
            let is_last = length.is_none();
            if text.is_some() && !is_last {
                if header.has_time() && header.columns.len() >= IN_COMMENT {
                    comment = Some(header);
                }
            } else if is_last || !is_blank(row) {
                return if header.has_time() { header } else { comment.unwrap_or(header) };
            }
        }
        Header::default()
    }

    /// A row as header.
    fn of(row: &[u8], map: &ColumnMap) -> Header<'a> {
        let with = |delimiter: u8| {
            let mut names: Vec<String> = fields(row, delimiter)
                .unwrap_or_default()
                .into_iter()
                .map(|field| trimmed(field).into_owned())
                .collect();
            // Some programs end each row with a delimiter.
            names.truncate(1 + names.iter().rposition(|name| !name.is_empty()).unwrap_or(0));
            Header { columns: recognised(&names, map), names, delimiter, ..Header::default() }
        };
        let all = DELIMITERS.into_iter().rev().map(with);
        all.max_by_key(|header| header.columns.len()).unwrap_or_default()
    }

    fn has_time(&self) -> bool {
        self.columns.iter().any(|column| column.named.channel == Channel::Time)
    }

    /// The fields of a row, as many as there are columns; `None` for a comment.
    ///
    /// # Errors
    /// A row of another width.
    pub(super) fn split<'r>(&self, row: &'r [u8]) -> Result<Option<Vec<&'r [u8]>>, String> {
        let mut fields = fields(row, self.delimiter)?;
        let (found, width) = (fields.len(), self.names.len());
        if found >= width && fields[width..].iter().all(|field| is_blank(field)) {
            fields.truncate(width);
            return Ok(Some(fields));
        }
        if commented(row).is_some() {
            return Ok(None);
        }
        // Probably decimal commas between delimiting commas.
        let hint = if found + 1 >= 2 * width {
            "; write decimal points, or another delimiter than the decimal comma"
        } else {
            ""
        };
        Err(format!("{found} columns where the header has {width}{hint}"))
    }

    /// The numbers in the recognised columns of a row.
    ///
    /// # Errors
    /// A text that is not a number.
    pub(super) fn numbers(
        &self,
        fields: &[&[u8]],
        notations: &[Notation],
    ) -> Result<Vec<f64>, String> {
        let number = |(column, notation): (&Column, &Notation)| {
            let text = trimmed(fields[column.index]);
            if column.named.channel == Channel::Part {
                return Ok(part_number(&text, *notation));
            }
            let value = number(&text, *notation);
            let value = value.map_err(|why| format!("{} {why}", column.name))?;
            Ok(value * column.named.unit)
        };
        self.columns.iter().zip(notations).map(number).collect()
    }

    /// The notations of the recognised columns, according to the rows in the head.
    pub(super) fn notations(&self) -> Vec<Notation> {
        let mut texts = vec![Vec::new(); self.columns.len()];
        for row in self.below.split(|byte| *byte == self.terminator) {
            let Ok(Some(fields)) = self.split(row) else { continue };
            for (texts, column) in texts.iter_mut().zip(&self.columns) {
                texts.push(trimmed(fields[column.index]).into_owned());
            }
        }
        notations(&texts)
    }

    /// Whether the last column of the file is a recognised one.
    pub(super) fn ends_recognised(&self) -> bool {
        self.columns.iter().any(|column| column.index + 1 == self.names.len())
    }
}

/// The text of a comment.
fn commented(row: &[u8]) -> Option<&[u8]> {
    let (mark, text) = row.split_first()?;
    COMMENTS.contains(mark).then_some(text)
}
