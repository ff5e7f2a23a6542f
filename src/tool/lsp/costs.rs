//! Time and energy of statements, routines and calls in a cycle.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::sync::Arc;

use super::findings::Analysis;
use crate::rapid::ir::movement::{ActiveCall, calls};
use crate::rapid::text::Span;
use crate::retime::energy::EnergyParts;
use crate::retime::motion::timeline::What;

/// Time and energy of some executed statements.
#[derive(Clone, Copy, Debug)]
pub(super) struct Costs {
    times: usize,
    time_s: f64,
    /// `None` for robots without dynamics.
    energy_j: Option<f64>,
}

impl Costs {
    fn add(&mut self, more: Costs) {
        self.times += more.times;
        self.time_s += more.time_s;
        self.energy_j = self.energy_j.zip(more.energy_j).map(|(sum, more)| sum + more);
    }
}

impl fmt::Display for Costs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(joules) = self.energy_j {
            write!(f, "{joules:.1} J, ")?;
        }
        write!(f, "{:.3} s", self.time_s)
    }
}

/// The costs of a movement or wait.
pub(super) struct StatementCosts {
    pub(super) span: Span,
    /// As written.
    instruction: Arc<str>,
    pub(super) costs: Costs,
}

impl fmt::Display for StatementCosts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "**{}**: {}", self.instruction, self.costs)?;
        match self.costs.times {
            1 => Ok(()),
            times => write!(f, ", {times} times a cycle together"),
        }
    }
}

/// The movements and waits of a document, in order of the text.
pub(super) fn of_statements(analysis: &Analysis) -> Vec<StatementCosts> {
    let mut all: BTreeMap<Span, StatementCosts> = BTreeMap::new();
    executions(analysis, |done| {
        let Execution { span, instruction, costs, .. } = done;
        if span.file == analysis.file.id {
            match all.entry(span) {
                Entry::Occupied(mut one) => one.get_mut().costs.add(costs),
                Entry::Vacant(place) => {
                    let instruction = instruction.clone();
                    place.insert(StatementCosts { span, instruction, costs });
                }
            }
        }
    });
    all.into_values().collect()
}

/// The movement or wait at a byte of a document.
pub(super) fn of_statement(analysis: &Analysis, at: u32) -> Option<StatementCosts> {
    of_statements(analysis).into_iter().find(|one| one.span.start <= at && at <= one.span.end)
}

/// What is executed inside parts of texts, or called from there; `None` where nothing is. The parts are in
/// order and do not overlap.
pub(super) fn of_parts(analysis: &Analysis, parts: &[Span]) -> Vec<Option<Costs>> {
    let part_of = |span: Span| {
        let before =
            parts.partition_point(|part| (part.file, part.start) <= (span.file, span.start));
        let part = before.checked_sub(1)?;
        (parts[part].file == span.file && span.end <= parts[part].end).then_some(part)
    };
    let mut sums: Vec<Option<Costs>> = vec![None; parts.len()];
    executions(analysis, |Execution { span, call, costs, .. }| {
        // A routine that calls itself counts once.
        let concerned: BTreeSet<usize> = calls(call).chain([span]).filter_map(part_of).collect();
        for part in concerned {
            match &mut sums[part] {
                Some(sum) => sum.add(costs),
                none => *none = Some(costs),
            }
        }
    });
    sums
}

/// The sum of some costs; `None` without any.
pub(super) fn sum(all: impl Iterator<Item = Costs>) -> Option<Costs> {
    all.reduce(|mut sum, more| {
        sum.add(more);
        sum
    })
}

/// A movement or wait, executed once.
struct Execution<'a> {
    span: Span,
    instruction: &'a Arc<str>,
    call: Option<&'a Arc<ActiveCall>>,
    costs: Costs,
}

/// Everything that the programs of a document execute.
fn executions<'a>(analysis: &'a Analysis, mut each: impl FnMut(Execution<'a>)) {
    let once = |time_s: f64, joules: f64| {
        let energy_j = analysis.dynamics.then_some(joules);
        Costs { times: 1, time_s, energy_j }
    };
    for cycle in analysis.examined.cycles.iter().flatten() {
        for (event, parts) in cycle.simulation.events.iter().zip(&cycle.account.events) {
            match &event.what {
                What::Run(run) => {
                    for (record, part) in run.moves.iter().zip(parts) {
                        let movement = &record.movement;
                        each(Execution {
                            span: movement.span,
                            instruction: &movement.instruction,
                            call: movement.call.as_ref(),
                            costs: once(record.duration, part.energy_j()),
                        });
                    }
                }
                What::Wait(record) => each(Execution {
                    span: record.wait.span,
                    instruction: &record.wait.instruction,
                    call: record.wait.call.as_ref(),
                    costs: once(event.duration, parts.iter().map(EnergyParts::energy_j).sum()),
                }),
                What::Output(..) | What::Left(_) => {}
            }
        }
    }
}
