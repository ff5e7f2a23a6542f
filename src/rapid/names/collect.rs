//! The declarations of a file.

use super::declaration::{
    Access, Declaration, DeclarationId, Kind, Mode, Reach, RoutineKind, Storage, ValueType,
};
use super::keys::{Key, Keys, Spellings};
use crate::rapid::syntax::{Node, NodeKind, Parse, TokenKind};
use crate::rapid::text::{Charset, FileId, Span};

/// The declarations found so far.
#[derive(Clone, Default)]
pub(super) struct Collected {
    pub(super) keys: Keys,
    /// In the order of the text; a declaration stands before those inside it.
    pub(super) declarations: Vec<Declaration>,
    /// Declarations and the names of their types.
    pub(super) stated: Vec<(DeclarationId, Key)>,
}

/// The bytes of a file.
#[derive(Clone, Copy)]
pub(super) struct Bytes<'a> {
    pub(super) file: FileId,
    pub(super) content: &'a [u8],
    pub(super) charset: Charset,
}

impl Bytes<'_> {
    pub(super) fn span(self, node: Node<'_>) -> Span {
        let range = node.range();
        Span { file: self.file, start: range.start, end: range.end }
    }
}

impl Collected {
    /// Adds the declarations of a file.
    pub(super) fn add(&mut self, source: Bytes<'_>, parse: &Parse) {
        let spellings = Spellings::new(source.charset);
        let mut collector = Collector { all: self, source, spellings, parent: None };
        let root = parse.tree.root();
        let mut bare = None;
        for child in root.children() {
            if child.kind() == NodeKind::Module {
                collector.inside(child, Kind::Module, Reach::Global, |collector| {
                    child.children().for_each(|item| collector.item(item));
                });
            } else if declares(child) {
                bare.get_or_insert_with(Vec::new).push(child);
            }
        }
        if let Some(items) = bare {
            collector.inside(root, Kind::Module, Reach::Global, |collector| {
                for item in items {
                    collector.item(item);
                }
            });
        }
    }
}

fn declares(node: Node<'_>) -> bool {
    node.kind().is_routine()
        || matches!(
            node.kind(),
            NodeKind::DataDeclaration | NodeKind::RecordDeclaration | NodeKind::AliasDeclaration
        )
}

struct Collector<'c, 'a> {
    all: &'c mut Collected,
    source: Bytes<'a>,
    spellings: Spellings<'a>,
    parent: Option<DeclarationId>,
}

impl Collector<'_, '_> {
    /// Adds a declaration; the name of its type, if it states one, is resolved later.
    fn declare(&mut self, node: Node<'_>, kind: Kind, reach: Reach) -> DeclarationId {
        let name = node.child(NodeKind::Name);
        let span = match name {
            Some(name) => self.source.span(name),
            None => Span { end: node.range().start, ..self.source.span(node) },
        };
        let text = name.map_or(&[][..], |name| name.text(self.source.content));
        let key = self.spellings.key(&mut self.all.keys, text);
        let id = DeclarationId(self.all.declarations.len() as u32);
        if let Some(type_name) = node.child(NodeKind::TypeName) {
            let text = type_name.text(self.source.content);
            let type_key = self.spellings.key(&mut self.all.keys, text);
            self.all.stated.push((id, type_key));
        }
        self.all.declarations.push(Declaration {
            kind,
            name: span,
            whole: self.source.span(node),
            parent: self.parent,
            reach,
            value: ValueType { dimensions: dimensions(node), ..ValueType::UNKNOWN },
            key,
            end: id.0 + 1,
        });
        id
    }

    /// Adds a declaration that contains others.
    fn inside(&mut self, node: Node<'_>, kind: Kind, reach: Reach, rest: impl FnOnce(&mut Self)) {
        let id = self.declare(node, kind, reach);
        let outer = self.parent.replace(id);
        rest(self);
        self.parent = outer;
        self.all.declarations[id.0 as usize].end = self.all.declarations.len() as u32;
    }

    fn item(&mut self, node: Node<'_>) {
        let reach = if node.own_token(TokenKind::Local).is_some() {
            Reach::Local
        } else if node.own_token(TokenKind::Task).is_some() {
            Reach::Task
        } else {
            Reach::Global
        };
        match node.kind() {
            NodeKind::DataDeclaration => {
                self.declare(node, Kind::Data(storage(node)), reach);
            }
            NodeKind::AliasDeclaration => {
                self.declare(node, Kind::Alias, reach);
            }
            NodeKind::RecordDeclaration => self.inside(node, Kind::Record, reach, |collector| {
                for part in node.children().filter(|c| c.kind() == NodeKind::RecordComponent) {
                    collector.declare(part, Kind::Component, Reach::Local);
                }
            }),
            NodeKind::ProcDeclaration => self.routine(node, RoutineKind::Proc, reach),
            NodeKind::FuncDeclaration => self.routine(node, RoutineKind::Func, reach),
            NodeKind::TrapDeclaration => self.routine(node, RoutineKind::Trap, reach),
            _ => {}
        }
    }

    fn routine(&mut self, node: Node<'_>, kind: RoutineKind, reach: Reach) {
        self.inside(node, Kind::Routine(kind), reach, |collector| {
            let mut group = 0;
            for parameter in node.child(NodeKind::Parameters).into_iter().flat_map(Node::children) {
                if parameter.kind() == NodeKind::OptionalParameters {
                    let parts = parameter.children().filter(|c| c.kind() == NodeKind::Parameter);
                    parts.for_each(|part| collector.parameter(part, Some(group)));
                    group += 1;
                } else if parameter.kind() == NodeKind::Parameter {
                    collector.parameter(parameter, None);
                }
            }
            for inner in node.subtree().skip(1) {
                match inner.kind() {
                    NodeKind::DataDeclaration => {
                        collector.declare(inner, Kind::Data(storage(inner)), Reach::Local);
                    }
                    NodeKind::ForStatement => {
                        collector.declare(inner, Kind::Counter, Reach::Local);
                    }
                    NodeKind::LabelStatement => {
                        collector.declare(inner, Kind::Label, Reach::Local);
                    }
                    _ => {}
                }
            }
        });
    }

    fn parameter(&mut self, node: Node<'_>, group: Option<u16>) {
        let mode = node.own_tokens().find_map(|token| match token.kind() {
            TokenKind::Var => Some(Access::Var),
            TokenKind::Pers => Some(Access::Pers),
            TokenKind::InOut => Some(Access::InOut),
            _ => None,
        });
        let access = mode.unwrap_or(Access::In);
        self.declare(node, Kind::Parameter(Mode { access, group }), Reach::Local);
    }
}

fn storage(node: Node<'_>) -> Storage {
    let keyword = node.own_tokens().find_map(|token| match token.kind() {
        TokenKind::Const => Some(Storage::Const),
        TokenKind::Pers => Some(Storage::Pers),
        _ => None,
    });
    keyword.unwrap_or(Storage::Var)
}

/// The number of dimensions of an array, 0 without any.
fn dimensions(node: Node<'_>) -> u8 {
    let stated = node
        .children()
        .find(|child| matches!(child.kind(), NodeKind::Dimensions | NodeKind::OpenDimensions));
    let commas =
        |list: Node<'_>| list.own_tokens().filter(|token| token.kind() == TokenKind::Comma).count();
    stated.map_or(0, |list| u8::try_from(commas(list) + 1).unwrap_or(u8::MAX))
}
