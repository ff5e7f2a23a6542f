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
use crate::rapid::syntax::{Node, NodeKind, Parse, Token, TokenKind};
use crate::rapid::text::{self, Charset, FileId, Span};

/// The modules of a file, in order. Declarations outside `MODULE` form a module without a name.
#[must_use]
pub fn lower(file: FileId, parse: &Parse, bytes: &[u8]) -> Vec<Module> {
    let charset = text::charset(bytes);
    let lowering = Lowering { file, bytes, charset, names: RefCell::default() };
    let root = parse.tree.root();
    let mut modules: Vec<Module> =
        children_of_kind(root, NodeKind::Module).map(|node| lowering.module(node)).collect();
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

    /// The name in a node, or an empty one if it is missing.
    fn name_of(&self, node: Node<'_>) -> Ident {
        self.ident_or_empty(node.child(NodeKind::Name), node)
    }

    fn type_name_of(&self, node: Node<'_>) -> Ident {
        self.ident_or_empty(node.child(NodeKind::TypeName), node)
    }

    /// The identifier, or an empty one at the start of `around`.
    fn ident_or_empty(&self, ident: Option<Node<'_>>, around: Node<'_>) -> Ident {
        ident.map_or_else(
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
            name: self.ident_or_empty(None, node),
            attributes: Vec::new(),
            types: Vec::new(),
            data: Vec::new(),
            routines: Vec::new(),
            span: self.span(node),
        }
    }

    fn module(&self, node: Node<'_>) -> Module {
        let mut lowered = self.empty_module(node);
        lowered.name = self.name_of(node);
        let attributes = node.child(NodeKind::ModuleAttributes).into_iter();
        lowered.attributes = attributes
            .flat_map(Node::own_tokens)
            .filter(|token| token.kind() == TokenKind::Identifier)
            .map(|token| String::from_utf8_lossy(token.text(self.bytes)).to_uppercase())
            .collect();
        for child in node.children() {
            self.item(child, &mut lowered);
        }
        lowered
    }

    fn item(&self, node: Node<'_>, module: &mut Module) {
        match node.kind() {
            NodeKind::DataDeclaration => module.data.push(self.data(node)),
            NodeKind::RecordDeclaration => {
                let components = children_of_kind(node, NodeKind::RecordComponent)
                    .map(|part| (self.type_name_of(part), self.name_of(part)));
                let kind = TypeDefKind::Record(components.collect());
                module.types.push(TypeDef { name: self.name_of(node), kind });
            }
            NodeKind::AliasDeclaration => {
                let kind = TypeDefKind::Alias(self.type_name_of(node));
                module.types.push(TypeDef { name: self.name_of(node), kind });
            }
            kind if kind.is_routine() => module.routines.push(self.routine(node)),
            _ => {}
        }
    }

    fn data(&self, node: Node<'_>) -> Data {
        let kind = node.own_tokens().find_map(|token| match token.kind() {
            TokenKind::Const => Some(DataKind::Const),
            TokenKind::Pers => Some(DataKind::Pers),
            TokenKind::Var => Some(DataKind::Var),
            _ => None,
        });
        let dimensions = node.child(NodeKind::Dimensions).into_iter().flat_map(Node::children);
        let init = if has_own_error(node) {
            Some(self.broken(node))
        } else {
            let value = node.children().filter(|child| child.kind().is_value()).last();
            let assigned = node.own_token(TokenKind::Assign).and(value);
            assigned.map(|value| self.expr(value))
        };
        Data {
            scope: scope(node),
            kind: kind.unwrap_or(DataKind::Var),
            type_name: self.type_name_of(node),
            name: self.name_of(node),
            dims: dimensions.map(|dimension| self.expr(dimension)).collect(),
            init,
            span: self.span(node),
        }
    }

    fn routine(&self, node: Node<'_>) -> Routine {
        let kind = match node.kind() {
            NodeKind::FuncDeclaration => RoutineKind::Func,
            NodeKind::TrapDeclaration => RoutineKind::Trap,
            _ => RoutineKind::Proc,
        };
        let handler = |kind| node.child(kind).map(|handler| self.block_in(handler));
        let errors = children_of_kind(node, NodeKind::ErrorHandler).map(|handler| {
            let numbers = handler.child(NodeKind::ErrorNumbers);
            let numbers = numbers.into_iter().flat_map(Node::children);
            (numbers.map(|number| self.expr(number)).collect(), self.block_in(handler))
        });
        Routine {
            kind,
            scope: scope(node),
            name: self.name_of(node),
            params: self.params(node),
            data: children_of_kind(node, NodeKind::DataDeclaration)
                .map(|data| self.data(data))
                .collect(),
            body: self.block_in(node),
            backward: handler(NodeKind::BackwardHandler),
            error: errors.collect(),
            undo: handler(NodeKind::UndoHandler),
            span: self.span(node),
        }
    }

    fn params(&self, routine: Node<'_>) -> Vec<Param> {
        let groups = routine.child(NodeKind::Parameters).into_iter().flat_map(Node::children);
        // Optional parameters that exclude each other form one group.
        let parameters = groups.flat_map(|group| {
            let optional = group.kind() == NodeKind::OptionalParameters;
            let parameters = group.subtree().filter(|node| node.kind() == NodeKind::Parameter);
            parameters.map(move |node| (node, optional))
        });
        parameters
            .map(|(node, optional)| Param {
                mode: match node.own_tokens().next().map(Token::kind) {
                    Some(TokenKind::Var) => ParamMode::Var,
                    Some(TokenKind::Pers) => ParamMode::Pers,
                    Some(TokenKind::InOut) => ParamMode::InOut,
                    _ => ParamMode::In,
                },
                type_name: self.type_name_of(node),
                name: self.name_of(node),
                optional,
            })
            .collect()
    }

    // --- statements ---

    /// The statements of the block in a node.
    fn block_in(&self, node: Node<'_>) -> Block {
        let statements = node.child(NodeKind::Block).into_iter().flat_map(Node::children);
        statements.map(|statement| self.stmt(statement)).collect()
    }

    /// A statement. The depth of the recursion is limited by the parser.
    fn stmt(&self, node: Node<'_>) -> Stmt {
        let kind = match node.kind() {
            NodeKind::IfStatement => Some(self.if_statement(node)),
            NodeKind::CompactIf => self.compact_if(node),
            NodeKind::ForStatement => self.for_statement(node),
            NodeKind::WhileStatement => {
                let (condition, body) = (self.header_value(node), self.block_in(node));
                Some(StmtKind::While { condition, body })
            }
            NodeKind::TestStatement => Some(self.test_statement(node)),
            NodeKind::DataDeclaration => Some(StmtKind::Data(self.data(node))),
            NodeKind::Placeholder | NodeKind::EmptyStatement => Some(StmtKind::Placeholder),
            _ if has_error(node) => None,
            _ => self.simple_statement(node),
        };
        Stmt { kind: kind.unwrap_or(StmtKind::Broken), span: self.span(node) }
    }

    /// A statement without inner statements and without syntax errors.
    fn simple_statement(&self, node: Node<'_>) -> Option<StmtKind> {
        let mut children = node.children();
        let first = children.next();
        let name = || node.child(NodeKind::Name).map(|name| self.ident(name));
        Some(match node.kind() {
            NodeKind::Assignment => {
                StmtKind::Assign { target: self.expr(first?), value: self.expr(children.next()?) }
            }
            NodeKind::CallStatement => {
                let callee = match node.child(NodeKind::LateBinding) {
                    Some(late) => Callee::Late(self.expr(late.children().next()?)),
                    None => Callee::Name(self.ident(node.callee()?)),
                };
                let is_argument =
                    |arg: &Node<'_>| arg.kind().is_value() || arg.kind().is_named_argument();
                let args = || node.children().skip(1).filter(is_argument);
                let args = exact(args(), args().count(), |arg| self.arg(arg));
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
        let branches = std::iter::once(node)
            .chain(children_of_kind(node, NodeKind::ElseIfBranch))
            .map(|branch| (self.header_value(branch), self.block_in(branch)));
        let otherwise = children_of_kind(node, NodeKind::ElseBranch).last();
        StmtKind::If {
            branches: branches.collect(),
            otherwise: otherwise.map(|branch| self.block_in(branch)),
        }
    }

    fn compact_if(&self, node: Node<'_>) -> Option<StmtKind> {
        let condition = node.children().find(|child| child.kind().is_value())?;
        let statement = node.children().nth(1)?;
        (statement.kind() != NodeKind::Error).then(|| StmtKind::If {
            branches: vec![(self.expr(condition), vec![self.stmt(statement)])],
            otherwise: None,
        })
    }

    fn for_statement(&self, node: Node<'_>) -> Option<StmtKind> {
        if has_own_error(node) {
            return None;
        }
        let mut bounds = node.children().filter(|child| child.kind().is_value());
        let step = node.child(NodeKind::ForStep).and_then(|step| step.children().next());
        Some(StmtKind::For {
            var: self.ident(node.child(NodeKind::Name)?),
            from: self.expr(bounds.next()?),
            to: self.expr(bounds.next()?),
            step: step.map(|step| self.expr(step)),
            body: self.block_in(node),
        })
    }

    fn test_statement(&self, node: Node<'_>) -> StmtKind {
        let cases = children_of_kind(node, NodeKind::CaseBranch).map(|case| {
            let values = case.children().filter(|child| child.kind().is_value());
            (values.map(|value| self.expr(value)).collect(), self.block_in(case))
        });
        let default = children_of_kind(node, NodeKind::DefaultBranch).last();
        StmtKind::Test {
            value: self.header_value(node),
            cases: cases.collect(),
            default: default.map(|branch| self.block_in(branch)),
        }
    }

    /// The value in the header of a block statement.
    fn header_value(&self, node: Node<'_>) -> Expr {
        let mut header = node.children().take_while(|child| child.kind() != NodeKind::Block);
        let value = header.next().filter(|child| child.kind().is_value());
        match value {
            Some(value) if header.all(|child| child.kind() != NodeKind::Error) => self.expr(value),
            _ => self.broken(node),
        }
    }
}

/// `LOCAL`, `TASK` or neither before a declaration.
fn scope(declaration: Node<'_>) -> Scope {
    match declaration.own_tokens().next().map(Token::kind) {
        Some(TokenKind::Local) => Scope::Local,
        Some(TokenKind::Task) => Scope::Task,
        _ => Scope::Global,
    }
}

fn children_of_kind(node: Node<'_>, kind: NodeKind) -> impl Iterator<Item = Node<'_>> {
    node.children().filter(move |child| child.kind() == kind)
}

/// Whether a part of the node itself, not of its children, is missing or wrong.
fn has_own_error(node: Node<'_>) -> bool {
    node.child(NodeKind::Error).is_some()
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
