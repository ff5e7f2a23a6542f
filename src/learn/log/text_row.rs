//! A row of a CSV file: its fields, and whether the end of the file cuts it.

use super::notation::trimmed;

/// Number of rows before the last one that are compared with it.
const COMPARED: usize = 8;
/// Decimals from which on it does not matter whether more were cut off.
const EXACT: usize = 9;

/// The fields of a row. Quoted delimiters do not separate; spaces separate only once.
///
/// # Errors
/// A quote is open.
pub(super) fn fields(row: &[u8], delimiter: u8) -> Result<Vec<&[u8]>, String> {
    let mut quoted = false;
    let separates = |byte: &u8| {
        quoted ^= *byte == b'"';
        *byte == delimiter && !quoted
    };
    let mut fields: Vec<&[u8]> = row.split(separates).collect();
    if quoted {
        return Err("a quote is not closed".into());
    }
    if delimiter == b' ' {
        fields.retain(|field| !is_blank(field));
    }
    Ok(fields)
}

/// Whether a row is empty.
pub(super) fn is_blank(row: &[u8]) -> bool {
    row.iter().all(u8::is_ascii_whitespace)
}

/// Compares the last number of a file with those above it: without a line end after it, some of its
/// digits may be missing.
#[derive(Default)]
pub(super) struct CutEnd {
    /// Decimals of the last rows, and the length of the last number.
    decimals: Vec<usize>,
    length: usize,
}

impl CutEnd {
    /// Checks the last field of a row; a row that `is_whole` ends with a line end.
    ///
    /// # Errors
    /// Digits may be missing.
    pub(super) fn check(&mut self, last: &[u8], is_whole: bool) -> Result<(), String> {
        let text = trimmed(last);
        let decimals = text
            .rsplit_once(['.', ','])
            .map_or(0, |(_, after)| after.bytes().take_while(u8::is_ascii_digit).count());
        let least = self.decimals.iter().min().copied().unwrap_or(0).min(EXACT);
        let is_cut = decimals < least
            || (decimals == 0 && text.len() < self.length)
            || text.contains(['e', 'E']);
        if !is_whole && is_cut {
            return Err(format!("the file ends in the number '{text}'"));
        }
        if self.decimals.len() == COMPARED {
            self.decimals.remove(0);
        }
        self.decimals.push(decimals);
        self.length = text.len();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

    use super::*;

    #[test]
    fn quotes_and_spaces_are_understood() {
        let split = |row: &'static str, delimiter: u8| -> Vec<&[u8]> {
            fields(row.as_bytes(), delimiter).unwrap()
        };
        assert_eq!(split("\"0,5\",1,", b','), [&b"\"0,5\""[..], b"1", b""]);
        assert_eq!(split(" 1   2 ", b' '), [b"1", b"2"]);
        assert!(fields(b"1,\"2,3", b',').is_err());
    }

    #[test]
    fn a_last_number_without_all_of_its_digits_is_cut() {
        let check = |above: &str, last: &str| {
            let mut end = CutEnd::default();
            for text in above.split(' ') {
                end.check(text.as_bytes(), true).unwrap();
            }
            end.check(last.as_bytes(), false)
        };
        for (above, last) in
            [("0.25 0.37", "0.4"), ("0,25 0,37", "-"), ("11 12", "1"), ("0.25 1.5e-7", "9.1e-0")]
        {
            assert!(check(above, last).is_err(), "{last} below {above}");
        }
        for (above, last) in [("0.25 0.37", "0.41"), ("9 12", "13"), ("0.5 0.123", "0.1")] {
            assert!(check(above, last).is_ok(), "{last} below {above}");
        }
    }
}
