//! Diagnostics with the lines of the source, in the format of rustc.

use std::ops::Range;

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

use super::concise::concise;
use super::diagnostic::{Diagnostic, Note, Severity};
use crate::rapid::text::{SourceFile, Span};

/// Longest line that is shown, bytes; for a longer one the concise form is used.
const LONGEST_LINE: u32 = 2_000;
/// Largest distance of two places that are shown in one piece, lines.
const PIECE: u32 = 20;

/// Whether colours are used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paint {
    /// Plain text.
    Plain,
    /// ANSI colours.
    Ansi,
}

/// Renders a diagnostic about `file`, without a line end. Labels in other files are omitted.
#[must_use]
pub fn full(diagnostic: &Diagnostic, file: &SourceFile, paint: Paint) -> String {
    let labels = diagnostic.labels.iter().filter(|label| label.span.file == file.id);
    let mut places = vec![Place {
        span: diagnostic.span,
        label: diagnostic.label.as_deref(),
        kind: AnnotationKind::Primary,
    }];
    places.extend(labels.map(|label| Place {
        span: label.span,
        label: Some(label.message.as_str()),
        kind: AnnotationKind::Context,
    }));
    let Some(pieces) = pieces(&places, file) else { return concise(diagnostic, file) };

    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Info => Level::INFO,
    };
    let mut title = level.primary_title(diagnostic.message.as_str());
    if let Some(code) = &diagnostic.code {
        title = title.id(code.as_str());
    }
    let mut group = Group::with_title(title);
    for piece in &pieces {
        let annotations = piece
            .places
            .iter()
            .map(|(place, range)| place.kind.span(range.clone()).label(place.label));
        group = group.element(
            Snippet::source(piece.text.as_str())
                .line_start(piece.first_line as usize)
                .path(file.path.as_str())
                .annotations(annotations),
        );
    }
    for note in &diagnostic.notes {
        group = group.element(match note {
            Note::Note(text) => Level::NOTE.message(text.as_str()),
            Note::Help(text) => Level::HELP.message(text.as_str()),
        });
    }
    let renderer = match paint {
        Paint::Plain => Renderer::plain(),
        Paint::Ansi => Renderer::styled(),
    };
    renderer.render(&[group])
}

#[derive(Clone, Copy)]
struct Place<'a> {
    span: Span,
    label: Option<&'a str>,
    kind: AnnotationKind,
}

/// Some lines of the source and the places in them.
struct Piece<'a> {
    first_line: u32,
    text: String,
    /// Ranges of bytes in `text`.
    places: Vec<(Place<'a>, Range<usize>)>,
}

/// The pieces to show, that of the first place first; `None` if a line is too long.
fn pieces<'a>(places: &[Place<'a>], file: &SourceFile) -> Option<Vec<Piece<'a>>> {
    let lines = |place: &Place<'_>| {
        let first = file.position(place.span.start).line;
        let last = file.position(place.span.end).line;
        // Of a long place only the first line is shown.
        (first, if last - first > PIECE { first } else { last })
    };
    let primary = lines(places.first()?);
    let (near, far): (Vec<Place<'a>>, Vec<Place<'a>>) = places.iter().partition(|place| {
        let (first, last) = lines(place);
        first.abs_diff(primary.0) <= PIECE && last.abs_diff(primary.1) <= PIECE
    });
    let groups = std::iter::once(near).chain(far.into_iter().map(|place| vec![place]));
    groups
        .map(|group| {
            let first = group.iter().map(|place| lines(place).0).min()?;
            let last = group.iter().map(|place| lines(place).1).max()?;
            piece(group, first, last, file)
        })
        .collect()
}

