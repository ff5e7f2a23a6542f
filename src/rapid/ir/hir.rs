//! The program as a tree of plain data, lowered from the syntax tree.
//!
//! Every node has the span of its source; nothing is evaluated. A part with a syntax error
//! becomes `Broken`, a placeholder such as `<SMT>` becomes `Placeholder`.

use std::ops::Deref;
use std::sync::Arc;

use crate::rapid::text::Span;

/// An identifier and its place; all uses of a name in a file share its text.
#[derive(Clone, Debug)]
pub struct Ident {
    name: Arc<Name>,
    /// Its place.
    pub span: Span,
}

/// The text of an identifier, which RAPID compares without regard to case.
#[derive(Debug, PartialEq, Eq)]
pub struct Name {
    /// As written.
    pub text: String,
    /// Lower case, for comparison.
    pub key: String,
}

impl Ident {
    /// A use of a name.
    pub fn new(name: Arc<Name>, span: Span) -> Ident {
        Ident { name, span }
    }
}

impl Deref for Ident {
    type Target = Name;

    fn deref(&self) -> &Name {
        &self.name
    }
}

/// One `MODULE … ENDMODULE`.
#[derive(Clone, Debug)]
pub struct Module {
    /// Its name.
    pub name: Ident,
    /// `SYSMODULE`, `NOVIEW`, … in upper case.
    pub attributes: Vec<String>,
    /// `RECORD` and `ALIAS` declarations.
    pub types: Vec<TypeDef>,
    /// Data at module level.
    pub data: Vec<Data>,
    /// Routines.
    pub routines: Vec<Routine>,
    /// The whole module.
    pub span: Span,
}

/// A user type.
#[derive(Clone, Debug)]
pub struct TypeDef {
    /// Its name.
    pub name: Ident,
    /// What it is.
    pub kind: TypeDefKind,
}

/// Record or alias.
#[derive(Clone, Debug)]
pub enum TypeDefKind {
    /// `RECORD`: (type, component) in order.
    Record(Vec<(Ident, Ident)>),
    /// `ALIAS` of this type.
    Alias(Ident),
}

/// Visibility of a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// The whole task (routine data: the routine).
    Global,
    /// `LOCAL`: the module.
    Local,
    /// `TASK`: global in the task, not shared between tasks.
    Task,
}

/// Kind of a data object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DataKind {
    /// `CONST`.
    Const,
    /// `VAR`.
    Var,
    /// `PERS`.
    Pers,
}

/// A data declaration.
#[derive(Clone, Debug)]
pub struct Data {
    /// `LOCAL`, `TASK` or neither.
    pub scope: Scope,
    /// `CONST`, `VAR`, `PERS`.
    pub kind: DataKind,
    /// Name of the type.
    pub type_name: Ident,
    /// Its name.
    pub name: Ident,
    /// Array dimensions, none for a scalar.
    pub dims: Vec<Expr>,
    /// `:=` value.
    pub init: Option<Expr>,
    /// The whole declaration.
    pub span: Span,
}

/// `PROC`, `FUNC` or `TRAP`.
#[derive(Clone, Debug)]
pub struct Routine {
    /// Which.
    pub kind: RoutineKind,
    /// `LOCAL` or global.
    pub scope: Scope,
    /// Its name.
    pub name: Ident,
    /// Its parameters.
    pub params: Vec<Param>,
    /// Its own data.
    pub data: Vec<Data>,
    /// Its statements.
    pub body: Block,
    /// `BACKWARD` handler.
    pub backward: Option<Block>,
    /// `ERROR` handlers: (error list, statements).
    pub error: Vec<(Vec<Expr>, Block)>,
    /// `UNDO` handler.
    pub undo: Option<Block>,
    /// The whole routine.
    pub span: Span,
}

/// Kind of a routine.
#[derive(Clone, Debug)]
pub enum RoutineKind {
    /// Procedure.
    Proc,
    /// Function.
    Func,
    /// Interrupt routine.
    Trap,
}

/// How an argument is passed to the routine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParamMode {
    /// By value.
    In,
    /// `VAR`.
    Var,
    /// `PERS`.
    Pers,
    /// `INOUT`.
    InOut,
}

/// A formal parameter.
#[derive(Clone, Debug)]
pub struct Param {
    /// How it is passed.
    pub mode: ParamMode,
    /// Name of the type; `switch` for switches.
    pub type_name: Ident,
    /// Its name.
    pub name: Ident,
    /// `\name`.
    pub optional: bool,
}

/// A statement list.
pub type Block = Vec<Stmt>;

/// A statement.
#[derive(Clone, Debug)]
pub struct Stmt {
    /// What it does.
    pub kind: StmtKind,
    /// From its first token to its last (`;`, `ENDIF` …), without surrounding blanks and comments.
    pub span: Span,
}

