//! Evaluation of operators.

use crate::rapid::ir::functions;
use crate::rapid::ir::hir::{BinaryOp, Expr};
use crate::rapid::ir::value::Datum;

pub(super) fn negated(items: &[Datum], expr: &Expr) -> Datum {
    let minus = |item: &Datum| match item {
        Datum::Num(x) => Datum::Num(-x),
        _ => Datum::unknown("'-' needs numbers", expr.span),
    };
    Datum::List(items.iter().map(minus).collect())
}

pub(super) fn binary(op: BinaryOp, left: &Datum, right: &Datum, expr: &Expr) -> Datum {
    if let Some(unknown) = left.first_unknown().or_else(|| right.first_unknown()) {
        // FALSE AND x, TRUE OR x are known for every x.
        return match (op, left, right) {
            (BinaryOp::And, Datum::Bool(false), _) | (BinaryOp::And, _, Datum::Bool(false)) => {
                Datum::Bool(false)
            }
            (BinaryOp::Or, Datum::Bool(true), _) | (BinaryOp::Or, _, Datum::Bool(true)) => {
                Datum::Bool(true)
            }
            _ => Datum::Unknown(unknown.clone()),
        };
    }
    let wrong = || Datum::unknown("the operator does not fit its operands", expr.span);
    match (op, left, right) {
        (BinaryOp::Eq, a, b) => Datum::Bool(equal(a, b)),
        (BinaryOp::Ne, a, b) => Datum::Bool(!equal(a, b)),
        (BinaryOp::And, a, b) => logic(a, b, |a, b| a && b).unwrap_or_else(wrong),
        (BinaryOp::Or, a, b) => logic(a, b, |a, b| a || b).unwrap_or_else(wrong),
        (BinaryOp::Xor, a, b) => logic(a, b, |a, b| a != b).unwrap_or_else(wrong),
        (_, Datum::Num(a), Datum::Num(b)) => arithmetic(op, *a, *b, expr),
        (BinaryOp::Add, Datum::Text(a), Datum::Text(b)) => Datum::Text(format!("{a}{b}").into()),
        (BinaryOp::Add | BinaryOp::Sub, Datum::List(a), Datum::List(b)) if a.len() == b.len() => {
            Datum::List(a.iter().zip(b).map(|(a, b)| binary(op, a, b, expr)).collect())
        }
        (BinaryOp::Mul, Datum::Num(_), Datum::List(items)) => {
            Datum::List(items.iter().map(|item| binary(op, left, item, expr)).collect())
        }
        (BinaryOp::Mul | BinaryOp::Div, Datum::List(items), Datum::Num(_)) => {
            Datum::List(items.iter().map(|item| binary(op, item, right, expr)).collect())
        }
        (BinaryOp::Mul, Datum::List(_), Datum::List(_)) => {
            functions::product(left, right).unwrap_or_else(wrong)
        }
        _ => wrong(),
    }
}

/// Equality with the precision of RAPID's `num`.
pub(super) fn equal(a: &Datum, b: &Datum) -> bool {
    match (a, b) {
        (Datum::Num(a), Datum::Num(b)) => (*a as f32) == (*b as f32),
        (Datum::List(a), Datum::List(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| equal(a, b))
        }
        (Datum::Bool(a), Datum::Num(b)) | (Datum::Num(b), Datum::Bool(a)) => *a == (*b != 0.0),
        _ => a == b,
    }
}

fn logic(a: &Datum, b: &Datum, f: fn(bool, bool) -> bool) -> Option<Datum> {
    let truth = |d: &Datum| match d {
        Datum::Bool(b) => Some(*b),
        Datum::Num(x) => Some(*x != 0.0),
        _ => None,
    };
    Some(Datum::Bool(f(truth(a)?, truth(b)?)))
}

fn arithmetic(op: BinaryOp, a: f64, b: f64, expr: &Expr) -> Datum {
    match op {
        BinaryOp::Add => Datum::Num(a + b),
        BinaryOp::Sub => Datum::Num(a - b),
        BinaryOp::Mul => Datum::Num(a * b),
        BinaryOp::Div | BinaryOp::IntDiv | BinaryOp::Mod if b == 0.0 => {
            Datum::unknown("division by zero", expr.span)
        }
        BinaryOp::Div => Datum::Num(a / b),
        BinaryOp::IntDiv => Datum::Num((a / b).trunc()),
        BinaryOp::Mod => Datum::Num(a % b),
        BinaryOp::Lt => Datum::Bool(a < b),
        BinaryOp::Le => Datum::Bool(a <= b),
        BinaryOp::Gt => Datum::Bool(a > b),
        BinaryOp::Ge => Datum::Bool(a >= b),
        _ => Datum::unknown("the operator does not fit numbers", expr.span),
    }
}
