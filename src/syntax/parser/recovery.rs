//! Getting on after an error.

use super::{Line, Open, Parser};
use crate::syntax::node::NodeKind;
use crate::syntax::token::TokenKind;

impl Parser<'_> {
    /// Whether a line ends between the token before `token` and `token`.
    pub(super) fn first_on_line(&self, token: usize) -> bool {
        self.line_gap(token).is_none_or(|gap| gap.iter().any(|b| matches!(b, b'\n' | b'\r')))
    }

    /// The white space before a token since the token (or comment) before it;
    /// `None` at the start of the file.
    fn line_gap(&self, token: usize) -> Option<&[u8]> {
        let before = token.checked_sub(1)?;
        match self.tokens.kind(before) {
            TokenKind::Whitespace => Some(self.text(before)),
            _ => Some(&[]),
        }
    }

    /// Column of a token that is first on its line.
    pub(super) fn indentation(&self, token: usize) -> Option<usize> {
        if !self.first_on_line(token) {
            return None;
        }
        let gap = self.line_gap(token).unwrap_or_default();
        Some(gap.iter().rev().take_while(|b| !matches!(b, b'\n' | b'\r')).count())
    }

    /// The first token of the line that a token is on.
    pub(super) fn first_of_line(&mut self, token: usize) -> usize {
        let mut first = token;
        while first > 0 && !self.first_on_line(first) {
            if first == self.line.token {
                first = self.line.first;
                break;
            }
            first -= 1;
            self.steps += 1;
        }
        self.line = Line { token, first };
        first
    }

    /// Whether a statement seems to start at the current token, which is no
    /// continuation of the line before.
    pub(super) fn looks_like_start(&mut self) -> bool {
        let kind = self.current();
        if starts_statement(kind) && kind.is_keyword() || ends_block(kind) {
            return true;
        }
        if !matches!(kind, TokenKind::Identifier | TokenKind::Percent | TokenKind::Placeholder) {
            return kind == TokenKind::EndOfFile;
        }
        let before = match self.end {
            0 => return true,
            end => self.tokens.kind(end - 1),
        };
        if continues(before) {
            return false;
        }
        kind != TokenKind::Identifier
            || !matches!(
                self.next(),
                TokenKind::Comma
                    | TokenKind::RightParen
                    | TokenKind::RightBracket
                    | TokenKind::RightBrace
                    | TokenKind::EndOfFile
            )
    }

    /// Skips the rest of a statement that has an error, with its `;`. Behind a
    /// `THEN` or `DO` the statement was the header of a block, whose keyword is
    /// missing or misspelt: the block is read with it.
    pub(super) fn recover(&mut self) {
        let mark = self.mark();
        let start = self.position;
        loop {
            let kind = self.current();
            match kind {
                TokenKind::EndOfFile => break,
                TokenKind::Semicolon => {
                    self.bump();
                    self.skip_leftovers();
                    break;
                }
                TokenKind::Then | TokenKind::Do if !self.first_on_line(self.position) => {
                    let inside = self.depth > 0 && !self.lacks_elseif();
                    self.bump();
                    if inside {
                        self.headless_block(kind);
                    }
                    break;
                }
                _ if ends_block(kind) => break,
                _ if self.first_on_line(self.position) && self.looks_like_start() => break,
                // What follows on its line is inside the string.
                _ if self.ended_by_unclosed_string() => break,
                _ => self.bump(),
            }
        }
        if self.position > start {
            self.finish(mark, NodeKind::Error);
        }
    }

    /// Behind a keyword: reports and skips the same keyword again.
    pub(super) fn skip_doubled(&mut self, keyword: TokenKind) {
        if self.at(keyword) && !self.first_on_line(self.position) {
            self.error_at(self.position, format!("{} is doubled", keyword.describe()));
            self.leaf(NodeKind::Error);
        }
    }

    /// Behind the `;` of a statement that has an error: what is left on the
    /// line without a `;` of its own belongs to the same mistake.
    fn skip_leftovers(&mut self) {
        let mut end = self.position;
        while !self.first_on_line(end) {
            let kind = self.tokens.kind(end);
            if kind == TokenKind::Semicolon || kind.is_keyword() || kind == TokenKind::EndOfFile {
                return;
            }
            end = self.after(end);
        }
        while self.position < end {
            self.bump();
        }
    }

    fn ended_by_unclosed_string(&self) -> bool {
        self.end > 0 && self.tokens.kind(self.end - 1) == TokenKind::UnclosedString
    }

    /// The end of a simple statement or declaration: its `;`, or recovery.
    pub(super) fn end_statement(&mut self, expected: &str) {
        if self.at(TokenKind::Semicolon) && self.quiet {
            self.recover();
            return;
        }
        if self.eat(TokenKind::Semicolon) {
            return;
        }
        if !self.quiet {
            let new_line = self.first_on_line(self.position) || self.at(TokenKind::EndOfFile);
            if ends_block(self.current()) || new_line && self.looks_like_start() {
                let message = format!("expected ';', found {}", self.found());
                self.error_before(message);
                self.headless_branches();
                return;
            }
            self.error_expected(expected);
        }
        self.recover();
    }

    /// Reads the keyword that ends the header of a block statement. Without it
    /// the rest of the header is skipped; gives whether its end was found.
    pub(super) fn end_header(&mut self, wanted: TokenKind) -> bool {
        // The keyword is inside the string then.
        if self.eat(wanted) || self.quiet && self.ended_by_unclosed_string() {
            return true;
        }
        self.error_expected(wanted.describe());
        let mut ended = false;
        let mark = self.mark();
        let start = self.position;
        loop {
            let kind = self.current();
            let stops = wanted == TokenKind::Colon || self.looks_like_start();
            if kind == TokenKind::EndOfFile
                || ends_block(kind)
                || stops && self.first_on_line(self.position)
            {
                break;
            }
            self.bump();
            ended = kind == wanted || matches!(kind, TokenKind::Then | TokenKind::Do);
            if ended || kind == TokenKind::Semicolon {
                break;
            }
        }
        if self.position > start {
            self.finish(mark, NodeKind::Error);
        }
        ended
    }

    // --- closing keywords ---

    pub(super) fn open(&mut self, closer: TokenKind, opener: usize) {
        self.open.push(Open { closer, opener });
    }

    fn is_awaited(&self, closer: TokenKind) -> bool {
        self.open.iter().any(|open| open.closer == closer)
    }

    /// Reads the keyword that closes the innermost open block.
    pub(super) fn close(&mut self) {
        let Some(Open { closer, opener }) = self.open.pop() else { return };
        self.quiet = false;
        if self.eat(closer) {
            return;
        }
        let wrong = self.current();
        let misspelt = self.misspelling(closer);
        if misspelt > 0 {
            let message = format!("expected {}, found {}", closer.describe(), self.found());
            self.close_error(message, opener, false);
            let mark = self.mark();
            for _ in 0..misspelt {
                self.bump();
            }
            self.eat(TokenKind::Semicolon);
            self.finish(mark, NodeKind::Error);
        } else if closes_block(wrong) && self.is_mistyped(closer, opener) {
            let message = format!("expected {}, found {}", closer.describe(), wrong.describe());
            self.close_error(message, opener, false);
            self.leaf(NodeKind::Error);
        } else {
            let message = format!("expected {} before {}", closer.describe(), self.found());
            self.close_error(message, opener, true);
        }
    }

    fn close_error(&mut self, message: String, opener: usize, before: bool) {
        let keyword = self.tokens.kind(opener).describe();
        let related = self.related(opener, format!("this {keyword} is not closed"));
        let range = self.tokens.range(self.position);
        let end = if before { range.start } else { range.end };
        self.push_error(range.start, end, message, Some(related));
    }

    /// Whether a misspelling of the keyword that closes the innermost block
    /// stands alone on this line: the number of its tokens, or 0.
    pub(super) fn misspelt_closer(&mut self) -> usize {
        match self.open.last() {
            Some(open) if self.at(TokenKind::Identifier) => self.misspelling(open.closer),
            _ => 0,
        }
    }

    /// `ENIDF`, `END IF`, `END` or `END_IF` for `ENDIF`, alone on its line: the
    /// number of its tokens, or 0.
    fn misspelling(&mut self, closer: TokenKind) -> usize {
        let word = self.text(self.position);
        if !self.at(TokenKind::Identifier)
            || !word.first().is_some_and(|letter| letter.eq_ignore_ascii_case(&b'E'))
            || !self.first_on_line(self.position)
        {
            return 0;
        }
        let second = self.after(self.position);
        let wanted = closer.describe().as_bytes();
        if word.eq_ignore_ascii_case(b"END") {
            let rest = wanted.get(word.len()..).unwrap_or_default();
            if self.text(second).eq_ignore_ascii_case(rest) {
                return 2;
            }
        }
        let alone = self.tokens.kind(second) == TokenKind::EndOfFile || self.first_on_line(second);
        let other = closer != TokenKind::EndModule
            && word.get(..3).is_some_and(|start| start.eq_ignore_ascii_case(b"END"));
        usize::from(alone && (other || is_near(word, wanted)))
    }

    /// Whether the closing keyword at hand is the wrong one for the innermost
    /// block, rather than the right one for a block around it.
    fn is_mistyped(&mut self, wanted: TokenKind, opener: usize) -> bool {
        let found = self.current();
        let owner = self.open.iter().rev().find(|open| open.closer == found).copied();
        match owner {
            None => closes_routine(wanted) || !self.is_left_over(Open { closer: wanted, opener }),
            Some(owner) => {
                let column = self.indentation(self.position);
                column.is_some()
                    && column == self.indentation(opener)
                    && column != self.indentation(owner.opener)
            }
        }
    }

    /// Whether the closing keyword at hand, which no open block wants, is one too
    /// many, rather than the innermost block's own one mistyped.
    fn is_left_over(&mut self, inner: Open) -> bool {
        let doubled = self.end > 0 && self.tokens.kind(self.end - 1) == self.current();
        let columns = (self.indentation(self.position), self.indentation(inner.opener));
        let outside = matches!(columns, (Some(here), Some(there)) if here != there);
        doubled || outside || self.next() == inner.closer
    }

    /// At a keyword that ends a block: whether no open block wants it, so that
    /// it can only be left over.
    pub(super) fn is_stray(&mut self) -> bool {
        let kind = self.current();
        let Some(inner) = self.open.last().copied() else { return true };
        let closer = inner.closer;
        match kind {
            TokenKind::Else | TokenKind::ElseIf => !self.is_awaited(TokenKind::EndIf),
            TokenKind::Case | TokenKind::Default => !self.is_awaited(TokenKind::EndTest),
            TokenKind::EndIf | TokenKind::EndFor | TokenKind::EndWhile | TokenKind::EndTest => {
                let outermost = closes_routine(closer) || closer == TokenKind::EndRecord;
                !self.is_awaited(kind) && (outermost || self.is_left_over(inner))
            }
            TokenKind::EndRecord => closer != kind,
            TokenKind::Then | TokenKind::Do => true,
            _ => false,
        }
    }
}

