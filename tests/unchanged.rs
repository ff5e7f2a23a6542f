//! Everything except rewritten movements is unchanged to the byte. An independent parser takes the
//! outputs apart: each statement that the result declares rewritten has a guard around it, and
//! every other byte is that of the original.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod support;

use std::ops::Range;
use std::path::PathBuf;

use joulepath::rapid::text::Span;
use joulepath::tool::retrofit::{OutputFile, OutputKind, Retrofit, Settings, Source, retrofit};
use support::{irb1600, module_paths};

/// Mark of a movement in `fixtures/hard` that can't be rewritten.
const REFUSED: &str = "! Refused:";
/// Prefixes of statements that move the robot.
const MOVES: [&str; 6] = ["Move", "Trigg", "Search", "Arc", "Spot", "Disp"];

/// A program and its retrofit.
struct Case {
    name: String,
    files: Vec<Source>,
    result: Retrofit,
}

fn case(name: &str, paths: &[PathBuf]) -> Case {
    let files = support::read(paths);
    let result = retrofit(&files, &irb1600(), &Settings::default(), &|_, _| ());
    let result = result.unwrap_or_else(|error| panic!("{name}: {error}"));
    Case { name: name.to_owned(), files, result }
}

impl Case {
    /// Byte ranges of a file that the result declares rewritten, in order.
    fn rewritten(&self, file: usize) -> Vec<Range<usize>> {
        let segments = self.result.segments.iter().filter(|segment| segment.rewritten);
        let mut spans: Vec<Range<usize>> = segments
            .flat_map(|segment| &segment.pieces)
            .filter(|piece| piece.file.0 as usize == file)
            .map(|piece| piece.start as usize..piece.end as usize)
            .collect();
        spans.sort_by_key(|span| span.start);
        spans.dedup();
        spans
    }

    /// Checks the outputs.
    fn check(&self) -> Result<(), String> {
        let originals: Vec<&OutputFile> =
            self.result.outputs.iter().filter(|output| output.kind != OutputKind::New).collect();
        if originals.len() != self.files.len() {
            return Err(format!("{} of {} files", originals.len(), self.files.len()));
        }
        for (i, (output, source)) in originals.iter().zip(&self.files).enumerate() {
            if output.path != source.relative || output.input != Some(i) {
                return Err(format!("{} stands in the place of {}", output.path, source.relative));
            }
            let spans = self.rewritten(i);
            if (output.kind == OutputKind::Unchanged) != spans.is_empty() {
                return Err(format!("{} is called {:?}", output.path, output.kind));
            }
            only_guards_added(&source.file.bytes, &output.bytes, &spans)
                .map_err(|why| format!("{}: {why}", output.path))?;
        }
        Ok(())
    }

    /// Checks that the movement of a line remains, with a reason.
    fn refusal(&self, line: u32) -> Result<(), String> {
        let file = &self.files[0].file;
        let covers = |span: Span| {
            (file.position(span.start).line..=file.position(span.end).line).contains(&line)
        };
        let segments: Vec<_> =
            self.result.segments.iter().filter(|segment| covers(segment.span)).collect();
        if segments.iter().any(|segment| segment.rewritten) {
            return Err(format!("{}:{line}: refused in the source, but rewritten", self.name));
        }
        let noted = self.result.before.0.unresolved.iter().any(|note| covers(note.span));
        if noted || segments.iter().any(|segment| segment.reason.is_some()) {
            Ok(())
        } else {
            Err(format!("{}:{line}: stays, but no reason is given", self.name))
        }
    }
}

/// Comments after the ELSE of a guard.
const REMARKS: [&str; 2] = [
    " ! after an edit of these lines: joulepath refresh",
    " ! joined with later movements: after an edit of these lines or up to there: joulepath refresh",
];

/// Removes the guards from an output; the rest has to be the original.
fn only_guards_added(original: &[u8], output: &[u8], spans: &[Range<usize>]) -> Result<(), String> {
    let end_of_line = match original.iter().position(|b| *b == b'\n') {
        Some(i) if i > 0 && original[i - 1] == b'\r' => "\r\n",
        _ => "\n",
    };
    let output = without_notes(output);
    let mut rest = output.as_slice();
    let mut from = 0;
    for span in spans {
        let statements = &original[span.clone()];
        let line = original[..span.start].iter().rposition(|b| *b == b'\n').map_or(0, |i| i + 1);
        let indent: String = original[line..span.start]
            .iter()
            .take_while(|b| b.is_ascii_whitespace())
            .map(|b| char::from(*b))
            .collect();
        let place = original[..span.start].split(|b| *b == b'\n').count();

        rest = rest
            .strip_prefix(&original[from..span.start])
            .ok_or(format!("bytes before line {place} differ"))?;
        let with = |remark| format!("{end_of_line}{indent}ELSE{remark}{end_of_line}{indent}");
        let first = REMARKS.map(with).into_iter().filter_map(|otherwise| {
            find_bytes(rest, otherwise.as_bytes()).map(|head| (head, otherwise))
        });
        let (head, otherwise) = first.min().ok_or(format!("no guard before line {place}"))?;
        guard_is_plain(&rest[..head], &format!("{end_of_line}{indent}"))
            .map_err(|why| format!("guard before line {place}: {why}"))?;
        rest = rest[head + otherwise.len()..]
            .strip_prefix(statements)
            .ok_or(format!("the statements from line {place} on differ"))?;
        let tail = format!("{end_of_line}{indent}ENDIF");
        rest = rest
            .strip_prefix(tail.as_bytes())
            .ok_or(format!("the guard of line {place} has no end"))?;
        from = span.end;
    }
    if rest == &original[from..] { Ok(()) } else { Err("bytes after the last guard differ".into()) }
}

