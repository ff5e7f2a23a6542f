//! Recovery after an error.

use super::{Line, Parser};
use crate::rapid::syntax::node::NodeKind;
use crate::rapid::syntax::token::TokenKind;

impl Parser<'_> {
    /// Whether a line ends between the token before `token` and `token`.
    pub(super) fn first_on_line(&self, token: usize) -> bool {
        self.line_gap(token).is_none_or(|gap| gap.iter().any(|b| matches!(b, b'\n' | b'\r')))
    }

    /// The white space directly before a token; `None` at the start of the file.
    fn line_gap(&self, token: usize) -> Option<&[u8]> {
        let before = token.checked_sub(1)?;
        match self.tokens.kind(before) {
            TokenKind::Whitespace => Some(self.text(before)),
            _ => Some(&[]),
        }
    }

    /// Column of a token that is the first on its line.
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

    /// Whether a statement seems to start at the current token, which does not continue the line
    /// before.
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

    /// Skips the rest of a statement with an error, including its `;`. A `THEN` or `DO` shows that
    /// the statement is the header of a block with a missing or misspelt keyword: the block is read
    /// too.
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
                // The rest of the line is inside the string.
                _ if self.ended_by_unclosed_string() => break,
                _ => self.bump(),
            }
        }
        self.finish_skipped(mark, start);
    }

    /// After a keyword: reports and skips a repetition of it.
    pub(super) fn skip_doubled(&mut self, keyword: TokenKind) {
        if self.at(keyword) && !self.first_on_line(self.position) {
            self.error_at(self.position, format!("{} is doubled", keyword.describe()));
            self.leaf(NodeKind::Error);
        }
    }

    /// After the `;` of a statement with an error: the rest of the line, if it has no `;`, belongs
    /// to the same error.
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
            return self.recover();
        }
        if self.eat(TokenKind::Semicolon) {
            return;
        }
        if !self.quiet {
            let new_line = self.first_on_line(self.position) || self.at(TokenKind::EndOfFile);
            if ends_block(self.current()) || new_line && self.looks_like_start() {
                if self.report_foreign_test() {
                    return;
                }
                let message = format!("expected ';', found {}", self.found());
                self.error_before(message);
                self.headless_branches();
                return;
            }
            self.error_expected(expected);
        }
        self.recover();
    }

    /// Reads the keyword that ends the header of a block statement. If it is missing, skips the
    /// rest of the header. Returns whether the end of the header was found.
    pub(super) fn end_header(&mut self, wanted: TokenKind) -> bool {
        // After an unclosed string, the keyword is inside the string.
        if self.eat(wanted) || self.quiet && self.ended_by_unclosed_string() {
            return true;
        }
        self.error_expected(wanted.describe());
        if self.opens_brace() {
            return true;
        }
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
        self.finish_skipped(mark, start);
        ended
    }
}

/// Keywords at which a routine starts.
pub(super) fn opens_routine(kind: TokenKind) -> bool {
    matches!(kind, TokenKind::Proc | TokenKind::Func | TokenKind::Trap)
}

pub(super) fn closes_routine(kind: TokenKind) -> bool {
    matches!(kind, TokenKind::EndProc | TokenKind::EndFunc | TokenKind::EndTrap)
}

/// Keywords that close a block statement or a routine.
pub(super) fn closes_block(kind: TokenKind) -> bool {
    closes_routine(kind)
        || matches!(
            kind,
            TokenKind::EndIf | TokenKind::EndFor | TokenKind::EndWhile | TokenKind::EndTest
        )
}

/// Keywords at which a block of statements ends.
pub(super) fn ends_block(kind: TokenKind) -> bool {
    closes_block(kind)
        || opens_routine(kind)
        || matches!(
            kind,
            TokenKind::Else
                | TokenKind::ElseIf
                | TokenKind::Case
                | TokenKind::Default
                | TokenKind::EndModule
                | TokenKind::EndRecord
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

/// Tokens after which the statement continues on the next line.
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
