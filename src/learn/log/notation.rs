//! Notations of numbers: decimal point or comma, grouped digits.
//!
//! A mark before a group of three digits, as in `1,234`, may be a decimal mark or group the digits.
//! The other numbers of the column decide, then those of the other columns.

use std::borrow::Cow;

/// Marks of groups beside point and comma; the last three are the spaces that do not break a line,
/// and the apostrophe of typesetting.
const GROUPING: [char; 5] = [' ', '\'', '\u{a0}', '\u{202f}', '\u{2019}'];
/// Digits in a group.
const GROUP: usize = 3;

/// The decimal mark of a column, as far as known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Notation {
    /// The mark of the column.
    column: Option<char>,
    /// The mark of the other columns.
    file: Option<char>,
}

/// The text of a field without quotes.
pub(super) fn trimmed(field: &[u8]) -> Cow<'_, str> {
    let is_around = |byte: &u8| byte.is_ascii_whitespace() || *byte == b'"';
    let begin = field.iter().position(|byte| !is_around(byte)).unwrap_or(field.len());
    let end = field.iter().rposition(|byte| !is_around(byte)).map_or(begin, |last| last + 1);
    String::from_utf8_lossy(&field[begin..end])
}

/// The notations of columns, each with some of its texts.
pub(super) fn notations(columns: &[Vec<String>]) -> Vec<Notation> {
    let of_columns: Vec<Option<char>> =
        columns.iter().map(|texts| most(texts.iter().filter_map(|text| mark(text)))).collect();
    let file = most(of_columns.iter().flatten().copied());
    of_columns.into_iter().map(|column| Notation { column, file }).collect()
}

/// The most frequent mark.
fn most(marks: impl Iterator<Item = char>) -> Option<char> {
    let balance: i64 = marks.map(|mark| if mark == ',' { -1 } else { 1 }).sum();
    match balance {
        0 => None,
        1.. => Some('.'),
        _ => Some(','),
    }
}

/// The decimal mark that a text has for certain.
fn mark(text: &str) -> Option<char> {
    let at = text.rfind(['.', ','])?;
    let last = if text[at..].starts_with(',') { ',' } else { '.' };
    let other = if last == ',' { '.' } else { ',' };
    if text.contains(other) {
        return Some(last);
    }
    match text.matches(last).count() {
        1 => (!is_grouped(text, last)).then_some(last),
        _ => Some(other),
    }
}

/// Whether `mark` separates groups of digits: one to three, not only 0, then three each.
fn is_grouped(text: &str, mark: char) -> bool {
    let mut groups = text.trim_start_matches(['-', '+']).split(mark);
    let is_digits = |group: &str| group.bytes().all(|byte| byte.is_ascii_digit());
    let first = groups.next().unwrap_or_default();
    (1..=GROUP).contains(&first.len())
        && !first.starts_with('0')
        && is_digits(first)
        && groups.all(|group| group.len() == GROUP && is_digits(group))
}

/// The finite number of a text in the notation of its column.
///
/// # Errors
/// Why it is not a number, as the end of a sentence that begins with the name of the column.
pub(super) fn number(text: &str, notation: Notation) -> Result<f64, String> {
    if text.is_empty() {
        return Err("is empty".into());
    }
    let value = match decimal(text, notation)? {
        Some(plain) => plain.parse().ok().filter(|value: &f64| value.is_finite()),
        None => None,
    };
    value.ok_or_else(|| format!("is '{text}', not a number"))
}

/// The text with a decimal point and without groups; `None` if the groups are wrong.
///
/// # Errors
/// A mark that may be decimal or group digits.
fn decimal(text: &str, notation: Notation) -> Result<Option<Cow<'_, str>>, String> {
    let Notation { column, file } = notation;
    if !text.contains([',', '.']) && !text.contains(GROUPING) {
        return Ok(Some(text.into()));
    }
    let decimal = match (mark(text), column) {
        (Some(mark), _) | (None, Some(mark)) => mark,
        (None, None) => {
            let own = if text.contains(',') { ',' } else { '.' };
            if file.is_some_and(|file| file != own) {
                return Err(format!(
                    "is '{text}', with a mark that may be decimal or group the digits"
                ));
            }
            own
        }
    };
    let (whole, fraction) = text.split_once(decimal).unwrap_or((text, ""));
    let grouping = if decimal == ',' { '.' } else { ',' };
    for mark in GROUPING.into_iter().chain([grouping]) {
        if whole.contains(mark) {
            let plain = whole.replace(mark, "");
            return Ok(is_grouped(whole, mark).then(|| format!("{plain}.{fraction}").into()));
        }
    }
    if decimal == '.' { Ok(Some(text.into())) } else { Ok(Some(text.replacen(',', ".", 1).into())) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(columns: &[&[&str]], text: &str) -> Result<f64, String> {
        let columns: Vec<Vec<String>> = columns
            .iter()
            .map(|texts| texts.iter().map(|text| (*text).to_owned()).collect())
            .collect();
        number(text, notations(&columns)[0])
    }

    #[test]
    fn numbers_are_read_in_the_notation_of_their_column() {
        for (column, text, value) in [
            (&["0.5", "1.234"][..], "1.234", 1.234),
            (&["0,5", "1,234"], "1,234", 1.234),
            // Groups of digits.
            (&["0.5"], "1,234", 1234.0),
            (&["0,5"], "1.234", 1234.0),
            (&["0,5"], "-1.234.567,25", -1_234_567.25),
            (&["0.5"], "12,345.5", 12_345.5),
            (&["0.5"], "1'234.5", 1234.5),
            (&["0,5"], "1\u{202f}234,5", 1234.5),
            (&["1,234,567"], "1,234", 1234.0),
            // No other column says anything.
            (&["12,345"], "12,345", 12.345),
            (&["12.345"], "12.345", 12.345),
            // Certain in itself.
            (&["0.5"], "10,0", 10.0),
            (&["0,5"], "0.125", 0.125),
            (&["0.5"], "-2.5e-3", -2.5e-3),
        ] {
            assert_eq!(read(&[column], text), Ok(value), "{text} in {column:?}");
        }
    }

    #[test]
    fn doubtful_numbers_are_refused() {
        for text in ["", "1e400", "inf", "NaN", "1,23,456", "1.2.3,4", "1 2", "0,5,", "e", ","] {
            assert!(read(&[&["0.5"]], text).is_err(), "{text}");
        }
        let doubtful = read(&[&["100.000", "100.008"], &["0,5", "0,25"]], "100.008");
        assert!(doubtful.is_err_and(|why| why.contains("group")));
    }
}
