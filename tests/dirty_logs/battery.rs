//! Clean logs, and what may happen to them.

use std::f64::consts::TAU;

/// A log as cells below a header.
#[derive(Clone)]
pub(crate) struct Table {
    pub(crate) header: Vec<String>,
    pub(crate) rows: Vec<Vec<String>>,
    /// Position, rate and acceleration of a joint (from 0) at a time \[s\].
    pub(crate) motion: fn(usize, f64) -> [f64; 3],
}

impl Table {
    /// A log of `joints` joints whose first `orders` of position, rate and acceleration are logged,
    /// in `count` rows at `rate` \[Hz\].
    pub(crate) fn new(
        [joints, orders, count]: [usize; 3],
        rate: f64,
        motion: fn(usize, f64) -> [f64; 3],
    ) -> Table {
        let mut header = vec!["t".to_owned()];
        for quantity in &["q", "qd", "qdd"][..orders] {
            header.extend((1..=joints).map(|joint| format!("{quantity}{joint}")));
        }
        let row = |i: usize| {
            let t = i as f64 / rate;
            let cells = (0..orders).flat_map(|order| {
                (0..joints).map(move |joint| format!("{:.6}", motion(joint, t)[order]))
            });
            [format!("{t:.3}")].into_iter().chain(cells).collect()
        };
        Table { header, rows: (0..count).map(row).collect(), motion }
    }

    pub(crate) fn text(&self, delimiter: &str) -> String {
        let line = |cells: &Vec<String>| cells.join(delimiter) + "\n";
        line(&self.header) + &self.rows.iter().map(line).collect::<String>()
    }

    pub(crate) fn plain(&self) -> Vec<u8> {
        self.text(",").into_bytes()
    }

    /// The table with other cells.
    pub(crate) fn cells(&self, change: impl Fn(&str) -> String) -> Table {
        let row = |cells: &Vec<String>| cells.iter().map(|cell| change(cell)).collect();
        Table { rows: self.rows.iter().map(row).collect(), ..self.clone() }
    }

    /// The text with other rows.
    fn with(&self, change: impl Fn(&mut Vec<Vec<String>>)) -> Vec<u8> {
        let mut table = self.clone();
        change(&mut table.rows);
        table.plain()
    }

    /// The text with other lines.
    fn lines(&self, change: impl Fn(&mut Vec<String>)) -> Vec<u8> {
        let mut lines: Vec<String> = self.text(",").lines().map(str::to_owned).collect();
        change(&mut lines);
        (lines.join("\n") + "\n").into_bytes()
    }

    /// The text with other cells in some rows from the middle on.
    fn with_middle(&self, count: usize, change: impl Fn(&mut [String])) -> Vec<u8> {
        self.with(|rows| {
            let at = middle(rows);
            rows[at..at + count].iter_mut().for_each(|row| change(row));
        })
    }

    /// The text with another time in a row of the middle.
    fn time(&self, by: f64) -> Vec<u8> {
        self.with_middle(1, |row| row[0] = moved(&row[0], by))
    }

    /// The text with a cell of the middle changed.
    fn cell(&self, text: &str) -> Vec<u8> {
        self.with_middle(1, |row| text.clone_into(&mut row[3]))
    }

    /// The text without some rows of the middle.
    fn without(&self, count: usize) -> Vec<u8> {
        self.with(|rows| {
            let at = middle(rows);
            rows.drain(at..at + count);
        })
    }

    /// The text in which the first columns stay for some rows.
    fn stuck(&self, count: usize) -> Vec<u8> {
        self.with(|rows| {
            let at = middle(rows);
            let row = rows[at].clone();
            rows[at + 1..=at + count].iter_mut().for_each(|to| to[1..].clone_from_slice(&row[1..]));
        })
    }

    /// The text without its last bytes.
    fn cut(&self, bytes: usize) -> Vec<u8> {
        let mut text = self.plain();
        text.truncate(text.len() - bytes);
        text
    }
}

/// Position, rate and acceleration of a joint in a motion with a period of 2 s.
pub(crate) fn periodic(joint: usize, t: f64) -> [f64; 3] {
    let mut at = [0.2 * joint as f64 - 0.5, 0.0, 0.0];
    for (k, harmonic) in [1.0, 2.0, 4.0].into_iter().enumerate() {
        let w = TAU * harmonic / 2.0;
        let a = (0.3 - 0.02 * joint as f64) / (harmonic * harmonic);
        let (sin, cos) = (w * t + 0.9 * joint as f64 + 1.7 * k as f64).sin_cos();
        at[0] += a * sin;
        at[1] += a * w * cos;
        at[2] -= a * w * w * sin;
    }
    at
}

