//! The whole way from logs to a verdict.

use super::blocks::{block_length, long_run_variance};
use super::doubt::{Doubt, Turned, drift, meter, other_work, step};
use super::error::ProveError;
use super::estimate::{Estimate, estimate};
use super::interval::uncertainty;
use super::mixture::swapped;
use super::outliers::{kept, median};
use super::plan::{FEWEST, needed};
use super::points::{points, prior};
use super::proof::{Estimated, Plan, Proof, Settings, Verdict};
use super::rest::Level;
use super::series::{Measure, measure};
use super::side::{PowerLog, Side};
use super::stamp::seconds;
use super::strata::{Common, common};
use super::summary::{adjustments, cycle_time, rest_means, strata};
use super::unit::{LeftOut, Period, Unit};
use super::units::{Measured, measured};
use super::waiting::Waiting;

/// The effects of the power analysis.
const EFFECTS: [f64; 6] = [0.01, 0.02, 0.03, 0.05, 0.08, 0.1];
/// Largest ratio of the periods that the power alone shows, and of the mean powers.
const PERIODS: f64 = 1.5;
const LEVELS: f64 = 3.0;
/// What the logs of two periods show.
///
/// # Errors
/// The logs cannot be used, or have nothing in common.
pub fn prove(before: &Side, after: &Side, settings: Settings) -> Result<Proof, ProveError> {
    let sides = [before, after];
    for (a, b) in before.logs.iter().flat_map(|a| after.logs.iter().map(move |b| (a, b))) {
        if a.log == b.log {
            return Err(ProveError::Same { file: b.shown.clone(), other: a.shown.clone() });
        }
    }
    for side in sides {
        side.check()?;
    }
    let programs = [before.program()?, after.program()?];
    let logs: Vec<&PowerLog> = before.logs.iter().chain(&after.logs).collect();
    let measure = measure(&logs)?;
    let mut measured =
        [measured(before, Period::Before, measure)?, measured(after, Period::After, measure)?];
    check_levels(&measured)?;
    let standing_w = rest(&mut measured, measure);
    let is_by_power = measured.iter().any(|side| side.by_power);
    let turned = if is_by_power { Turned::Anyhow } else { Turned::Alike };
    let mut notes = notes(sides, &programs);
    let [from_before, from_after] = measured;
    let mut left_out = [from_before.left_out, from_after.left_out].concat();
    notes.extend([from_before.notes, from_after.notes].concat());
    let found = common([from_before.units, from_after.units])?;
    let Common { names, sides: units, left_out: strange, notes: of_kinds } = found;
    left_out.extend(strange);
    notes.extend(of_kinds);
    let (keep, faults) = kept(&units, names.len());
    let all = points(&units).0;
    let with_faults = estimate([&all[0], &all[1]], names.len(), prior(measure, standing_w, &all));
    let has_faults = !faults.is_empty();
    left_out.extend(faults);
    let units = filtered(units, &keep);
    let (points, said) = points(&units);
    notes.extend(said);
    let sizes = [points[0].len(), points[1].len()];
    let prior = prior(measure, standing_w, &points);
    let slices = [points[0].as_slice(), points[1].as_slice()];
    let of = estimate(slices, names.len(), prior).ok_or_else(|| ProveError::NoCycles {
        file: "--before and --after".to_owned(),
        why: " that is no fault".to_owned(),
    })?;
    let is_enough = sizes.iter().all(|n| *n >= FEWEST);
    let uncertain = is_enough.then(|| uncertainty(slices, names.len(), prior, &of));
    let doubts = doubts(&of, &units, apart(sides, &units), turned);
    let statistical = uncertain.as_ref().map(|of| of.interval);
    let interval = statistical.map(|interval| widened(interval, &doubts));
    let long_run = uncertain.as_ref().map_or_else(
        || (0..2).map(|side| long_run_variance(&of.influence[side], 1)).sum::<f64>() * 0.5,
        |of| 0.5 * of.long_run.iter().sum::<f64>(),
    );
    let needed_for = |effect: f64| needed(effect, long_run);
    let needed_now = needed_for(settings.effect.max(of.saving.abs()).min(0.9));
    let verdict = verdict(interval, sizes, needed_now);
    Ok(Proof {
        verdict,
        saving: Estimated { value: of.saving, interval },
        standard_error: uncertain.as_ref().map(|of| of.error),
        statistical,
        raw_saving: of.raw,
        saving_with_faults: with_faults.filter(|_| has_faults).map(|of| of.saving),
        cycle: cycle_time(&of, uncertain.as_ref()),
        energy_j: of.energy,
        cycles: sizes,
        needed: needed_now,
        measure,
        rest_w: rest_means(&units),
        adjustments: adjustments(&of, measure),
        strata: strata(&names, &units, &of),
        blocks: uncertain.as_ref().map_or([1, 1], |of| of.blocks),
        plan: EFFECTS.into_iter().map(|effect| (effect, needed_for(effect))).collect(),
        energies: [0, 1].map(|side| {
            of.residual[side].iter().map(|y| of.energy[side] + y * of.energy[0]).collect()
        }),
        doubts,
        left_out,
        programs,
        notes,
        settings,
    })
}

