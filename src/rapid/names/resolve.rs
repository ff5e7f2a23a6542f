//! The meaning of each identifier of a file.

use std::collections::HashMap;
use std::ops::Range;

use super::collect::Bytes;
use super::declaration::{Basic, DeclarationId, Kind, ValueType};
use super::index::Names;
use super::keys::{Key, KeyMap, Spellings};
use super::predefined::PREDEFINED;
use super::uses::{Meaning, Role, Use};
use crate::rapid::builtins;
use crate::rapid::syntax::{Node, NodeKind, Parse};

/// The identifiers of a file, in the order of the text; `own` are the numbers of its declarations.
pub(super) fn uses(
    names: &mut Names,
    source: Bytes<'_>,
    parse: &Parse,
    own: Range<usize>,
) -> Vec<Use> {
    let ids = own.clone().map(|index| DeclarationId(index as u32));
    let bare = ids.clone().find(|id| {
        let declaration = names.declaration(*id);
        declaration.kind == Kind::Module && declaration.name.start == declaration.name.end
    });
    let declared = ids.map(|id| (names.declaration(id).name.start, id)).collect();
    let mut resolver = Resolver {
        spellings: Spellings::new(source.charset),
        names,
        source,
        declared,
        module: None,
        bare,
        local: KeyMap::new(),
        routine: KeyMap::new(),
        labels: KeyMap::new(),
        counters: Vec::new(),
        outside: KeyMap::new(),
        uses: Vec::new(),
    };
    resolver.enter(bare);
    resolver.node(parse.tree.root());
    // Recovery from syntax errors may put a node before its place.
    if !resolver.uses.is_sorted_by_key(|one| one.start) {
        resolver.uses.sort_by_key(|one| one.start);
    }
    resolver.uses
}

struct Resolver<'n, 'a> {
    names: &'n mut Names,
    source: Bytes<'a>,
    spellings: Spellings<'a>,
    /// The declarations of the file by the first byte of their names.
    declared: HashMap<u32, DeclarationId>,
    module: Option<DeclarationId>,
    /// The module of declarations outside modules.
    bare: Option<DeclarationId>,
    /// The names of the module.
    local: KeyMap<DeclarationId>,
    /// The parameters and data of the routine.
    routine: KeyMap<DeclarationId>,
    labels: KeyMap<DeclarationId>,
    counters: Vec<(Key, DeclarationId)>,
    /// The meaning of names that no file declares.
    outside: KeyMap<Meaning>,
    uses: Vec<Use>,
}

impl Resolver<'_, '_> {
    fn key(&mut self, node: Node<'_>) -> Key {
        self.spellings.key(&mut self.names.keys, node.text(self.source.content))
    }

    fn add(&mut self, node: Node<'_>, role: Role, meaning: Meaning) {
        let range = node.range();
        if range.start < range.end {
            self.uses.push(Use { start: range.start, end: range.end, role, meaning });
        }
    }

    /// The declaration whose name is a child of this node.
    fn declared_by(&self, node: Node<'_>) -> Option<DeclarationId> {
        let name = node.child(NodeKind::Name)?;
        self.declared.get(&name.range().start).copied()
    }

    /// Statements, declarations and what else contains names.
    fn node(&mut self, node: Node<'_>) {
        match node.kind() {
            NodeKind::Module => {
                let module = self.declared_by(node);
                self.enter(module);
                self.children(node);
                self.enter(self.bare);
            }
            kind if kind.is_routine() => self.routine(node),
            NodeKind::ForStatement => self.for_statement(node),
            NodeKind::GotoStatement => {
                for name in node.children().filter(|child| child.kind() == NodeKind::Name) {
                    let key = self.key(name);
                    let found = self.labels.get(key);
                    self.add(name, Role::Label, found.map_or(Meaning::Unknown, Meaning::Declared));
                }
            }
            NodeKind::ConnectStatement => {
                for child in node.children() {
                    if child.kind() == NodeKind::Name {
                        self.called(child, Role::Trap);
                    } else {
                        self.value(child);
                    }
                }
            }
            NodeKind::CallStatement => self.call_statement(node),
            NodeKind::Name => {
                let found = self.declared.get(&node.range().start).copied();
                let meaning = found.map_or(Meaning::Open, Meaning::Declared);
                self.add(node, Role::Declaration, meaning);
            }
            NodeKind::TypeName => self.type_name(node),
            kind if kind.is_value() => {
                self.value(node);
            }
            _ => self.children(node),
        }
    }

