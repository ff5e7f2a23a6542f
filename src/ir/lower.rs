//! Syntax tree → plain data.
//!
//! Lowering evaluates nothing and drops nothing that runs: what has a syntax
//! error becomes `Broken`, so that nobody takes half a statement for a whole.

use super::hir::{
    Arg, ArgKind, BinaryOp, Block, Call, Callee, Data, DataKind, Expr, ExprKind, Ident, Module,
    Param, ParamMode, Routine, RoutineKind, Scope, Stmt, StmtKind, TypeDef, TypeDefKind, UnaryOp,
};
use crate::syntax::{Node, NodeKind, Parse, Token, TokenKind, ast};
use crate::text::{self, Charset, FileId, Span};

/// The modules of a file, in order. Declarations that no `MODULE` encloses form
/// a module with an empty name.
#[must_use]
pub fn lower(file: FileId, parse: &Parse, bytes: &[u8]) -> Vec<Module> {
    let lowering = Lowering { file, bytes, charset: text::charset(bytes) };
    let root = parse.tree.root();
    let mut modules: Vec<Module> =
        root.children().filter_map(ast::Module::cast).map(|node| lowering.module(node)).collect();
    let mut bare = lowering.empty_module(root);
    for child in root.children() {
        lowering.item(child, &mut bare);
    }
    if !(bare.types.is_empty() && bare.data.is_empty() && bare.routines.is_empty()) {
        modules.push(bare);
    }
    modules
}

struct Lowering<'a> {
    file: FileId,
    bytes: &'a [u8],
    charset: Charset,
}

