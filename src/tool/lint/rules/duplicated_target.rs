//! Two targets of a module are the same.
//!
//! ## What it does
//! Finds robot targets of a module with the same value, both of which movements use.
//!
//! ## Why it wastes energy
//! Movements between them are movements to the same place that nobody sees; and once one of them
//! is taught anew, the robot makes a way between two points that were meant to be one.
//!
//! ## How the saving is computed
//! There is none: with one target in place of two the cycle is the same.
//!
//! ## Example
//! ```text
//! CONST robtarget p10:=[[600,0,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
//! CONST robtarget p20:=[[600,0,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
//! ```
//!
//! ## Use instead
//! ```text
//! CONST robtarget p10:=[[600,0,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
//! ```
//!
//! ## Safety
//! Without a fix: which name stays is a matter of taste.
//!
//! ## Assumptions
//! Targets that are all zero are placeholders, and left alone.

use std::collections::{BTreeMap, BTreeSet};

use super::super::context::Context;
use super::super::rule::Finding;
use super::super::site::parts;
use crate::rapid::ir::exec::value_of;
use crate::rapid::ir::hir::{DataKind, ExprKind};
use crate::rapid::ir::program::{DataId, Symbol};
use crate::rapid::ir::value::Datum;

rule!("EW703", "duplicated-target", Program, Text, Info, "duplicated_target.rs");

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let mut used: BTreeSet<DataId> = BTreeSet::new();
    for site in &context.sites {
        if let ExprKind::Ref(name) = &site.target.kind
            && !context.flow.data_names.is_local(site.place.0, &name.key)
            && let Some(Symbol::Data(id)) = context.program.resolve(site.place.0.module, &name.key)
            && context.program.data(id).kind == DataKind::Const
            && context.program.data(id).dims.is_empty()
        {
            used.insert(id);
        }
    }
    let mut known: BTreeMap<(usize, String), DataId> = BTreeMap::new();
    for id in used {
        let data = context.program.data(id);
        let value = value_of(context.program, id).datum;
        if data.type_name.key != "robtarget"
            || is_placeholder(&value)
            || value.first_unknown().is_some()
        {
            continue;
        }
        // Values are compared as they are written out.
        let first = *known.entry((id.module, format!("{value:?}"))).or_insert(id);
        if first != id {
            let first = context.program.data(first);
            let message = format!("{} is the same target as {}", data.name.text, first.name.text);
            let finding = Finding::new(&RULE, data.name.span, message)
                .with_related(first.name.span, "the same value");
            findings.push(finding);
        }
    }
}

fn is_placeholder(value: &Datum) -> bool {
    let place = parts(value).and_then(|parts| self::parts(parts.first()?));
    place.is_none_or(|place| place.iter().all(|x| x.num() == Some(0.0)))
}
