//! Arguments: `grammar/arguments.ebnf`.

use super::expressions::Height;
use super::recovery::ends_block;
use super::{Parentheses, Parser};
use crate::rapid::syntax::node::NodeKind;
use crate::rapid::syntax::token::TokenKind;
use crate::rapid::syntax::tolerance::Tolerance;

impl Parser<'_> {
    /// At least one argument, separated by `,` or by the `\` of the next.
    pub(super) fn arguments(&mut self) -> Height {
        let mut height = 0;
        let mut first = true;
        loop {
            match self.current() {
                TokenKind::Backslash => height = height.max(self.optional_argument()),
                TokenKind::Comma if !first => {
                    let comma = self.position;
                    self.bump();
                    if self.at(TokenKind::Backslash) {
                        self.tolerate(Tolerance::CommaBeforeOptional, comma);
                        height = height.max(self.optional_argument());
                    } else {
                        height = height.max(self.argument());
                    }
                }
                _ if first => height = self.argument(),
                _ => return height,
            }
            first = false;
        }
    }

    fn argument(&mut self) -> Height {
        let mark = self.mark();
        match self.current() {
            TokenKind::Star => self.argument_value(),
            TokenKind::Identifier if self.next() == TokenKind::Assign => {
                self.name();
                self.bump();
                let height = self.argument_value();
                self.finish(mark, NodeKind::NamedArgument);
                height + 1
            }
            _ => self.expression_or("an argument"),
        }
    }

    fn argument_value(&mut self) -> Height {
        if self.at(TokenKind::Star) {
            self.leaf(NodeKind::AnyPosition);
            1
        } else {
            self.expression()
        }
    }

    /// `\name := value`, `\name`, `\name ? parameter`
    fn optional_argument(&mut self) -> Height {
        let mark = self.mark();
        self.bump();
        let mut kind = NodeKind::OptionalArgument;
        let mut height = 1;
        if self.current().is_keyword() {
            // Optional arguments have a name space of their own.
            self.tolerate(Tolerance::KeywordAsArgument, self.position);
            self.leaf(NodeKind::Name);
        } else {
            self.name();
        }
        match self.current() {
            TokenKind::Assign => {
                self.bump();
                height = self.argument_value();
            }
            TokenKind::Question => {
                self.bump();
                self.name();
                kind = NodeKind::ConditionalArgument;
            }
            TokenKind::Equal if !self.quiet => {
                self.wrong_token(TokenKind::Assign);
                height = self.argument_value();
            }
            _ => {}
        }
        self.finish(mark, kind);
        height + 1
    }

    /// At the `(` after the name of a called procedure: whether the parentheses enclose all
    /// arguments, `Proc(a, b);`, or belong to the first, `Proc (a + b) * c, d;`.
    pub(super) fn parentheses_hold_arguments(&mut self) -> bool {
        if self.position >= self.parentheses.end {
            self.scan_parentheses();
        }
        let found = self.parentheses.found.binary_search_by_key(&self.position, |one| one.0);
        found.is_ok_and(|index| self.parentheses.found[index].1)
    }

    /// Scans from the current `(` to its `)` or to the end of the statement and records all
    /// brackets on the way, so that a broken program is not scanned again for each of them.
    fn scan_parentheses(&mut self) {
        let mut found = std::mem::take(&mut self.parentheses.found);
        found.clear();
        let mut open: Vec<usize> = Vec::new();
        let mut index = self.position;
        let mut before = TokenKind::EndOfFile;
        loop {
            let kind = self.tokens.kind(index);
            match kind {
                TokenKind::LeftParen | TokenKind::LeftBracket | TokenKind::LeftBrace => {
                    open.push(found.len());
                    found.push((index, false));
                }
                TokenKind::RightParen | TokenKind::RightBracket | TokenKind::RightBrace => {
                    if let Some(opener) = open.pop() {
                        found[opener].1 |= before == TokenKind::LeftParen;
                    }
                }
                TokenKind::Comma | TokenKind::Backslash | TokenKind::Assign => {
                    if let Some(opener) = open.last() {
                        found[*opener].1 = true;
                    }
                }
                _ => {}
            }
            if open.is_empty() || kind == TokenKind::Semicolon || ends_block(kind) {
                break;
            }
            before = kind;
            index = self.after(index);
        }
        self.parentheses = Parentheses { found, end: index };
    }
}
