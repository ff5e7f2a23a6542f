//! What one cycle of both programs takes, by procedure.

use std::collections::{BTreeMap, BTreeSet};

use crate::arm::robot::Model;
use crate::rapid::ir::program::Program;
use crate::retime::energy::account;
use crate::retime::energy::plausible::{Interval, Robots};
use crate::retime::energy::{Account, EnergyParts};
use crate::retime::motion::timeline::What;
use crate::retime::motion::{Options, Simulation, simulate};

/// Time and energy.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Costs {
    /// s.
    pub time_s: f64,
    /// J; `None` for a robot without dynamics.
    pub energy_j: Option<f64>,
}

/// The cycles of two programs.
#[derive(Clone, Debug, PartialEq)]
pub struct Cycle {
    /// The task; empty without one.
    pub task: String,
    /// The procedures of both cycles and those with changes, by name.
    pub procedures: Vec<Procedure>,
    /// The whole cycles.
    pub totals: Totals,
}

/// A procedure in both cycles.
#[derive(Clone, Debug, PartialEq)]
pub struct Procedure {
    /// Its new name if it has one.
    pub name: String,
    /// In the old cycle; `None` if it is not executed or nothing could be simulated.
    pub old: Option<Costs>,
    /// In the new cycle.
    pub new: Option<Costs>,
    /// Why a side has no figures.
    pub reason: Option<String>,
}

/// Two whole cycles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Totals {
    /// The old cycle.
    pub old: Option<Costs>,
    /// The new cycle.
    pub new: Option<Costs>,
    /// Why a side has no figures.
    pub reason: Option<String>,
    /// 90 % of the plausible robots: change of the energy, J; `None` if all its numbers are known.
    pub energy_interval_j: Option<[f64; 2]>,
    /// Statements that could not be simulated, old and new.
    pub unresolved: [usize; 2],
}

/// One program that was run.
pub(super) struct Run {
    simulation: Simulation,
    account: Account,
    /// By name in lower case, with the name as written.
    procedures: BTreeMap<String, (String, Costs)>,
}

/// Runs a program, or says why it cannot be run.
pub(super) fn run(
    program: &Program,
    entry: &str,
    model: &Model,
    options: &Options,
) -> Result<Run, String> {
    let id = program.entry(entry).ok_or_else(|| {
        let why = if program.clash(entry).is_some() { "more than one" } else { "no" };
        format!("{why} procedure '{entry}' that starts a program (--entry NAME)")
    })?;
    let simulation = simulate(program, id, model, options);
    let account = account(model, &simulation);
    let known = model.has_dynamics();
    let mut procedures: BTreeMap<String, (String, Costs)> = BTreeMap::new();
    let mut add = |routine: &str, time_s: f64, parts: &EnergyParts| {
        let new = || (routine.to_owned(), Costs { time_s: 0.0, energy_j: known.then_some(0.0) });
        let (_, costs) = procedures.entry(routine.to_lowercase()).or_insert_with(new);
        costs.time_s += time_s;
        costs.energy_j = costs.energy_j.map(|energy| energy + parts.energy_j());
    };
    for (event, parts) in simulation.events.iter().zip(&account.events) {
        match &event.what {
            What::Run(run) => {
                for (record, parts) in run.moves.iter().zip(parts) {
                    add(&record.movement.routine, record.duration, parts);
                }
            }
            What::Wait(record) => {
                let parts = parts.first().copied().unwrap_or_default();
                add(&record.wait.routine, event.duration, &parts);
            }
            What::Output(..) | What::Left(_) => {}
        }
    }
    Ok(Run { simulation, account, procedures })
}

impl Run {
    fn costs(&self, model: &Model) -> Costs {
        let energy = self.account.total.energy_j();
        let energy_j = (model.has_dynamics() && energy.is_finite()).then_some(energy);
        Costs { time_s: self.simulation.cycle_s, energy_j }
    }
}

/// Sides of a comparison for [`cycle`].
pub(super) struct Runs<'a> {
    pub(super) task: &'a str,
    /// Old and new.
    pub(super) both: [&'a Result<Run, String>; 2],
    /// New names of routines by their old ones, in lower case.
    pub(super) renamed: &'a BTreeMap<String, String>,
    /// Routines with changes.
    pub(super) changed: &'a BTreeSet<String>,
    /// The robot; `None` with the reason in `both`.
    pub(super) model: Option<&'a Model>,
    /// Draws of plausible robots, if intervals are asked for.
    pub(super) robots: Option<&'a Robots>,
}

/// Compares two cycles.
pub(super) fn cycle(of: &Runs<'_>) -> Cycle {
    let [old, new] = of.both.map(|run| run.as_ref().ok());
    let mut rows: BTreeMap<String, Procedure> = BTreeMap::new();
    let empty =
        |name: &str| Procedure { name: name.to_owned(), old: None, new: None, reason: None };
    for name in of.changed {
        rows.insert(name.to_lowercase(), empty(name));
    }
    for (key, (name, costs)) in old.iter().flat_map(|run| &run.procedures) {
        let key = of.renamed.get(key).unwrap_or(key);
        rows.entry(key.clone()).or_insert_with(|| empty(name)).old = Some(*costs);
    }
    for (key, (name, costs)) in new.iter().flat_map(|run| &run.procedures) {
        let row = rows.entry(key.clone()).or_insert_with(|| empty(name));
        row.new = Some(*costs);
        row.name.clone_from(name);
    }
    let reason = reason(&of.both);
    for row in rows.values_mut() {
        row.reason = match (&reason, row.old, row.new) {
            (Some(reason), ..) => Some(reason.clone()),
            (None, Some(_), Some(_)) => None,
            (None, Some(_), None) => Some("not executed in the new cycle".to_owned()),
            (None, None, Some(_)) => Some("not executed in the old cycle".to_owned()),
            (None, None, None) => {
                Some("without movements and waits of its own in both cycles".to_owned())
            }
        };
    }
    let costs = |run: Option<&Run>| Some(run?.costs(of.model?));
    let totals = Totals {
        old: costs(old),
        new: costs(new),
        reason,
        energy_interval_j: old.zip(new).and_then(|(old, new)| interval(of, old, new)),
        unresolved: [old, new].map(|run| run.map_or(0, |run| run.simulation.unresolved.len())),
    };
    Cycle { task: of.task.to_owned(), procedures: rows.into_values().collect(), totals }
}

/// Why a side could not be run.
fn reason(runs: &[&Result<Run, String>; 2]) -> Option<String> {
    match runs.map(|run| run.as_ref().err()) {
        [None, None] => None,
        [Some(old), Some(new)] if old == new => Some(old.clone()),
        [old, new] => {
            let sides = [("old", old), ("new", new)];
            let told = sides.iter().filter_map(|(side, why)| Some(format!("{side}: {}", (*why)?)));
            Some(told.collect::<Vec<_>>().join("; "))
        }
    }
}

/// The change of the energy in 90 % of the plausible robots, J.
fn interval(of: &Runs<'_>, old: &Run, new: &Run) -> Option<[f64; 2]> {
    let (model, robots) = (of.model?, of.robots?);
    let energies = |run: &Run| robots.energies(model, &run.simulation, run.account.total);
    let differences: Vec<f64> = energies(old)
        .iter()
        .zip(energies(new))
        .map(|(old, new)| new.energy_j() - old.energy_j())
        .collect();
    let Interval { low, high, .. } = Interval::from_values(&differences);
    (low.is_finite() && high.is_finite()).then_some([low, high])
}
