//! What the rows of a CSV file tell before they are sorted by time: names of parts, jumps of the
//! clock, rows of two recorders.

use super::channel::Channel;
use super::columns::ColumnMap;
use super::header::Header;
use super::notation::{Notation, number, trimmed};
use super::part::part_number;
use super::text_row::is_blank;
use super::utf16;

/// Rows with which an alternation can be told from noise.
const ROWS: usize = 50;
/// How much more neighbours differ than every second row where two recorders write in turn.
const TURNS: f64 = 2.0;

/// Properties of the rows in the order of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scan {
    /// The names of the column `part`, with the numbers that stand for them.
    pub parts: Vec<(f64, String)>,
    /// The largest jump back of the clock: line and s.
    pub back: Option<(u64, f64)>,
    /// Whether the power alternates between two series from row to row.
    pub alternates: bool,
}

/// Scans the rows of a CSV file; other files have no such properties.
#[must_use]
pub fn scan(bytes: &[u8], map: &ColumnMap) -> Scan {
    if bytes.starts_with(b"PAR1") || utf16::is_utf16(bytes) {
        return Scan::default();
    }
    let head = &bytes[..bytes.len().min(HEAD)];
    let header = Header::find(head, map);
    let notations = header.notations();
    let below = bytes.get(bytes.len() - rest(bytes, head, header.below)..).unwrap_or_default();
    let column = |channel: Channel| {
        let columns = header.columns.iter().zip(&notations);
        let mut found = columns.filter(|(column, _)| column.named.channel == channel);
        found.next().map(|(column, notation)| (column.index, *notation))
    };
    let value = |fields: &[&[u8]], of: Option<(usize, Notation)>| {
        let (index, notation) = of?;
        number(&trimmed(fields.get(index)?), notation).ok()
    };
    let [time, power, part] = [Channel::Time, Channel::Power, Channel::Part].map(column);
    let mut scan = Scan::default();
    let mut turns = Turns::default();
    let mut before: Option<f64> = None;
    for (line, row) in (header.line + 1..).zip(below.split(|byte| *byte == header.terminator)) {
        if is_blank(row) {
            continue;
        }
        let Ok(Some(fields)) = header.split(row) else { continue };
        let Some(t) = value(&fields, time) else { continue };
        let back = before.map_or(0.0, |before| before - t);
        if back > 0.0 && scan.back.is_none_or(|(_, most)| back > most) {
            scan.back = Some((line, back));
        }
        before = Some(t);
        if let Some(power) = value(&fields, power) {
            turns.push(power);
        }
        if let Some((index, notation)) = part {
            let text = trimmed(fields[index]);
            let number = part_number(&text, notation);
            if !scan.parts.iter().any(|(known, _)| *known == number) && scan.parts.len() < NAMES {
                scan.parts.push((number, text.into_owned()));
            }
        }
    }
    scan.alternates = turns.are_two();
    scan
}

/// Bytes that hold the header and show the notation of the numbers.
const HEAD: usize = 1 << 16;
/// Most names of parts.
const NAMES: usize = 1000;

/// Number of bytes below the header, of which `below` is the part in `head`.
fn rest(bytes: &[u8], head: &[u8], below: &[u8]) -> usize {
    below.len() + (bytes.len() - head.len())
}

/// Sums of the differences of neighbours and of every second row.
#[derive(Default)]
struct Turns {
    last: [Option<f64>; 2],
    next: f64,
    second: f64,
    rows: usize,
}

impl Turns {
    fn push(&mut self, value: f64) {
        if let [Some(before), Some(last)] = self.last {
            self.next += (value - last).abs();
            self.second += (value - before).abs();
            self.rows += 1;
        }
        self.last = [self.last[1], Some(value)];
    }

    fn are_two(&self) -> bool {
        self.rows >= ROWS && self.next > TURNS * self.second
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scanned(rows: impl Iterator<Item = String>) -> Scan {
        let text = format!("t,power,part\n{}\n", rows.collect::<Vec<_>>().join("\n"));
        scan(text.as_bytes(), &ColumnMap::default().with_products())
    }

    #[test]
    fn two_recorders_and_jumps_are_seen() {
        let smooth = |i: i32| 500.0 + 100.0 * (0.1 * f64::from(i)).sin();
        let one = scanned((0..200).map(|i| format!("{},{},A", 0.1 * f64::from(i), smooth(i))));
        assert_eq!((one.alternates, one.back), (false, None));
        assert_eq!(one.parts.len(), 1);
        assert_eq!(one.parts[0].1, "A");
        let two = scanned(
            (0..200).map(|i| format!("{},{},7", i / 2, smooth(i) + f64::from(i % 2 * 300))),
        );
        assert!(two.alternates);
        let night = scanned((0..200).map(|i| format!("{},{},7", (86_350 + i) % 86_400, smooth(i))));
        assert_eq!(night.back, Some((52, 86_399.0)));
    }
}
