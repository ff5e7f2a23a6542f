//! Recovery from missing, misspelt or superfluous block keywords.

use super::recovery::{closes_block, closes_routine, ends_block, opens_routine};
use super::{Open, Parser, SplitIf, excerpt};
use crate::rapid::syntax::node::NodeKind;
use crate::rapid::syntax::token::TokenKind;

impl Parser<'_> {
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
            // The error was reported at its `{`.
            self.quiet = self.closes_brace();
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
        match (before, self.at(TokenKind::EndOfFile)) {
            // Reported at the last token, not on the empty line after it.
            (true, true) => {
                let place = self.end_before(self.position);
                self.push_error(place, place, message, Some(related));
            }
            (true, false) => self.push_error(range.start, range.start, message, Some(related)),
            (false, _) => self.push_error(range.start, range.end, message, Some(related)),
        }
    }

    /// Number of tokens of a misspelling, alone on this line, of the keyword that closes the
    /// innermost block; 0 if there is none.
    pub(super) fn misspelt_closer(&mut self) -> usize {
        match self.open.last() {
            Some(open)
                if matches!(self.current(), TokenKind::Identifier | TokenKind::RightBrace) =>
            {
                self.misspelling(open.closer)
            }
            _ => 0,
        }
    }

    /// Number of tokens of `ENIDF`, `END IF`, `END`, `END_IF` for `ENDIF`, alone on its line, or 0.
    fn misspelling(&mut self, closer: TokenKind) -> usize {
        let foreign = self.foreign_closer(closer);
        if foreign > 0 {
            return foreign;
        }
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
        let near = is_near(word, wanted);
        usize::from(alone && (near || other && !self.ends_nothing(second, closer)))
    }

    /// Whether the current closing keyword is a typing error for that of the innermost block, and
    /// not the right one for an outer block.
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

    /// Whether the current closing keyword, which fits no open block, is superfluous, and not a
    /// typing error for that of the innermost block.
    fn is_left_over(&mut self, inner: Open) -> bool {
        let doubled = self.end > 0 && self.tokens.kind(self.end - 1) == self.current();
        let columns = (self.indentation(self.position), self.indentation(inner.opener));
        let outside = matches!(columns, (Some(here), Some(there)) if here != there);
        doubled || outside || self.next() == inner.closer
    }

    /// At a keyword that ends a block: whether it fits no open block and is therefore superfluous.
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

    /// Reads a keyword that ends a block without a beginning. The statements and the `ENDIF` of a
    /// superfluous `ELSE` belong to the same error.
    pub(super) fn stray(&mut self) {
        let mark = self.mark();
        let kind = self.current();
        let position = self.position;
        let message = match kind {
            TokenKind::Else | TokenKind::ElseIf => {
                format!("{} without an IF … THEN before it", kind.describe())
            }
            TokenKind::EndIf => "ENDIF without an IF … THEN before it".to_owned(),
            TokenKind::Case | TokenKind::Default => {
                format!("{} outside TEST … ENDTEST", kind.describe())
            }
            _ => format!("{} without its beginning", kind.describe()),
        };
        if !self.report_missing_then() {
            self.error_at(position, message);
        }
        let branches = match kind {
            TokenKind::Else | TokenKind::ElseIf => {
                self.stray_branches(TokenKind::EndIf, Self::else_branches)
            }
            TokenKind::Case | TokenKind::Default => {
                self.stray_branches(TokenKind::EndTest, Self::cases)
            }
            _ => None,
        };
        if branches.is_none() {
            self.bump();
        }
        self.finish(mark, NodeKind::Error);
    }

    /// Reads branches without the beginning of their statement.
    fn stray_branches(&mut self, closer: TokenKind, read: fn(&mut Self)) -> Option<()> {
        let position = self.position;
        self.deeper(|parser| {
            parser.open(closer, position);
            read(parser);
            parser.close_stray(closer);
        })
    }

    /// At a superfluous keyword: if it is aligned with a compact IF over two lines, reports the
    /// missing `THEN` of that IF.
    fn report_missing_then(&mut self) -> bool {
        let kind = self.current();
        let Some(SplitIf { opener, statement }) = self.split_if.take() else { return false };
        let column = self.indentation(self.position);
        if !matches!(kind, TokenKind::Else | TokenKind::ElseIf | TokenKind::EndIf)
            || column.is_none()
            || column != self.indentation(opener)
        {
            return false;
        }
        let found = excerpt(self.text(statement));
        let place = self.end_before(statement);
        let related = self.related(self.position, format!("this {} has no IF", kind.describe()));
        self.push_error(place, place, format!("expected THEN, found '{found}'"), Some(related));
        true
    }

    /// Reads a block whose header has an error, from after `THEN` or `DO` to its closing keyword.
    pub(super) fn headless_block(&mut self, after: TokenKind) {
        let opener = self.position;
        let read = self.deeper(|parser| {
            if after == TokenKind::Then {
                parser.open(TokenKind::EndIf, opener);
                parser.block();
                parser.else_branches();
                parser.close_stray(TokenKind::EndIf);
            } else {
                parser.open(TokenKind::EndFor, opener);
                parser.open(TokenKind::EndWhile, opener);
                parser.block();
                parser.open.pop();
                parser.close_stray(TokenKind::EndFor);
                parser.eat(TokenKind::EndWhile);
            }
        });
        if read.is_none() {
            self.skip_nested();
        }
        self.quiet = true;
    }

    /// At the `THEN` of a header without its keyword: whether it is a branch of the innermost `IF`,
    /// because its line is not indented more than the `IF`.
    pub(super) fn lacks_elseif(&mut self) -> bool {
        let Some(open) = self.open.last().copied() else { return false };
        let line = self.first_of_line(self.position);
        let columns = (self.indentation(line), self.indentation(open.opener));
        // One more column is the space after the missing keyword.
        open.closer == TokenKind::EndIf
            && self.at(TokenKind::Then)
            && matches!(columns, (Some(here), Some(there)) if here <= there + 1)
    }

    /// After a statement that ends in an error: the branches of a `TEST` whose keyword is missing
    /// belong to the same error.
    pub(super) fn headless_branches(&mut self) {
        let branch = matches!(self.current(), TokenKind::Case | TokenKind::Default);
        if branch && self.depth > 0 && self.is_stray() {
            self.stray();
        }
    }

    /// Closes the block of a superfluous branch without a message.
    fn close_stray(&mut self, closer: TokenKind) {
        self.open.pop();
        if !self.eat(closer) {
            for _ in 0..self.misspelling(closer) {
                self.bump();
            }
        }
    }

    /// Skips a statement that is nested too deeply, with its inner statements.
    pub(super) fn skip_nested(&mut self) {
        let mark = self.mark();
        let mut open = 0_u32;
        // Whether the next THEN belongs to an IF and opens a block.
        let mut after_if = false;
        loop {
            let kind = self.current();
            match kind {
                TokenKind::EndOfFile | TokenKind::Module | TokenKind::EndModule => break,
                _ if opens_routine(kind) || closes_routine(kind) => break,
                TokenKind::For | TokenKind::While | TokenKind::Test => open += 1,
                TokenKind::If => after_if = true,
                TokenKind::ElseIf => after_if = false,
                TokenKind::Then if after_if => {
                    after_if = false;
                    open += 1;
                }
                TokenKind::EndIf | TokenKind::EndFor | TokenKind::EndWhile | TokenKind::EndTest => {
                    if open == 0 {
                        break;
                    }
                    open -= 1;
                    if open == 0 {
                        self.bump();
                        break;
                    }
                }
                TokenKind::Semicolon if open == 0 => {
                    self.bump();
                    break;
                }
                _ => {}
            }
            self.bump();
        }
        self.finish(mark, NodeKind::Error);
    }

    /// Whether the keyword that ends a condition follows before the end of the statement or the
    /// start of another header.
    fn condition_goes_on(&mut self, keyword: TokenKind) -> bool {
        let mut index = self.position;
        loop {
            let kind = self.tokens.kind(index);
            let ends = matches!(
                kind,
                TokenKind::Semicolon
                    | TokenKind::If
                    | TokenKind::For
                    | TokenKind::While
                    | TokenKind::Test
            );
            if kind == keyword || ends || ends_block(kind) {
                return kind == keyword;
            }
            index = self.after(index);
        }
    }

    /// Reports a `!` that turns the rest of a condition and its keyword into a comment,
    /// `IF a != 1 THEN`; true if there is one.
    pub(super) fn commented_condition(&mut self, keyword: TokenKind) -> bool {
        if !self.first_on_line(self.position) {
            return false;
        }
        let comment = (self.end..self.position)
            .find(|&token| self.tokens.kind(token) == TokenKind::Comment)
            .filter(|&token| !self.first_on_line(token));
        let Some(comment) = comment else { return false };
        let text = self.text(comment).trim_ascii_end();
        let word = keyword.describe().as_bytes();
        let unequal = text.starts_with(b"!=");
        let alone = self.end > 0 && self.tokens.kind(self.end - 1).is_keyword();
        let ends = text.len() > word.len() && {
            let (before, last) = text.split_at(text.len() - word.len());
            last.eq_ignore_ascii_case(word) && before.ends_with(b" ")
        };
        if !ends || !unequal && !alone || self.condition_goes_on(keyword) {
            return false;
        }
        let operator = if unequal { "'<>'" } else { "NOT" };
        let message = format!("expected {operator}, found '!', which starts a comment");
        let start = self.tokens.range(comment).start;
        self.push_error(start, start + 1, message, None);
        if alone {
            self.missing();
        }
        true
    }
}

/// Whether a word differs from a keyword by one wrong, missing or extra letter, or by two
/// exchanged neighbours.
pub(super) fn is_near(word: &[u8], keyword: &[u8]) -> bool {
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
