//! The suggestions of a program, and what they do together.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::change::{changed, edited};
use super::lever::{Lever, Offer, Offers};
use super::levers::levers;
use super::search::{Tried, ordered, shifted};
use super::swept::Swept;
use crate::rapid::text::{Edit, SourceFile, Span};
use crate::retime::energy::EnergyParts;
use crate::retime::energy::plausible::{Interval, Robots};
use crate::retime::motion::Simulation;
use crate::tool::lint::context::Context;
use crate::tool::lint::evaluate::Cycle;
use crate::tool::lint::known::Known;
use crate::tool::lint::process::Kept;
use crate::tool::lint::{Group, Job, Settings, lint};
use crate::tool::retrofit::{Cell, RetrofitError, Simulated, Source, read_program};

/// Least saving of a suggestion, of the energy of the cycle.
const LEAST: f64 = 5e-4;

/// A change that a person has to approve.
#[derive(Clone, Debug)]
pub struct Suggestion {
    /// The place.
    pub span: Span,
    /// The change in words.
    pub title: String,
    /// What may go wrong.
    pub risk: &'static str,
    /// The change of the text.
    pub edits: Vec<Edit>,
    /// Saved energy of a cycle.
    pub saved: EnergyParts,
    /// The same over plausible robots, J; `None` where all is known.
    pub saved_j: Option<Interval>,
    /// Saved time of a cycle, s.
    pub time_s: f64,
    /// How far arm or tool leave the space that they sweep today, m, at most.
    pub leaves_m: f64,
    kept: Kept,
}

/// The suggestions of a program, and its cycle.
pub struct Suggestions {
    /// Those that save most first.
    pub all: Vec<Suggestion>,
    /// Energy of the cycle.
    pub energy: EnergyParts,
    /// Duration of the cycle, s.
    pub cycle_s: f64,
    /// What is wrong with marks of the user.
    pub notes: Vec<String>,
    simulation: Simulation,
}

/// Suggestions that are made together.
pub struct Applied {
    /// Their numbers, from 0.
    pub taken: Vec<usize>,
    /// Those that save nothing beside the others, or change the same text.
    pub left: Vec<usize>,
    /// The changed files.
    pub files: Vec<Source>,
    /// Energy of the cycle: before, after.
    pub energy: [EnergyParts; 2],
    /// Duration of the cycle: before, after, s.
    pub cycle_s: [f64; 2],
}

/// The suggestions of a program. `progress` receives the number of finished places and the total.
///
/// # Errors
/// The program cannot be read.
pub fn suggestions(
    cell: Cell<'_>,
    point_estimate: bool,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Suggestions, RetrofitError> {
    let known = Known::new(cell.model);
    let options = known.options(cell.options);
    let cell = Cell { options: &options, ..cell };
    let (program, _) = read_program(cell.files, cell.entry)?;
    let files: Vec<SourceFile> = cell.files.iter().map(|source| source.file.clone()).collect();
    let group =
        Group { files: (0..files.len()).collect(), entry: cell.entry.to_owned(), system: None };
    let settings = Settings::default();
    let found = lint(&Job {
        files: &files,
        groups: vec![group.clone()],
        model: Some(cell.model),
        options: cell.options.clone(),
        settings: &settings,
    });
    let Simulated { simulation, account } = cell.simulated()?;
    let cycle = Cycle::new(simulation, account, cell.options, &known);
    let context = Context::new(&files, Some(cell.model), &program, &group, Some(&cycle), None);
    let (levers, notes) = levers(&context, &found.findings);
    let swept = Swept::new(cell.model, &cycle.simulation);
    let robots = if point_estimate { None } else { Robots::new(cell.model) };
    let energies = |simulation: &Simulation, total: EnergyParts| {
        let of = robots.as_ref()?.energies(cell.model, simulation, total);
        Some(of.iter().map(EnergyParts::energy_j).collect::<Vec<f64>>())
    };
    let was = energies(&cycle.simulation, cycle.account.total);
    let done = AtomicUsize::new(0);
    let suggestion = |lever: &Lever| {
        let best = best_offer(cell, &cycle, lever);
        progress(done.fetch_add(1, Ordering::Relaxed) + 1, levers.len());
        let (offer, after) = best?;
        let is = energies(&after.simulation, after.account.total);
        let saved_j = was.as_ref().zip(is).map(|(was, is)| {
            let saved: Vec<f64> = was.iter().zip(is).map(|(was, is)| was - is).collect();
            Interval::from_values(&saved)
        });
        Some(Suggestion {
            span: lever.span,
            title: offer.title,
            risk: lever.risk,
            edits: offer.edits,
            saved: cycle.account.total + after.account.total * -1.0,
            saved_j,
            time_s: cycle.simulation.cycle_s - after.simulation.cycle_s,
            leaves_m: swept.left_by(cell.model, &after.simulation),
            kept: lever.kept,
        })
    };
    let mut all: Vec<Suggestion> = levers.par_iter().filter_map(suggestion).collect();
    all.sort_by(|a, b| b.saved.energy_j().total_cmp(&a.saved.energy_j()));
    Ok(Suggestions {
        all,
        energy: cycle.account.total,
        cycle_s: cycle.simulation.cycle_s,
        notes,
        simulation: cycle.simulation,
    })
}

impl Suggestions {
    /// Applies suggestions by their numbers, from 0: in their order, as long as each saves energy beside
    /// those before it.
    #[must_use]
    pub fn applied(&self, cell: Cell<'_>, numbers: &[usize]) -> Applied {
        let (mut energy, mut cycle_s) = (self.energy, self.cycle_s);
        let (mut taken, mut left) = (Vec::new(), Vec::new());
        let mut edits: Vec<Edit> = Vec::new();
        // What one of them moves is not at its place for the others.
        let mut kept = Kept::Outputs;
        let mut order = numbers.to_vec();
        order.sort_unstable();
        order.dedup();
        for number in order {
            let Some(next) = self.all.get(number) else { continue };
            let with: Vec<Edit> = edits.iter().chain(&next.edits).cloned().collect();
            let least = kept.min(next.kept);
            let after = changed(cell, &self.simulation, &with, least);
            match after.filter(|after| after.account.total.energy_j() < energy.energy_j()) {
                Some(after) => {
                    (energy, cycle_s) = (after.account.total, after.simulation.cycle_s);
                    (edits, kept) = (with, least);
                    taken.push(number);
                }
                None => left.push(number),
            }
        }
        Applied {
            taken,
            left,
            files: edited(cell, &edits).unwrap_or_else(|| cell.files.to_vec()),
            energy: [self.energy, energy],
            cycle_s: [self.cycle_s, cycle_s],
        }
    }
}

/// The offer of a lever that saves most, and its cycle; `None` if none saves enough.
fn best_offer(cell: Cell<'_>, before: &Cycle, lever: &Lever) -> Option<Tried> {
    let energy = |of: &Simulated| of.account.total.energy_j();
    let least = (1.0 - LEAST) * before.account.total.energy_j();
    let after = |offer: Offer| {
        let after = changed(cell, &before.simulation, &offer.edits, lever.kept)?;
        Some((offer, after))
    };
    let best = match &lever.offers {
        Offers::List(offers) => {
            let all = offers.iter().cloned().filter_map(after);
            all.min_by(|(_, a), (_, b)| energy(a).total_cmp(&energy(b)))
        }
        Offers::Shift(shift) => shifted(shift, before.account.total.energy_j(), &after),
        Offers::Order(visits) => ordered(visits, before.account.total.energy_j(), &after),
    };
    best.filter(|(_, after)| energy(after) < least)
}
