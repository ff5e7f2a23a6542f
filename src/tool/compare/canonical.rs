//! Expressions and statements as text without layout: two with the same text mean the same.
//!
//! Numbers lose their form, names their case, and brackets that change nothing disappear. What has a
//! syntax error is represented by its words.

use std::fmt::Write as _;

use super::names::Names;
use super::number;
use super::unread::words;
use crate::rapid::builtins;
use crate::rapid::ir::hir::{
    Arg, ArgKind, BinaryOp, Call, Callee, Data, DataKind, Expr, ExprKind, Ident, Param, ParamMode,
    Scope, Stmt, StmtKind, UnaryOp,
};
use crate::rapid::text::{SourceFile, Span};

/// Binding strengths, from loose to tight; `NOT` stands between `OR` and `AND`, a sign is as loose as
/// a sum.
const LOOSEST: u8 = 0;
const NOT: u8 = 2;
const SIGN: u8 = 5;
const TIGHTEST: u8 = 7;

/// Writes parts of one side's program.
#[derive(Clone, Copy)]
pub(super) struct Writer<'a> {
    pub(super) files: &'a [SourceFile],
    pub(super) names: &'a Names<'a>,
}

impl Writer<'_> {
    pub(super) fn expr(&self, expr: &Expr) -> String {
        let mut out = String::new();
        self.write(&mut out, expr, LOOSEST);
        out
    }

    // The depth of an expression is limited by the parser.
    fn write(&self, out: &mut String, expr: &Expr, around: u8) {
        if let Some(x) = expr.literal_number() {
            out.push_str(&number::coarse(x));
            return;
        }
        match &expr.kind {
            ExprKind::Num(x) => out.push_str(&number::coarse(*x)),
            ExprKind::Str(text) => {
                out.push('"');
                out.push_str(&text.replace('"', "\"\""));
                out.push('"');
            }
            ExprKind::Bool(true) => out.push_str("TRUE"),
            ExprKind::Bool(false) => out.push_str("FALSE"),
            ExprKind::Ref(name) => out.push_str(self.names.of(&name.key)),
            ExprKind::Field(base, name) => {
                self.write(out, base, TIGHTEST);
                out.push('.');
                out.push_str(&name.key);
            }
            ExprKind::Index(base, indices) => {
                self.write(out, base, TIGHTEST);
                self.list(out, "{", indices, "}");
            }
            ExprKind::Call(name, args) => {
                let key = self.names.of(&name.key);
                out.push_str(builtins::function(key).map_or(key, |function| function.name));
                out.push('(');
                self.args(out, args);
                out.push(')');
            }
            ExprKind::Aggregate(items) => self.list(out, "[", items, "]"),
            ExprKind::Unary(UnaryOp::Plus, operand) => self.write(out, operand, around),
            ExprKind::Unary(op, operand) => {
                let (sign, own, inner) =
                    if *op == UnaryOp::Not { ("NOT ", NOT, NOT) } else { ("-", SIGN, SIGN + 1) };
                bracketed(out, own < around, |out| {
                    out.push_str(sign);
                    self.write(out, operand, inner);
                });
            }
            ExprKind::Binary(op, left, right) => {
                let (sign, own) = operator(*op);
                bracketed(out, own < around, |out| {
                    self.write(out, left, own);
                    out.push_str(sign);
                    self.write(out, right, own + 1);
                });
            }
            ExprKind::AnyPosition => out.push('*'),
            ExprKind::Placeholder => out.push_str("<EXP>"),
            ExprKind::Broken => out.push_str(&self.words(expr.span)),
        }
    }

    fn list(&self, out: &mut String, open: &str, items: &[Expr], close: &str) {
        out.push_str(open);
        for (i, item) in items.iter().enumerate() {
            if i > 0 {
                out.push(',');
            }
            self.write(out, item, LOOSEST);
        }
        out.push_str(close);
    }

    fn args(&self, out: &mut String, args: &[Arg]) {
        for (i, arg) in args.iter().enumerate() {
            let option = matches!(arg.kind, ArgKind::Optional(..) | ArgKind::Conditional(..));
            if i > 0 && !option {
                out.push(',');
            }
            self.arg(out, arg);
        }
    }

    fn arg(&self, out: &mut String, arg: &Arg) {
        match &arg.kind {
            ArgKind::Positional(value) => self.write(out, value, LOOSEST),
            ArgKind::Named(name, value) => {
                let _ = write!(out, "{}:=", name.key);
                self.write(out, value, LOOSEST);
            }
            ArgKind::Optional(name, None) => {
                let _ = write!(out, "\\{}", name.key);
            }
            ArgKind::Optional(name, Some(value)) => {
                let _ = write!(out, "\\{}:=", name.key);
                self.write(out, value, LOOSEST);
            }
            ArgKind::Conditional(name, value) => {
                let _ = write!(out, "\\{}?", name.key);
                self.write(out, value, LOOSEST);
            }
        }
    }

    pub(super) fn call(&self, call: &Call) -> String {
        let mut out = match &call.callee {
            Callee::Name(name) => self.callee(name),
            Callee::Late(value) => format!("%{}%", self.expr(value)),
        };
        if !call.args.is_empty() {
            out.push(' ');
            self.args(&mut out, &call.args);
        }
        out
    }

    /// The called procedure as RAPID or its declaration writes it.
    fn callee(&self, name: &Ident) -> String {
        let key = self.names.of(&name.key);
        builtins::instruction(key).map_or(key, |instruction| instruction.name).to_owned()
    }

    /// A statement without inner statements; of a block its header.
    pub(super) fn statement(&self, stmt: &Stmt) -> String {
        match &stmt.kind {
            StmtKind::Assign { target, value } => {
                format!("{}:={}", self.expr(target), self.expr(value))
            }
            StmtKind::Call(call) => self.call(call),
            StmtKind::If { branches, .. } => match branches.first() {
                Some((condition, _)) => format!("IF {} THEN", self.header(first(stmt), condition)),
                None => "IF".to_owned(),
            },
            StmtKind::For { var, from, to, step, .. } => {
                let step = step.as_ref().map(|step| format!(" STEP {}", self.expr(step)));
                let step = step.unwrap_or_default();
                let (from, to) = (self.expr(from), self.expr(to));
                format!("FOR {} FROM {from} TO {to}{step} DO", var.key)
            }
            StmtKind::While { condition, .. } => {
                format!("WHILE {} DO", self.header(first(stmt), condition))
            }
            StmtKind::Test { value, .. } => format!("TEST {}", self.header(first(stmt), value)),
            StmtKind::Goto(label) => format!("GOTO {}", label.key),
            StmtKind::Label(label) => format!("{}:", label.key),
            StmtKind::Return(None) => "RETURN".to_owned(),
            StmtKind::Return(Some(value)) => format!("RETURN {}", self.expr(value)),
            StmtKind::Raise(None) => "RAISE".to_owned(),
            StmtKind::Raise(Some(value)) => format!("RAISE {}", self.expr(value)),
            StmtKind::Exit => "EXIT".to_owned(),
            StmtKind::Retry => "RETRY".to_owned(),
            StmtKind::TryNext => "TRYNEXT".to_owned(),
            StmtKind::Connect { interrupt, trap } => {
                format!("CONNECT {} WITH {}", self.expr(interrupt), self.names.of(&trap.key))
            }
            StmtKind::Data(data) => self.data(data),
            StmtKind::Placeholder => String::new(),
            StmtKind::Broken => self.words(stmt.span),
        }
    }

    /// The value in the header of a block whose first statement starts at `first`. With a syntax error
    /// the span of the value is the whole block.
    pub(super) fn header(&self, first: Option<u32>, value: &Expr) -> String {
        if !matches!(value.kind, ExprKind::Broken) {
            return self.expr(value);
        }
        let first = first.filter(|start| *start >= value.span.start);
        let end = first.map_or(value.span.end, |start| start.min(value.span.end));
        self.words(Span { end, ..value.span })
    }

    /// A declaration with its value.
    pub(super) fn data(&self, data: &Data) -> String {
        let value = data.init.as_ref().map(|value| format!(":={}", self.expr(value)));
        format!("{}{}", self.declaration(data), value.unwrap_or_default())
    }

    /// A declaration without its value.
    pub(super) fn declaration(&self, data: &Data) -> String {
        let mut out = String::new();
        out.push_str(scope(data.scope));
        out.push_str(match data.kind {
            DataKind::Const => "CONST ",
            DataKind::Var => "VAR ",
            DataKind::Pers => "PERS ",
        });
        let _ = write!(out, "{} {}", data.type_name.key, self.names.of(&data.name.key));
        if !data.dims.is_empty() {
            self.list(&mut out, "{", &data.dims, "}");
        }
        out
    }

    pub(super) fn words(&self, span: Span) -> String {
        self.files.get(span.file.0 as usize).map(|file| words(file, span)).unwrap_or_default()
    }
}