    /// Prefers the names of a module to global ones of others. In a program that can be loaded this
    /// matters for LOCAL names only; where files of several tasks are given together, for all.
    fn enter(&mut self, module: Option<DeclarationId>) {
        for id in self.module.into_iter().flat_map(|old| self.names.inside(old)) {
            self.local.remove(self.names.declaration(id).key);
        }
        for id in module.into_iter().flat_map(|new| self.names.inside(new)) {
            self.local.insert_first(self.names.declaration(id).key, id);
        }
        self.module = module;
    }

    fn children(&mut self, node: Node<'_>) {
        for child in node.children() {
            self.node(child);
        }
    }

    fn type_name(&mut self, node: Node<'_>) {
        let key = self.key(node);
        let meaning = match self.names.find_type(self.module, key) {
            Some(id) => Meaning::Declared(id),
            None => self.outside(key),
        };
        self.add(node, Role::Type, meaning);
    }

    fn routine(&mut self, node: Node<'_>) {
        let id = self.declared_by(node);
        for inner in id.into_iter().flat_map(|id| self.names.inside(id)) {
            let declaration = self.names.declaration(inner);
            match declaration.kind {
                Kind::Label => self.labels.insert_first(declaration.key, inner),
                Kind::Counter => {}
                _ => self.routine.insert_first(declaration.key, inner),
            }
        }
        self.children(node);
        for inner in id.into_iter().flat_map(|id| self.names.inside(id)) {
            let key = self.names.declaration(inner).key;
            self.labels.remove(key);
            self.routine.remove(key);
        }
    }

    /// The counter is visible in the block only.
    fn for_statement(&mut self, node: Node<'_>) {
        let counter = self.declared_by(node);
        for child in node.children() {
            if child.kind() == NodeKind::Block
                && let Some(id) = counter
            {
                let key = self.names.declaration(id).key;
                self.counters.push((key, id));
                self.node(child);
                self.counters.pop();
            } else {
                self.node(child);
            }
        }
    }

    fn call_statement(&mut self, node: Node<'_>) {
        let mut children = node.children();
        let callee = match children.next() {
            Some(name) if name.kind() == NodeKind::Name => self.called(name, Role::Procedure),
            Some(late) => {
                self.late_binding(late);
                None
            }
            None => None,
        };
        for argument in children {
            self.argument(argument, callee);
        }
    }

    /// `%"name"%` names a procedure that cannot be looked up: the string may be any.
    fn late_binding(&mut self, node: Node<'_>) {
        for child in node.children() {
            if child.kind() == NodeKind::StringLiteral {
                self.add(child, Role::Procedure, Meaning::Late);
            } else {
                self.value(child);
            }
        }
    }

    /// A called routine; its declaration if there is one.
    fn called(&mut self, name: Node<'_>, role: Role) -> Option<DeclarationId> {
        let key = self.key(name);
        let meaning = self.look_up(key, true);
        self.add(name, role, meaning);
        match meaning {
            Meaning::Declared(id) => Some(id),
            _ => None,
        }
    }

    fn argument(&mut self, node: Node<'_>, callee: Option<DeclarationId>) {
        let mut children = node.children();
        match node.kind() {
            NodeKind::NamedArgument | NodeKind::OptionalArgument => {
                if let Some(name) = children.next() {
                    self.argument_name(name, callee);
                }
                children.for_each(|child| self.node(child));
            }
            NodeKind::ConditionalArgument => {
                if let Some(name) = children.next() {
                    self.argument_name(name, callee);
                }
                for own in children {
                    let key = self.key(own);
                    let meaning = self.look_up(key, false);
                    self.add(own, Role::Value, meaning);
                }
            }
            _ => self.node(node),
        }
    }