/// The power analysis from the logs of one period.
///
/// # Errors
/// The logs cannot be used.
pub fn plan(before: &Side, settings: Settings) -> Result<Plan, ProveError> {
    before.check()?;
    before.program()?;
    let logs: Vec<&PowerLog> = before.logs.iter().collect();
    let measure = measure(&logs)?;
    let mut side = [measured(before, Period::Before, measure)?];
    let standing_w = rest(&mut side, measure);
    let [side] = side;
    let twice = [side.units.clone(), side.units];
    let found = common(twice)?;
    let (keep, faults) = kept(&found.sides, found.names.len());
    let units = filtered(found.sides, &keep);
    let (points, said) = points(&units);
    let prior = prior(measure, standing_w, &points);
    let slices = [points[0].as_slice(), points[1].as_slice()];
    let of = estimate(slices, found.names.len(), prior).ok_or_else(|| ProveError::NoCycles {
        file: "--before".to_owned(),
        why: " that is no fault".to_owned(),
    })?;
    let influence = &of.influence[1];
    let long_run = long_run_variance(influence, block_length(influence));
    let squares: f64 = of.residual[0].iter().map(|y| y * y).sum();
    let is_first = |left: &LeftOut| left.period == Period::Before;
    let others = found.left_out.into_iter().chain(faults).filter(is_first);
    Ok(Plan {
        cycles: points[0].len(),
        energy_j: of.energy[0],
        duration_s: of.duration[0],
        deviation: (squares / (points[0].len() as f64 - 1.0).max(1.0)).sqrt(),
        needed: needed(settings.effect, long_run),
        plan: EFFECTS.into_iter().map(|effect| (effect, needed(effect, long_run))).collect(),
        measure,
        left_out: side.left_out.into_iter().chain(others).collect(),
        notes: side.notes.into_iter().chain(said).collect(),
        settings,
    })
}

/// Refuses sides that are not of one work or of one unit.
fn check_levels(sides: &[Measured; 2]) -> Result<(), ProveError> {
    let durations = [0, 1].map(|side: usize| {
        median(&sides[side].units.iter().map(|unit| unit.duration_s).collect::<Vec<f64>>())
    });
    let ratio = durations[1] / durations[0];
    let file = || sides[1].units[0].file.clone();
    let is_by_power = sides.iter().any(|side| side.by_power);
    if is_by_power && !(PERIODS.recip()..=PERIODS).contains(&ratio) {
        let [before_s, after_s] = durations;
        return Err(ProveError::Periods { file: file(), before_s, after_s });
    }
    let powers = [0, 1].map(|side: usize| {
        let units = &sides[side].units;
        let energy: f64 = units.iter().map(|unit| unit.energy_j).sum();
        energy / units.iter().map(|unit| unit.duration_s).sum::<f64>()
    });
    let factor = powers[1] / powers[0];
    if !(LEVELS.recip()..=LEVELS).contains(&factor) {
        return Err(ProveError::Level { file: file(), factor });
    }
    Ok(())
}

/// Fills in what the cycles of the sides rest; the mean power while the robot waits, W.
fn rest(sides: &mut [Measured], measure: Measure) -> Option<f64> {
    let with_events = sides.iter().all(|side| side.has_events);
    let first = sides.first().and_then(|side| side.level);
    let levels = first.zip(sides.last().and_then(|side| side.level));
    let levels = levels.map(|(before, after)| Level::common([before, after]));
    for (index, side) in sides.iter_mut().enumerate() {
        side.rest(levels.map(|levels| levels[index]), with_events);
    }
    let is_cabinet = measure == Measure::Cabinet;
    let waiting = match sides {
        [before, others @ ..] if with_events && is_cabinet => {
            Waiting::of(before.cycles(), others.iter().flat_map(Measured::cycles))
        }
        _ => None,
    };
    for side in sides.iter_mut() {
        match &waiting {
            Some(waiting) => side.wait(waiting),
            None => side.units.iter_mut().for_each(|unit| unit.waiting_s = unit.rest_s),
        }
    }
    let mean = |[before, after]: [Level; 2]| 0.5 * (before.power_w + after.power_w);
    waiting.map(|of| of.mean_w).or(levels.map(mean))
}

