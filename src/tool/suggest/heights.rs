//! Lower approach heights: the last offset of `Offs` and `RelTool` in targets that are passed.

use std::collections::BTreeMap;

use super::lever::{Lever, Offer, Offers, written};
use crate::rapid::ir::hir::{Arg, Call, Callee, Expr, ExprKind, StmtKind};
use crate::rapid::ir::program::{Program, Symbol};
use crate::rapid::text::{Edit, Span};
use crate::tool::lint::context::Context;
use crate::tool::lint::process::Kept;

/// Shares of the height that are offered.
const SHARES: [f64; 2] = [0.75, 0.5];
/// Least height that is offered, mm.
const LEAST_MM: f64 = 15.0;
/// Functions whose third offset is a height.
const FUNCTIONS: [&str; 2] = ["offs", "reltool"];

/// Numbers that are heights of passed points, each once.
pub(super) fn levers(context: &Context<'_>) -> Vec<Lever> {
    let mut found: BTreeMap<Span, f64> = BTreeMap::new();
    for site in &context.sites {
        if site.is_stop() || !site.is_plain() || site.executions.is_empty() {
            continue;
        }
        let module = site.place.0.module;
        let Some(height) = height(site.target) else { continue };
        let routine = context.program.routine(site.place.0);
        // The height may be a parameter: what the calls of the routine give.
        let parameter = match &height.kind {
            ExprKind::Ref(name) => routine.params.iter().position(|of| of.name.key == name.key),
            _ => None,
        };
        match parameter {
            Some(place) => found.extend(stated(context.program, &routine.name.key, place)),
            None => found.extend(literal(context.program, module, height)),
        }
    }
    // Where a constant also stands for a place at which something happens, the simulation refuses it.
    found.into_iter().filter(|(_, mm)| mm.abs() > LEAST_MM).map(|at| lever(context, at)).collect()
}

fn lever(context: &Context<'_>, (span, mm): (Span, f64)) -> Lever {
    let was = written(context, span);
    let offer = |share: &f64| {
        let lower = (mm.abs() * share).max(LEAST_MM).round().copysign(mm);
        Offer {
            title: format!("height {lower:.0} in place of {was}"),
            edits: vec![Edit { span, text: format!("{lower:.0}").into_bytes() }],
        }
    };
    Lever {
        span,
        risk: "less room above what stands there",
        kept: Kept::Outputs,
        offers: Offers::List(SHARES.iter().map(offer).collect()),
    }
}

/// The height in a target.
fn height(target: &Expr) -> Option<&Expr> {
    let ExprKind::Call(name, args) = &target.kind else { return None };
    if !FUNCTIONS.contains(&name.key.as_str()) {
        return None;
    }
    args.iter().filter_map(Arg::positional).nth(3)
}

/// The numbers that the calls of a routine state for a parameter.
fn stated(program: &Program, routine: &str, place: usize) -> Vec<(Span, f64)> {
    let mut all = Vec::new();
    for (id, of) in program.routines() {
        for stmt in of.statements() {
            let StmtKind::Call(Call { callee: Callee::Name(name), args, .. }) = &stmt.kind else {
                continue;
            };
            if name.key == routine {
                let value = args.iter().filter_map(Arg::positional).nth(place);
                all.extend(value.and_then(|value| literal(program, id.module, value)));
            }
        }
    }
    all
}

/// The number of an expression, and its place: a literal, or that of a constant with a literal value.
fn literal(program: &Program, module: usize, expr: &Expr) -> Option<(Span, f64)> {
    let ExprKind::Ref(name) = &expr.kind else {
        return Some((expr.span, expr.literal_number()?));
    };
    let Symbol::Data(id) = program.resolve(module, &name.key)? else { return None };
    let init = program.data(id).init.as_ref().filter(|_| !program.is_written(id))?;
    Some((init.span, init.literal_number()?))
}
