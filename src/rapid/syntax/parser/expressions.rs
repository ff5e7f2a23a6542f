//! Expressions: `grammar/expressions.ebnf`.

use super::Parser;
use crate::rapid::syntax::node::NodeKind;
use crate::rapid::syntax::parsed::MAX_EXPRESSION_HEIGHT;
use crate::rapid::syntax::token::TokenKind;
use crate::rapid::syntax::tolerance::Tolerance;
use crate::rapid::syntax::tree::Mark;

/// Precedence of an operator, lowest first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Or,
    And,
    Relation,
    Sum,
    Product,
    Primary,
}

impl Level {
    fn of(kind: TokenKind) -> Option<Level> {
        Some(match kind {
            TokenKind::Or | TokenKind::Xor => Level::Or,
            TokenKind::And => Level::And,
            TokenKind::Equal
            | TokenKind::NotEqual
            | TokenKind::Less
            | TokenKind::LessEqual
            | TokenKind::Greater
            | TokenKind::GreaterEqual => Level::Relation,
            TokenKind::Plus | TokenKind::Minus => Level::Sum,
            TokenKind::Star | TokenKind::Slash | TokenKind::Div | TokenKind::Mod => Level::Product,
            _ => return None,
        })
    }

    /// The lowest precedence inside the right operand of an operator of this level.
    fn tighter(self) -> Level {
        match self {
            Level::Or => Level::And,
            Level::And => Level::Relation,
            Level::Relation => Level::Sum,
            Level::Sum => Level::Product,
            Level::Product | Level::Primary => Level::Primary,
        }
    }
}

/// Number of levels of the tree of an expression.
pub(super) type Height = u32;