fn filtered(sides: [Vec<(usize, Unit)>; 2], keep: &[Vec<bool>; 2]) -> [Vec<(usize, Unit)>; 2] {
    let mut index = 0;
    sides.map(|units| {
        let kept = units.into_iter().zip(&keep[index]).filter(|(_, keep)| **keep);
        let kept = kept.map(|(unit, _)| unit).collect();
        index += 1;
        kept
    })
}

fn notes(sides: [&Side; 2], programs: &[Option<String>; 2]) -> Vec<String> {
    let mut notes = Vec::new();
    if let [Some(before), Some(after)] = programs
        && before == after
    {
        notes.push(format!("the same program, {before}, ran before and after"));
    }
    let dates = sides.map(|side| {
        let mut seconds: Vec<f64> = side.dates().into_iter().filter_map(seconds).collect();
        seconds.sort_by(f64::total_cmp);
        seconds
    });
    if let [Some(first), Some(last)] = [dates[0].first(), dates[1].last()]
        && last < first
    {
        notes.push(
            "the logs of --after were recorded before those of --before: are they swapped?"
                .to_owned(),
        );
    }
    for (period, side) in [Period::Before, Period::After].into_iter().zip(sides) {
        let lost: u64 = side.events.iter().map(|of| of.recording.lost).sum();
        if lost > 0 {
            notes.push(format!("{}: the recorder lost {lost} events", period.option()));
        }
    }
    notes
}

/// Time between the middles of the periods, s: by their dates, else as if one followed the other.
fn apart(sides: [&Side; 2], units: &[Vec<(usize, Unit)>; 2]) -> f64 {
    let ranges = [0, 1].map(|side: usize| {
        let times = || units[side].iter().map(|(_, unit)| unit.t);
        times().fold(f64::NEG_INFINITY, f64::max) - times().fold(f64::INFINITY, f64::min)
    });
    let next = 0.5 * (ranges[0] + ranges[1]);
    let starts = sides.map(|side| side.dates().into_iter().find_map(seconds));
    match starts {
        [Some(before), Some(after)] => after + 0.5 * ranges[1] - before - 0.5 * ranges[0],
        _ => next,
    }
}

fn doubts(
    of: &Estimate,
    units: &[Vec<(usize, Unit)>; 2],
    apart: f64,
    turned: Turned,
) -> Vec<Doubt> {
    let level = [0, 1].map(|side: usize| {
        units[side].iter().filter_map(|(_, unit)| unit.level_w).collect::<Vec<f64>>()
    });
    let times =
        [0, 1].map(|side: usize| units[side].iter().map(|(_, unit)| unit.t).collect::<Vec<f64>>());
    let courses = [0, 1].map(|side: usize| {
        units[side].iter().map(|(_, unit)| unit.course.as_slice()).collect::<Vec<_>>()
    });
    let found = [
        meter([&level[0], &level[1]], of.saving),
        drift(of, [&times[0], &times[1]], apart),
        step(&of.residual[0], 0, of.saving),
        step(&of.residual[1], 1, of.saving),
        swapped(of),
        // Machines that let the robot wait longer are no other work.
        other_work(
            [&courses[0], &courses[1]],
            [of.duration[0], of.duration[1] - of.foreign],
            turned,
        ),
    ];
    found.into_iter().flatten().collect()
}

/// The interval that covers each doubt.
fn widened([low, high]: [f64; 2], doubts: &[Doubt]) -> [f64; 2] {
    let most = |end: usize| doubts.iter().map(|doubt| doubt.widens[end]).fold(0.0, f64::max);
    let (low, high) = (low - most(0), high + most(1));
    if doubts.iter().any(|doubt| doubt.withholds) {
        [low.min(0.0), high.max(0.0)]
    } else {
        [low, high]
    }
}

fn verdict(interval: Option<[f64; 2]>, cycles: [usize; 2], needed: usize) -> Verdict {
    match interval {
        None => Verdict::TooFewCycles,
        Some([low, _]) if low > 0.0 => Verdict::Saves,
        Some([_, high]) if high < 0.0 => Verdict::Costs,
        Some(_) if cycles.iter().any(|n| *n < needed) => Verdict::TooFewCycles,
        Some(_) => Verdict::NoDifference,
    }
}
