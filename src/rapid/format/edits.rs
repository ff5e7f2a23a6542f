//! From the layout to edits.

use std::ops::Range;

use super::alignment::{Trailing, align};
use super::gap::Gap;
use super::layout::{Layout, Start};
use super::protected::Protected;
use super::spacing::{self, Word};
use super::style::{KeywordCase, Style};
use super::units::Units;
use crate::rapid::syntax::{Parse, TokenKind};
use crate::rapid::text::{Edit, SourceFile, Span};

/// The edits of a file, or only of the statements that a range touches.
pub(super) fn edits(
    file: &SourceFile,
    parse: &Parse,
    style: &Style,
    protected: &Protected,
    range: Option<&Range<u32>>,
) -> Vec<Edit> {
    let tokens = parse.tree.tokens();
    let words: Vec<usize> =
        (0..tokens.count()).filter(|index| tokens.kind(*index) != TokenKind::Whitespace).collect();
    let layout = Layout::new(&parse.tree);
    let formatter = Formatter { file, parse, style, protected, layout, words };
    let gaps = formatter.gaps();
    let is_first = |index: usize| index == 0 || formatter.old(index).lines() > 0;
    let units =
        range.map(|range| Units::new(&formatter.words, &formatter.layout, tokens, range, is_first));
    let mut edits = formatter.keywords(units.as_ref());
    for (index, wanted) in gaps.into_iter().enumerate() {
        let Some(wanted) = wanted else { continue };
        let (place, old) = (formatter.gap(index), formatter.old(index));
        let (from, text) = match &units {
            Some(units) => match units.part(index, old, &wanted) {
                Some(part) => part,
                None => continue,
            },
            None => (0, wanted),
        };
        if old.bytes()[from..] != text[..] {
            let span = Span { file: file.id, start: place.start + from as u32, end: place.end };
            edits.push(Edit { span, text });
        }
    }
    edits
}

struct Formatter<'f> {
    file: &'f SourceFile,
    parse: &'f Parse,
    style: &'f Style,
    protected: &'f Protected,
    layout: Layout,
    /// The tokens that are no white space.
    words: Vec<usize>,
}

impl<'f> Formatter<'f> {
    /// The bytes before a word; behind the last word, up to the end.
    fn gap(&self, index: usize) -> Range<u32> {
        let tokens = self.parse.tree.tokens();
        let before = index.checked_sub(1).map_or(0, |before| tokens.range(self.words[before]).end);
        let after = self.words.get(index).map(|word| tokens.range(*word).start);
        before..after.unwrap_or(self.file.bytes.len().min(u32::MAX as usize) as u32)
    }