/// Keywords that close a block statement or a routine.
fn closes_block(kind: TokenKind) -> bool {
    closes_routine(kind)
        || matches!(
            kind,
            TokenKind::EndIf | TokenKind::EndFor | TokenKind::EndWhile | TokenKind::EndTest
        )
}

pub(super) fn closes_routine(kind: TokenKind) -> bool {
    matches!(kind, TokenKind::EndProc | TokenKind::EndFunc | TokenKind::EndTrap)
}

/// Keywords at which a block of statements ends.
pub(super) fn ends_block(kind: TokenKind) -> bool {
    closes_block(kind)
        || matches!(
            kind,
            TokenKind::Else
                | TokenKind::ElseIf
                | TokenKind::Case
                | TokenKind::Default
                | TokenKind::EndModule
                | TokenKind::EndRecord
                | TokenKind::Proc
                | TokenKind::Func
                | TokenKind::Trap
                | TokenKind::Module
                | TokenKind::Error
                | TokenKind::Undo
                | TokenKind::Backward
                | TokenKind::EndOfFile
        )
}

/// Tokens at which a statement starts.
pub(super) fn starts_statement(kind: TokenKind) -> bool {
    matches!(
        kind,
        TokenKind::Identifier
            | TokenKind::Percent
            | TokenKind::Placeholder
            | TokenKind::Semicolon
            | TokenKind::If
            | TokenKind::For
            | TokenKind::While
            | TokenKind::Test
            | TokenKind::Goto
            | TokenKind::Return
            | TokenKind::Raise
            | TokenKind::Exit
            | TokenKind::Retry
            | TokenKind::TryNext
            | TokenKind::Connect
    ) || starts_data(kind)
}