impl Parser<'_> {
    /// `a, b, c`
    pub(super) fn expressions(&mut self) -> Height {
        let mut height = self.expression();
        while self.eat(TokenKind::Comma) {
            height = height.max(self.expression());
        }
        height
    }

    pub(super) fn expression(&mut self) -> Height {
        self.expression_or("an expression")
    }

    /// An expression; `expected` names it in the message if it is missing.
    pub(super) fn expression_or(&mut self, expected: &str) -> Height {
        if self.lone_operand() { 1 } else { self.binary(Level::Or, expected) }
    }

    /// Reads an expression of one token (the most frequent case), if the next token confirms it.
    fn lone_operand(&mut self) -> bool {
        let kind = match self.current() {
            TokenKind::Identifier => Some(NodeKind::Reference),
            current => literal(current),
        };
        let Some(kind) = kind else { return false };
        let alone = matches!(
            self.tokens.kind(self.position + 1),
            TokenKind::Comma
                | TokenKind::Semicolon
                | TokenKind::Backslash
                | TokenKind::RightParen
                | TokenKind::RightBracket
        );
        if alone {
            self.leaf(kind);
        }
        alone
    }

    fn binary(&mut self, least: Level, expected: &str) -> Height {
        let mark = self.mark();
        let mut height = self.operand(least, expected);
        let mut related = false;
        while let Some(level) = Level::of(self.current()) {
            if level < least || height >= MAX_EXPRESSION_HEIGHT {
                break;
            }
            if level == Level::Relation {
                if related {
                    let message = format!(
                        "relations cannot be chained; put the first in parentheses before {}",
                        self.found()
                    );
                    self.error_at(self.position, message);
                }
                related = true;
            }
            let comparing = self.at(TokenKind::Equal);
            self.bump();
            if comparing {
                self.skip_doubled_equal();
            }
            let right = self.binary(level.tighter(), "an expression");
            height = self.taller(mark, NodeKind::BinaryExpression, height.max(right));
        }
        height
    }

    /// Finishes a node above subtrees of height `below`.
    fn taller(&mut self, mark: Mark, kind: NodeKind, below: Height) -> Height {
        self.finish(mark, kind);
        let height = below + 1;
        if height >= MAX_EXPRESSION_HEIGHT {
            let message =
                format!("expression of more than {MAX_EXPRESSION_HEIGHT} levels; split it up");
            self.error_at(self.end.saturating_sub(1), message);
        }
        height
    }

    /// A primary with its signs or `NOT`.
    fn operand(&mut self, least: Level, expected: &str) -> Height {
        let mark = self.mark();
        let level = match self.current() {
            TokenKind::Not => {
                if least > Level::And {
                    self.tolerate(Tolerance::NotAfterOperator, self.position);
                }
                least.max(Level::And)
            }
            TokenKind::Plus | TokenKind::Minus => {
                if least > Level::Sum {
                    self.tolerate(Tolerance::SignAfterOperator, self.position);
                }
                least.max(Level::Product)
            }
            _ => return self.primary(expected),
        };
        let height = self.deeper(|parser| {
            let not = parser.at(TokenKind::Not);
            parser.bump();
            if not && parser.at(TokenKind::Not) {
                parser.tolerate(Tolerance::NotAfterOperator, parser.position);
            }
            let below = parser.binary(level, "an expression");
            parser.taller(mark, NodeKind::UnaryExpression, below)
        });
        height.unwrap_or_else(|| self.missing_operand())
    }

    fn missing_operand(&mut self) -> Height {
        self.missing();
        1
    }

    fn primary(&mut self, expected: &str) -> Height {
        if let Some(kind) = literal(self.current()) {
            self.leaf(kind);
            return 1;
        }
        match self.current() {
            TokenKind::Placeholder => return self.variable(),
            TokenKind::UnclosedString => {
                let message = "expected '\"' at the end of this string".to_owned();
                self.error_at(self.position, message);
                self.leaf(NodeKind::Error);
            }
            TokenKind::LeftParen | TokenKind::LeftBracket => return self.bracketed(),
            TokenKind::Identifier => return self.variable_or_call(),
            _ => {
                self.error_expected(expected);
                self.missing();
            }
        }
        1
    }

    /// `(a)`, `[a, b]`
    fn bracketed(&mut self) -> Height {
        let mark = self.mark();
        let is_list = self.at(TokenKind::LeftBracket);
        let height = self.deeper(|parser| {
            parser.bump();
            if is_list {
                let below = parser.expressions();
                parser.close_bracket(TokenKind::RightBracket, "',' or ']'");
                parser.taller(mark, NodeKind::Aggregate, below)
            } else {
                let below = parser.expression();
                parser.close_bracket(TokenKind::RightParen, "an operator or ')'");
                parser.taller(mark, NodeKind::Parenthesized, below)
            }
        });
        height.unwrap_or_else(|| self.missing_operand())
    }

    /// `a`, `a.b`, `a{1}`
    pub(super) fn variable(&mut self) -> Height {
        let mark = self.mark();
        match self.current() {
            TokenKind::Identifier => self.leaf(NodeKind::Reference),
            TokenKind::Placeholder => self.leaf(NodeKind::Placeholder),
            _ => {
                self.error_expected("a variable");
                self.missing();
                return 1;
            }
        }
        self.components(mark, 1)
    }

    fn variable_or_call(&mut self) -> Height {
        if self.next() != TokenKind::LeftParen {
            return self.variable();
        }
        let mark = self.mark();
        let height = self.deeper(|parser| {
            parser.name();
            parser.bump();
            let mut below = 1;
            if !parser.at(TokenKind::RightParen) {
                below = parser.arguments();
            }
            parser.close_bracket(TokenKind::RightParen, "',' or ')'");
            parser.taller(mark, NodeKind::FunctionCall, below)
        });
        let Some(height) = height else { return self.missing_operand() };
        if matches!(self.current(), TokenKind::Dot | TokenKind::LeftBrace) && !self.quiet {
            self.tolerate(Tolerance::ComponentOfCall, self.position);
        }
        self.components(mark, height)
    }

    /// `.b`, `{1, 2}` after the expression that began at `mark`.
    fn components(&mut self, mark: Mark, mut height: Height) -> Height {
        while height < MAX_EXPRESSION_HEIGHT {
            match self.current() {
                TokenKind::Dot => {
                    self.bump();
                    self.name();
                    height = self.taller(mark, NodeKind::FieldAccess, height);
                }
                TokenKind::LeftBrace if self.brace_opens_block() => break,
                TokenKind::LeftBracket if self.position == self.end => {
                    self.bracketed_index();
                    height = self.taller(mark, NodeKind::Error, height);
                }
                TokenKind::LeftBrace => {
                    let indices = self.deeper(|parser| {
                        parser.bump();
                        let below = parser.expressions();
                        parser.close_bracket(TokenKind::RightBrace, "',' or '}'");
                        below
                    });
                    let Some(below) = indices else { break };
                    height = self.taller(mark, NodeKind::IndexAccess, height.max(below));
                }
                _ => break,
            }
        }
        height
    }
}

fn literal(kind: TokenKind) -> Option<NodeKind> {
    match kind {
        TokenKind::Number => Some(NodeKind::NumberLiteral),
        TokenKind::String => Some(NodeKind::StringLiteral),
        TokenKind::True | TokenKind::False => Some(NodeKind::BoolLiteral),
        _ => None,
    }
}