    fn old(&self, index: usize) -> Gap<'f> {
        let place = self.gap(index);
        Gap::new(&self.file.bytes[place.start as usize..place.end as usize])
    }

    fn word(&self, index: usize) -> Word<'f> {
        let token = self.words[index];
        let range = self.parse.tree.tokens().range(token);
        let text = &self.file.bytes[range.start as usize..range.end as usize];
        Word { kind: self.parse.tree.tokens().kind(token), text }
    }

    fn is_comment(&self, index: usize) -> bool {
        self.words
            .get(index)
            .is_some_and(|token| self.parse.tree.tokens().kind(*token) == TokenKind::Comment)
    }

    /// The new white space before each word and at the end; `None` where it stays.
    fn gaps(&self) -> Vec<Option<Vec<u8>>> {
        let line_end = self.line_end();
        let mut gaps: Vec<Option<Vec<u8>>> = Vec::with_capacity(self.words.len() + 1);
        let mut trailing: Vec<Trailing> = Vec::new();
        // The line and column of the formatted text, in characters.
        let (mut line, mut column) = (0, 0);
        for index in 0..=self.words.len() {
            let place = self.gap(index);
            let old = self.old(index);
            let head = old.before_last_line();
            let is_kept =
                old.is_unusual() || self.protected.touches(&(place.start + head as u32..place.end));
            let wanted = (!is_kept).then(|| {
                let new = self.wanted(index, old, line_end);
                if head > 0 && self.protected.touches(&(place.start..place.start)) {
                    // Behind a line that stays, only the indentation changes.
                    return [&old.bytes()[..head], &new[Gap::new(&new).before_last_line()..]]
                        .concat();
                }
                new
            });
            let text = wanted.as_deref().unwrap_or(old.bytes());
            let (lines, last) = (Gap::new(text).lines(), Gap::new(text).before_last_line());
            if lines > 0 {
                line += lines;
                column = text.len() - last;
            } else {
                column += text.len();
            }
            if index < self.words.len() {
                if self.is_comment(index) && !is_kept && index > 0 && old.lines() == 0 {
                    let from = self.file.position(place.end).column;
                    trailing.push(Trailing { gap: index, line, code: column - text.len(), from });
                }
                column += self.width(self.word(index).text);
            }
            gaps.push(wanted);
        }
        for (gap, blanks) in align(&trailing) {
            gaps[gap] = Some(vec![b' '; blanks]);
        }
        gaps
    }

    /// Number of characters.
    fn width(&self, text: &[u8]) -> usize {
        if text.is_ascii() { text.len() } else { self.file.charset.decode(text).chars().count() }
    }

    /// The line end of new lines: the first of the file.
    fn line_end(&self) -> &'f [u8] {
        Gap::new(&self.file.bytes).line_end().unwrap_or(b"\n")
    }

    fn wanted(&self, index: usize, old: Gap<'_>, line_end: &[u8]) -> Vec<u8> {
        let Some(token) = self.words.get(index) else {
            // The end of the file: one line end, if there is any.
            return old.line_end().map(<[u8]>::to_vec).unwrap_or_default();
        };
        let breaks = |count: usize, steps: usize| {
            let end = old.line_end().unwrap_or(line_end);
            let mut text = end.repeat(count);
            text.extend(self.style.indentation(steps));
            text
        };
        let lines = if index == 0 { 0 } else { old.lines().min(self.style.blank_lines + 1) };
        if self.is_comment(index) {
            return if old.lines() == 0 && index > 0 {
                vec![b' ']
            } else {
                breaks(lines, self.comment_steps(index))
            };
        }
        let steps = usize::from(self.layout.steps[*token]);
        let least = usize::from(index > 0);
        match self.layout.starts[*token] {
            Start::Line => breaks(lines.max(least), steps),
            Start::Free if old.lines() > 0 => breaks(lines.max(least), steps),
            Start::Inside if old.lines() > 0 && index > 0 => breaks(1, steps + 1),
            Start::Free | Start::Inside if index == 0 => Vec::new(),
            Start::Free => Vec::new(),
            Start::Inside => {
                let (before, after) = (self.word(index - 1), self.word(index));
                let blank = spacing::blank(before, after, !old.is_empty());
                let blank = blank || self.layout.compact[*token] || self.is_argument(index, old);
                if blank { vec![b' '] } else { Vec::new() }
            }
        }
    }

    /// Whether a word is the first argument of a call: a blank stands before it. Brackets around all
    /// arguments stand as the user has put them.
    fn is_argument(&self, index: usize, old: Gap<'_>) -> bool {
        use TokenKind::{Backslash, Colon, LeftParen, Semicolon};
        self.layout.callees[self.words[index - 1]]
            && match self.word(index).kind {
                Semicolon | Backslash | Colon => false,
                LeftParen => !old.is_empty(),
                _ => true,
            }
    }

    /// Indentation of a comment on a line of its own: that of the statement behind it, or of the block
    /// that ends there. Before `ELSE` and the like, a comment further to the right than this word belongs
    /// to the block before it.
    fn comment_steps(&self, index: usize) -> usize {
        let token = self.words[index];
        let Some(next) = self.layout.behind(token) else { return 0 };
        let steps = usize::from(self.layout.steps[next]);
        match self.layout.starts[next] {
            Start::Inside => steps + 1,
            Start::Line if self.parse.tree.tokens().kind(next).closes_block() => steps + 1,
            Start::Line if divides(self.parse.tree.tokens().kind(next)) => {
                steps + usize::from(self.column(token) > self.column(next))
            }
            Start::Line | Start::Free => steps,
        }
    }

    /// Number of bytes of the white space before a token on its line.
    fn column(&self, token: usize) -> usize {
        let tokens = self.parse.tree.tokens();
        match token.checked_sub(1) {
            Some(before) if tokens.kind(before) == TokenKind::Whitespace => {
                let range = tokens.range(before);
                let gap = Gap::new(&self.file.bytes[range.start as usize..range.end as usize]);
                gap.bytes().len() - gap.before_last_line()
            }
            _ => 0,
        }
    }

    /// Keywords in the wrong case.
    fn keywords(&self, units: Option<&Units>) -> Vec<Edit> {
        if self.style.keywords == KeywordCase::Keep {
            return Vec::new();
        }
        let mut edits = Vec::new();
        for (index, token) in self.words.iter().enumerate() {
            let word = self.word(index);
            if !word.kind.is_keyword() || !word.text.iter().any(u8::is_ascii_lowercase) {
                continue;
            }
            let range = self.parse.tree.tokens().range(*token);
            // Behind a backslash it is the name of an argument.
            let before = (0..index).rev().find(|before| !self.is_comment(*before));
            let is_name =
                before.is_some_and(|before| self.word(before).kind == TokenKind::Backslash);
            let is_left = units.is_some_and(|units| !units.contains(index));
            if !is_name && !is_left && !self.protected.touches(&range) {
                let span = Span { file: self.file.id, start: range.start, end: range.end };
                edits.push(Edit { span, text: word.text.to_ascii_uppercase() });
            }
        }
        edits
    }
}

/// Words that end one block of statements and begin another one.
fn divides(kind: TokenKind) -> bool {
    matches!(
        kind,
        TokenKind::Else
            | TokenKind::ElseIf
            | TokenKind::Case
            | TokenKind::Default
            | TokenKind::Backward
            | TokenKind::Error
            | TokenKind::Undo
    )
}
