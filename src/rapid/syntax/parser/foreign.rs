//! Constructs of other languages, each reported as one error: `SWITCH`, `ENDCASE`, `NEXT i`,
//! blocks in braces, indices in square brackets.

use super::Parser;
use super::recovery::{closes_routine, starts_statement};
use crate::rapid::syntax::node::NodeKind;
use crate::rapid::syntax::token::TokenKind;

impl Parser<'_> {
    /// Number of tokens of `NEXT i` for `ENDFOR`, `WEND` for `ENDWHILE`, `}` for a closing keyword;
    /// or 0.
    pub(super) fn foreign_closer(&mut self, closer: TokenKind) -> usize {
        if self.at(TokenKind::RightBrace) {
            let instead = self.first_on_line(self.position)
                && !closes_routine(closer)
                && self.next() != closer;
            return usize::from(self.braces > 0 || instead);
        }
        let word = self.text(self.position);
        let next = closer == TokenKind::EndFor && word.eq_ignore_ascii_case(b"NEXT");
        let wend = closer == TokenKind::EndWhile && word.eq_ignore_ascii_case(b"WEND");
        if !(next || wend) || !self.first_on_line(self.position) {
            return 0;
        }
        let second = self.after(self.position);
        if self.first_on_line(second) {
            return 1;
        }
        let third = self.after(second);
        let counter = next && self.tokens.kind(second) == TokenKind::Identifier;
        if counter && self.first_on_line(third) { 2 } else { 0 }
    }

    /// Whether `END…` before the token `next` has no counterpart in RAPID, because the innermost
    /// block continues or is closed at `next`.
    pub(super) fn ends_nothing(&mut self, next: usize, closer: TokenKind) -> bool {
        let kind = self.tokens.kind(next);
        let word = self.text(self.position);
        let exact = word.len() == 3 || word.get(3) == Some(&b'_');
        let branch = match closer {
            TokenKind::EndTest => matches!(kind, TokenKind::Case | TokenKind::Default),
            TokenKind::EndIf => matches!(kind, TokenKind::Else | TokenKind::ElseIf),
            _ => false,
        };
        !exact && (branch || kind == closer)
    }

    /// Reads a word such as `ENDCASE`, which RAPID does not have.
    pub(super) fn foreign_branch_end(&mut self) -> bool {
        let Some(closer) = self.open.last().map(|open| open.closer) else { return false };
        let word = self.text(self.position);
        let end = self.at(TokenKind::Identifier)
            && word.get(..3).is_some_and(|start| start.eq_ignore_ascii_case(b"END"))
            && self.first_on_line(self.position);
        if !end {
            return false;
        }
        let next = self.after(self.position);
        if !self.first_on_line(next) || !self.ends_nothing(next, closer) {
            return false;
        }
        self.error_unexpected("a statement");
        self.leaf(NodeKind::Error);
        true
    }

    /// At a `CASE` after a line without `;`: reports the word used there instead of `TEST` and
    /// reads the branches.
    pub(super) fn report_foreign_test(&mut self) -> bool {
        if !matches!(self.current(), TokenKind::Case | TokenKind::Default) || !self.is_stray() {
            return false;
        }
        let word = self.first_of_line(self.end.saturating_sub(1));
        if self.tokens.kind(word) != TokenKind::Identifier {
            return false;
        }
        let found = super::excerpt(self.text(word));
        self.error_at(word, format!("expected TEST, found '{found}'"));
        self.headless_branches();
        true
    }

    /// After a header: reads a `{` that replaces its keyword; true if there is one.
    pub(super) fn opens_brace(&mut self) -> bool {
        let brace = self.at(TokenKind::LeftBrace);
        if brace {
            self.leaf(NodeKind::Error);
            self.braces += 1;
        }
        brace
    }

    /// Whether the current `}` closes a block whose `{` was reported.
    pub(super) fn closes_brace(&mut self) -> bool {
        let brace = self.at(TokenKind::RightBrace) && self.braces > 0;
        self.braces -= u32::from(brace);
        brace
    }

    /// Reads the `}` of `} ELSE`.
    pub(super) fn closes_brace_before_else(&mut self) -> bool {
        let branch = matches!(self.next(), TokenKind::Else | TokenKind::ElseIf);
        let brace = branch && self.closes_brace();
        if brace {
            self.leaf(NodeKind::Error);
        }
        brace
    }

    /// Whether a `{` after a name opens a block and not an index: a statement starts on the next
    /// line.
    pub(super) fn brace_opens_block(&mut self) -> bool {
        let first = self.after(self.position);
        if !self.first_on_line(first) {
            return false;
        }
        let kind = self.tokens.kind(first);
        let second = self.after(first);
        starts_statement(kind) && kind.is_keyword()
            || kind == TokenKind::Identifier
                && matches!(
                    self.tokens.kind(second),
                    TokenKind::Identifier | TokenKind::Assign | TokenKind::Semicolon
                )
    }

    /// At `name[`: whether a `:=` follows the `]`.
    pub(super) fn assigns_to_brackets(&mut self) -> bool {
        let mut token = self.after(self.position);
        loop {
            match self.tokens.kind(token) {
                TokenKind::RightBracket => break,
                TokenKind::Semicolon | TokenKind::EndOfFile => return false,
                _ => token = self.after(token),
            }
            if self.first_on_line(token) {
                return false;
            }
        }
        let behind = self.after(token);
        self.tokens.kind(behind) == TokenKind::Assign
    }

    /// `[1]` for `{1}`.
    pub(super) fn bracketed_index(&mut self) {
        self.error_expected("'{' before an index");
        let read = self.deeper(|parser| {
            parser.bump();
            parser.expressions();
            parser.eat(TokenKind::RightBracket);
        });
        if read.is_none() {
            self.bump();
        }
    }

    /// `==`: reports the second `=` and reads past it.
    pub(super) fn skip_doubled_equal(&mut self) {
        if self.at(TokenKind::Equal) && self.position == self.end {
            self.error_at(self.position, "expected '=' to compare, found '=='".to_owned());
            self.leaf(NodeKind::Error);
        }
    }

    /// `i++;`, `i--;`, `i += 2;` as a statement.
    pub(super) fn foreign_increment(&mut self) -> bool {
        let first = self.after(self.position);
        let second = self.after(first);
        let kinds = (self.tokens.kind(first), self.tokens.kind(second));
        let doubled = kinds.0 == kinds.1;
        let third = self.after(second);
        let alone = matches!(self.tokens.kind(third), TokenKind::Semicolon | TokenKind::EndOfFile);
        if !(kinds.1 == TokenKind::Equal || doubled && alone) || second != first + 1 {
            return false;
        }
        let name = super::excerpt(self.text(self.position));
        let sign = if kinds.0 == TokenKind::Plus { '+' } else { '-' };
        let operator = if doubled { format!("{sign}{sign}") } else { format!("{sign}=") };
        let amount = if doubled { "1" } else { "…" };
        let mark = self.mark();
        self.bump();
        self.error_at(
            first,
            format!("expected ':=', found '{operator}'; write {name} := {name} {sign} {amount}"),
        );
        self.recover();
        self.finish(mark, NodeKind::Error);
        true
    }

    /// Reports a comment of another language.
    pub(super) fn foreign_comment(&mut self) -> bool {
        let second = self.tokens.kind(self.position + 1);
        let slashes =
            self.at(TokenKind::Slash) && matches!(second, TokenKind::Slash | TokenKind::Star);
        let hash = self.at(TokenKind::Unknown) && self.text(self.position) == b"#";
        if slashes || hash {
            let found = if hash {
                "#"
            } else if second == TokenKind::Slash {
                "//"
            } else {
                "/*"
            };
            let message = format!("expected a statement, found '{found}'; comments start with '!'");
            self.error_at(self.position, message);
        }
        slashes || hash
    }
}
