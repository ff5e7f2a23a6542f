//! The search for the programmed speeds of least energy.

use super::cycle_time::cycle;
use super::files::{OutputFile, Source, read_again, with_edits};
use super::job::Job;
use super::order::same_order;
use super::read::read_program;
use super::settings::{Budget, Objective};
use super::simulated::{Simulated, TIME_TOLERANCE};
use super::speed_slots::Slot;
use crate::retime::energy::EnergyParts;
use crate::retime::motion::simulate;
use crate::retime::optimize::convex_curve::EnergyCurve;

/// Grid of factors on the programmed speeds.
const FACTORS: [f64; 18] =
    [0.03, 0.05, 0.08, 0.12, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.15, 1.4, 1.8, 2.5, 4.0];
/// Number of bisections of a factor.
const HALVINGS: usize = 6;
/// Factors this close to 1 count as 1.
const UNCHANGED: f64 = 2e-3;

/// The factors of least energy, and the program files with them. `progress` receives the number of
/// finished rounds and the total.
pub(super) fn search(
    job: &Job<'_>,
    slots: &[Slot],
    progress: &dyn Fn(usize, usize),
) -> Option<(Vec<f64>, Vec<OutputFile>)> {
    let done = |round: usize| progress(round, FACTORS.len() + HALVINGS + 1);
    if slots.is_empty() {
        return None;
    }
    let mut known: Vec<Vec<(f64, f64, f64)>> = vec![Vec::new(); slots.len()];
    for (round, factor) in FACTORS.iter().enumerate() {
        done(round + 1);
        // A slow cycle may be too long for the simulation.
        let factors = vec![*factor; slots.len()];
        let Some(tried) = try_speeds(job, slots, &factors) else { continue };
        for (slot, list) in slots.iter().zip(&mut known) {
            let (time, energy) = mean(slot, &tried);
            list.push((*factor, time, energy));
        }
    }
    if known.iter().any(Vec::is_empty) {
        return None;
    }
    let times = times(job, slots, &known)?;
    // The slowest factor that fits the time, and the next slower one, which does not.
    let mut fits: Vec<f64> = Vec::new();
    let mut slower: Vec<Option<f64>> = Vec::new();
    for (list, time) in known.iter().zip(&times) {
        let first = list.iter().position(|(_, t, _)| *t <= time + TIME_TOLERANCE);
        let first = first.unwrap_or(list.len() - 1);
        fits.push(list[first].0);
        slower.push(first.checked_sub(1).map(|i| list[i].0));
    }
    for round in 0..HALVINGS {
        let middle: Vec<f64> = fits
            .iter()
            .zip(&slower)
            .map(|(fit, slower)| slower.map_or(*fit, |slower| f64::midpoint(*fit, slower)))
            .collect();
        let tried = try_speeds(job, slots, &middle)?;
        for (i, slot) in slots.iter().enumerate() {
            let (time, _) = mean(slot, &tried);
            if time <= times[i] + TIME_TOLERANCE {
                fits[i] = middle[i];
            } else {
                slower[i] = Some(middle[i]);
            }
        }
        done(FACTORS.len() + round + 1);
    }
    for factor in &mut fits {
        if (*factor - 1.0).abs() < UNCHANGED {
            *factor = 1.0;
        }
    }
    let outputs = with_speeds(job.original.files, slots, &fits)?;
    done(FACTORS.len() + HALVINGS + 1);
    Some((fits, outputs))
}

/// The time goal of each slot, s.
fn times(job: &Job<'_>, slots: &[Slot], known: &[Vec<(f64, f64, f64)>]) -> Option<Vec<f64>> {
    let settings = &job.settings;
    if settings.objective == Objective::Time {
        let least = |list: &Vec<(f64, f64, f64)>| list.iter().map(|k| k.1).fold(f64::MAX, f64::min);
        return Some(known.iter().map(least).collect());
    }
    let time_at_1 =
        |list: &Vec<(f64, f64, f64)>| list.iter().find(|k| k.0 == 1.0).map_or(0.0, |k| k.1);
    let takt = match settings.budget {
        Budget::Factor(x) => return Some(known.iter().map(|list| x * time_at_1(list)).collect()),
        Budget::AsBefore => job.original.cycle.simulation.cycle_s,
        Budget::Takt(takt) => takt,
    };
    let runs: Vec<&[usize]> = slots.iter().map(|slot| slot.events.as_slice()).collect();
    let cycle = cycle(&job.original, job.aim(), settings, &runs, takt);
    let curves: Option<Vec<EnergyCurve>> = known
        .iter()
        .map(|list| {
            EnergyCurve::new(list.iter().map(|(_, time, energy)| (*time, *energy)).collect())
        })
        .collect();
    cycle.share(&curves?)
}

/// Mean time (s) and motion energy (J) of an execution of a slot.
fn mean(slot: &Slot, tried: &Simulated) -> (f64, f64) {
    let n = slot.events.len().max(1) as f64;
    let time: f64 = slot.events.iter().map(|event| tried.simulation.events[*event].duration).sum();
    let parts = slot.events.iter().flat_map(|event| &tried.account.events[*event]);
    (time / n, parts.map(EnergyParts::motion_energy_j).sum::<f64>() / n)
}

/// The cycle with these factors; `None` if its order of events differs.
fn try_speeds(job: &Job<'_>, slots: &[Slot], factors: &[f64]) -> Option<Simulated> {
    let outputs = with_speeds(job.original.files, slots, factors)?;
    let settings = &job.settings;
    let (program, entry) = read_program(&read_again(&outputs), &settings.entry).ok()?;
    let simulation = simulate(&program, entry, job.aim(), &settings.options);
    same_order(&job.original.cycle.simulation, &simulation)
        .then(|| Simulated::with_energy(job.aim(), simulation))
}

/// The files of the program with these factors.
fn with_speeds(files: &[Source], slots: &[Slot], factors: &[f64]) -> Option<Vec<OutputFile>> {
    let edits = slots.iter().zip(factors).flat_map(|(slot, factor)| slot.edits(*factor));
    with_edits(files, edits)
}