impl Lowering<'_> {
    fn span(&self, node: Node<'_>) -> Span {
        let range = node.range();
        Span { file: self.file, start: range.start, end: range.end }
    }

    // --- names ---

    fn ident(&self, node: Node<'_>) -> Ident {
        let text = self.charset.decode(node.text(self.bytes)).into_owned();
        Ident { key: text.to_lowercase(), text, span: self.span(node) }
    }

    /// The name, or an empty one where `around` lacks it.
    fn ident_in(&self, node: Option<Node<'_>>, around: Node<'_>) -> Ident {
        node.map_or_else(
            || {
                let start = self.span(around).start;
                let span = Span { file: self.file, start, end: start };
                Ident { text: String::new(), key: String::new(), span }
            },
            |node| self.ident(node),
        )
    }

    // --- declarations ---

    fn empty_module(&self, node: Node<'_>) -> Module {
        Module {
            name: self.ident_in(None, node),
            attributes: Vec::new(),
            types: Vec::new(),
            data: Vec::new(),
            routines: Vec::new(),
            span: self.span(node),
        }
    }

    fn module(&self, module: ast::Module<'_>) -> Module {
        let node = module.node();
        let mut lowered = self.empty_module(node);
        lowered.name = self.ident_in(module.name(), node);
        lowered.attributes = module
            .attributes()
            .map(|token| String::from_utf8_lossy(token.text(self.bytes)).to_uppercase())
            .collect();
        for child in node.children() {
            self.item(child, &mut lowered);
        }
        lowered
    }

    fn item(&self, node: Node<'_>, module: &mut Module) {
        if let Some(data) = ast::Data::cast(node) {
            module.data.push(self.data(data));
        } else if let Some(routine) = ast::Routine::cast(node) {
            module.routines.push(self.routine(routine));
        } else if matches!(node.kind(), NodeKind::RecordDeclaration | NodeKind::AliasDeclaration) {
            module.types.push(self.type_def(node));
        }
    }

    fn type_def(&self, node: Node<'_>) -> TypeDef {
        let kind = if node.kind() == NodeKind::AliasDeclaration {
            TypeDefKind::Alias(self.ident_in(node.child(NodeKind::TypeName), node))
        } else {
            let component = |child: Node<'_>| {
                (
                    self.ident_in(child.child(NodeKind::TypeName), child),
                    self.ident_in(child.child(NodeKind::Name), child),
                )
            };
            TypeDefKind::Record(
                node.children()
                    .filter(|child| child.kind() == NodeKind::RecordComponent)
                    .map(component)
                    .collect(),
            )
        };
        TypeDef {
            scope: scope(node.own_tokens().next().map(Token::kind)),
            name: self.ident_in(node.child(NodeKind::Name), node),
            kind,
            span: self.span(node),
        }
    }

    fn data(&self, data: ast::Data<'_>) -> Data {
        let node = data.node();
        let broken = node.children().any(|child| child.kind() == NodeKind::Error);
        let init = data.value().map(|value| self.expr(value));
        Data {
            scope: scope(data.scope()),
            kind: match data.keyword() {
                Some(TokenKind::Const) => DataKind::Const,
                Some(TokenKind::Pers) => DataKind::Pers,
                _ => DataKind::Var,
            },
            type_name: self.ident_in(data.type_name(), node),
            name: self.ident_in(data.name(), node),
            dims: data.dimensions().map(|dimension| self.expr(dimension)).collect(),
            init: if broken { Some(self.broken(node)) } else { init },
            span: self.span(node),
        }
    }

    fn routine(&self, routine: ast::Routine<'_>) -> Routine {
        let node = routine.node();
        let kind = match node.kind() {
            NodeKind::FuncDeclaration => {
                RoutineKind::Func(self.ident_in(routine.type_name(), node))
            }
            NodeKind::TrapDeclaration => RoutineKind::Trap,
            _ => RoutineKind::Proc,
        };
        let params = routine
            .parameter_groups()
            .enumerate()
            .flat_map(|(group, parameters)| {
                parameters.parameters().map(move |parameter| (group, parameters, parameter))
            })
            .map(|(group, parameters, parameter)| self.param(group, parameters, parameter))
            .collect();
        let handler = |kind| routine.handlers(kind).next().map(|node| self.block_in(node));
        Routine {
            kind,
            scope: scope(routine.scope()),
            name: self.ident_in(routine.name(), node),
            params,
            data: routine.data().map(|data| self.data(data)).collect(),
            body: self.block_in(node),
            backward: handler(NodeKind::BackwardHandler),
            error: routine
                .handlers(NodeKind::ErrorHandler)
                .map(|node| {
                    let numbers = node.child(NodeKind::ErrorNumbers);
                    let numbers = numbers.into_iter().flat_map(Node::children);
                    (numbers.map(|number| self.expr(number)).collect(), self.block_in(node))
                })
                .collect(),
            undo: handler(NodeKind::UndoHandler),
            span: self.span(node),
        }
    }

    fn param(
        &self,
        group: usize,
        parameters: ast::ParameterGroup<'_>,
        parameter: ast::Parameter<'_>,
    ) -> Param {
        let node = parameter.node();
        Param {
            mode: match parameter.mode() {
                Some(TokenKind::Var) => ParamMode::Var,
                Some(TokenKind::Pers) => ParamMode::Pers,
                Some(TokenKind::InOut) => ParamMode::InOut,
                _ => ParamMode::In,
            },
            type_name: self.ident_in(parameter.type_name(), node),
            name: self.ident_in(parameter.name(), node),
            dims: parameter.dimensions(),
            optional: parameters.is_optional(),
            group,
        }
    }

    // --- statements ---

    /// The statements of the block in a node.
    fn block_in(&self, node: Node<'_>) -> Block {
        node.child(NodeKind::Block)
            .into_iter()
            .flat_map(Node::children)
            .filter_map(|child| self.stmt(child))
            .collect()
    }

    /// A statement. The depth of the recursion is limited by the parser.
    fn stmt(&self, node: Node<'_>) -> Option<Stmt> {
        let kind = match node.kind() {
            NodeKind::IfStatement => self.if_statement(node),
            NodeKind::CompactIf => self.compact_if(node),
            NodeKind::ForStatement => self.for_statement(node),
            NodeKind::WhileStatement => {
                StmtKind::While { condition: self.header_value(node), body: self.block_in(node) }
            }
            NodeKind::TestStatement => self.test_statement(node),
            NodeKind::DataDeclaration => StmtKind::Data(self.data(ast::Data::cast(node)?)),
            NodeKind::Placeholder | NodeKind::EmptyStatement => StmtKind::Placeholder,
            _ if has_error(node) => StmtKind::Broken,
            _ => self.simple_statement(node).unwrap_or(StmtKind::Broken),
        };
        Some(Stmt { kind, span: self.span(node) })
    }

    /// A statement without statements in it, and without errors.
    fn simple_statement(&self, node: Node<'_>) -> Option<StmtKind> {
        let first = node.children().next();
        let name = || node.child(NodeKind::Name).map(|name| self.ident(name));
        Some(match node.kind() {
            NodeKind::Assignment => {
                let mut sides = node.children();
                StmtKind::Assign {
                    target: self.expr(sides.next()?),
                    value: self.expr(sides.next()?),
                }
            }
            NodeKind::CallStatement => {
                let call = ast::Call::cast(node)?;
                let callee = match call.late_binding() {
                    Some(late) => Callee::Late(self.expr(late.children().next()?)),
                    None => Callee::Name(self.ident(call.name()?)),
                };
                let args = call.arguments().map(|argument| self.arg(argument)).collect();
                StmtKind::Call(Call { callee, args })
            }
            NodeKind::GotoStatement => StmtKind::Goto(name()?),
            NodeKind::LabelStatement => StmtKind::Label(name()?),
            NodeKind::ReturnStatement => StmtKind::Return(first.map(|value| self.expr(value))),
            NodeKind::RaiseStatement => StmtKind::Raise(first.map(|value| self.expr(value))),
            NodeKind::ExitStatement => StmtKind::Exit,
            NodeKind::RetryStatement => StmtKind::Retry,
            NodeKind::TryNextStatement => StmtKind::TryNext,
            NodeKind::ConnectStatement => {
                StmtKind::Connect { interrupt: self.expr(first?), trap: name()? }
            }
            _ => return None,
        })
    }

    fn if_statement(&self, node: Node<'_>) -> StmtKind {
        let mut branches = vec![(self.header_value(node), self.block_in(node))];
        let mut otherwise = None;
        for child in node.children() {
            match child.kind() {
                NodeKind::ElseIfBranch => {
                    branches.push((self.header_value(child), self.block_in(child)));
                }
                NodeKind::ElseBranch => otherwise = Some(self.block_in(child)),
                _ => {}
            }
        }
        StmtKind::If { branches, otherwise }
    }

    fn compact_if(&self, node: Node<'_>) -> StmtKind {
        let parts = ast::If::cast(node).and_then(|view| view.condition().zip(view.statement()));
        match parts {
            Some((condition, statement)) if statement.kind() != NodeKind::Error => {
                let body = self.stmt(statement).into_iter().collect();
                StmtKind::If { branches: vec![(self.expr(condition), body)], otherwise: None }
            }
            _ => StmtKind::Broken,
        }
    }

    fn for_statement(&self, node: Node<'_>) -> StmtKind {
        let broken = node.children().any(|child| child.kind() == NodeKind::Error);
        let parts = ast::For::cast(node)
            .filter(|_| !broken)
            .and_then(|view| Some((view.variable()?, view.bounds()?, view.step())));
        let Some((variable, (from, to), step)) = parts else { return StmtKind::Broken };
        StmtKind::For {
            var: self.ident(variable),
            from: self.expr(from),
            to: self.expr(to),
            step: step.map(|step| self.expr(step)),
            body: self.block_in(node),
        }
    }

    fn test_statement(&self, node: Node<'_>) -> StmtKind {
        let mut cases = Vec::new();
        let mut default = None;
        for child in node.children() {
            if let Some(case) = ast::Case::cast(child) {
                let values = case.values().map(|value| self.expr(value)).collect();
                cases.push((values, self.block_in(child)));
            } else if child.kind() == NodeKind::DefaultBranch {
                default = Some(self.block_in(child));
            }
        }
        StmtKind::Test { value: self.header_value(node), cases, default }
    }

    /// The value in the header of a block statement.
    fn header_value(&self, node: Node<'_>) -> Expr {
        let mut header = node.children().take_while(|child| child.kind() != NodeKind::Block);
        let value = header.next().filter(|child| ast::is_value(*child));
        match value {
            Some(value) if header.all(|child| child.kind() != NodeKind::Error) => self.expr(value),
            _ => self.broken(node),
        }
    }

    // --- expressions ---

    fn broken(&self, node: Node<'_>) -> Expr {
        Expr { kind: ExprKind::Broken, span: self.span(node) }
    }

    /// An expression. The depth of the recursion is limited by the parser.
    fn expr(&self, node: Node<'_>) -> Expr {
        if node.children().any(|child| child.kind() == NodeKind::Error) {
            return self.broken(node);
        }
        let mut children = node.children();
        let kind = match node.kind() {
            // Parentheses only group: the span is that of the parentheses.
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
                let args = children.map(|argument| self.arg(argument)).collect();
                ExprKind::Call(self.ident(name), args)
            }),
            NodeKind::Aggregate => {
                Some(ExprKind::Aggregate(children.map(|part| self.expr(part)).collect()))
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

    fn arg(&self, node: Node<'_>) -> Arg {
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
                ArgKind::Conditional(name, self.ident_in(parameter, node))
            }
            (_, Some(value)) => ArgKind::Named(name, self.expr(value)),
            (_, None) => ArgKind::Named(name, self.broken(node)),
        };
        Arg { kind, span }
    }

    /// The text of a string, escapes resolved.
    fn string(&self, node: Node<'_>) -> String {
        let text = node.text(self.bytes);
        let inner = text.get(1..text.len().saturating_sub(1)).unwrap_or_default();
        unescape(&self.charset.decode(inner))
    }
}

