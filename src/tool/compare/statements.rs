//! Changes of the statements of a routine.

use super::align::{Alignment, align, flat};
use super::canonical::Writer;
use super::change::{Action, Subject};
use super::context::{Context, source};
use super::exact::same_node;
use super::names::Names;
use super::node::{Builder, Interner, Label, Node};
use super::statement::{Found, changed, headline, subject};
use crate::rapid::ir::hir::{Routine, StmtKind};

/// The changes of the statements of two routines, in the order of the new one.
pub(super) fn statements(context: &Context<'_>, old: &Routine, new: &Routine) -> Vec<Found> {
    let mut interner = Interner::default();
    let identity = Names::default();
    let old_nodes = Builder::new(context.old_writer(), &mut interner).routine(old);
    let writer = Writer { files: context.new.files, names: &identity };
    let new_nodes = Builder::new(writer, &mut interner).routine(new);
    let mut alignment = align(&old_nodes, &new_nodes);
    let (olds, news) = (flat(&old_nodes), flat(&new_nodes));
    separate(&mut alignment, &olds, &news);
    let mut walk = Walk { context, alignment: &alignment, found: Vec::new() };
    walk.removed(&olds);
    walk.added(&news);
    walk.pairs(&olds, &news);
    // In the order of the text, removed ones by the place where they were.
    walk.found.sort_by_key(|(order, _)| *order);
    walk.found.into_iter().map(|(_, found)| found).collect()
}

/// Blocks with another header and other statements are two blocks.
fn separate(alignment: &mut Alignment, olds: &[&Node<'_>], news: &[&Node<'_>]) {
    for old in olds.iter().filter(|node| node.label.is_block()) {
        let Some(new) = alignment.new_of[old.id].map(|id| news[id]) else { continue };
        let keeps = old.subtree().iter().skip(1).any(|below| alignment.new_of[below.id].is_some());
        let is_empty = old.children.is_empty() && new.children.is_empty();
        if old.own != new.own && !keeps && !is_empty {
            alignment.new_of[old.id] = None;
            alignment.old_of[new.id] = None;
        }
    }
}

struct Walk<'w, 'a> {
    context: &'w Context<'a>,
    alignment: &'w Alignment,
    /// With the place in the order of the new routine.
    found: Vec<((usize, usize), Found)>,
}

impl Walk<'_, '_> {
    /// The place of an old node in the order of the new routine: behind what stood before it.
    fn order(&self, old: usize) -> (usize, usize) {
        let before = (0..old).rev().find_map(|id| {
            let is_moved = self.alignment.moved.contains_key(&id);
            self.alignment.new_of[id].filter(|_| !is_moved)
        });
        (before.map_or(0, |new| new + 1), old + 1)
    }

    fn removed(&mut self, olds: &[&Node<'_>]) {
        let mut next = 0;
        for node in olds {
            if node.id < next || self.alignment.new_of[node.id].is_some() {
                continue;
            }
            let inner = node.subtree();
            let is_whole = inner.iter().all(|node| self.alignment.new_of[node.id].is_none());
            if is_whole {
                next = node.id + inner.len();
            }
            let kept = inner.iter().filter(|node| self.alignment.new_of[node.id].is_some()).count();
            let message = described(self.context.old.files, node, kept);
            let found = Found {
                subject: subject(&node.label),
                action: Action::Removed,
                spans: [Some(node.span), None],
                message,
                differences: Vec::new(),
            };
            self.found.push((self.order(node.id), found));
        }
    }

    fn added(&mut self, news: &[&Node<'_>]) {
        let mut next = 0;
        for node in news {
            if node.id < next || self.alignment.old_of[node.id].is_some() {
                continue;
            }
            let inner = node.subtree();
            let is_whole = inner.iter().all(|node| self.alignment.old_of[node.id].is_none());
            if is_whole {
                next = node.id + inner.len();
            }
            let kept = inner.iter().filter(|node| self.alignment.old_of[node.id].is_some()).count();
            let found = Found {
                subject: subject(&node.label),
                action: Action::Added,
                spans: [None, Some(node.span)],
                message: described(self.context.new.files, node, kept),
                differences: Vec::new(),
            };
            self.found.push(((node.id + 1, 0), found));
        }
    }

    fn pairs(&mut self, olds: &[&Node<'_>], news: &[&Node<'_>]) {
        let mut next = 0;
        for old in olds {
            let Some(new) = self.alignment.new_of[old.id].map(|id| news[id]) else { continue };
            let place = (new.id + 1, 0);
            if self.alignment.moved.contains_key(&old.id) && old.id >= next {
                next = old.id + old.subtree().len();
                let found = Found {
                    subject: subject(&new.label),
                    action: Action::Moved,
                    spans: [Some(old.span), Some(new.span)],
                    message: described(self.context.new.files, new, 0),
                    differences: Vec::new(),
                };
                self.found.push((place, found));
            }
            if old.own == new.own && same_node(old, new) {
                continue;
            }
            let changes = changed(self.context, old, new);
            self.found.extend(changes.into_iter().map(|found| (place, found)));
        }
    }
}

/// A statement with what is in it; `kept` of its inner nodes exist on the other side, too.
fn described(files: &[crate::rapid::text::SourceFile], node: &Node<'_>, kept: usize) -> String {
    if !node.label.is_block() {
        return source(files, node.span);
    }
    let head = headline(files, &node.label);
    let inner: Vec<&Node<'_>> = node.subtree().into_iter().skip(1).collect();
    let is_movement = |node: &&&Node<'_>| subject(&node.label) == Subject::Movement;
    let is_statement = |node: &&&Node<'_>| match node.label {
        Label::Statement(stmt) => !matches!(stmt.kind, StmtKind::Label(_)),
        _ => false,
    };
    let movements = inner.iter().filter(is_movement).count();
    let statements = inner.iter().filter(is_statement).count();
    let preposition = if kept > 0 { "around" } else { "with" };
    match (statements, movements) {
        (0, _) => head,
        (_, 0) => format!("{head} {preposition} {}", counted(statements, "statement")),
        _ if movements == statements => {
            format!("{head} {preposition} {}", counted(movements, "movement"))
        }
        _ => format!(
            "{head} {preposition} {}, {}",
            counted(statements, "statement"),
            counted(movements, "movement")
        ),
    }
}

fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}