    fn argument_name(&mut self, name: Node<'_>, callee: Option<DeclarationId>) {
        let key = self.key(name);
        let routine =
            callee.filter(|id| matches!(self.names.declaration(*id).kind, Kind::Routine(_)));
        let meaning = match routine {
            None => Meaning::Open,
            Some(routine) => {
                let parameter = self.names.inside(routine).find(|id| {
                    let declaration = self.names.declaration(*id);
                    matches!(declaration.kind, Kind::Parameter(_)) && declaration.key == key
                });
                match parameter {
                    Some(id) => Meaning::Declared(id),
                    None if self.names.has_other_parameters(routine) => Meaning::Open,
                    None => Meaning::Unknown,
                }
            }
        };
        self.add(name, Role::Argument, meaning);
    }

    /// Resolves the names of an expression and tells its type, as far as declarations state it.
    fn value(&mut self, node: Node<'_>) -> ValueType {
        match node.kind() {
            NodeKind::Reference => {
                let key = self.key(node);
                let meaning = self.look_up(key, false);
                self.add(node, Role::Value, meaning);
                match meaning {
                    Meaning::Declared(id) => self.names.declaration(id).value,
                    Meaning::Predefined(value) => value,
                    _ => ValueType::UNKNOWN,
                }
            }
            NodeKind::FieldAccess => self.component(node),
            NodeKind::IndexAccess => {
                let mut children = node.children();
                let array = children.next().map(|child| self.value(child));
                children.for_each(|child| self.node(child));
                array.map_or(ValueType::UNKNOWN, |array| ValueType { dimensions: 0, ..array })
            }
            NodeKind::FunctionCall => {
                let mut children = node.children();
                let callee = children.next().and_then(|name| self.called(name, Role::Function));
                children.for_each(|argument| self.argument(argument, callee));
                callee.map_or(ValueType::UNKNOWN, |id| self.names.declaration(id).value)
            }
            NodeKind::Parenthesized => {
                let mut inner = ValueType::UNKNOWN;
                for child in node.children() {
                    inner = self.value(child);
                }
                inner
            }
            _ => {
                self.children(node);
                ValueType::UNKNOWN
            }
        }
    }

    fn component(&mut self, node: Node<'_>) -> ValueType {
        let mut children = node.children();
        let value = children.next().map_or(ValueType::UNKNOWN, |child| self.value(child));
        let Some(name) = children.next() else { return ValueType::UNKNOWN };
        let key = self.key(name);
        let base = value.declaration.and_then(|id| self.names.base(id));
        let meaning = match base.map(|id| (id, self.names.declaration(id).kind)) {
            None | Some((_, Kind::Basic(Basic::Opaque | Basic::Any))) => Meaning::Open,
            Some((record, _)) => {
                let component =
                    self.names.inside(record).find(|id| self.names.declaration(*id).key == key);
                component.map_or(Meaning::Unknown, Meaning::Declared)
            }
        };
        self.add(name, Role::Component, meaning);
        match meaning {
            Meaning::Declared(id) => self.names.declaration(id).value,
            _ => ValueType::UNKNOWN,
        }
    }

    /// The meaning of a name; where a routine is called, routines are preferred.
    fn look_up(&mut self, key: Key, called: bool) -> Meaning {
        let counter = self.counters.iter().rev().find(|(own, _)| *own == key).map(|(_, id)| *id);
        let found = [
            counter,
            self.routine.get(key),
            self.local.get(key),
            self.names.global.get(key),
            PREDEFINED.by_name.get(key),
        ];
        let is_routine =
            |id: &DeclarationId| matches!(self.names.declaration(*id).kind, Kind::Routine(_));
        let mut all = found.into_iter().flatten();
        let first = all.next();
        let id = if called {
            first.filter(is_routine).or_else(|| all.find(is_routine)).or(first)
        } else {
            first
        };
        id.map_or_else(|| self.outside(key), Meaning::Declared)
    }

    /// The meaning of a name that no file declares.
    fn outside(&mut self, key: Key) -> Meaning {
        if let Some(meaning) = self.outside.get(key) {
            return meaning;
        }
        let name = self.names.keys.text(key);
        let meaning = if let Some(data) = builtins::predefined(name) {
            let declaration = Names::predefined(data.type_name);
            Meaning::Predefined(ValueType { declaration, dimensions: 0 })
        } else if builtins::is_known(name) {
            Meaning::Known
        } else {
            Meaning::Unknown
        };
        self.outside.insert(key, meaning);
        meaning
    }
}
