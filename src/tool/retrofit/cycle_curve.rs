//! The curve of least energy of the whole cycle over its time, with a lower bound.
//!
//! Runs with a stream take any time on their path, as a takt of that length would let them: from the
//! cycle time of today on no run is faster than today. All else stays as in the retrofit. The rest of
//! each time is spent in the cheapest state.

use rayon::prelude::*;

use super::candidate::{Candidate, with_stream};
use super::cycle_time::{base_w, cycle};
use super::job::Job;
use super::simulated::{Simulated, TIME_TOLERANCE};
use super::whole_cycle::CyclePoint;
use crate::retime::energy::EnergyParts;
use crate::retime::optimize::convex_curve::EnergyCurve;
use crate::retime::optimize::cycle::{Cycle, Part};
use crate::retime::optimize::energy_curve::{TradeOff, trade_off};
use crate::retime::optimize::resting::cheapest;
use crate::retime::optimize::retime::{SLOWEST, Task};

/// Ratio of the longest time of the curve to the cycle of today.
const LONGEST: f64 = 1.5;

/// A run with a stream.
struct Run<'a> {
    events: &'a [usize],
    /// Time in the original, s.
    before: f64,
    trade_off: TradeOff,
}

/// The curve at `count` times, one of which is the takt (s).
pub(super) fn cycle_curve(
    job: &Job<'_>,
    candidates: &[Candidate],
    after: &Simulated,
    takt: f64,
    count: usize,
) -> Vec<CyclePoint> {
    let original = &job.original;
    let streams: Vec<&Candidate> = with_stream(candidates).map(|(_, c)| c).collect();
    let runs: Vec<Run<'_>> =
        streams.into_par_iter().filter_map(|candidate| run(job, candidate, after)).collect();
    let events: Vec<&[usize]> = runs.iter().map(|run| run.events).collect();
    let model = cycle(original, job.model, &job.settings, &events, takt);
    let fixed = fixed_j(job, &runs, &model, after);
    let now = original.cycle.simulation.cycle_s;
    let curves = |of: fn(&TradeOff) -> &EnergyCurve, time: f64| -> Vec<EnergyCurve> {
        let curve = |run: &Run<'_>| {
            let is_slower = time >= now - TIME_TOLERANCE;
            of(&run.trade_off).not_faster(if is_slower { run.before } else { 0.0 })
        };
        runs.iter().map(curve).collect()
    };
    let reachable: fn(&TradeOff) -> &EnergyCurve = |run| &run.reachable;
    let least: Vec<f64> = runs.iter().map(|run| run.trade_off.reachable.range().0).collect();
    let (shortest, longest) = (model.time(&least), takt.max(LONGEST * now));
    let point = |time_s: f64| {
        let cycle = Cycle { takt: time_s, ..model.clone() };
        let drawn = fixed + base_w(job.model) * time_s;
        let (energy, rest) = least_energy(&cycle, &curves(reachable, time_s), &least)?;
        let bound = least_energy(&cycle, &curves(|run| &run.bound, time_s), &least)?.0;
        let state = cheapest(&cycle.resting, rest).0.checked_sub(1);
        Some(CyclePoint {
            time_s,
            energy_j: energy + drawn,
            lower_bound_j: bound.min(energy) + drawn,
            state: state.map(|index| job.settings.idle[index].name.clone()),
        })
    };
    times(shortest, longest, takt, count).into_par_iter().filter_map(point).collect()
}

/// `count` times from the shortest to the longest in equal steps; the takt replaces the nearest one
/// after the shortest.
fn times(shortest: f64, longest: f64, takt: f64, count: usize) -> Vec<f64> {
    let step = (longest - shortest) / count.saturating_sub(1).max(1) as f64;
    let mut times: Vec<f64> = (0..count).map(|i| shortest + step * i as f64).collect();
    if takt >= shortest {
        let far = |time: &f64| (time - takt).abs();
        if let Some(nearest) = times.iter_mut().skip(1).min_by(|a, b| far(a).total_cmp(&far(b))) {
            *nearest = takt;
        }
    }
    times
}

/// Least energy of runs, known waits and rest (J), and the rest (s). `fastest`: least times, s.
fn least_energy(cycle: &Cycle, curves: &[EnergyCurve], fastest: &[f64]) -> Option<(f64, f64)> {
    let times = cycle.share(curves).or_else(|| {
        // The shortest cycle leaves no choice.
        (cycle.time(fastest) <= cycle.takt + TIME_TOLERANCE).then(|| fastest.to_vec())
    })?;
    let energies: Vec<f64> = curves.iter().zip(&times).map(|(c, time)| c.energy(*time)).collect();
    Some((cycle.energy(&times, &energies), cycle.takt - cycle.time(&times)))
}

/// The trade-off of a run with a stream; the original and the stream can be reached.
fn run<'a>(job: &'a Job<'_>, candidate: &Candidate, after: &Simulated) -> Option<Run<'a>> {
    let original = &job.original;
    let events = original.events(candidate);
    let event = *events.first()?;
    let run = original.run(candidate)?;
    let parts = original.cycle.account.events[event].iter();
    let task = Task {
        model: job.model,
        run,
        energy_before: parts.fold(EnergyParts::default(), |a, b| a + *b),
        spacing_s: job.settings.spacing_s,
        closest_s: job.settings.closest_s,
        freedom: &job.settings.freedom,
        cost: job.settings.cost,
    };
    let taken =
        |cycle: &Simulated| (cycle.simulation.events[event].duration, motion_j(cycle, event));
    let before = run.duration();
    let also = [taken(&original.cycle), taken(after)];
    let trade_off = trade_off(&task, SLOWEST * before, &also)?;
    Some(Run { events, before, trade_off })
}

/// Motion energy of an event, J.
fn motion_j(cycle: &Simulated, event: usize) -> f64 {
    cycle.account.events[event].iter().map(EnergyParts::motion_energy_j).sum()
}

/// Energy of the retrofit that no time of these runs changes: other movements, settling, waits of
/// stated length, J; without the power that is drawn at any time.
fn fixed_j(job: &Job<'_>, runs: &[Run<'_>], cycle: &Cycle, after: &Simulated) -> f64 {
    let moving: f64 = runs.iter().flat_map(|run| run.events).map(|e| motion_j(after, *e)).sum();
    let events = after.simulation.events.iter().zip(&cycle.parts);
    let waiting: f64 = events
        .map(|(event, part)| match part {
            Part::Arrival { holding_w, .. } => holding_w * event.duration,
            Part::Run(_) | Part::Fixed(_) => 0.0,
        })
        .sum();
    let drawn = base_w(job.model) * after.simulation.cycle_s;
    after.account.total.energy_j() - drawn - moving - waiting
}
