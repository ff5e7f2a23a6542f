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
//! The cycle is laid on a time line with the other configuration in the target, for every movement
//! to it or to a place beside it, up to where the robot stands as before.
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
//! A target of several movements is changed for all of them; one that something else uses too is
//! left alone. Nothing is told where a line between it and the next joint movement is not simulated: its
//! configuration might not agree with the changed one.

use std::collections::BTreeSet;

use super::super::context::Context;
use super::super::edits::{change_movement, replace};
use super::super::flow::Through;
use super::super::rule::Finding;
use super::super::site::Site;
use super::super::words;
use crate::rapid::ir::hir::{ArgKind, Expr, ExprKind, Ident};
use crate::rapid::ir::movement::Target;
use crate::rapid::ir::program::Symbol;
use crate::rapid::text::{FileId, Span};
use crate::retime::motion::Step;

rule!("EW405", "long-way-round", Path, Robot, Warning, "long_way_round.rs");

/// Axes that can turn by whole turns (4 and 6) with the components of the configuration that count their
/// quarter turns.
const AXES: [(usize, usize); 2] = [(3, 1), (5, 2)];
/// Quarter turns of a whole turn.
const WHOLE: i32 = 4;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for site in &context.sites {
        if !site.is_plain() {
            continue;
        }
        for (axis, part) in AXES {
            let Some((turned, stated)) = farthest(context, site, axis, part) else { continue };
            if turned.abs() <= std::f64::consts::PI {
                continue;
            }
            let Some((literal, spans)) = literal(context, site, part) else { continue };
            if !spans.iter().all(|span| lines_behind_are_simulated(context, *span)) {
                continue;
            }
            let quarters = if turned > 0.0 { -WHOLE } else { WHOLE };
            let change = |step: &Step| with_conf(step, part, quarters);
            let Ok(Some(saving)) = context.evaluate(&spans, &change) else { continue };
            let message = format!(
                "axis {} turns {:.0}° in this {}: the long way round",
                axis + 1,
                turned.to_degrees().abs(),
                site.name
            );
            let written = context.text(literal.span);
            let conf = stated + quarters;
            let change = format!("cf{} {conf} in place of {written} in the target", axis + 1);
            let finding = Finding::new(&RULE, site.stmt.span, message)
                .with_related(literal.span, "the configuration says so")
                .with_saving(change, saving)
                .with_assumption("no hose or cable asks for the long way")
                .with_unsafe_fix([replace(literal.span, &conf.to_string())]);
            findings.push(finding);
        }
    }
}

/// Whether all lines from a movement to the next joint movement are simulated: their configurations
/// have to agree with its own.
fn lines_behind_are_simulated(context: &Context<'_>, span: Span) -> bool {
    let mut open: Vec<usize> = context.site_of(span).into_iter().collect();
    let mut seen = BTreeSet::new();
    while let Some(site) = open.pop() {
        for next in context.next(site, Through::All).iter().filter_map(|it| context.movement(it)) {
            if !context.sites[next].is_linear() || !seen.insert(next) {
                continue;
            }
            let mut runs = context.sites[next].executions.iter().map(|step| context.record(*step));
            if runs.len() == 0 || runs.any(|it| it.is_none_or(|(run, ..)| run.problem.is_some())) {
                return false;
            }
            open.push(next);
        }
    }
    true
}

/// The farthest that an axis turns in an execution of a movement, rad, and the component of the
/// configuration there.
fn farthest(
    context: &Context<'_>,
    site: &Site<'_>,
    axis: usize,
    part: usize,
) -> Option<(f64, i32)> {
    let turns = site.executions.iter().filter_map(|step| {
        let (_, record, leg) = context.record(*step)?;
        let Target::Pose(target) = &record.movement.target else { return None };
        Some((leg.end[axis] - leg.start[axis], target.conf[part]))
    });
    turns.reduce(|a, b| if b.0.abs() > a.0.abs() { b } else { a })
}

/// A movement whose target has another component of the configuration.
fn with_conf(step: &Step, part: usize, quarters: i32) -> Vec<Step> {
    change_movement(step, |movement| {
        if let Target::Pose(target) = &mut movement.target {
            target.conf[part] += quarters;
        }
    })
}

/// Where the text states a component of the configuration of a movement's target, and the
/// movements that it is the target of; `None` where something else uses it too.
fn literal<'c>(
    context: &Context<'c>,
    site: &Site<'c>,
    part: usize,
) -> Option<(&'c Expr, Vec<Span>)> {
    let mut spans = vec![site.stmt.span];
    let aggregate = if let Some(name) = named(site.target) {
        let symbol = context.program.resolve(site.place.0.module, &name.key)?;
        let Symbol::Data(id) = symbol else { return None };
        if context.program.is_written(id)
            || context.flow.data_names.is_local(site.place.0, &name.key)
        {
            return None;
        }
        let is_use = |other: &&Site<'c>| named(other.target).is_some_and(|it| it.key == name.key);
        let uses: Vec<&Site<'c>> = context.sites.iter().filter(is_use).collect();
        let all: usize =
            uses.iter().map(|other| words::count(&context.text(other.stmt.span), &name.key)).sum();
        if words_of_program(context, &name.key) != all + 1 {
            return None;
        }
        spans = uses.iter().map(|other| other.stmt.span).collect();
        context.program.data(id).init.as_ref()?
    } else {
        site.target
    };
    let ExprKind::Aggregate(parts) = &aggregate.kind else { return None };
    let ExprKind::Aggregate(conf) = &parts.get(2)?.kind else { return None };
    Some((conf.get(part)?, spans))
}

/// How often the files of the program name something.
fn words_of_program(context: &Context<'_>, key: &str) -> usize {
    let files: BTreeSet<FileId> =
        context.program.modules.iter().map(|module| module.name.span.file).collect();
    files.iter().map(|file| words::in_file(&context.files[file.0 as usize], key)).sum()
}

/// The name of a target's data, also inside `Offs` and the like.
fn named(target: &Expr) -> Option<&Ident> {
    match &target.kind {
        ExprKind::Ref(name) => Some(name),
        ExprKind::Call(function, args) if ["offs", "reltool"].contains(&function.key.as_str()) => {
            match args.first().map(|arg| &arg.kind) {
                Some(ArgKind::Positional(expr)) => named(expr),
                _ => None,
            }
        }
        _ => None,
    }
}
