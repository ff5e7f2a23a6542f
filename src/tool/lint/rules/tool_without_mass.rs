//! A tool has a frame but no mass.
//!
//! ## What it does
//! Finds tool data that movements use, whose TCP lies away from the flange and whose mass is at
//! most 0.01 kg, as post-processors write it.
//!
//! ## Why it wastes energy
//! The controller computes torques, accelerations and its collision supervision without the tool:
//! it accelerates too hard, wears, and every figure about energy is wrong.
//!
//! ## How the saving is computed
//! There is none to tell: with a wrong mass no figure is right.
//!
//! ## Example
//! ```text
//! PERS tooldata tGrip:=[TRUE,[[0,0,150],[1,0,0,0]],[0.001,[0,0,0.001],[1,0,0,0],0,0,0]];
//! ```
//!
//! ## Use instead
//! ```text
//! PERS tooldata tGrip:=[TRUE,[[0,0,150],[1,0,0,0]],[3.2,[0,0,70],[1,0,0,0],0.01,0.01,0.01]];
//! ```
//!
//! ## Safety
//! Without a fix: only a scale or a load identification knows the mass.
//!
//! ## Assumptions
//! Nothing sets the mass while the program runs.

use super::super::context::Context;
use super::super::rule::Finding;
use super::super::site::{numbers, parts};
use crate::rapid::ir::exec::value_of;
use crate::rapid::ir::hir::{Data, Expr, ExprKind};
use crate::rapid::ir::program::{DataId, Symbol};
use crate::rapid::ir::value::Datum;

rule!("EW501", "tool-without-mass", Load, Text, Warning, "tool_without_mass.rs");

/// Tools up to this have no mass, kg.
const MAX_NO_MASS: f64 = 0.01;
/// A TCP nearer to the flange than this may be a bare flange, mm.
const MIN_DISTANCE: f64 = 5.0;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for (module, body) in context.program.modules.iter().enumerate() {
        for (index, data) in body.data.iter().enumerate() {
            let id = DataId { module, index };
            if data.type_name.key != "tooldata"
                || !data.dims.is_empty()
                || context.program.is_written(id)
                || !is_used(context, id)
            {
                continue;
            }
            let Some((held, away, mass)) = measured(&value_of(context.program, id).datum) else {
                continue;
            };
            if !held || away < MIN_DISTANCE || mass > MAX_NO_MASS {
                continue;
            }
            let span = mass_of(data).map_or(data.name.span, |expr| expr.span);
            let message = format!(
                "tool {} has a TCP {away:.0} mm from the flange and a mass of {mass} kg: energy \
                 and limits are computed without it",
                data.name.text
            );
            findings.push(Finding::new(&RULE, span, message));
        }
    }
}

fn is_used(context: &Context<'_>, id: DataId) -> bool {
    context.sites.iter().any(|site| {
        let module = site.place.0.module;
        let symbol = site.tool_key().and_then(|key| context.program.resolve(module, key));
        symbol == Some(Symbol::Data(id))
    })
}

/// Whether the robot holds it, the distance of the TCP (mm), and the mass (kg).
fn measured(tool: &Datum) -> Option<(bool, f64, f64)> {
    let [Datum::Bool(held), frame, load] = parts(tool)? else { return None };
    let place = numbers(parts(frame)?.first()?)?;
    let away = place.iter().map(|x| x * x).sum::<f64>().sqrt();
    Some((*held, away, parts(load)?.first()?.num()?))
}

/// Where the declaration states the mass.
fn mass_of(data: &Data) -> Option<&Expr> {
    let ExprKind::Aggregate(parts) = &data.init.as_ref()?.kind else { return None };
    let ExprKind::Aggregate(load) = &parts.get(2)?.kind else { return None };
    load.first()
}