/// `LOCAL`, `TASK` or nothing, with a blank.
pub(super) fn scope(scope: Scope) -> &'static str {
    match scope {
        Scope::Global => "",
        Scope::Local => "LOCAL ",
        Scope::Task => "TASK ",
    }
}

/// A parameter without its name.
pub(super) fn parameter(param: &Param) -> String {
    let mode = match param.mode {
        ParamMode::In => "",
        ParamMode::Var => "VAR ",
        ParamMode::Pers => "PERS ",
        ParamMode::InOut => "INOUT ",
    };
    let option = if param.optional { "\\" } else { "" };
    format!("{option}{mode}{}", param.type_name.key)
}

/// The start of the first statement inside a block statement.
fn first(block: &Stmt) -> Option<u32> {
    block.kind.blocks().into_iter().flatten().map(|stmt| stmt.span.start).min()
}

fn bracketed(out: &mut String, needed: bool, write: impl FnOnce(&mut String)) {
    if needed {
        out.push('(');
    }
    write(out);
    if needed {
        out.push(')');
    }
}

/// The sign of an operator and how tightly it binds.
fn operator(op: BinaryOp) -> (&'static str, u8) {
    match op {
        BinaryOp::Or => (" OR ", 1),
        BinaryOp::Xor => (" XOR ", 1),
        BinaryOp::And => (" AND ", 3),
        BinaryOp::Eq => ("=", 4),
        BinaryOp::Ne => ("<>", 4),
        BinaryOp::Lt => ("<", 4),
        BinaryOp::Le => ("<=", 4),
        BinaryOp::Gt => (">", 4),
        BinaryOp::Ge => (">=", 4),
        BinaryOp::Add => ("+", 5),
        BinaryOp::Sub => ("-", 5),
        BinaryOp::Mul => ("*", 6),
        BinaryOp::Div => ("/", 6),
        BinaryOp::IntDiv => (" DIV ", 6),
        BinaryOp::Mod => (" MOD ", 6),
    }
}
