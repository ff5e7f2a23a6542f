//! What the rules look at.

use std::collections::BTreeMap;

use super::types::Basics;
use crate::rapid::names::{Declaration, DeclarationId, Meaning, Names, SourceText, Use};
use crate::rapid::syntax::{Node, NodeKind};
use crate::rapid::text::{SourceFile, Span};

/// How much of a task the given files are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Extent {
    /// Some modules; others may declare more names, and some may be alternatives to each other.
    Some,
    /// A program, as far as its entry and the names of its modules tell; system modules may declare
    /// more names.
    Program,
    /// Modules that something states to be of one task; others may declare more names.
    Task,
    /// All modules of a task but those that options install, with the names that the controller
    /// itself declares (signals, mechanical units), in lower case.
    All(Vec<String>),
}

/// The files of one task.
#[derive(Debug)]
pub struct Task<'a> {
    /// The files.
    pub files: &'a [SourceText<'a>],
    /// How much of the task they are.
    pub extent: &'a Extent,
    /// The name of the procedure that starts the program.
    pub entry: &'a str,
}

/// A task with its index of names.
pub(super) struct Context<'a> {
    pub(super) task: &'a Task<'a>,
    pub(super) names: Names,
    pub(super) basics: Basics,
    texts: BTreeMap<crate::rapid::text::FileId, &'a SourceFile>,
}

/// A node of a file.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub(super) file: &'a SourceFile,
    pub(super) node: Node<'a>,
}

impl<'a> Place<'a> {
    pub(super) fn span(self) -> Span {
        let range = self.node.range();
        Span { file: self.file.id, start: range.start, end: range.end }
    }

    pub(super) fn kind(self) -> NodeKind {
        self.node.kind()
    }

    pub(super) fn at(self, node: Node<'a>) -> Place<'a> {
        Place { node, ..self }
    }

    pub(super) fn children(self) -> impl Iterator<Item = Place<'a>> {
        self.node.children().map(move |node| self.at(node))
    }

    pub(super) fn child(self, kind: NodeKind) -> Option<Place<'a>> {
        self.node.child(kind).map(|node| self.at(node))
    }

    /// Its text, decoded.
    pub(super) fn text(self) -> String {
        self.file.text(self.span()).into_owned()
    }

    /// Whether it contains a syntax error.
    pub(super) fn is_broken(self) -> bool {
        self.node.subtree().any(|node| node.kind() == NodeKind::Error)
    }
}

impl<'a> Context<'a> {
    pub(super) fn new(task: &'a Task<'a>) -> Context<'a> {
        let names = Names::new(task.files);
        let basics = Basics::new();
        let texts = task.files.iter().map(|source| (source.file.id, source.file)).collect();
        Context { task, names, basics, texts }
    }

    /// All nodes of all files, in preorder.
    pub(super) fn nodes(&self) -> impl Iterator<Item = Place<'a>> {
        self.task.files.iter().flat_map(|source| {
            source.parse.tree.nodes().map(|node| Place { file: source.file, node })
        })
    }

    /// The routines of all files.
    pub(super) fn routines(&self) -> impl Iterator<Item = Place<'a>> {
        self.nodes().filter(|place| place.kind().is_routine())
    }

    /// The identifier that starts where a place starts.
    pub(super) fn use_at(&self, place: Place<'_>) -> Option<&Use> {
        let start = place.node.range().start;
        self.names.at(place.file.id, start).filter(|one| one.start == start)
    }

    /// The declaration that the identifier at a place names.
    pub(super) fn declared(&self, place: Place<'_>) -> Option<DeclarationId> {
        match self.use_at(place)?.meaning {
            Meaning::Declared(id) => Some(id),
            _ => None,
        }
    }

    /// A name as its declaration spells it.
    pub(super) fn name(&self, declaration: &Declaration) -> String {
        let file = self.texts.get(&declaration.name.file);
        file.map_or_else(String::new, |file| file.text(declaration.name).into_owned())
    }

    /// The name of a declaration of a file or a predefined one.
    pub(super) fn shown(&self, id: DeclarationId) -> String {
        match self.names.predefined_name(id) {
            Some(name) => name.to_owned(),
            None => self.name(self.names.declaration(id)),
        }
    }
}