/// The same of a joint in a program of three moves with rests.
pub(crate) fn program(joint: usize, t: f64) -> [f64; 3] {
    /// Start and duration \[s\], distance \[rad\].
    const MOVES: [(f64, f64, f64); 3] = [(0.1, 0.3, 0.5), (0.45, 0.3, -0.4), (0.75, 0.2, 0.2)];
    let size = (0.6 + 0.1 * joint as f64) * if joint.is_multiple_of(2) { 1.0 } else { -1.0 };
    let mut at = [0.1 * joint as f64 - 0.6, 0.0, 0.0];
    for (start, duration, distance) in MOVES {
        let s = ((t - start) / duration).clamp(0.0, 1.0);
        let rest = s * (1.0 - s);
        at[0] += size * distance * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
        at[1] += size * distance * 30.0 * rest * rest / duration;
        at[2] += size * distance * 60.0 * rest * (1.0 - 2.0 * s) / (duration * duration);
    }
    at
}

fn middle(rows: &[Vec<String>]) -> usize {
    rows.len() / 2 + 7
}

fn moved(cell: &str, by: f64) -> String {
    format!("{:.6}", cell.parse::<f64>().unwrap() + by)
}

fn with_comma(cell: &str) -> String {
    cell.replace('.', ",")
}

fn utf_16(text: &str) -> Vec<u8> {
    text.encode_utf16().flat_map(u16::to_le_bytes).collect()
}

/// A dirty version of a log.
pub(crate) struct Dirty {
    pub(crate) name: &'static str,
    pub(crate) bytes: fn(&Table) -> Vec<u8>,
    /// The rows of the clean log that are lost with it.
    pub(crate) lost: usize,
}

const fn dirty(name: &'static str, lost: usize, bytes: fn(&Table) -> Vec<u8>) -> Dirty {
    Dirty { name, bytes, lost }
}

/// Other forms of the same log: nothing changes.
pub(crate) const FORMS: &[Dirty] = &[
    dirty("no last line end", 0, |log| log.cut(1)),
    dirty("decimal commas between semicolons", 0, |log| log.cells(with_comma).text(";").into()),
    dirty("decimal commas between tabs", 0, |log| log.cells(with_comma).text("\t").into()),
    dirty("decimal commas in quotes", 0, |log| {
        log.cells(|cell| format!("\"{}\"", with_comma(cell))).plain()
    }),
    dirty("some decimal commas", 0, |log| {
        log.cells(|cell| if cell.ends_with('3') { with_comma(cell) } else { cell.into() })
            .text(";")
            .into()
    }),
    dirty("grouped digits", 0, |log| {
        let mut log = log.cells(with_comma);
        log.header.push("power".into());
        log.rows.iter_mut().for_each(|row| row.push("1.250,5".into()));
        log.text(";").into()
    }),
    dirty("comments", 0, |log| {
        log.lines(|lines| {
            lines.insert(40, "# pause".into());
            lines.insert(0, "# logged by a robot".into());
        })
    }),
    dirty("a header in a comment", 0, |log| {
        log.lines(|lines| {
            lines[0].insert_str(0, "# ");
            lines.insert(0, "% t is in s".into());
        })
    }),
    dirty("blank lines", 0, |log| {
        log.lines(|lines| {
            for (at, line) in [(40, ""), (41, "   "), (1, ""), (0, "")] {
                lines.insert(at, line.into());
            }
        })
    }),
    dirty("byte order mark and CRLF", 0, |log| {
        format!("\u{feff}{}", log.text(",").replace('\n', "\r\n")).into()
    }),
    dirty("CR alone", 0, |log| log.text(",").replace('\n', "\r").into()),
    dirty("UTF-16", 0, |log| utf_16(&format!("\u{feff}{}", log.text(",")))),
    dirty("a delimiter after each row", 0, |log| {
        log.lines(|lines| lines.iter_mut().skip(1).for_each(|line| line.push(',')))
    }),
    dirty("several spaces", 0, |log| log.text("   ").into()),
    dirty("the header again", 0, |log| log.lines(|lines| lines.insert(90, lines[0].clone()))),
    dirty("a row of units", 0, |log| {
        log.lines(|lines| lines.insert(1, lines[0].replace('t', "[s]").replace('q', "[rad]")))
    }),
    dirty("empty cells", 0, |log| {
        log.lines(|lines| {
            let empty = ",".repeat(lines[0].matches(',').count());
            lines.insert(40, empty.clone());
            lines.push(empty);
        })
    }),
    dirty("zero bytes at the end", 0, |log| [log.plain(), vec![0; 4096]].concat()),
    dirty("some rows twice", 0, |log| {
        log.with(|rows| [90, 120, 121].into_iter().for_each(|at| rows.insert(at, rows[at].clone())))
    }),
    dirty("a block twice", 0, |log| {
        log.with(|rows| {
            let at = middle(rows);
            let block = rows[at..at + 50].to_vec();
            rows.splice(at + 50..at + 50, block);
        })
    }),
    dirty("the log twice", 0, |log| log.with(|rows| rows.extend(rows.clone()))),
    dirty("the log and its header twice", 0, |log| log.plain().repeat(2)),
];

