//! Expressions and arguments.

use super::{Lowering, exact, has_own_error};
use crate::rapid::ir::hir::{Arg, ArgKind, BinaryOp, Expr, ExprKind, UnaryOp};
use crate::rapid::syntax::{Node, NodeKind, TokenKind};

impl Lowering<'_> {
    pub(super) fn broken(&self, node: Node<'_>) -> Expr {
        Expr { kind: ExprKind::Broken, span: self.span(node) }
    }

    /// An expression. The depth of the recursion is limited by the parser.
    pub(super) fn expr(&self, node: Node<'_>) -> Expr {
        let kind = if has_own_error(node) { None } else { self.expr_kind(node) };
        Expr { kind: kind.unwrap_or(ExprKind::Broken), span: self.span(node) }
    }

    fn expr_kind(&self, node: Node<'_>) -> Option<ExprKind> {
        let mut children = node.children();
        Some(match node.kind() {
            // Parentheses form no node of their own, but the span includes them.
            NodeKind::Parenthesized => self.expr(children.next()?).kind,
            NodeKind::NumberLiteral => ExprKind::Num(number(node.text(self.bytes))?),
            NodeKind::StringLiteral => ExprKind::Str(self.string(node)),
            NodeKind::BoolLiteral => {
                ExprKind::Bool(node.text(self.bytes).eq_ignore_ascii_case(b"TRUE"))
            }
            NodeKind::Reference => ExprKind::Ref(self.ident(node)),
            NodeKind::FieldAccess => {
                let (base, name) = (children.next()?, children.next()?);
                ExprKind::Field(Box::new(self.expr(base)), self.ident(name))
            }
            NodeKind::IndexAccess => {
                let base = Box::new(self.expr(children.next()?));
                ExprKind::Index(base, children.map(|index| self.expr(index)).collect())
            }
            NodeKind::FunctionCall => {
                let name = self.ident(children.next()?);
                let count = node.children().count() - 1;
                ExprKind::Call(name, exact(children, count, |argument| self.arg(argument)))
            }
            NodeKind::Aggregate => {
                let count = node.children().count();
                ExprKind::Aggregate(exact(children, count, |part| self.expr(part)))
            }
            NodeKind::UnaryExpression => {
                ExprKind::Unary(unary_op(node)?, Box::new(self.expr(children.next()?)))
            }
            NodeKind::BinaryExpression => {
                let (op, left, right) = (binary_op(node)?, children.next()?, children.next()?);
                ExprKind::Binary(op, Box::new(self.expr(left)), Box::new(self.expr(right)))
            }
            NodeKind::AnyPosition => ExprKind::AnyPosition,
            NodeKind::Placeholder => ExprKind::Placeholder,
            _ => return None,
        })
    }

    pub(super) fn arg(&self, node: Node<'_>) -> Arg {
        let name = || self.name_of(node);
        let value = node.children().nth(1);
        let kind = match node.kind() {
            NodeKind::OptionalArgument => {
                ArgKind::Optional(name(), value.map(|value| self.expr(value)))
            }
            NodeKind::ConditionalArgument => {
                let outer = self.ident_or_empty(value, node);
                let span = outer.span;
                ArgKind::Conditional(name(), Expr { kind: ExprKind::Ref(outer), span })
            }
            NodeKind::NamedArgument => {
                let value = value.map_or_else(|| self.broken(node), |value| self.expr(value));
                ArgKind::Named(name(), value)
            }
            _ => ArgKind::Positional(self.expr(node)),
        };
        Arg { kind, span: self.span(node) }
    }

    /// The text of a string, escapes resolved.
    pub(super) fn string(&self, node: Node<'_>) -> String {
        let text = node.text(self.bytes);
        let inner = text.get(1..text.len().saturating_sub(1)).unwrap_or_default();
        unescape(&self.charset.decode(inner))
    }
}

/// `12`, `1.5E-3`, `.5`, `1.`, `0xFF`, `0b01`, `0o17`.
fn number(text: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(text).ok()?;
    let radix = match text.as_bytes() {
        [b'0', b'x' | b'X', ..] => 16,
        [b'0', b'o' | b'O', ..] => 8,
        [b'0', b'b' | b'B', ..] => 2,
        _ => return text.parse().ok(),
    };
    let mut value = 0.0;
    for digit in text.chars().skip(2) {
        value = value * f64::from(radix) + f64::from(digit.to_digit(radix)?);
    }
    Some(value)
}

/// `""` → `"`, `\\` → `\`, `\hh` → the character of that code.
fn unescape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text.chars();
    while let Some(first) = rest.next() {
        let mut ahead = rest.clone();
        let second = ahead.next();
        match (first, second, ahead.next()) {
            ('"', Some('"'), _) | ('\\', Some('\\'), _) => {
                out.push(first);
                rest.next();
            }
            ('\\', Some(high), Some(low)) => {
                if let (Some(high), Some(low)) = (high.to_digit(16), low.to_digit(16)) {
                    out.extend(char::from_u32(high * 16 + low));
                    rest.next();
                    rest.next();
                } else {
                    out.push(first);
                }
            }
            _ => out.push(first),
        }
    }
    out
}

fn unary_op(node: Node<'_>) -> Option<UnaryOp> {
    Some(match node.own_tokens().next()?.kind() {
        TokenKind::Plus => UnaryOp::Plus,
        TokenKind::Minus => UnaryOp::Minus,
        TokenKind::Not => UnaryOp::Not,
        _ => return None,
    })
}

fn binary_op(node: Node<'_>) -> Option<BinaryOp> {
    Some(match node.own_tokens().next()?.kind() {
        TokenKind::Plus => BinaryOp::Add,
        TokenKind::Minus => BinaryOp::Sub,
        TokenKind::Star => BinaryOp::Mul,
        TokenKind::Slash => BinaryOp::Div,
        TokenKind::Div => BinaryOp::IntDiv,
        TokenKind::Mod => BinaryOp::Mod,
        TokenKind::Equal => BinaryOp::Eq,
        TokenKind::NotEqual => BinaryOp::Ne,
        TokenKind::Less => BinaryOp::Lt,
        TokenKind::LessEqual => BinaryOp::Le,
        TokenKind::Greater => BinaryOp::Gt,
        TokenKind::GreaterEqual => BinaryOp::Ge,
        TokenKind::And => BinaryOp::And,
        TokenKind::Or => BinaryOp::Or,
        TokenKind::Xor => BinaryOp::Xor,
        _ => return None,
    })
}