/// What a statement does.
#[derive(Clone, Debug)]
pub enum StmtKind {
    /// `target := value;`
    Assign {
        /// Left side.
        target: Expr,
        /// Right side.
        value: Expr,
    },
    /// Procedure call or instruction.
    Call(Call),
    /// `IF`, with and without `ELSE`, compact form too.
    If {
        /// Condition and statements of `IF` and each `ELSEIF`.
        branches: Vec<(Expr, Block)>,
        /// `ELSE`.
        otherwise: Option<Block>,
    },
    /// `FOR`.
    For {
        /// Loop variable (implicit num, read only).
        var: Ident,
        /// First value.
        from: Expr,
        /// Last value.
        to: Expr,
        /// `STEP`.
        step: Option<Expr>,
        /// Statements.
        body: Block,
    },
    /// `WHILE`.
    While {
        /// Condition.
        condition: Expr,
        /// Statements.
        body: Block,
    },
    /// `TEST`.
    Test {
        /// Test value.
        value: Expr,
        /// Values and statements of each `CASE`.
        cases: Vec<(Vec<Expr>, Block)>,
        /// `DEFAULT`.
        default: Option<Block>,
    },
    /// `GOTO label;`
    Goto(Ident),
    /// `label:`
    Label(Ident),
    /// `RETURN`.
    Return(Option<Expr>),
    /// `RAISE`.
    Raise(Option<Expr>),
    /// `EXIT`.
    Exit,
    /// `RETRY`.
    Retry,
    /// `TRYNEXT`.
    TryNext,
    /// `CONNECT var WITH trap;`
    Connect {
        /// Interrupt variable.
        interrupt: Expr,
        /// Trap routine.
        trap: Ident,
    },
    /// A data declaration between statements (real files have them).
    Data(Data),
    /// A placeholder such as `<SMT>`, or a lone `;`.
    Placeholder,
    /// A statement with a syntax error.
    Broken,
}

/// A procedure call or instruction.
#[derive(Clone, Debug)]
pub struct Call {
    /// The called procedure.
    pub callee: Callee,
    /// The arguments.
    pub args: Vec<Arg>,
}

/// The called procedure.
#[derive(Clone, Debug)]
pub enum Callee {
    /// By name; `module:name` keeps the name after the colon.
    Name(Ident),
    /// Late binding `%expr%`.
    Late(Expr),
}

/// An actual argument.
#[derive(Clone, Debug)]
pub struct Arg {
    /// Which form.
    pub kind: ArgKind,
    /// From its first token to its last.
    pub span: Span,
}

/// The forms of an argument.
#[derive(Clone, Debug)]
pub enum ArgKind {
    /// `expr`
    Positional(Expr),
    /// `name := expr`
    Named(Ident, Expr),
    /// `\name := expr`, or `\name` for a switch.
    Optional(Ident, Option<Expr>),
    /// `\name ? parameter`: stated only if the call of the routine states the parameter.
    Conditional(Ident, Expr),
}

/// An expression.
#[derive(Clone, Debug)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// From its first token to its last.
    pub span: Span,
}

/// What an expression is.
#[derive(Clone, Debug)]
pub enum ExprKind {
    /// Number (`num` or `dnum`), read as a double.
    Num(f64),
    /// String, escapes resolved.
    Str(String),
    /// `TRUE`, `FALSE`.
    Bool(bool),
    /// A name.
    Ref(Ident),
    /// `base.component`
    Field(Box<Expr>, Ident),
    /// `base{i, j}`
    Index(Box<Expr>, Vec<Expr>),
    /// `f(args)`
    Call(Ident, Vec<Arg>),
    /// `[a, b, …]`
    Aggregate(Vec<Expr>),
    /// Unary operator.
    Unary(UnaryOp, Box<Expr>),
    /// Binary operator.
    Binary(BinaryOp, Box<Expr>, Box<Expr>),
    /// `*` in place of a position.
    AnyPosition,
    /// A placeholder such as `<EXP>`, or an omitted value.
    Placeholder,
    /// A syntax error.
    Broken,
}

/// Unary operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnaryOp {
    /// `+`
    Plus,
    /// `-`
    Minus,
    /// `NOT`
    Not,
}

/// Binary operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BinaryOp {
    /// `+`
    Add,
    /// `-`
    Sub,
    /// `*`
    Mul,
    /// `/`
    Div,
    /// `DIV`
    IntDiv,
    /// `MOD`
    Mod,
    /// `=`
    Eq,
    /// `<>`
    Ne,
    /// `<`
    Lt,
    /// `<=`
    Le,
    /// `>`
    Gt,
    /// `>=`
    Ge,
    /// `AND`
    And,
    /// `OR`
    Or,
    /// `XOR`
    Xor,
}
