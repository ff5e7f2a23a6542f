//! Expressions and arguments.

use super::{Lowering, exact};
use crate::rapid::ir::hir::{Arg, ArgKind, BinaryOp, Expr, ExprKind, UnaryOp};
use crate::rapid::syntax::{Node, NodeKind, TokenKind, ast};

impl Lowering<'_> {
    pub(super) fn broken(&self, node: Node<'_>) -> Expr {
        Expr { kind: ExprKind::Broken, span: self.span(node) }
    }

    /// An expression. The depth of the recursion is limited by the parser.
    pub(super) fn expr(&self, node: Node<'_>) -> Expr {
        if node.children().any(|child| child.kind() == NodeKind::Error) {
            return self.broken(node);
        }
        let mut children = node.children();
        let kind = match node.kind() {
            // Parentheses form no node of their own, but the span includes them.
            NodeKind::Parenthesized => children.next().map(|inner| self.expr(inner).kind),
            NodeKind::NumberLiteral => number(node.text(self.bytes)).map(ExprKind::Num),
            NodeKind::StringLiteral => Some(ExprKind::Str(self.string(node))),
            NodeKind::BoolLiteral => {
                Some(ExprKind::Bool(node.text(self.bytes).eq_ignore_ascii_case(b"TRUE")))
            }
            NodeKind::Reference => Some(ExprKind::Ref(self.ident(node))),
            NodeKind::FieldAccess => children
                .next()
                .zip(children.next())
                .map(|(base, name)| ExprKind::Field(Box::new(self.expr(base)), self.ident(name))),
            NodeKind::IndexAccess => children.next().map(|base| {
                let base = Box::new(self.expr(base));
                ExprKind::Index(base, children.map(|index| self.expr(index)).collect())
            }),
            NodeKind::FunctionCall => children.next().map(|name| {
                let count = node.children().count() - 1;
                let args = exact(children, count, |argument| self.arg(argument));
                ExprKind::Call(self.ident(name), args)
            }),
            NodeKind::Aggregate => {
                let count = node.children().count();
                Some(ExprKind::Aggregate(exact(children, count, |part| self.expr(part))))
            }
            NodeKind::UnaryExpression => unary_op(node)
                .zip(children.next())
                .map(|(op, operand)| ExprKind::Unary(op, Box::new(self.expr(operand)))),
            NodeKind::BinaryExpression => {
                match (binary_op(node), children.next(), children.next()) {
                    (Some(op), Some(left), Some(right)) => Some(ExprKind::Binary(
                        op,
                        Box::new(self.expr(left)),
                        Box::new(self.expr(right)),
                    )),
                    _ => None,
                }
            }
            NodeKind::AnyPosition => Some(ExprKind::AnyPosition),
            NodeKind::Placeholder => Some(ExprKind::Placeholder),
            _ => None,
        };
        Expr { kind: kind.unwrap_or(ExprKind::Broken), span: self.span(node) }
    }

    pub(super) fn arg(&self, node: Node<'_>) -> Arg {
        let span = self.span(node);
        let Some(argument) = ast::Argument::cast(node) else {
            return Arg { kind: ArgKind::Positional(self.expr(node)), span };
        };
        let name = self.ident_in(argument.name(), node);
        let kind = match (node.kind(), argument.value()) {
            (NodeKind::OptionalArgument, value) => {
                ArgKind::Optional(name, value.map(|value| self.expr(value)))
            }
            (NodeKind::ConditionalArgument, parameter) => {
                let outer = self.ident_in(parameter, node);
                let span = outer.span;
                ArgKind::Conditional(name, Expr { kind: ExprKind::Ref(outer), span })
            }
            (_, Some(value)) => ArgKind::Named(name, self.expr(value)),
            (_, None) => ArgKind::Named(name, self.broken(node)),
        };
        Arg { kind, span }
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
