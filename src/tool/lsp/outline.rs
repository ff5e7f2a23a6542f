//! The declarations of a file as a tree, from its text alone.

use gen_lsp_types::SymbolKind;

use super::module::Module;
use crate::rapid::syntax::{Node, NodeKind, TokenKind};
use crate::rapid::text::Span;

/// A declaration.
pub(super) struct Symbol {
    pub(super) name: String,
    /// Its type, or what it is.
    pub(super) detail: String,
    pub(super) kind: SymbolKind,
    /// All of it.
    pub(super) whole: Span,
    /// Its name.
    pub(super) place: Span,
    pub(super) children: Vec<Symbol>,
}

/// The declarations of a file.
pub(super) fn outline(module: &Module) -> Vec<Symbol> {
    symbols(module, module.parse().tree.root())
}

fn symbols(module: &Module, node: Node<'_>) -> Vec<Symbol> {
    node.children().flat_map(|child| symbol(module, child)).collect()
}

/// The declaration that a node is, or those inside it.
fn symbol(module: &Module, node: Node<'_>) -> Vec<Symbol> {
    let constant = || node.own_token(TokenKind::Const).is_some();
    let kind = match node.kind() {
        NodeKind::Module => SymbolKind::Module,
        NodeKind::RecordDeclaration | NodeKind::AliasDeclaration => SymbolKind::Struct,
        NodeKind::RecordComponent => SymbolKind::Field,
        NodeKind::ProcDeclaration | NodeKind::FuncDeclaration => SymbolKind::Function,
        NodeKind::TrapDeclaration => SymbolKind::Event,
        NodeKind::DataDeclaration if constant() => SymbolKind::Constant,
        NodeKind::DataDeclaration => SymbolKind::Variable,
        NodeKind::Parameters => return Vec::new(),
        kind if kind.is_value() => return Vec::new(),
        _ => return symbols(module, node),
    };
    let children = symbols(module, node);
    let Some(name) = node.child(NodeKind::Name) else { return children };
    let span = |node: Node<'_>| {
        let range = node.range();
        Span { file: module.file.id, start: range.start, end: range.end }
    };
    let place = span(name);
    let named = module.file.text(place).into_owned();
    vec![Symbol {
        name: named,
        detail: detail(module, node),
        kind,
        whole: span(node),
        place,
        children,
    }]
}

/// The words before the name: `LOCAL PERS tooldata`.
fn detail(module: &Module, node: Node<'_>) -> String {
    let mut words = Vec::new();
    for token in node.all_tokens() {
        let range = token.range();
        if node.child(NodeKind::Name).is_none_or(|name| name.range().start <= range.start) {
            break;
        }
        if !token.kind().is_trivia() {
            let span = Span { file: module.file.id, start: range.start, end: range.end };
            words.push(module.file.text(span).into_owned());
        }
    }
    words.join(" ")
}
