//! Statements: `grammar/statements.ebnf`.

use super::recovery::{ends_block, opens_routine, starts_data, starts_statement};
use super::{Parser, SplitIf};
use crate::rapid::syntax::node::NodeKind;
use crate::rapid::syntax::token::TokenKind;
use crate::rapid::syntax::tolerance::Tolerance;
use crate::rapid::syntax::tree::Mark;

impl Parser<'_> {
    /// Statements up to a keyword that ends the block.
    pub(super) fn block(&mut self) {
        let mark = self.mark();
        loop {
            self.quiet = false;
            let ends = self.at(TokenKind::EndOfFile) || self.at_routine();
            if ends || self.misspelt_closer() > 0 {
                break;
            }
            if self.foreign_branch_end() {
                continue;
            }
            let before = self.position;
            let kind = self.current();
            if ends_block(kind) || matches!(kind, TokenKind::Then | TokenKind::Do) {
                if !self.is_stray() {
                    break;
                }
                self.stray();
            } else {
                self.statement();
            }
            self.ensure_progress(before);
        }
        self.quiet = false;
        self.finish(mark, NodeKind::Block);
    }

    /// Whether a routine that starts with `LOCAL` is here.
    pub(super) fn at_routine(&mut self) -> bool {
        self.at(TokenKind::Local) && opens_routine(self.next())
    }

    /// One statement or data declaration; reads at least one token.
    pub(super) fn statement(&mut self) {
        self.quiet = false;
        if self.deeper(Self::statement_inside).is_none() {
            self.skip_nested();
        }
    }

    fn statement_inside(&mut self) {
        match self.current() {
            TokenKind::If => self.if_statement(),
            TokenKind::For => self.for_statement(),
            TokenKind::While => self.while_statement(),
            TokenKind::Test => self.test_statement(),
            TokenKind::Goto => self.keyword_statement(NodeKind::GotoStatement, Self::name),
            TokenKind::Return => self.value_statement(NodeKind::ReturnStatement),
            TokenKind::Raise => self.value_statement(NodeKind::RaiseStatement),
            TokenKind::Exit => self.keyword_statement(NodeKind::ExitStatement, |_| {}),
            TokenKind::Retry => self.keyword_statement(NodeKind::RetryStatement, |_| {}),
            TokenKind::TryNext => self.keyword_statement(NodeKind::TryNextStatement, |_| {}),
            TokenKind::Connect => {
                self.keyword_statement(NodeKind::ConnectStatement, Self::connection);
            }
            TokenKind::Percent => self.call_statement(),
            TokenKind::Placeholder => self.placeholder_statement(),
            TokenKind::Semicolon => {
                self.tolerate(Tolerance::EmptyStatement, self.position);
                self.leaf(NodeKind::EmptyStatement);
            }
            kind if starts_data(kind) => {
                self.tolerate(Tolerance::DataBetweenStatements, self.position);
                self.data_declaration();
            }
            TokenKind::Identifier => self.name_statement(),
            _ => {
                let mark = self.mark();
                if !self.foreign_comment() {
                    self.error_unexpected("a statement");
                }
                self.bump();
                self.recover();
                self.finish(mark, NodeKind::Error);
            }
        }
    }

    /// A statement that starts with a name: label, assignment or call.
    fn name_statement(&mut self) {
        match self.next() {
            TokenKind::Colon => {
                let mark = self.mark();
                self.name();
                self.bump();
                self.finish(mark, NodeKind::LabelStatement);
            }
            TokenKind::Assign | TokenKind::Equal | TokenKind::Dot | TokenKind::LeftBrace => {
                self.assignment();
            }
            TokenKind::LeftBracket if self.assigns_to_brackets() => self.assignment(),
            TokenKind::Plus | TokenKind::Minus if self.foreign_increment() => {}
            _ => self.call_statement(),
        }
    }

    /// `a{1}.b := value;`
    fn assignment(&mut self) {
        let mark = self.mark();
        self.variable();
        if !self.assigned_value() {
            self.error_expected("':='");
        }
        self.end_statement("an operator or ';'");
        self.finish(mark, NodeKind::Assignment);
    }

    /// `MoveJ p, v, z, t;`, `%name% a;`
    fn call_statement(&mut self) {
        let mark = self.mark();
        let callee = self.position;
        if self.at(TokenKind::Percent) {
            self.late_binding();
        } else {
            self.name();
        }
        if self.at(TokenKind::LeftParen) && self.parentheses_hold_arguments() {
            self.tolerate(Tolerance::ParenthesizedArguments, self.position);
            self.bump();
            if !self.at(TokenKind::RightParen) {
                self.arguments();
            }
            self.close_bracket(TokenKind::RightParen, "',' or ')'");
        } else if !matches!(self.current(), TokenKind::Semicolon | TokenKind::EndOfFile)
            && !self.ends_early(callee)
        {
            self.arguments();
        }
        self.end_statement("',' or ';'");
        self.finish(mark, NodeKind::CallStatement);
    }

    /// Whether the `;` of the statement at `word` is missing, because the next statement starts on
    /// the current line. An argument or value on a line of its own would be indented further.
    fn ends_early(&mut self, word: usize) -> bool {
        let kind = self.current();
        if !self.first_on_line(self.position) {
            return false;
        }
        if ends_block(kind) || starts_statement(kind) && kind.is_keyword() {
            return true;
        }
        let line = self.first_of_line(word);
        kind == TokenKind::Identifier
            && self.indentation(self.position) <= self.indentation(line)
            && matches!(
                self.next(),
                TokenKind::Identifier
                    | TokenKind::Assign
                    | TokenKind::Colon
                    | TokenKind::Semicolon
                    | TokenKind::String
                    | TokenKind::Backslash
            )
    }

    /// `%expr%`
    fn late_binding(&mut self) {
        let mark = self.mark();
        self.bump();
        self.expression();
        self.expect(TokenKind::Percent);
        self.finish(mark, NodeKind::LateBinding);
    }

    /// `<SMT>`, or a placeholder for the variable of an assignment.
    fn placeholder_statement(&mut self) {
        match self.next() {
            TokenKind::Assign | TokenKind::Dot | TokenKind::LeftBrace => self.assignment(),
            _ => self.leaf(NodeKind::Placeholder),
        }
    }

    /// `IF … THEN … ENDIF`, `IF … statement`
    fn if_statement(&mut self) {
        let mark = self.mark();
        let opener = self.position;
        self.bump();
        if self.commented_condition(TokenKind::Then) {
            return self.if_block(mark, opener);
        }
        self.expression();
        let broken = self.quiet || self.then_follows();
        if !broken && self.commented_condition(TokenKind::Then) {
            return self.if_block(mark, opener);
        }
        if !broken && starts_statement(self.current()) {
            if self.first_on_line(self.position) {
                self.split_if = Some(SplitIf { opener, statement: self.position });
            }
            self.statement();
            self.finish(mark, NodeKind::CompactIf);
            return;
        }
        if !self.at(TokenKind::Then) {
            self.error_expected(if broken { "an operator or THEN" } else { "THEN or a statement" });
        }
        if self.end_header(TokenKind::Then) {
            self.if_block(mark, opener);
        } else {
            self.finish(mark, NodeKind::CompactIf);
        }
    }

    /// The part after the `THEN` of the IF that began at `mark`.
    fn if_block(&mut self, mark: Mark, opener: usize) {
        self.open(TokenKind::EndIf, opener);
        self.block();
        self.else_branches();
        self.close();
        self.finish(mark, NodeKind::IfStatement);
    }

    /// After the condition of an IF, not at THEN: whether a THEN follows on the line, so that the
    /// tokens before it are an error in the condition.
    fn then_follows(&mut self) -> bool {
        let mut index = self.position;
        if self.tokens.kind(index) == TokenKind::Then {
            return false;
        }
        loop {
            match self.tokens.kind(index) {
                TokenKind::Then => return true,
                TokenKind::Semicolon | TokenKind::If | TokenKind::EndOfFile => return false,
                _ => {}
            }
            index = self.after(index);
            if self.first_on_line(index) {
                return false;
            }
        }
    }

    /// `ELSEIF … THEN …`, `ELSE …`
    pub(super) fn else_branches(&mut self) {
        let mut after_else = false;
        loop {
            let braced = self.closes_brace_before_else();
            let mark = self.mark();
            let branch = matches!(self.current(), TokenKind::ElseIf | TokenKind::Else);
            if branch && after_else {
                self.error_expected("ENDIF");
            }
            after_else |= self.at(TokenKind::Else);
            match self.current() {
                TokenKind::ElseIf => {
                    self.bump();
                    self.expression();
                    self.quiet |= braced;
                    self.end_header(TokenKind::Then);
                    self.block();
                    self.finish(mark, NodeKind::ElseIfBranch);
                }
                TokenKind::Else => {
                    self.bump();
                    if braced {
                        self.opens_brace();
                    }
                    self.block();
                    self.finish(mark, NodeKind::ElseBranch);
                }
                TokenKind::Placeholder if self.text(self.position) == b"<EIT>" => {
                    self.leaf(NodeKind::Placeholder);
                }
                _ => break,
            }
        }
    }

    fn for_statement(&mut self) {
        let mark = self.mark();
        self.open(TokenKind::EndFor, self.position);
        self.bump();
        self.name();
        for keyword in [TokenKind::From, TokenKind::To] {
            if self.eat(keyword) {
                self.expression();
            } else {
                self.error_expected(keyword.describe());
            }
        }
        if self.at(TokenKind::Step) {
            let step = self.mark();
            self.bump();
            self.expression();
            self.finish(step, NodeKind::ForStep);
        }
        self.end_header(TokenKind::Do);
        self.block();
        self.close();
        self.finish(mark, NodeKind::ForStatement);
    }

    fn while_statement(&mut self) {
        let mark = self.mark();
        self.open(TokenKind::EndWhile, self.position);
        self.bump();
        if !self.commented_condition(TokenKind::Do) {
            self.expression();
            if !self.commented_condition(TokenKind::Do) {
                self.end_header(TokenKind::Do);
            }
        }
        self.block();
        self.close();
        self.finish(mark, NodeKind::WhileStatement);
    }

    fn test_statement(&mut self) {
        let mark = self.mark();
        self.open(TokenKind::EndTest, self.position);
        self.bump();
        self.expression();
        let branch = |kind| {
            matches!(
                kind,
                TokenKind::Case | TokenKind::Default | TokenKind::Placeholder | TokenKind::EndTest
            )
        };
        if !branch(self.current()) {
            self.error_expected("CASE");
            let rest = self.mark();
            let start = self.position;
            if !starts_statement(self.current()) && !ends_block(self.current()) {
                self.bump();
            }
            while !self.first_on_line(self.position) && !ends_block(self.current()) {
                self.bump();
            }
            if starts_statement(self.current()) && !ends_block(self.current()) {
                self.block();
            }
            self.finish_skipped(rest, start);
        }
        self.cases();
        self.close();
        self.finish(mark, NodeKind::TestStatement);
    }

    /// `CASE …:`, `DEFAULT:`
    pub(super) fn cases(&mut self) {
        let mut after_default = false;
        loop {
            let mark = self.mark();
            self.quiet = false;
            match self.current() {
                TokenKind::Case => {
                    if after_default {
                        self.tolerate(Tolerance::DefaultNotLast, self.position);
                        after_default = false;
                    }
                    self.bump();
                    self.expressions();
                    self.end_header(TokenKind::Colon);
                    self.block();
                    self.finish(mark, NodeKind::CaseBranch);
                }
                TokenKind::Default => {
                    if after_default {
                        self.error_expected("ENDTEST");
                    }
                    after_default = true;
                    self.bump();
                    self.skip_doubled(TokenKind::Default);
                    self.end_header(TokenKind::Colon);
                    self.block();
                    self.finish(mark, NodeKind::DefaultBranch);
                }
                TokenKind::Placeholder => self.leaf(NodeKind::Placeholder),
                _ => break,
            }
        }
    }

    /// `RETURN value;`, `RAISE number;`
    fn value_statement(&mut self, kind: NodeKind) {
        let mark = self.mark();
        let word = self.position;
        self.bump();
        let bare = self.at(TokenKind::Semicolon) || ends_block(self.current());
        if !bare && !self.ends_early(word) {
            self.expression();
        }
        self.end_statement("an operator or ';'");
        self.finish(mark, kind);
    }

    /// A keyword and what `rest` reads, up to the `;`.
    fn keyword_statement(&mut self, kind: NodeKind, rest: impl FnOnce(&mut Self)) {
        let mark = self.mark();
        self.bump();
        rest(self);
        self.end_statement("';'");
        self.finish(mark, kind);
    }

    /// `variable WITH trap` after `CONNECT`.
    fn connection(&mut self) {
        self.variable();
        if self.expect(TokenKind::With) {
            self.name();
        }
    }
}