fn scope(keyword: Option<TokenKind>) -> Scope {
    match keyword {
        Some(TokenKind::Local) => Scope::Local,
        Some(TokenKind::Task) => Scope::Task,
        _ => Scope::Global,
    }
}

fn has_error(node: Node<'_>) -> bool {
    node.subtree().any(|inner| inner.kind() == NodeKind::Error)
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

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a missing value fails the test")]
mod tests {
    use super::*;
    use crate::syntax;

    fn modules(bytes: &[u8]) -> Vec<Module> {
        lower(FileId(3), &syntax::parse(bytes), bytes)
    }

    fn statements(text: &str) -> Vec<Stmt> {
        let text = format!("MODULE m PROC p()\n{text}\nENDPROC ENDMODULE");
        modules(text.as_bytes()).remove(0).routines.remove(0).body
    }

    /// An expression with all its parentheses.
    fn shown(expr: &Expr) -> String {
        let list = |parts: &[Expr]| parts.iter().map(shown).collect::<Vec<_>>().join(" ");
        match &expr.kind {
            ExprKind::Num(value) => format!("{value}"),
            ExprKind::Str(text) => format!("{text:?}"),
            ExprKind::Bool(value) => format!("{value}"),
            ExprKind::Ref(name) => name.key.clone(),
            ExprKind::Field(base, name) => format!("{}.{}", shown(base), name.key),
            ExprKind::Index(base, indices) => format!("{}{{{}}}", shown(base), list(indices)),
            ExprKind::Call(name, args) => {
                let args: Vec<String> = args.iter().map(shown_arg).collect();
                format!("{}({})", name.key, args.join(" "))
            }
            ExprKind::Aggregate(parts) => format!("[{}]", list(parts)),
            ExprKind::Unary(op, operand) => format!("({op:?} {})", shown(operand)),
            ExprKind::Binary(op, left, right) => {
                format!("({} {op:?} {})", shown(left), shown(right))
            }
            ExprKind::AnyPosition => "*".to_owned(),
            ExprKind::Placeholder => "<>".to_owned(),
            ExprKind::Broken => "broken".to_owned(),
        }
    }

    fn shown_arg(arg: &Arg) -> String {
        match &arg.kind {
            ArgKind::Positional(value) => shown(value),
            ArgKind::Named(name, value) => format!("{}={}", name.key, shown(value)),
            ArgKind::Optional(name, None) => format!("\\{}", name.key),
            ArgKind::Optional(name, Some(value)) => format!("\\{}={}", name.key, shown(value)),
            ArgKind::Conditional(name, parameter) => format!("\\{}?{}", name.key, parameter.key),
        }
    }

    fn value(text: &str) -> String {
        match &statements(&format!("x := {text};"))[0].kind {
            StmtKind::Assign { value, .. } => shown(value),
            other => format!("{other:?}"),
        }
    }

    #[test]
    fn operators_bind_as_the_priority_table_says() {
        assert_eq!(value("1+2*3-4"), "((1 Add (2 Mul 3)) Sub 4)");
        assert_eq!(value("8/4/2 DIV 1"), "(((8 Div 4) Div 2) IntDiv 1)");
        assert_eq!(value("-a*b+c"), "((Minus (a Mul b)) Add c)");
        assert_eq!(value("a*-1"), "(a Mul (Minus 1))");
        assert_eq!(value("NOT a AND b"), "(Not (a And b))");
        assert_eq!(value("NOT a OR b"), "((Not a) Or b)");
        assert_eq!(value("a OR b AND c XOR d"), "((a Or (b And c)) Xor d)");
        assert_eq!(value("a AND NOT b AND c"), "((a And (Not b)) And c)");
        assert_eq!(value("a=b AND c<>d"), "((a Eq b) And (c Ne d))");
        assert_eq!(value("(a+b)*c"), "((a Add b) Mul c)");
    }

    #[test]
    fn literals_have_their_values() {
        assert_eq!(value("[1., .5, 1E3, 2.5e-1, 9E+09]"), "[1 0.5 1000 0.25 9000000000]");
        assert_eq!(value("[0x1F, 0B101, 0o17]"), "[31 5 15]");
        assert_eq!(value("True"), "true");
        assert_eq!(value(r#""a""b\\c\41\0Ad\zz""#), "\"a\\\"b\\\\cA\\nd\\\\zz\"");
        assert_eq!(value("A.b{1, i}.C"), "a.b{1 i}.c");
        assert_eq!(value("f(1, \\On, \\v:=2, x:=3, *)"), "f(1 \\on \\v=2 x=3 *)");
    }

    #[test]
    fn calls_keep_all_forms_of_arguments() {
        let body =
            statements("MoveJ \\Conc, *, v100 \\T:=2, Tool:=t \\WObj?w;\n%\"a\"% 1;\nHome(2);");
        let calls: Vec<(String, Vec<String>)> = body
            .iter()
            .map(|stmt| match &stmt.kind {
                StmtKind::Call(Call { callee, args }) => (
                    match callee {
                        Callee::Name(name) => name.text.clone(),
                        Callee::Late(expr) => shown(expr),
                    },
                    args.iter().map(shown_arg).collect(),
                ),
                other => panic!("{other:?}"),
            })
            .collect();
        let call = |name: &str, args: &[&str]| {
            (name.to_owned(), args.iter().map(|&arg| arg.to_owned()).collect::<Vec<_>>())
        };
        assert_eq!(
            calls,
            [
                call("MoveJ", &["\\conc", "*", "v100", "\\t=2", "tool=t", "\\wobj?w"]),
                call("\"a\"", &["1"]),
                call("Home", &["2"]),
            ]
        );
    }

    #[test]
    fn spans_are_those_of_the_original_bytes() {
        let bytes = b"\xEF\xBB\xBFMODULE m\r\n PROC p()\r\n  ! c\r\n  MoveJ a,\r\n   b; ! d\r\n ENDPROC\r\nENDMODULE";
        let module = modules(bytes).remove(0);
        let stmt = &module.routines[0].body[0];
        assert_eq!(stmt.span.file, FileId(3));
        assert_eq!(&bytes[stmt.span.start as usize..stmt.span.end as usize], b"MoveJ a,\r\n   b;");
        assert_eq!(module.span.start, 3);
    }

    #[test]
    fn names_are_decoded_and_compared_without_case() {
        let module =
            modules(b"MODULE m\nCONST num A\xD1O := 1;\n! f\xFCr die Gr\xF6\xDFe\nENDMODULE")
                .remove(0);
        assert_eq!(module.data[0].name.text, "AÑO");
        assert_eq!(module.data[0].name.key, "año");
    }

    #[test]
    fn declarations_keep_everything() {
        let module = modules(
            b"MODULE m(sysmodule, NOSTEPIN)
            LOCAL RECORD r num a; string b; ENDRECORD
            ALIAS num level;
            TASK PERS num a{2, n};
            PROC p(VAR num a{*, *}, \\switch b | num c, PERS bool d)
              VAR num x := 1;
              VAR bool y;
              x := 2;
              VAR num z;
            BACKWARD p;
            ERROR (ERR_A, ERR_B) RETRY;
            ERROR TRYNEXT;
            UNDO RAISE 5;
            ENDPROC
            LOCAL FUNC num f() RETURN 1; ENDFUNC
            TRAP t ENDTRAP
            ENDMODULE",
        )
        .remove(0);
        assert_eq!(module.attributes, ["SYSMODULE", "NOSTEPIN"]);
        assert!(matches!(&module.types[0].kind, TypeDefKind::Record(parts) if parts.len() == 2));
        assert_eq!(module.types[0].scope, Scope::Local);
        assert!(matches!(&module.types[1].kind, TypeDefKind::Alias(name) if name.key == "num"));
        let data = &module.data[0];
        assert_eq!((data.scope, data.kind, data.dims.len()), (Scope::Task, DataKind::Pers, 2));
        let [p, f, t] = &module.routines[..] else { panic!("three routines") };
        let params: Vec<_> = p
            .params
            .iter()
            .map(|param| {
                (param.name.key.as_str(), param.mode, param.dims, param.optional, param.group)
            })
            .collect();
        assert_eq!(
            params,
            [
                ("a", ParamMode::Var, 2, false, 0),
                ("b", ParamMode::In, 0, true, 1),
                ("c", ParamMode::In, 0, true, 1),
                ("d", ParamMode::Pers, 0, false, 2),
            ]
        );
        assert_eq!(p.data.len(), 2);
        assert!(matches!(p.body[1].kind, StmtKind::Data(_)));
        assert_eq!(p.backward.as_ref().unwrap().len(), 1);
        assert_eq!(p.error.iter().map(|(numbers, _)| numbers.len()).collect::<Vec<_>>(), [2, 0]);
        assert!(matches!(p.undo.as_ref().unwrap()[0].kind, StmtKind::Raise(Some(_))));
        assert!(matches!(&f.kind, RoutineKind::Func(name) if name.key == "num"));
        assert_eq!((f.scope, t.scope), (Scope::Local, Scope::Global));
        assert!(matches!(t.kind, RoutineKind::Trap));
    }

    #[test]
    fn statements_with_errors_are_broken_and_their_neighbours_are_not() {
        let body = statements(
            "a;
            MoveJ p1 v100, z10, t;
            x = 1;
            y := [1, 2;
            IF a := 1 THEN b; ENDIF
            IF a = 1 c d e;
            FOR i := 1 TO 2 DO f; ENDFOR
            WHILE (a DO g; ENDWHILE
            z;",
        );
        let kinds: Vec<bool> =
            body.iter().map(|stmt| matches!(stmt.kind, StmtKind::Broken)).collect();
        let StmtKind::If { branches, .. } = &body[4].kind else { panic!("{:?}", body[4]) };
        assert!(matches!(branches[0].0.kind, ExprKind::Broken));
        assert_eq!(branches[0].1.len(), 1);
        let StmtKind::If { branches, .. } = &body[5].kind else { panic!("{:?}", body[5]) };
        assert!(matches!(branches[0].1[0].kind, StmtKind::Broken));
        let StmtKind::While { condition, .. } = &body[7].kind else { panic!("{:?}", body[7]) };
        assert!(matches!(condition.kind, ExprKind::Broken));
        assert_eq!(kinds, [false, true, true, true, false, false, true, false, false]);
    }

    #[test]
    fn control_flow_keeps_its_branches() {
        let body = statements(
            "IF a THEN b; ELSEIF c THEN d; e; ELSE f; ENDIF
            FOR i FROM 1 TO 9 STEP 2 DO g; ENDFOR
            TEST x CASE 1, 2: h; CASE 3: DEFAULT: k; l; ENDTEST
            lab: GOTO lab;
            CONNECT n WITH t;
            <SMT>",
        );
        let StmtKind::If { branches, otherwise } = &body[0].kind else { panic!() };
        assert_eq!(branches.iter().map(|(_, block)| block.len()).collect::<Vec<_>>(), [1, 2]);
        assert_eq!(otherwise.as_ref().unwrap().len(), 1);
        let StmtKind::For { var, from, to, step, body: inner } = &body[1].kind else { panic!() };
        assert_eq!((var.key.as_str(), shown(from), shown(to)), ("i", "1".into(), "9".into()));
        assert_eq!((shown(step.as_ref().unwrap()), inner.len()), ("2".into(), 1));
        let StmtKind::Test { cases, default, .. } = &body[2].kind else { panic!() };
        let sizes: Vec<_> =
            cases.iter().map(|(values, block)| (values.len(), block.len())).collect();
        assert_eq!((sizes, default.as_ref().unwrap().len()), (vec![(2, 1), (1, 0)], 2));
        assert!(matches!(&body[3].kind, StmtKind::Label(name) if name.key == "lab"));
        assert!(matches!(&body[4].kind, StmtKind::Goto(name) if name.key == "lab"));
        assert!(matches!(&body[5].kind, StmtKind::Connect { trap, .. } if trap.key == "t"));
        assert!(matches!(body[6].kind, StmtKind::Placeholder));
    }

    #[test]
    fn declarations_without_a_module_form_one() {
        let modules = modules(b"CONST num a := 1;\nPROC main()\nENDPROC\n");
        assert_eq!(modules.len(), 1);
        assert_eq!(modules[0].name.text, "");
        assert_eq!((modules[0].data.len(), modules[0].routines.len()), (1, 1));
        assert!(super::lower(FileId(0), &syntax::parse(b"! nothing"), b"! nothing").is_empty());
    }
}
