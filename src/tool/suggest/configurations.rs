//! Other configurations of targets: the wrist turned over, or axis 4 or 6 a turn farther.

use std::collections::{BTreeMap, BTreeSet};

use super::lever::{Lever, Offer, Offers};
use crate::rapid::ir::hir::{Expr, ExprKind};
use crate::rapid::ir::program::{DataId, Symbol};
use crate::rapid::text::{Edit, Span};
use crate::tool::lint::context::Context;
use crate::tool::lint::process::Kept;

/// Changes of the quarter turns of axes 4 and 6 and of the last number, which the sign of axis 5 makes odd;
/// what they are in words.
const CHANGES: [([i32; 3], &str); 8] = [
    ([2, 2, 1], "wrist turned over, axes 4 and 6 half a turn forward"),
    ([2, -2, 1], "wrist turned over, axis 4 half a turn forward, axis 6 back"),
    ([-2, 2, 1], "wrist turned over, axis 4 half a turn back, axis 6 forward"),
    ([-2, -2, 1], "wrist turned over, axes 4 and 6 half a turn back"),
    ([0, 4, 0], "axis 6 a turn forward"),
    ([0, -4, 0], "axis 6 a turn back"),
    ([4, 0, 0], "axis 4 a turn forward"),
    ([-4, 0, 0], "axis 4 a turn back"),
];

/// A target with literal configuration.
struct Taught {
    name: String,
    span: Span,
    conf: [i32; 4],
}

/// The targets of the cycle one by one, those of each routine, and all.
pub(super) fn levers(context: &Context<'_>) -> Vec<Lever> {
    let mut of_routine: BTreeMap<_, BTreeSet<DataId>> = BTreeMap::new();
    for site in context.sites.iter().filter(|site| !site.executions.is_empty()) {
        let mut found = BTreeSet::new();
        names(context, site.place.0.module, site.target, &mut found);
        of_routine.entry((site.place.0.module, site.place.0.index)).or_default().extend(found);
    }
    let all: BTreeSet<DataId> = of_routine.values().flatten().copied().collect();
    let single = all.iter().map(|id| BTreeSet::from([*id]));
    let groups: BTreeSet<BTreeSet<DataId>> =
        single.chain(of_routine.into_values()).chain([all.clone()]).collect();
    groups.iter().filter_map(|group| lever(context, group)).collect()
}

fn lever(context: &Context<'_>, group: &BTreeSet<DataId>) -> Option<Lever> {
    let taught: Vec<Taught> = group.iter().filter_map(|id| taught(context, *id)).collect();
    let names: Vec<&str> = taught.iter().map(|of| of.name.as_str()).collect();
    let offer = |([four, six, last], words): &([i32; 3], &str)| Offer {
        title: format!("{words} at {}", names.join(", ")),
        edits: taught
            .iter()
            .map(|of| {
                let [cf1, cf4, cf6, cfx] = of.conf;
                let text = format!("[{cf1},{},{},{}]", cf4 + four, cf6 + six, cfx ^ last);
                Edit { span: of.span, text: text.into_bytes() }
            })
            .collect(),
    };
    Some(Lever {
        span: taught.first()?.span,
        risk: "arm and cables go another way",
        kept: Kept::Flange,
        offers: Offers::List(CHANGES.iter().map(offer).collect()),
    })
}

fn taught(context: &Context<'_>, id: DataId) -> Option<Taught> {
    let data = context.program.data(id);
    let ExprKind::Aggregate(parts) = &data.init.as_ref()?.kind else { return None };
    if data.type_name.key != "robtarget" || context.program.is_written(id) {
        return None;
    }
    let conf = parts.get(2)?;
    let numbers: Vec<i32> = conf.literal_numbers()?.into_iter().map(|x| x as i32).collect();
    let name = data.name.text.clone();
    Some(Taught { name, span: conf.span, conf: numbers.try_into().ok()? })
}

/// The targets that an expression names.
fn names(context: &Context<'_>, module: usize, expr: &Expr, found: &mut BTreeSet<DataId>) {
    if let ExprKind::Ref(name) = &expr.kind
        && let Some(Symbol::Data(id)) = context.program.resolve(module, &name.key)
        && context.program.data(id).type_name.key == "robtarget"
    {
        found.insert(id);
    }
    for part in expr.parts() {
        names(context, module, part, found);
    }
}
