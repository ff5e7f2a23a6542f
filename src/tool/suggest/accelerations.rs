//! Other accelerations: another `AccSet` in place of one with stated numbers, or one at the start of a
//! program that has none.

use super::lever::{Lever, Offer, Offers};
use crate::rapid::ir::hir::{Arg, Call, Callee, Stmt, StmtKind};
use crate::rapid::text::{Edit, Span};
use crate::tool::lint::context::Context;
use crate::tool::lint::process::Kept;

/// Accelerations and ramps that are offered, %.
const OFFERED: [f64; 4] = [100.0, 80.0, 60.0, 40.0];

/// The statements that set the acceleration, or the place for one.
pub(super) fn levers(context: &Context<'_>) -> Vec<Lever> {
    let all = context.program.routines().flat_map(|(_, routine)| routine.statements());
    let set: Vec<(&Stmt, &Call)> = all.filter_map(acceleration).collect();
    if set.is_empty() {
        return inserted(context).into_iter().collect();
    }
    set.into_iter().filter_map(|(stmt, call)| changed(stmt, call)).collect()
}

fn acceleration(stmt: &Stmt) -> Option<(&Stmt, &Call)> {
    let StmtKind::Call(call) = &stmt.kind else { return None };
    let is_it = matches!(&call.callee, Callee::Name(name) if name.key == "accset");
    is_it.then_some((stmt, call))
}

fn changed(stmt: &Stmt, call: &Call) -> Option<Lever> {
    let numbers: Vec<_> = call.args.iter().filter_map(Arg::positional).collect();
    let [acceleration, ramp] = numbers.as_slice() else { return None };
    let was = [acceleration.literal_number()?, ramp.literal_number()?];
    let pairs = OFFERED.iter().flat_map(|a| OFFERED.iter().map(move |r| [*a, *r]));
    let offer = |[a, r]: [f64; 2]| Offer {
        title: format!("AccSet {a},{r} in place of {},{}", was[0], was[1]),
        edits: vec![
            Edit { span: acceleration.span, text: a.to_string().into_bytes() },
            Edit { span: ramp.span, text: r.to_string().into_bytes() },
        ],
    };
    let offers = pairs.filter(|pair| *pair != was).map(offer).collect();
    Some(lever(stmt.span, offers))
}

fn inserted(context: &Context<'_>) -> Option<Lever> {
    let entry = context.program.routine(context.entry?);
    let first = entry.body.first()?.span;
    let offer = |a: &f64| Offer {
        title: format!("AccSet {a},{a} at the start"),
        edits: vec![Edit {
            span: Span { end: first.start, ..first },
            text: format!("AccSet {a},{a}; ").into_bytes(),
        }],
    };
    let lower = OFFERED.iter().filter(|a| **a < 100.0);
    Some(lever(first, lower.map(offer).collect()))
}

fn lever(span: Span, offers: Vec<Offer>) -> Lever {
    let risk = "another acceleration: what the gripper holds may slip";
    Lever { span, risk, kept: Kept::Outputs, offers: Offers::List(offers) }
}
