//! An axis of the wrist turns the long way round because of the target's configuration.
//!
//! ## What it does
//! Finds movements on which axis 4 or 6 turns by more than 180°, although a full turn less of it
//! holds the tool in the same pose within the axis' limits and is nearer.
//!
//! ## Why it wastes energy
//! The axis turns farther than it has to; often it sets the time of the movement.
//!
//! ## How the saving is computed
//! The cycle is laid on a time line with the other configuration in the target, up to where the
//! robot stands as before.
//!
//! ## Example
//! ```text
//! CONST robtarget pPick:=[[600,0,400],[0,0,1,0],[0,0,2,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
//! ```
//!
//! ## Use instead
//! ```text
//! CONST robtarget pPick:=[[600,0,400],[0,0,1,0],[0,0,-2,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
//! ```
//!
//! ## Safety
//! Unsafe: hoses and cables turn with the axis, and may be why it turns that way.
//!
//! ## Assumptions
//! The target is used once; a target of several movements is left alone.

use super::super::context::Context;
use super::super::edits::{fix, replace};
use super::super::finding::{Applicability, Finding};
use super::super::site::Site;
use super::super::weigh::Weighed;
use crate::ir::hir::{Expr, ExprKind};
use crate::ir::movement::{Movement, RobTarget, Target};
use crate::ir::program::Symbol;
use crate::motion::Step;

rule!("EW405", "long-way-round", Path, Robot, Warning, "long_way_round.rs");

/// Axes that can turn on (4 and 6) with the components of the configuration that count their
/// quarter turns.
const AXES: [(usize, usize); 2] = [(3, 1), (5, 2)];
/// Quarter turns of a whole turn.
const WHOLE: i32 = 4;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for site in &context.sites {
        let [step] = site.executions.as_slice() else { continue };
        let Some((_, record, leg)) = context.record(*step) else { continue };
        let Target::Pose(target) = &record.movement.target else { continue };
        if !site.is_plain() {
            continue;
        }
        for (axis, part) in AXES {
            let turned = leg.end[axis] - leg.start[axis];
            if turned.abs() <= std::f64::consts::PI {
                continue;
            }
            let quarters = if turned > 0.0 { -WHOLE } else { WHOLE };
            let mut conf = target.conf;
            conf[part] += quarters;
            let change = |step: &Step| with_conf(step, conf);
            let Weighed::Saves(saving) = context.weigh(&[site.stmt.span], &change) else {
                continue;
            };
            let Some(literal) = literal(context, site, part) else { continue };
            let message = format!(
                "axis {} turns {:.0}° in this {}: the long way round",
                axis + 1,
                turned.to_degrees().abs(),
                site.name
            );
            let mut finding = Finding::new(&RULE, site.stmt.span, message);
            finding.related.push((literal.span, "the configuration says so".to_owned()));
            let written = context.text(literal.span);
            finding.change =
                format!("cf{} {} in place of {written} in the target", axis + 1, conf[part]);
            finding.saving = Some(saving);
            finding.assumptions.push("no hose or cable asks for the long way".to_owned());
            let edit = replace(literal.span, &conf[part].to_string());
            finding.fix = Some(fix(Applicability::Unsafe, edit));
            findings.push(finding);
        }
    }
}

/// A movement whose target has another configuration.
fn with_conf(step: &Step, conf: [i32; 4]) -> Vec<Step> {
    match step {
        Step::Move(movement) => {
            let mut movement = Movement::clone(movement);
            if let Target::Pose(target) = &movement.target {
                movement.target = Target::Pose(RobTarget { conf, ..target.clone() });
            }
            vec![Step::Move(Box::new(movement))]
        }
        other @ Step::Wait(_) => vec![other.clone()],
    }
}

/// Where the text states a component of the configuration of a target that is used once.
fn literal<'c>(context: &Context<'c>, site: &Site<'c>, part: usize) -> Option<&'c Expr> {
    let aggregate = match &site.target.kind {
        ExprKind::Aggregate(_) => site.target,
        ExprKind::Ref(name) => {
            let symbol = context.program.resolve(site.place.0.module, &name.key)?;
            let Symbol::Data(id) = symbol else { return None };
            let uses = context.sites.iter().filter(|other| mentions(other.target, &name.key));
            if uses.count() != 1 || context.program.is_written(id) {
                return None;
            }
            context.program.data(id).init.as_ref()?
        }
        _ => return None,
    };
    let ExprKind::Aggregate(parts) = &aggregate.kind else { return None };
    let ExprKind::Aggregate(conf) = &parts.get(2)?.kind else { return None };
    conf.get(part)
}

fn mentions(expr: &Expr, key: &str) -> bool {
    match &expr.kind {
        ExprKind::Ref(name) => name.key == key,
        ExprKind::Field(base, _) | ExprKind::Index(base, _) => mentions(base, key),
        // Whatever else a call does with it, it is one more use.
        ExprKind::Call(_, args) => args.iter().any(|arg| match &arg.kind {
            crate::ir::hir::ArgKind::Positional(expr) => mentions(expr, key),
            _ => false,
        }),
        _ => false,
    }
}
