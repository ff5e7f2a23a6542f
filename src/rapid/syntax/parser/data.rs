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
        self.eat_scope();
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
            self.expression_list(NodeKind::Dimensions, TokenKind::RightBrace, "',' or '}'");
        }
        if self.assigned_value() {
            self.end_statement("an operator or ';'");
        } else {
            if constant && !self.quiet {
                self.tolerate(Tolerance::ConstWithoutValue, keyword);
            }
            self.end_statement("':=' or ';'");
        }
        self.finish(mark, NodeKind::DataDeclaration);
    }

    /// `:= value`, and `= value` with an error; false if neither is here.
    pub(super) fn assigned_value(&mut self) -> bool {
        let wrong = !self.quiet && self.at(TokenKind::Equal);
        if wrong {
            self.wrong_token(TokenKind::Assign);
        }
        let assigned = wrong || self.eat(TokenKind::Assign);
        if assigned {
            self.expression();
        }
        assigned
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

    /// `{2, 3}`, `(ERR_A, ERR_B)`
    pub(super) fn expression_list(&mut self, kind: NodeKind, closer: TokenKind, expected: &str) {
        let mark = self.mark();
        self.bump();
        self.expressions();
        self.close_bracket(closer, expected);
        self.finish(mark, kind);
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
