//! Two targets of a module are the same.
//!
//! ## What it does
//! Finds robot targets of a module with the same value, both of which movements use: one finding for a
//! module.
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
    // Values are compared as they are written out.
    let mut same: BTreeMap<(usize, String), Vec<DataId>> = BTreeMap::new();
    for id in used {
        let data = context.program.data(id);
        let value = value_of(context.program, id).datum;
        if data.type_name.key == "robtarget"
            && !is_placeholder(&value)
            && value.first_unknown().is_none()
        {
            same.entry((id.module, format!("{value:?}"))).or_default().push(id);
        }
    }
    let mut of_module: BTreeMap<usize, Vec<(DataId, DataId)>> = BTreeMap::new();
    for ((module, _), targets) in same {
        let others = targets.iter().skip(1).map(|other| (targets[0], *other));
        of_module.entry(module).or_default().extend(others);
    }
    findings.extend(of_module.values().filter_map(|pairs| duplicated(context, pairs)));
}

/// One finding for the pairs of a module: what wrote them is the cause.
fn duplicated(context: &Context<'_>, pairs: &[(DataId, DataId)]) -> Option<Finding> {
    let name = |id: DataId| &context.program.data(id).name;
    let ((first, second), others) = pairs.split_first()?;
    let more = match others.len() {
        0 => String::new(),
        count => format!(", and so are {count} others"),
    };
    let message =
        format!("{} is the same target as {}{more}", name(*second).text, name(*first).text);
    let finding = Finding::new(&RULE, name(*second).span, message)
        .for_places(pairs.len())
        .with_related(name(*first).span, "the same value");
    Some(others.iter().fold(finding, |finding, (first, other)| {
        finding.with_related(name(*other).span, format!("the same as {}", name(*first).text))
    }))
}

fn is_placeholder(value: &Datum) -> bool {
    let place = parts(value).and_then(|parts| self::parts(parts.first()?));
    place.is_none_or(|place| place.iter().all(|x| x.num() == Some(0.0)))
}
