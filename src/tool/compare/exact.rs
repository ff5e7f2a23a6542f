//! Exact comparison of what has the same canonical text.

use super::node::{Label, Node};
use super::number::same;
use crate::rapid::ir::hir::{Data, Expr, StmtKind};

/// Whether two nodes with the same canonical text are the same: that text rounds numbers.
pub(super) fn same_node(old: &Node<'_>, new: &Node<'_>) -> bool {
    let numbers = |node: &Node<'_>| -> Vec<f64> {
        exprs(&node.label).into_iter().flat_map(literals).collect()
    };
    all_same(&numbers(old), &numbers(new))
}

/// The same for declarations.
pub(super) fn same_data(old: &Data, new: &Data) -> bool {
    let numbers = |data: &Data| -> Vec<f64> {
        data.dims.iter().chain(&data.init).flat_map(literals).collect()
    };
    all_same(&numbers(old), &numbers(new))
}

/// The same for expressions.
pub(super) fn same_expr(old: &Expr, new: &Expr) -> bool {
    all_same(&literals(old), &literals(new))
}

fn all_same(old: &[f64], new: &[f64]) -> bool {
    old.len() == new.len() && old.iter().zip(new).all(|(old, new)| same(*old, *new))
}

/// The expressions of a node alone.
pub(super) fn exprs<'a>(label: &Label<'a>) -> Vec<&'a Expr> {
    match label {
        Label::Statement(stmt) => match &stmt.kind {
            // The others have nodes of their own.
            StmtKind::If { branches, .. } => {
                branches.iter().take(1).map(|(expr, _)| expr).collect()
            }
            StmtKind::Test { value, .. } => vec![value],
            kind => kind.exprs(),
        },
        Label::ElseIf(condition, _) => vec![condition],
        Label::Case(values) | Label::Error(values) => values.iter().collect(),
        Label::Else | Label::Default | Label::Backward | Label::Undo => Vec::new(),
    }
}

/// The numbers in an expression, in order.
fn literals(expr: &Expr) -> Vec<f64> {
    let mut found = Vec::new();
    let mut open = vec![expr];
    while let Some(expr) = open.pop() {
        match expr.literal_number() {
            Some(x) => found.push(x),
            None => open.extend(expr.parts().into_iter().rev()),
        }
    }
    found
}
