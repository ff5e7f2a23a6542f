//! The suggestions of a program, and what they do together.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::cell::{Cell, Places};
use super::lever::{Lever, Offer, Offers, Shift};
use super::levers::levers;
use super::swept::Swept;
use crate::rapid::text::{Edit, SourceFile, Span};
use crate::retime::energy::EnergyParts;
use crate::retime::energy::plausible::{Interval, Robots, moments};
use crate::tool::lint::context::Context;
use crate::tool::lint::evaluate::Cycle;
use crate::tool::lint::{Group, Job, Settings, lint};
use crate::tool::retrofit::{RetrofitError, Simulated, Source, read_program};

/// Least saving of a suggestion, of the energy of the cycle.
const LEAST: f64 = 5e-4;
/// How often the step of a shift is halved.
const HALVINGS: usize = 2;
/// Most steps of one size.
const STEPS: usize = 6;

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
    places: Places,
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

/// The suggestions of a program, those that save most first. `progress` receives the number of finished
/// places and the total.
///
/// # Errors
/// The program cannot be read.
pub fn suggestions(
    cell: Cell<'_>,
    point_estimate: bool,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Vec<Suggestion>, RetrofitError> {
    let before = cell.cycle()?;
    let (program, _) = read_program(cell.files, cell.entry)?;
    let files: Vec<SourceFile> = cell.files.iter().map(|source| source.file.clone()).collect();
    let group =
        Group { files: (0..files.len()).collect(), entry: cell.entry.to_owned(), system: None };
    let settings = Settings::default();
    let findings = lint(&Job {
        files: &files,
        groups: vec![group.clone()],
        model: Some(cell.model),
        options: cell.options.clone(),
        settings: &settings,
    });
    let again = cell.cycle()?;
    let cycle = Cycle::new(cell.model, again.simulation, again.account, cell.options.clone());
    let context = Context::new(&files, Some(cell.model), &program, &group, Some(&cycle), None);
    let all = levers(&context, &findings.findings);
    let done = AtomicUsize::new(0);
    let swept = Swept::new(cell.model, &before.simulation);
    let robots = if point_estimate { None } else { Robots::new(cell.model) };
    let was = robots.as_ref().map(|robots| energies(cell, robots, &before));
    let mut found: Vec<Suggestion> = all
        .par_iter()
        .filter_map(|lever| {
            let best = best_offer(cell, &before, lever);
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, all.len());
            best.map(|(offer, after)| (lever, offer, after))
        })
        .map(|(lever, offer, after)| {
            let saved_j = robots.as_ref().zip(was.as_ref()).map(|(robots, was)| {
                let is = energies(cell, robots, &after);
                let saved: Vec<f64> = was.iter().zip(&is).map(|(was, is)| was - is).collect();
                Interval::from_values(&saved)
            });
            Suggestion {
                span: lever.span,
                title: offer.title,
                risk: lever.risk,
                edits: offer.edits,
                saved: before.account.total + after.account.total * -1.0,
                saved_j,
                time_s: before.simulation.cycle_s - after.simulation.cycle_s,
                leaves_m: swept.left_by(cell.model, &after.simulation),
                places: lever.places,
            }
        })
        .collect();
    found.sort_by(|a, b| b.saved.energy_j().total_cmp(&a.saved.energy_j()));
    Ok(found)
}

/// Applies suggestions in their order as long as each saves energy beside those before it.
///
/// # Errors
/// The program cannot be read.
pub fn applied(
    cell: Cell<'_>,
    all: &[Suggestion],
    numbers: &[usize],
) -> Result<Applied, RetrofitError> {
    let before = cell.cycle()?;
    let mut now: Option<Simulated> = None;
    let (mut taken, mut left): (Vec<usize>, Vec<usize>) = (Vec::new(), Vec::new());
    let mut edits: Vec<Edit> = Vec::new();
    let mut order = numbers.to_vec();
    order.sort_unstable();
    order.dedup();
    for number in order {
        let Some(next) = all.get(number) else { continue };
        let places = if taken.iter().chain([&number]).any(|n| moves_places(&all[*n])) {
            Places::Other
        } else {
            Places::Same
        };
        let with: Vec<Edit> = edits.iter().chain(&next.edits).cloned().collect();
        let least = now.as_ref().unwrap_or(&before).account.total.energy_j();
        let after = cell.after(&before, &with, places);
        match after.filter(|after| after.account.total.energy_j() < least) {
            Some(after) => {
                now = Some(after);
                edits = with;
                taken.push(number);
            }
            None => left.push(number),
        }
    }
    let files = cell.edited(&edits).unwrap_or_else(|| cell.files.to_vec());
    let after = now.as_ref().unwrap_or(&before);
    Ok(Applied {
        taken,
        left,
        files,
        energy: [before.account.total, after.account.total],
        cycle_s: [before.simulation.cycle_s, after.simulation.cycle_s],
    })
}

fn moves_places(of: &Suggestion) -> bool {
    of.places == Places::Other
}

/// Energy of a cycle over plausible robots, J.
fn energies(cell: Cell<'_>, robots: &Robots, cycle: &Simulated) -> Vec<f64> {
    let changes = robots.changes(cell.model, &moments(cell.model, &cycle.simulation));
    changes.iter().map(|change| cycle.account.total.energy_j() + change.energy_j()).collect()
}

/// The offer of a lever that saves most, and its cycle; `None` if none saves enough.
fn best_offer(cell: Cell<'_>, before: &Simulated, lever: &Lever) -> Option<(Offer, Simulated)> {
    let energy = |of: &Simulated| of.account.total.energy_j();
    let least = (1.0 - LEAST) * energy(before);
    let best = match &lever.offers {
        Offers::List(offers) => offers
            .iter()
            .filter_map(|offer| {
                Some((offer.clone(), cell.after(before, &offer.edits, lever.places)?))
            })
            .min_by(|(_, a), (_, b)| energy(a).total_cmp(&energy(b))),
        Offers::Shift(shift) => shifted(cell, before, lever, shift),
    };
    best.filter(|(_, after)| energy(after) <= least)
}

/// The best shift of a point by a pattern search along its axes (R. Hooke, T. Jeeves, J. ACM 8, 1961).
fn shifted(
    cell: Cell<'_>,
    before: &Simulated,
    lever: &Lever,
    shift: &Shift,
) -> Option<(Offer, Simulated)> {
    let mut at = vec![0.0; shift.dimension()];
    let mut best: Option<(Offer, Simulated)> = None;
    let mut least = before.account.total.energy_j();
    let mut step = shift.step;
    for _ in 0..=HALVINGS {
        for _ in 0..STEPS {
            let start = least;
            for axis in 0..at.len() {
                for by in [step, -step] {
                    let mut next = at.clone();
                    next[axis] += by;
                    if next[axis].abs() > shift.most {
                        continue;
                    }
                    let offer = shift.offer(&next);
                    let Some(after) = cell.after(before, &offer.edits, lever.places) else {
                        continue;
                    };
                    let energy = after.account.total.energy_j();
                    if energy < least {
                        (least, at, best) = (energy, next, Some((offer, after)));
                        break;
                    }
                }
            }
            if least >= start {
                break;
            }
        }
        step *= 0.5;
    }
    best
}
