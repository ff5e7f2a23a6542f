//! Names that are too long, reserved, or look like each other.

use std::collections::BTreeMap;

use super::context::Context;
use super::fault::{error, warning, with_place};
use crate::rapid::diagnostics::Diagnostic;
use crate::rapid::names::{DeclarationId, Kind};

/// Most letters of a name.
const LONGEST: usize = 32;
/// Reserved words that the syntax accepts as names elsewhere.
const RESERVED: [&str; 5] = ["sysmodule", "noview", "nostepin", "viewonly", "readonly"];

pub(super) fn check(context: &Context<'_>, out: &mut Vec<Diagnostic>) {
    let names = &context.names;
    let mut global = Vec::new();
    for module in names.modules() {
        name(context, module, out);
        for id in names.inside(module) {
            name(context, id, out);
            global.push(id);
            let own: Vec<DeclarationId> = names.inside(id).collect();
            for inner in &own {
                name(context, *inner, out);
            }
            look_alikes(context, &own, out);
        }
    }
    look_alikes(context, &global, out);
}

fn name(context: &Context<'_>, id: DeclarationId, out: &mut Vec<Diagnostic>) {
    let span = context.names.declaration(id).name;
    let key = context.names.key(id);
    let length = key.chars().count();
    if length > LONGEST {
        let message = format!("this name has {length} characters, {LONGEST} are allowed");
        out.push(error("name", span, message, "shorten it".to_owned()));
    }
    if RESERVED.contains(&key) {
        let message = format!("{} is a reserved word", key.to_uppercase());
        out.push(error("name", span, message, "choose another name".to_owned()));
    }
}

/// Names of one scope that differ in O and 0, or in l, I and 1 only.
fn look_alikes(context: &Context<'_>, ids: &[DeclarationId], out: &mut Vec<Diagnostic>) {
    let names = &context.names;
    let mut seen: BTreeMap<String, DeclarationId> = BTreeMap::new();
    for id in ids {
        let declaration = names.declaration(*id);
        if matches!(declaration.kind, Kind::Label | Kind::Counter) {
            continue;
        }
        let name = context.name(declaration);
        if name.is_empty() {
            continue;
        }
        let first = *seen.entry(outline(&name)).or_insert(*id);
        if names.key(first) != names.key(*id) {
            let other = context.name(names.declaration(first));
            let message = format!("{name} looks like {other}");
            let help = "rename one of them".to_owned();
            let finding = warning("look-alike", declaration.name, message, help);
            out.push(with_place(finding, names.declaration(first).name, "the other is here"));
        }
    }
}

/// The name with letters that look alike made equal.
fn outline(name: &str) -> String {
    let letter = |c: char| match c {
        '0' | 'O' | 'o' => 'o',
        '1' | 'I' | 'l' => 'l',
        other => other.to_ascii_lowercase(),
    };
    name.chars().map(letter).collect()
}
