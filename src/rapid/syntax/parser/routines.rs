//! Routines: `grammar/routines.ebnf`.

use super::recovery::{ends_block, starts_data};
use super::{Parser, excerpt};
use crate::rapid::syntax::node::NodeKind;
use crate::rapid::syntax::token::TokenKind;
use crate::rapid::syntax::tolerance::Tolerance;

impl Parser<'_> {
    /// `PROC`, `FUNC` or `TRAP` (the `keyword`) with its handlers.
    pub(super) fn routine(&mut self, keyword: TokenKind) {
        let mark = self.mark();
        self.depth_reported = false;
        self.split_if = None;
        self.eat_scope();
        let (closer, kind) = match keyword {
            TokenKind::Func => (TokenKind::EndFunc, NodeKind::FuncDeclaration),
            TokenKind::Trap => (TokenKind::EndTrap, NodeKind::TrapDeclaration),
            _ => (TokenKind::EndProc, NodeKind::ProcDeclaration),
        };
        self.open(closer, self.position);
        self.bump();
        self.skip_doubled(keyword);
        if keyword == TokenKind::Func {
            let first = self.position;
            self.type_name();
            if self.at(TokenKind::LeftParen) && !self.quiet {
                let name = excerpt(self.text(first));
                self.error_at(first, format!("expected a type before the name '{name}'"));
                self.quiet = false;
                self.missing();
            } else {
                self.name();
            }
        } else {
            self.name();
        }
        match (keyword, self.at(TokenKind::LeftParen)) {
            (TokenKind::Trap, true) => {
                self.error_at(self.position, "a TRAP has no parameters".to_owned());
            }
            (TokenKind::Trap, false) => {}
            (_, true) => self.parameters(),
            (_, false) => self.error_expected("'('"),
        }
        if self.at(TokenKind::LeftBrace) {
            self.error_unexpected("a statement");
            self.opens_brace();
        }
        if self.quiet {
            self.rest_of_parameters();
        }
        self.routine_data();
        self.block();
        self.handlers();
        self.close();
        self.finish(mark, kind);
    }

    /// Data declarations before the statements.
    fn routine_data(&mut self) {
        while starts_data(self.current()) && !self.at_routine() {
            self.quiet = false;
            if matches!(self.current(), TokenKind::Local | TokenKind::Task) {
                self.tolerate(Tolerance::ScopeInRoutine, self.position);
            }
            self.data_declaration();
        }
    }

    /// Skips the rest of the parameters of a routine, possibly on several lines: to a `)` at the
    /// end of a line, else to the end of the current line.
    pub(super) fn rest_of_parameters(&mut self) {
        if self.end > 0 && self.tokens.kind(self.end - 1) == TokenKind::RightParen {
            self.rest_of_header();
            return;
        }
        let mark = self.mark();
        let start = self.position;
        let mut index = start;
        while !ends_block(self.tokens.kind(index))
            && !matches!(self.tokens.kind(index), TokenKind::Semicolon | TokenKind::Assign)
        {
            let closes = self.tokens.kind(index) == TokenKind::RightParen;
            index = self.after(index);
            if closes && self.first_on_line(index) {
                while self.position < index {
                    self.bump();
                }
                break;
            }
        }
        if !self.finish_skipped(mark, start) {
            self.rest_of_header();
        }
    }

    /// Skips the rest of the line of a routine or module header.
    pub(super) fn rest_of_header(&mut self) {
        let mark = self.mark();
        let start = self.position;
        while !self.first_on_line(self.position) && !ends_block(self.current()) {
            self.bump();
        }
        self.finish_skipped(mark, start);
    }

    /// `(num a, \num b | num c, VAR num d{*})`
    fn parameters(&mut self) {
        let mark = self.mark();
        self.bump();
        let mut first = true;
        loop {
            match self.current() {
                TokenKind::RightParen => break,
                TokenKind::Backslash => self.optional_parameters(),
                TokenKind::Comma if !first => {
                    self.bump();
                    if self.at(TokenKind::Backslash) {
                        self.tolerate(Tolerance::CommaBeforeOptional, self.position);
                        self.optional_parameters();
                    } else {
                        self.parameter();
                    }
                }
                _ if first => self.parameter(),
                _ => break,
            }
            first = false;
            if self.quiet {
                break;
            }
        }
        self.close_bracket(TokenKind::RightParen, "',' or ')'");
        self.finish(mark, NodeKind::Parameters);
    }

    /// `\num a | num b`
    fn optional_parameters(&mut self) {
        let mark = self.mark();
        self.bump();
        self.parameter();
        while self.eat(TokenKind::Bar) {
            if self.at(TokenKind::Backslash) {
                self.tolerate(Tolerance::BackslashInAlternative, self.position);
                self.bump();
            }
            self.parameter();
        }
        self.finish(mark, NodeKind::OptionalParameters);
    }

    /// `[VAR|PERS|INOUT] type name {*}`
    fn parameter(&mut self) {
        let referenced = self.at_reference_mode();
        let typed = matches!(self.next(), TokenKind::Identifier | TokenKind::Placeholder);
        if self.at(TokenKind::Placeholder) && !typed {
            self.leaf(NodeKind::Placeholder);
            return;
        }
        let mark = self.mark();
        if referenced {
            self.tolerate(Tolerance::ReferenceParameter, self.position);
            self.bump();
        } else if matches!(self.current(), TokenKind::Var | TokenKind::Pers | TokenKind::InOut) {
            self.bump();
        }
        self.type_name();
        self.name();
        if self.at(TokenKind::LeftBrace) {
            self.open_dimensions();
        }
        self.finish(mark, NodeKind::Parameter);
    }

    /// Whether a parameter with the mode `REF`, which is not a keyword, starts here.
    fn at_reference_mode(&mut self) -> bool {
        self.at(TokenKind::Identifier)
            && self.text(self.position).eq_ignore_ascii_case(b"REF")
            && self.two_names_follow()
    }

    /// `{*, *}`; `{2, 3}` is tolerated.
    fn open_dimensions(&mut self) {
        let mark = self.mark();
        self.bump();
        loop {
            match self.current() {
                TokenKind::Placeholder => self.leaf(NodeKind::Placeholder),
                TokenKind::Number | TokenKind::Identifier => {
                    self.tolerate(Tolerance::ParameterWithSize, self.position);
                    self.expression();
                }
                _ => {
                    self.expect(TokenKind::Star);
                }
            }
            if !self.eat(TokenKind::Comma) {
                break;
            }
        }
        self.close_bracket(TokenKind::RightBrace, "',' or '}'");
        self.finish(mark, NodeKind::OpenDimensions);
    }

    /// `BACKWARD …`, `ERROR …`, `UNDO …`
    fn handlers(&mut self) {
        let mut last = TokenKind::Whitespace;
        let order = |kind| match kind {
            TokenKind::Backward => 1,
            TokenKind::Error => 2,
            TokenKind::Undo => 3,
            _ => 0,
        };
        while order(self.current()) > 0 {
            let kind = self.current();
            self.quiet = false;
            if order(kind) < order(last) {
                self.tolerate(Tolerance::HandlerOrder, self.position);
            } else if kind == last && kind != TokenKind::Error {
                let message = format!("a routine has one {} handler", kind.describe());
                self.error_at(self.position, message);
            }
            last = kind;
            let mark = self.mark();
            self.bump();
            if kind == TokenKind::Error && self.at(TokenKind::LeftParen) {
                self.expression_list(NodeKind::ErrorNumbers, TokenKind::RightParen, "',' or ')'");
                if self.quiet {
                    self.rest_of_header();
                }
            }
            self.block();
            self.finish(
                mark,
                match kind {
                    TokenKind::Backward => NodeKind::BackwardHandler,
                    TokenKind::Undo => NodeKind::UndoHandler,
                    _ => NodeKind::ErrorHandler,
                },
            );
        }
    }
}