/// Rows that are lost.
pub(crate) const LOSSES: &[Dirty] = &[
    dirty("not a number", 1, |log| log.cell("NaN")),
    dirty("an empty cell", 1, |log| log.cell("")),
    dirty("a word", 1, |log| log.cell("ERR")),
    dirty("an open quote", 1, |log| log.cell("\"0.3")),
    dirty("infinity", 1, |log| log.cell("-inf")),
    dirty("beyond all numbers", 1, |log| log.cell("1e400")),
    dirty("other words for not a number", 6, |log| {
        log.with(|rows| {
            let words = ["nan", "-nan(ind)", "#N/A", "null", "1.#QNAN", "Infinity"];
            for (k, word) in words.into_iter().enumerate() {
                rows[40 + 12 * k][0] = word.into();
            }
        })
    }),
    dirty("a missing field", 1, |log| {
        log.lines(|lines| {
            let at = lines.len() / 2;
            let end = lines[at].rfind(',').unwrap();
            lines[at].truncate(end);
        })
    }),
    dirty("an additional field", 1, |log| {
        log.lines(|lines| {
            let at = lines.len() / 2;
            lines[at] += ",1";
        })
    }),
    dirty("zero bytes in a row", 1, |log| {
        log.lines(|lines| {
            let at = lines.len() / 2;
            lines[at].replace_range(9..20, &"\0".repeat(64));
        })
    }),
    dirty("an end within the last number", 1, |log| log.cut(5)),
    dirty("an end within the last row", 1, |log| log.cut(30)),
    dirty("a missing row", 1, |log| log.without(1)),
    dirty("5 missing rows", 5, |log| log.without(5)),
    dirty("100 missing rows", 100, |log| log.without(100)),
    dirty("a tenth of the rows missing", 30, |log| {
        log.with(|rows| {
            let mut count = 0;
            rows.retain(|_| {
                count += 1;
                count % 10 != 3 || count > 300
            });
        })
    }),
    dirty("a time twice, wrong in the row before", 2, |log| {
        log.with(|rows| {
            let at = middle(rows);
            rows[at][0] = rows[at + 1][0].clone();
        })
    }),
    dirty("a time twice, wrong in the row after", 2, |log| {
        log.with(|rows| {
            let at = middle(rows);
            rows[at][0] = rows[at - 1][0].clone();
        })
    }),
    dirty("a time back", 1, |log| log.time(-0.3)),
    dirty("a time ahead", 1, |log| log.time(0.3)),
    dirty("a time a little ahead", 1, |log| log.time(0.012)),
    dirty("a time far ahead", 1, |log| log.time(1e6)),
    dirty("the first time ahead", 1, |log| log.with(|rows| rows[0][0] = "99.5".into())),
    dirty("rows that changed places", 1, |log| {
        log.with(|rows| {
            let at = middle(rows);
            rows.swap(at, at + 1);
        })
    }),
    dirty("a jump of 1 rad", 1, |log| log.with_middle(1, |row| row[2] = moved(&row[2], 1.0))),
    dirty("a jump of 0.03 rad", 1, |log| log.with_middle(1, |row| row[2] = moved(&row[2], 0.03))),
    dirty("a jump for three rows", 3, |log| {
        log.with_middle(3, |row| row[2] = moved(&row[2], -1.0))
    }),
    dirty("a jump in the first row", 1, |log| {
        log.with(|rows| rows[0][2] = moved(&rows[0][2].clone(), 1.0))
    }),
    dirty("a jump in the last row", 1, |log| {
        log.with(|rows| {
            let last = rows.last_mut().unwrap();
            last[2] = moved(&last[2], 1.0);
        })
    }),
    dirty("a position without sense", 1, |log| log.cell("1e6")),
    dirty("a row of zeros", 1, |log| log.with_middle(1, |row| row[1..].fill("0".into()))),
    dirty("a row in degrees", 1, |log| {
        log.with_middle(1, |row| {
            for cell in &mut row[1..] {
                *cell = cell.parse::<f64>().unwrap().to_degrees().to_string();
            }
        })
    }),
    dirty("5 rows of a stuck sensor", 5, |log| log.stuck(5)),
    dirty("30 rows of a stuck sensor", 30, |log| log.stuck(30)),
    dirty("a stuck joint", 30, |log| {
        log.with(|rows| {
            let at = middle(rows);
            let stuck = rows[at][2].clone();
            rows[at + 1..=at + 30].iter_mut().for_each(|row| row[2].clone_from(&stuck));
        })
    }),
];
