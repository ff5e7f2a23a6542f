//! The movements for which a motion setting is in force.

use super::context::Context;
use super::flow::Place;
use super::statements::first_argument;
use crate::rapid::ir::hir::{Call, Stmt};
use crate::rapid::ir::movement::Settings;
use crate::rapid::ir::program::RoutineId;
use crate::rapid::text::Span;

/// A call that lowers a motion setting, with what it is in force for.
pub(super) struct Region<'c> {
    /// The call.
    pub(super) stmt: &'c Stmt,
    /// Its arguments.
    pub(super) call: &'c Call,
    /// What it sets, %.
    pub(super) value: f64,
    /// The movements that could do without it.
    pub(super) free: Vec<usize>,
    /// Whether it is in force for a process too.
    pub(super) spares: bool,
}

impl Region<'_> {
    /// The spans of the movements that could do without it.
    pub(super) fn spans(&self, context: &Context<'_>) -> Vec<Span> {
        self.free.iter().map(|site| context.sites[*site].stmt.span).collect()
    }

    /// Whether it may go unasked: no process needs it, and no part that is carried.
    pub(super) fn may_go(&self, context: &Context<'_>) -> bool {
        !self.spares && !self.free.iter().any(|site| context.carries_part(*site))
    }

    /// The lines of these movements, as they follow a change in a message: empty if they are all
    /// for which the setting is in force.
    pub(super) fn lines(&self, context: &Context<'_>) -> String {
        if !self.spares {
            return String::new();
        }
        let lines = self.spans(context).into_iter().map(|span| context.line(span).to_string());
        format!(" for line {} alone", lines.collect::<Vec<_>>().join(", "))
    }
}

/// The first argument of a call, if it is known.
pub(super) fn percent(context: &Context<'_>, routine: RoutineId, call: &Call) -> Option<f64> {
    context.constant(routine, first_argument(call)?)?.num()
}

/// The calls of an instruction that set less than 100 %, each with the executed movements for which
/// it alone is in force. `is_set` tells the setting of a movement from the value of the call, %.
pub(super) fn lowered<'c>(
    context: &Context<'c>,
    instruction: &'static str,
    is_set: fn(&Settings, f64) -> bool,
) -> Vec<Region<'c>> {
    let calls = context.calls(instruction);
    let in_force: Vec<_> =
        calls.iter().map(|(place, ..)| context.flow.in_force(*place, instruction)).collect();
    let value_of = |(place, _, call): &(Place, &Stmt, &Call)| percent(context, place.0, call);
    let values: Vec<Option<f64>> = calls.iter().map(value_of).collect();
    let mut regions = Vec::new();
    for (index, (place, stmt, call)) in calls.iter().enumerate() {
        let Some(value) = values[index].filter(|value| *value > 0.0 && *value < 100.0) else {
            continue;
        };
        // Lines between a setting and the one that ends it are a process with its own setting.
        let raises = |end: &Place| {
            let ending = calls.iter().position(|(other, ..)| other == end);
            ending.and_then(|ending| values[ending]).is_some_and(|other| other > value)
        };
        let reach = &in_force[index];
        let brackets = !reach.runs_out
            && reach.ends.iter().all(|end| end == place || raises(end))
            && reach.ends.iter().any(raises);
        let others = || in_force.iter().enumerate().filter(move |(other, _)| *other != index);
        let own = context.sites.iter().enumerate().filter(|(site, it)| {
            !it.executions.is_empty()
                && reach.movements.contains(&it.place)
                && others().all(|(_, other)| !other.movements.contains(&it.place))
                && context.always(*site, |settings| is_set(settings, value))
        });
        let (free, spared): (Vec<usize>, Vec<usize>) =
            own.map(|(site, _)| site).partition(|site| {
                let site_of = &context.sites[*site];
                !(context.is_process(*site) || brackets && site_of.is_linear())
            });
        if !free.is_empty() {
            let spares = !spared.is_empty();
            regions.push(Region { stmt, call, value, free, spares });
        }
    }
    regions
}
