//! GOTO into a branch or a loop from outside.

use std::collections::BTreeMap;

use super::context::{Context, Place};
use super::fault::{error, with_place};
use crate::rapid::diagnostics::Diagnostic;
use crate::rapid::names::DeclarationId;
use crate::rapid::syntax::NodeKind;

pub(super) fn check(context: &Context<'_>, out: &mut Vec<Diagnostic>) {
    for routine in context.routines() {
        let mut jumps = Jumps {
            context,
            blocks: Vec::new(),
            count: 0,
            labels: BTreeMap::new(),
            gotos: Vec::new(),
        };
        jumps.walk(routine);
        for (place, label, from) in &jumps.gotos {
            // The blocks around the label have to be around the GOTO, too.
            let Some(to) = jumps.labels.get(label) else { continue };
            if !from.starts_with(to) {
                let message = format!("GOTO {} leads into a branch, loop or handler", place.text());
                let help = "move the label out of it, or the GOTO into it".to_owned();
                let finding = error("goto", place.span(), message, help);
                let name = context.names.declaration(*label).name;
                out.push(with_place(finding, name, "the label is here"));
            }
        }
    }
}

struct Jumps<'c, 'a> {
    context: &'c Context<'a>,
    /// The numbers of the blocks around the current place.
    blocks: Vec<u32>,
    count: u32,
    labels: BTreeMap<DeclarationId, Vec<u32>>,
    gotos: Vec<(Place<'a>, DeclarationId, Vec<u32>)>,
}

impl<'a> Jumps<'_, 'a> {
    fn walk(&mut self, place: Place<'a>) {
        for child in place.children() {
            let name = child.child(NodeKind::Name);
            let named = name.and_then(|name| Some((name, self.context.declared(name)?)));
            match (child.kind(), named) {
                (NodeKind::LabelStatement, Some((_, id))) => {
                    self.labels.insert(id, self.blocks.clone());
                }
                (NodeKind::GotoStatement, Some((name, id))) => {
                    self.gotos.push((name, id, self.blocks.clone()));
                }
                (NodeKind::Block | NodeKind::CompactIf, _) => {
                    self.count += 1;
                    self.blocks.push(self.count);
                    self.walk(child);
                    self.blocks.pop();
                }
                (kind, _) if kind.is_value() => {}
                _ => self.walk(child),
            }
        }
    }
}