/// Keywords at which a data declaration starts.
pub(super) fn starts_data(kind: TokenKind) -> bool {
    matches!(
        kind,
        TokenKind::Local | TokenKind::Task | TokenKind::Var | TokenKind::Pers | TokenKind::Const
    )
}

/// Tokens after which a line goes on.
fn continues(kind: TokenKind) -> bool {
    matches!(
        kind,
        TokenKind::Comma
            | TokenKind::Assign
            | TokenKind::LeftParen
            | TokenKind::LeftBracket
            | TokenKind::LeftBrace
            | TokenKind::Backslash
            | TokenKind::Plus
            | TokenKind::Minus
            | TokenKind::Star
            | TokenKind::Slash
            | TokenKind::Equal
            | TokenKind::And
            | TokenKind::Or
    )
}

/// Whether a word differs from a keyword by one letter that is wrong, missing
/// or too much, or by two neighbours exchanged.
fn is_near(word: &[u8], keyword: &[u8]) -> bool {
    let word = word.to_ascii_uppercase();
    let same = word.iter().zip(keyword).take_while(|(a, b)| a == b).count();
    let (a, b) = (&word[same..], &keyword[same..]);
    match (a, b) {
        ([first, second, a @ ..], [third, fourth, b @ ..])
            if (first, second) == (fourth, third) && a == b =>
        {
            true
        }
        ([_, a @ ..], [_, b @ ..]) if a == b => true,
        ([_, rest @ ..], _) if rest == b => true,
        (_, [_, rest @ ..]) => rest == a,
        _ => false,
    }
}
