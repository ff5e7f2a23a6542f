//! Other places for points that are only passed or where the robot only waits or ends: a way round, a
//! home position, a waiting position.

use std::collections::BTreeMap;

use super::lever::{Lever, Offers, Shift};
use crate::rapid::builtins::MoveForm;
use crate::rapid::ir::hir::{Data, Expr, ExprKind};
use crate::rapid::ir::program::{DataId, Program, Symbol};
use crate::rapid::ir::walk::statements;
use crate::tool::lint::context::Context;
use crate::tool::lint::process::Kept;
use crate::tool::lint::site::Site;
use crate::tool::lint::trace::Action;

/// First step and largest shift of a position, mm, and of a joint, degrees.
const POSITION: [f64; 2] = [40.0, 100.0];
const JOINTS: [f64; 2] = [5.0, 12.0];

/// The declared points whose every use is such a movement.
pub(super) fn levers(context: &Context<'_>) -> Vec<Lever> {
    let uses = uses(context.program);
    let mut of: BTreeMap<DataId, Vec<&Site<'_>>> = BTreeMap::new();
    for site in context.sites.iter().filter(|site| is_free(context, site)) {
        let ExprKind::Ref(name) = &site.target.kind else { continue };
        let module = site.place.0.module;
        if let Some(Symbol::Data(id)) = context.program.resolve(module, &name.key) {
            of.entry(id).or_default().push(site);
        }
    }
    let lever = |(id, sites): (DataId, Vec<&Site<'_>>)| {
        let data = context.program.data(id);
        let is_free = !context.program.is_written(id)
            && returns(context, &sites)
            && uses.get(data.name.key.as_str()) == Some(&sites.len());
        let shift = is_free.then(|| shift(data)).flatten()?;
        Some(Lever {
            span: data.span,
            risk: "the robot goes another way or rests elsewhere",
            kept: Kept::Order,
            offers: Offers::Shift(shift),
        })
    };
    of.into_iter().filter_map(lever).collect()
}

/// Whether the cycle ends where it begins, if it begins at the target of one of these movements: the way
/// back of a program that ends elsewhere is not simulated.
fn returns(context: &Context<'_>, sites: &[&Site<'_>]) -> bool {
    let moves = |step: &usize| context.trace[*step].what.moves();
    let steps = 0..context.trace.len();
    let [first, last] = [steps.clone().find(moves), steps.rev().find(moves)];
    let is_there = |step: Option<usize>| {
        step.is_some_and(|step| sites.iter().any(|site| site.executions.contains(&step)))
    };
    !is_there(first) || is_there(last)
}

/// Whether a movement passes its target, or comes to it along the joints and nothing is switched there.
fn is_free(context: &Context<'_>, site: &Site<'_>) -> bool {
    let idles = |step: &usize| {
        let mut here = context.trace[step + 1..].iter().take_while(|next| !next.what.moves());
        !here.any(|next| matches!(next.what, Action::Output(_)))
    };
    // An arc is there for the process.
    let is_there =
        !site.executions.is_empty() && site.is_plain() && site.signature.form != MoveForm::Circular;
    is_there && (!site.is_stop() || (!site.is_linear() && site.executions.iter().all(idles)))
}

fn shift(data: &Data) -> Option<Shift> {
    let ExprKind::Aggregate(parts) = &data.init.as_ref()?.kind else { return None };
    let first = parts.first()?;
    let values = first.literal_numbers()?;
    let (unit, [step, most]) = match data.type_name.key.as_str() {
        "robtarget" if values.len() == 3 => ("mm", POSITION),
        "jointtarget" if values.len() == 6 => ("degrees", JOINTS),
        _ => return None,
    };
    Some(Shift { span: first.span, values, name: data.name.text.clone(), unit, step, most })
}

/// How often each name is used in statements and declarations, by its key.
fn uses(program: &Program) -> BTreeMap<String, usize> {
    let mut count = BTreeMap::new();
    for module in &program.modules {
        for init in module.data.iter().filter_map(|data| data.init.as_ref()) {
            add(init, &mut count);
        }
        for routine in &module.routines {
            for init in routine.data.iter().filter_map(|data| data.init.as_ref()) {
                add(init, &mut count);
            }
            let all = routine.blocks().flat_map(|block| statements(block));
            for expr in all.flat_map(|stmt| stmt.kind.exprs()) {
                add(expr, &mut count);
            }
        }
    }
    count
}

fn add(expr: &Expr, count: &mut BTreeMap<String, usize>) {
    if let ExprKind::Ref(name) = &expr.kind {
        *count.entry(name.key.clone()).or_default() += 1;
    }
    for part in expr.parts() {
        add(part, count);
    }
}
