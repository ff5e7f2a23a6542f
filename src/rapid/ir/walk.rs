//! Iterators over the statements, expressions and arguments of a program.

use crate::rapid::builtins::ArgumentPlace;

use super::hir::{
    Arg, ArgKind, Block, Callee, Expr, ExprKind, Ident, Routine, Stmt, StmtKind, UnaryOp,
};

impl Routine {
    /// The statements of the body and of every handler, with those of inner blocks.
    pub fn statements(&self) -> impl Iterator<Item = &Stmt> {
        self.blocks().flat_map(|block| statements(block))
    }

    /// The body and every handler.
    pub fn blocks(&self) -> impl Iterator<Item = &Block> {
        std::iter::once(&self.body)
            .chain(&self.backward)
            .chain(self.error.iter().map(|(_, block)| block))
            .chain(&self.undo)
    }
}

/// The statements of a block and of its inner blocks, in the order of the text.
pub fn statements(block: &[Stmt]) -> impl Iterator<Item = &Stmt> {
    let mut open: Vec<&Stmt> = block.iter().rev().collect();
    std::iter::from_fn(move || {
        let stmt = open.pop()?;
        open.extend(stmt.kind.blocks().into_iter().rev().flat_map(|inner| inner.iter().rev()));
        Some(stmt)
    })
}

impl Stmt {
    /// The condition and the statement of a compact IF: it ends with its only statement, the block
    /// form with ENDIF.
    pub fn compact(&self) -> Option<(&Expr, &Stmt)> {
        let StmtKind::If { branches, otherwise: None } = &self.kind else { return None };
        let [(condition, inner)] = branches.as_slice() else { return None };
        let [only] = inner.as_slice() else { return None };
        (only.span.end == self.span.end).then_some((condition, only))
    }
}

impl StmtKind {
    /// The statement lists directly inside the statement.
    pub fn blocks(&self) -> Vec<&Block> {
        match self {
            StmtKind::If { branches, otherwise } => {
                branches.iter().map(|(_, block)| block).chain(otherwise).collect()
            }
            StmtKind::For { body, .. } | StmtKind::While { body, .. } => vec![body],
            StmtKind::Test { cases, default, .. } => {
                cases.iter().map(|(_, block)| block).chain(default).collect()
            }
            _ => Vec::new(),
        }
    }

    /// The expressions of the statement itself, without those of inner statements.
    pub fn exprs(&self) -> Vec<&Expr> {
        match self {
            StmtKind::Assign { target, value } => vec![target, value],
            StmtKind::Call(call) => {
                let late = match &call.callee {
                    Callee::Late(expr) => Some(expr),
                    Callee::Name(_) => None,
                };
                late.into_iter().chain(call.args.iter().filter_map(Arg::value)).collect()
            }
            StmtKind::If { branches, .. } => branches.iter().map(|(expr, _)| expr).collect(),
            StmtKind::For { from, to, step, .. } => [from, to].into_iter().chain(step).collect(),
            StmtKind::While { condition, .. } => vec![condition],
            StmtKind::Test { value, cases, .. } => {
                let values = cases.iter().flat_map(|(values, _)| values);
                std::iter::once(value).chain(values).collect()
            }
            StmtKind::Return(expr) | StmtKind::Raise(expr) => expr.iter().collect(),
            StmtKind::Connect { interrupt, .. } => vec![interrupt],
            StmtKind::Data(data) => data.init.iter().collect(),
            _ => Vec::new(),
        }
    }
}

/// The arguments of a call with a value, each with its place.
pub fn arguments_with_places(args: &[Arg]) -> impl Iterator<Item = (ArgumentPlace<'_>, &Expr)> {
    let mut position = 0;
    args.iter().filter_map(move |arg| {
        let expr = arg.value()?;
        let place = match &arg.kind {
            ArgKind::Positional(_) => {
                position += 1;
                ArgumentPlace::Position(position - 1)
            }
            ArgKind::Named(name, _)
            | ArgKind::Optional(name, _)
            | ArgKind::Conditional(name, _) => ArgumentPlace::Name(&name.key),
        };
        Some((place, expr))
    })
}

impl Arg {
    /// Its value, if it has no name.
    pub fn positional(&self) -> Option<&Expr> {
        match &self.kind {
            ArgKind::Positional(expr) => Some(expr),
            _ => None,
        }
    }

    /// Its value; none for a switch.
    pub fn value(&self) -> Option<&Expr> {
        match &self.kind {
            ArgKind::Positional(expr)
            | ArgKind::Named(_, expr)
            | ArgKind::Optional(_, Some(expr))
            | ArgKind::Conditional(_, expr) => Some(expr),
            ArgKind::Optional(_, None) => None,
        }
    }
}

impl Expr {
    /// The function calls in the expression, inner ones included.
    pub fn calls(&self) -> Vec<(&Ident, &[Arg])> {
        let mut calls = Vec::new();
        let mut open = vec![self];
        while let Some(expr) = open.pop() {
            if let ExprKind::Call(name, args) = &expr.kind {
                calls.push((name, args.as_slice()));
            }
            open.extend(expr.parts());
        }
        calls
    }

    /// The expressions directly inside the expression.
    pub fn parts(&self) -> Vec<&Expr> {
        match &self.kind {
            ExprKind::Field(base, _) | ExprKind::Unary(_, base) => vec![base],
            ExprKind::Index(base, indices) => std::iter::once(&**base).chain(indices).collect(),
            ExprKind::Call(_, args) => args.iter().filter_map(Arg::value).collect(),
            ExprKind::Aggregate(items) => items.iter().collect(),
            ExprKind::Binary(_, left, right) => vec![left, right],
            _ => Vec::new(),
        }
    }

    /// The number that stands in the text, with its sign.
    pub fn literal_number(&self) -> Option<f64> {
        match &self.kind {
            ExprKind::Num(x) => Some(*x),
            ExprKind::Unary(UnaryOp::Minus, x) => x.literal_number().map(|x| -x),
            ExprKind::Unary(UnaryOp::Plus, x) => x.literal_number(),
            _ => None,
        }
    }

    /// The numbers of an aggregate `[a, b, …]` that stand in the text.
    pub fn literal_numbers(&self) -> Option<Vec<f64>> {
        match &self.kind {
            ExprKind::Aggregate(items) => items.iter().map(Expr::literal_number).collect(),
            _ => None,
        }
    }

    /// The operands of an operator, or the positional arguments of a call.
    pub fn operands(&self) -> Vec<&Expr> {
        match &self.kind {
            ExprKind::Call(_, args) => args.iter().filter_map(Arg::positional).collect(),
            ExprKind::Unary(..) | ExprKind::Binary(..) => self.parts(),
            _ => Vec::new(),
        }
    }

    /// The data object that it is a part of: `d` of `d.x{2}.y`.
    pub fn base(&self) -> Option<&Ident> {
        match &self.kind {
            ExprKind::Ref(name) => Some(name),
            ExprKind::Field(inner, _) | ExprKind::Index(inner, _) => inner.base(),
            _ => None,
        }
    }
}
