//! Lowering of the syntax tree to plain data.
//!
//! Lowering evaluates nothing and omits no statement: one with a syntax error becomes `Broken`,
//! so that no later stage uses only a part of it.

mod expressions;

use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::Arc;

use super::hir::{
    Block, Call, Callee, Data, DataKind, Expr, Ident, Module, Name, Param, ParamMode, Routine,
    RoutineKind, Scope, Stmt, StmtKind, TypeDef, TypeDefKind,
};
use crate::rapid::syntax::{Node, NodeKind, Parse, TokenKind, ast};
use crate::rapid::text::{self, Charset, FileId, Span};

/// The modules of a file, in order. Declarations outside `MODULE` form a module without a name.
#[must_use]
pub fn lower(file: FileId, parse: &Parse, bytes: &[u8]) -> Vec<Module> {
    let charset = text::charset(bytes);
    let lowering = Lowering { file, bytes, charset, names: RefCell::default() };
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
    /// The names found so far, by their bytes.
    names: RefCell<HashMap<&'a [u8], Arc<Name>>>,
}

impl<'a> Lowering<'a> {
    fn span(&self, node: Node<'_>) -> Span {
        let range = node.range();
        Span { file: self.file, start: range.start, end: range.end }
    }

    // --- names ---

    fn name(&self, bytes: &'a [u8]) -> Arc<Name> {
        let new = || {
            let text = self.charset.decode(bytes).into_owned();
            Arc::new(Name { key: text.to_lowercase(), text })
        };
        self.names.borrow_mut().entry(bytes).or_insert_with(new).clone()
    }

    fn ident(&self, node: Node<'_>) -> Ident {
        Ident::new(self.name(node.text(self.bytes)), self.span(node))
    }

    /// The identifier, or an empty one if `around` does not contain it.
    fn ident_in(&self, node: Option<Node<'_>>, around: Node<'_>) -> Ident {
        node.map_or_else(
            || {
                let start = self.span(around).start;
                Ident::new(self.name(&[]), Span { file: self.file, start, end: start })
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
        let node = module.0;
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
        TypeDef { name: self.ident_in(node.child(NodeKind::Name), node), kind }
    }

    fn data(&self, data: ast::Data<'_>) -> Data {
        let node = data.0;
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
        let node = routine.0;
        let kind = match node.kind() {
            NodeKind::FuncDeclaration => RoutineKind::Func,
            NodeKind::TrapDeclaration => RoutineKind::Trap,
            _ => RoutineKind::Proc,
        };
        let params = routine
            .parameter_groups()
            .flat_map(|group| group.parameters().map(move |parameter| (group, parameter)))
            .map(|(group, parameter)| self.param(group, parameter))
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

    fn param(&self, group: ast::ParameterGroup<'_>, parameter: ast::Parameter<'_>) -> Param {
        let node = parameter.0;
        Param {
            mode: match parameter.mode() {
                Some(TokenKind::Var) => ParamMode::Var,
                Some(TokenKind::Pers) => ParamMode::Pers,
                Some(TokenKind::InOut) => ParamMode::InOut,
                _ => ParamMode::In,
            },
            type_name: self.ident_in(parameter.type_name(), node),
            name: self.ident_in(parameter.name(), node),
            optional: group.is_optional(),
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

    /// A statement without inner statements and without syntax errors.
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
                let args = exact(call.arguments(), call.arguments().count(), |arg| self.arg(arg));
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
}

fn scope(keyword: Option<TokenKind>) -> Scope {
    match keyword {
        Some(TokenKind::Local) => Scope::Local,
        Some(TokenKind::Task) => Scope::Task,
        _ => Scope::Global,
    }
}

/// Lowers a list of known length. A growing vector needs up to twice the memory, which dominates
/// the time for a large file.
fn exact<'t, T>(
    nodes: impl Iterator<Item = Node<'t>>,
    count: usize,
    lower: impl FnMut(Node<'t>) -> T,
) -> Vec<T> {
    let mut list = Vec::with_capacity(count);
    list.extend(nodes.map(lower));
    list
}

fn has_error(node: Node<'_>) -> bool {
    node.subtree().any(|inner| inner.kind() == NodeKind::Error)
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a missing value fails the test")]
mod tests;
