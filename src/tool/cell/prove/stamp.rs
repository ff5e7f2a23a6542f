//! The notes of a recorder in a log: program and session.

/// Notes of a file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Stamp {
    /// Hashes of programs with the lines of their notes.
    pub programs: Vec<(u64, String)>,
    /// Dates of sessions.
    pub sessions: Vec<String>,
}

/// Reads the lines that start with `#`.
#[must_use]
pub fn stamp(bytes: &[u8]) -> Stamp {
    let mut stamp = Stamp::default();
    if bytes.starts_with(b"PAR1") {
        return stamp;
    }
    for (line, row) in (1..).zip(bytes.split(|byte| *byte == b'\n')) {
        let Some(note) = row.strip_prefix(b"#") else { continue };
        let text = String::from_utf8_lossy(note);
        match text.trim().split_once(' ') {
            Some(("program", hash)) => stamp.programs.push((line, hash.trim().to_owned())),
            Some(("session", date)) => stamp.sessions.push(date.trim().to_owned()),
            _ => {}
        }
    }
    stamp
}

/// Seconds from an arbitrary day to a date such as `2026-11-29 08:33:12`.
pub(super) fn seconds(date: &str) -> Option<f64> {
    let numbers: Option<Vec<i64>> = date
        .split(|c: char| !c.is_ascii_digit())
        .filter(|part| !part.is_empty())
        .map(|part| part.parse().ok())
        .collect();
    let numbers = numbers?;
    let [year, month, day, rest @ ..] = numbers.as_slice() else { return None };
    let in_range =
        (1970..=9999).contains(year) && (1..=12).contains(month) && (1..=31).contains(day);
    if !in_range {
        return None;
    }
    // The year begins in March, so that the leap day is its last one.
    let (year, month) = if *month < 3 { (year - 1, month + 9) } else { (*year, month - 3) };
    let days = 365 * year + year / 4 - year / 100 + year / 400 + (153 * month + 2) / 5 + day;
    let of = |place: usize| rest.get(place).copied().unwrap_or(0) as f64;
    Some(86_400.0 * days as f64 + 3600.0 * of(0) + 60.0 * of(1) + of(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notes_are_read() {
        let found =
            stamp(b"# program 3f2a\r\n# session 2026-11-29 08:33:12\nt,power\n0,1\n# program 77\n");
        assert_eq!(found.programs, [(1, "3f2a".to_owned()), (5, "77".to_owned())]);
        assert_eq!(found.sessions, ["2026-11-29 08:33:12"]);
    }

    #[test]
    fn dates_are_seconds() {
        let between = |a: &str, b: &str| Some(seconds(b)? - seconds(a)?);
        assert_eq!(between("2026-11-29 08:33:12", "2026-11-30 08:33:13"), Some(86_401.0));
        assert_eq!(between("2028-02-28 23:00:00", "2028-03-01 00:00:00"), Some(90_000.0));
        assert_eq!(seconds("yesterday"), None);
    }
}
