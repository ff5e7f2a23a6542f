//! Types and data: `grammar/data.ebnf`.

use super::Parser;
use super::recovery::ends_block;
use crate::rapid::syntax::node::NodeKind;
use crate::rapid::syntax::token::TokenKind;
use crate::rapid::syntax::tolerance::Tolerance;

impl Parser<'_> {
    /// `[LOCAL|TASK] (VAR|PERS|CONST) type name {dims} := value;`
    pub(super) fn data_declaration(&mut self) {
        let mark = self.mark();
        if matches!(self.current(), TokenKind::Local | TokenKind::Task) {
            self.bump();
        }
        let keyword = self.position;
        let constant = self.at(TokenKind::Const);
        if matches!(self.current(), TokenKind::Var | TokenKind::Pers | TokenKind::Const) {
            self.bump();
        } else {
            self.error_expected("VAR, PERS or CONST");
        }
        self.type_name();
        if !self.quiet {
            self.name();
        }
        if self.at(TokenKind::LeftBrace) {
            self.dimensions();
        }
        let mut expected = "an operator or ';'";
        if self.eat(TokenKind::Assign) {
            self.expression();
        } else if !self.quiet && self.at(TokenKind::Equal) {
            self.wrong_token(TokenKind::Assign);
            self.expression();
        } else {
            if constant && !self.quiet {
                self.tolerate(Tolerance::ConstWithoutValue, keyword);
            }
            expected = "':=' or ';'";
        }
        self.end_statement(expected);
        self.finish(mark, NodeKind::DataDeclaration);
    }

    /// Reports that another token is expected here, and reads past the current one.
    pub(super) fn wrong_token(&mut self, wanted: TokenKind) {
        self.error_expected(wanted.describe());
        self.leaf(NodeKind::Error);
    }

    pub(super) fn type_name(&mut self) {
        match self.current() {
            TokenKind::Identifier => self.leaf(NodeKind::TypeName),
            TokenKind::Placeholder => self.leaf(NodeKind::Placeholder),
            _ => {
                self.error_expected("the name of a type");
                self.missing();
            }
        }
    }

    /// `{2, 3}`
    fn dimensions(&mut self) {
        let mark = self.mark();
        self.bump();
        self.expressions();
        self.close_bracket(TokenKind::RightBrace, "',' or '}'");
        self.finish(mark, NodeKind::Dimensions);
    }

    /// `RECORD name {type component;} ENDRECORD`
    pub(super) fn record(&mut self) {
        let mark = self.mark();
        self.eat_scope();
        self.open(TokenKind::EndRecord, self.position);
        self.bump();
        self.skip_doubled(TokenKind::Record);
        self.name();
        if self.at(TokenKind::Semicolon) {
            self.tolerate(Tolerance::EmptyStatement, self.position);
            self.leaf(NodeKind::EmptyStatement);
        }
        loop {
            self.quiet = false;
            let before = self.position;
            match self.current() {
                TokenKind::Placeholder => self.leaf(NodeKind::Placeholder),
                TokenKind::Identifier if self.misspelt_closer() > 0 => break,
                TokenKind::Identifier => self.record_component(),
                TokenKind::Local | TokenKind::Task if self.next() == TokenKind::Identifier => {
                    self.error_unexpected("a component or ENDRECORD");
                    self.leaf(NodeKind::Error);
                    self.record_component();
                }
                kind if ends_block(kind) || kind.is_keyword() => break,
                _ => {
                    self.error_expected("a component or ENDRECORD");
                    self.recover();
                }
            }
            if self.position == before {
                break;
            }
        }
        self.close();
        self.finish(mark, NodeKind::RecordDeclaration);
    }

    fn record_component(&mut self) {
        let mark = self.mark();
        self.type_name();
        self.name();
        self.end_statement("';'");
        self.finish(mark, NodeKind::RecordComponent);
    }

    /// `ALIAS type name;`
    pub(super) fn alias(&mut self) {
        let mark = self.mark();
        self.eat_scope();
        self.bump();
        self.type_name();
        self.name();
        self.end_statement("';'");
        self.finish(mark, NodeKind::AliasDeclaration);
    }

    pub(super) fn eat_scope(&mut self) {
        if matches!(self.current(), TokenKind::Local | TokenKind::Task) {
            self.bump();
        }
    }
}