/// `IF … THEN` with a function of the streams, its arguments on one or more lines, and a call.
fn guard_is_plain(head: &[u8], line_break: &str) -> Result<(), String> {
    let head = String::from_utf8_lossy(head);
    let Some((condition, call)) = head.rsplit_once(line_break) else {
        return Err(format!("'{head}'"));
    };
    let asks = condition.starts_with("IF jpFits") && condition.ends_with(") THEN");
    let calls = call.starts_with("    jpRun") && call.ends_with(';');
    let one = call.matches(';').count() == 1 && !condition.contains(';');
    if asks && calls && one { Ok(()) } else { Err(format!("'{head}'")) }
}

/// A text without the statements that record loads and settings, and those that make up for
/// movements that were put off.
fn without_notes(text: &[u8]) -> Vec<u8> {
    let mut left = text.to_vec();
    while let Some(begin) = find_bytes(&left, b"jpBack;") {
        let is_blank = |b: &u8| b.is_ascii_whitespace();
        let end = begin + b"jpBack;".len();
        let blanks = left[end..].iter().take_while(|b| is_blank(b)).count();
        left.drain(begin..end + blanks);
    }
    while let Some(begin) = find_bytes(&left, b" jpLoad:=") {
        let end = begin + left[begin..].iter().position(|b| *b == b';').unwrap() + 1;
        left.drain(begin..end);
    }
    left
}

fn find_bytes(bytes: &[u8], part: &[u8]) -> Option<usize> {
    bytes.windows(part.len()).position(|window| window == part)
}

/// Lines (from 1) of the movements below a `! Refused:` comment.
fn refused_lines(bytes: &[u8]) -> Vec<u32> {
    let text = String::from_utf8_lossy(bytes);
    let mut lines = Vec::new();
    let mut open = false;
    for (i, line) in text.lines().enumerate() {
        let statement = line.trim_start();
        open |= statement.starts_with(REFUSED);
        if open && MOVES.iter().any(|name| statement.starts_with(name)) {
            lines.push(i as u32 + 1);
            open = false;
        }
    }
    lines
}

#[test]
fn programs_keep_every_byte_outside_their_guards() {
    for name in ["pick_place", "paper"] {
        let case = case(name, &module_paths(name));
        case.check().unwrap_or_else(|why| panic!("{name}: {why}"));
        let rewritten: usize = (0..case.files.len()).map(|i| case.rewritten(i).len()).sum();
        assert!(rewritten > 0, "{name}: nothing was rewritten, so nothing was tested");
    }
}

#[test]
fn hard_programs_keep_every_byte_and_every_refused_movement() {
    let mut rewritten = 0;
    let mut refused = 0;
    let mut wrong = Vec::new();
    for path in module_paths("hard") {
        let case = case(path.file_name().unwrap().to_str().unwrap(), std::slice::from_ref(&path));
        if let Err(why) = case.check() {
            wrong.push(format!("{}: {why}", case.name));
        }
        rewritten += case.rewritten(0).len();
        let file = &case.files[0].file;
        for line in refused_lines(&file.bytes) {
            refused += 1;
            wrong.extend(case.refusal(line).err());
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(rewritten > 0 && refused > 0, "{rewritten} rewritten, {refused} refused");
}

/// The check detects changed bytes.
#[test]
fn the_check_detects_changed_bytes() {
    let original = b"! a\n  MoveJ p,v,fine,t;\n! b\n";
    let start = find_bytes(original, b"MoveJ").unwrap();
    let span = start..start + "MoveJ p,v,fine,t;".len();
    let good = "! a\n  IF jpFits1(p,t) THEN\n      jpRun1 t;\n  ELSE ! after an edit of these lines: joulepath refresh\n  MoveJ p,v,fine,t;\n  \
                ENDIF\n! b\n";
    let check =
        |output: &str| only_guards_added(original, output.as_bytes(), std::slice::from_ref(&span));
    assert_eq!(check(good), Ok(()));
    let bad = [
        ("! a", "! A"),
        ("! b", "!  b"),
        ("MoveJ p,v,fine", "MoveJ p,v,z10"),
        ("  ENDIF", "  Stop;\n  ENDIF"),
        ("ENDIF\n", "ENDIF\r\n"),
        ("jpRun1 t;", "jpRun1 t;\n      Stop;"),
        ("jpFits1(p,t)", "TRUE"),
    ];
    for (from, to) in bad {
        assert!(check(&good.replacen(from, to, 1)).is_err(), "{from} -> {to}");
    }
    assert!(only_guards_added(original, good.as_bytes(), &[]).is_err());
}
