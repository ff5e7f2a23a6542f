//! The arguments of a call.

use super::executor::Executor;
use crate::rapid::ir::hir::{Arg, ArgKind, Expr, ExprKind, Ident};

/// The arguments of an instruction, by position and by name.
pub(super) struct Arguments<'e> {
    /// All of them, in order.
    pub(super) all: &'e [Arg],
    pub(super) positional: Vec<&'e Expr>,
    /// Name and value.
    pub(super) optional: Vec<(&'e Ident, Option<&'e Expr>)>,
    /// Options `\Z?Zone`, stated only if the routine has the parameter `Zone`, as text: `Z?Zone`.
    pub(super) conditional: Vec<String>,
}

impl<'e> Arguments<'e> {
    /// The arguments of a call in the routine that `executor` currently runs.
    pub(super) fn new(executor: &Executor<'_>, args: &'e [Arg]) -> Arguments<'e> {
        let mut positional = Vec::new();
        let mut optional = Vec::new();
        let mut conditional = Vec::new();
        for arg in args {
            match &arg.kind {
                ArgKind::Positional(expr) => positional.push(expr),
                ArgKind::Named(name, expr) => optional.push((name, Some(expr))),
                ArgKind::Optional(name, expr) => optional.push((name, expr.as_ref())),
                ArgKind::Conditional(name, outer) => {
                    if let ExprKind::Ref(outer) = &outer.kind {
                        conditional.push(format!("{}?{}", name.text, outer.text));
                    }
                    if executor.given(outer).is_some() {
                        optional.push((name, Some(outer)));
                    }
                }
            }
        }
        Arguments { all: args, positional, optional, conditional }
    }

    /// Whether an option is given, with or without a value.
    pub(super) fn has_option(&self, key: &str) -> bool {
        self.optional.iter().any(|(name, _)| name.key == key)
    }

    /// The value of an option that is present and has one.
    pub(super) fn option_value(&self, key: &str) -> Option<&'e Expr> {
        self.optional.iter().find(|(name, _)| name.key == key).and_then(|(_, expr)| *expr)
    }
}
