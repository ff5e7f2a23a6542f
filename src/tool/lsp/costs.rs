//! Time and energy of a statement.

use std::fmt;

use super::findings::Analysis;
use crate::rapid::text::Span;
use crate::retime::energy::EnergyParts;
use crate::retime::motion::timeline::What;

/// Costs of a statement in a cycle.
pub(super) struct Costs {
    pub(super) span: Span,
    what: String,
    times: usize,
    time_s: f64,
    /// `None` for robots without dynamics.
    energy_j: Option<f64>,
}

impl fmt::Display for Costs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "**{}**: ", self.what)?;
        if let Some(joules) = self.energy_j {
            write!(f, "{joules:.1} J, ")?;
        }
        write!(f, "{:.3} s", self.time_s)?;
        match self.times {
            1 => Ok(()),
            times => write!(f, ", {times} times a cycle together"),
        }
    }
}

/// The costs of the movement or wait at a byte, summed over its executions.
pub(super) fn costs_at(analysis: &Analysis, at: u32) -> Option<Costs> {
    let mut found: Option<Costs> = None;
    for cycle in analysis.examined.cycles.iter().flatten() {
        for (event, parts) in cycle.simulation.events.iter().zip(&cycle.account.events) {
            let mut add = |span: Span, what: &str, time_s: f64, joules: f64| {
                let here = span.file == analysis.file.id && span.start <= at && at <= span.end;
                if !here {
                    return;
                }
                let energy_j = analysis.dynamics.then_some(0.0);
                let what = what.to_owned();
                let costs =
                    found.get_or_insert(Costs { span, what, times: 0, time_s: 0.0, energy_j });
                costs.times += 1;
                costs.time_s += time_s;
                costs.energy_j = costs.energy_j.map(|sum| sum + joules);
            };
            match &event.what {
                What::Run(run) => {
                    for (record, part) in run.moves.iter().zip(parts) {
                        let movement = &record.movement;
                        add(movement.span, &movement.instruction, record.duration, part.energy_j());
                    }
                }
                What::Wait(wait) => {
                    let joules = parts.iter().map(EnergyParts::energy_j).sum();
                    add(wait.wait.span, &wait.wait.instruction, event.duration, joules);
                }
                What::Output(..) | What::Left(_) => {}
            }
        }
    }
    found
}