fn piece<'a>(
    group: Vec<Place<'a>>,
    first_line: u32,
    last_line: u32,
    file: &SourceFile,
) -> Option<Piece<'a>> {
    let mut text = String::new();
    let mut spans: Vec<(usize, usize)> = vec![(usize::MAX, usize::MAX); group.len()];
    for number in first_line..=last_line {
        let line = file.lines.range(number);
        if line.end - line.start > LONGEST_LINE {
            return None;
        }
        let content = decoded(file, line.clone());
        let content = content.trim_end_matches(['\r', '\n']);
        for (place, span) in group.iter().zip(&mut spans) {
            for (offset, target) in [(place.span.start, &mut span.0), (place.span.end, &mut span.1)]
            {
                let here = line.contains(&offset) || offset == line.end && number == last_line;
                if here && *target == usize::MAX {
                    let before = decoded(file, line.start..offset).len();
                    *target = text.len() + before.min(content.len());
                }
            }
        }
        text.push_str(content);
        text.push('\n');
    }
    let end = text.len().saturating_sub(1);
    let places = group
        .into_iter()
        .zip(spans)
        .map(|(place, (start, stop))| {
            let start = boundary(&text, start.min(end));
            (place, start..boundary(&text, stop.min(end)).max(start))
        })
        .collect();
    Some(Piece { first_line, text, places })
}

/// The start of the character that contains `offset`. Bytes cut inside a character decode to
/// another length.
fn boundary(text: &str, offset: usize) -> usize {
    (0..=offset).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0)
}

/// Decoded bytes without the byte order mark. Control characters, which would break the layout,
/// become U+FFFD.
fn decoded(file: &SourceFile, range: Range<u32>) -> String {
    let span = Span { file: file.id, start: range.start, end: range.end };
    let text = file.text(span);
    text.trim_start_matches('\u{feff}')
        .chars()
        .map(|c| if c.is_control() && !matches!(c, '\t' | '\r' | '\n') { '\u{fffd}' } else { c })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rapid::diagnostics::diagnostic::Label;
    use crate::rapid::text::FileId;

    fn span(start: u32, end: u32) -> Span {
        Span { file: FileId(0), start, end }
    }

    fn file(bytes: &[u8]) -> SourceFile {
        SourceFile::new(FileId(0), "cell/Main.mod".to_owned(), bytes.to_vec())
    }

    #[test]
    fn shows_the_place_as_rustc_does() {
        let file = file(b"MODULE a\r\n  ! f\xFCr\r\n\tIF x THEN\r\n\tENDPROC\r\n");
        let mut diagnostic =
            Diagnostic::error(span(32, 32), "expected ENDIF before ENDPROC".to_owned());
        diagnostic
            .labels
            .push(Label { span: span(20, 22), message: "this IF is not closed".to_owned() });
        diagnostic.notes.push(Note::Help("close it".to_owned()));
        insta::assert_snapshot!(full(&diagnostic, &file, Paint::Plain));
        assert_eq!(
            concise(&diagnostic, &file),
            "cell/Main.mod:4:2: error: expected ENDIF before ENDPROC"
        );
    }

    #[test]
    fn any_place_in_any_bytes_can_be_shown() {
        let bytes = b"\xEF\xBB\xBFa\0b\r\xFF\xFE\n\x1B[31m\"\xC3\xA4\r\n\r";
        for bytes in [&bytes[..], &bytes[3..], b"", b"\n", b"x"] {
            let file = file(bytes);
            let length = bytes.len() as u32;
            for start in 0..=length {
                for end in start..=length {
                    let diagnostic = Diagnostic::error(span(start, end), "wrong".to_owned());
                    let shown = full(&diagnostic, &file, Paint::Plain);
                    let position = file.position(start);
                    let place = format!("Main.mod:{}:", position.line);
                    assert!(shown.contains(&place) || bytes.is_empty(), "{start}..{end}: {shown}");
                }
            }
        }
    }

    #[test]
    fn very_long_lines_are_not_shown() {
        let file = file(&[b'a'; 5_000]);
        let diagnostic = Diagnostic::error(span(4_000, 4_001), "wrong".to_owned());
        assert_eq!(full(&diagnostic, &file, Paint::Plain), "cell/Main.mod:1:4001: error: wrong");
    }
}
