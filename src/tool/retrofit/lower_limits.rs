//! The retrofit on a robot with lower limits than its file assumes.
//!
//! Unpublished limits are assumed. If they are too high, a stream must not lose more time than its
//! original movements: the retrofit would make the cycle longer.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::candidate::{Candidate, State, with_stream};
use super::figures::LowerLimits;
use super::files::{OutputFile, read_again};
use super::job::Original;
use super::lowered::Lowered;
use super::planning::Planning;
use super::read::read_program;
use super::settings::Settings;
use crate::retime::motion::timeline::{Run, What};
use crate::retime::motion::{Simulation, simulate};
use crate::retime::optimize::allowed::Loads;
use crate::retime::optimize::reason::Reason;
use crate::retime::optimize::retime::{Goal, Retiming, retime};
use crate::retime::path::joint_path::Joints;

/// Ratio by which a stream may exceed the time of its movements under lower limits.
const LONGER: f64 = 1.005;
/// Rounding of a time, s.
const ROUNDING: f64 = 1e-4;

/// Maximum number of plans of a stream, and what a plan reduces loads beyond the lower limits to.
const MAX_PLANS: usize = 4;
const REDUCTION: f64 = 0.9;

/// The emitted program under each of the lower limits; empty if it cannot be read.
pub(super) fn emitted_under(
    lowered: &[Lowered],
    outputs: &[OutputFile],
    settings: &Settings,
) -> Vec<Simulation> {
    let emitted = read_again(outputs);
    let Ok((program, entry)) = read_program(&emitted, &settings.entry) else { return Vec::new() };
    let simulated = |lower: &Lowered| simulate(&program, entry, &lower.model, &settings.options);
    lowered.par_iter().map(simulated).collect()
}

/// Cycle times of original and retrofit under lower limits.
pub(super) fn cycles(lowered: &[Lowered], emitted: &[Simulation]) -> Vec<LowerLimits> {
    let cycles = |(lower, after): (&Lowered, &Simulation)| LowerLimits {
        share: lower.share,
        original_s: lower.simulation.cycle_s,
        optimized_s: after.cycle_s,
    };
    lowered.iter().zip(emitted).map(cycles).collect()
}

/// Plans again, within loads nearer to the lower limits, the streams that lose more time under them than
/// their movements.
#[derive(Default)]
pub(super) struct Gentler {
    /// Number of plans, by candidate.
    plans: BTreeMap<usize, usize>,
}

/// A candidate whose stream loses time under lower limits.
struct Losing<'a> {
    index: usize,
    lower: &'a Lowered,
    /// The stream under the assumed limits.
    run: &'a Run,
    reason: Reason,
}

impl Gentler {
    /// New states of the candidates whose streams lose time: a stream with smaller loads, or the reason for
    /// refusal. `after`: the retrofit under the assumed limits, with the events of the original; `emitted`
    /// the same under each of the lower ones.
    pub(super) fn replanned(
        &mut self,
        planning: &Planning<'_>,
        after: &Simulation,
        emitted: &[Simulation],
        candidates: &[Candidate],
    ) -> Vec<(usize, State)> {
        let losing = losing(&planning.job.original, after, emitted, candidates);
        let counted = losing.into_iter().map(|it| {
            let plans = self.plans.entry(it.index).or_insert(1);
            *plans += 1;
            (*plans <= MAX_PLANS, it)
        });
        let counted: Vec<(bool, Losing<'_>)> = counted.collect();
        let states = counted.into_par_iter().map(|(again, it)| {
            let stream = again.then(|| gentler(planning, &candidates[it.index], &it)).flatten();
            (it.index, State::from(stream.ok_or(it.reason)))
        });
        states.collect()
    }
}

/// A stream of the same duration with smaller loads where the present one exceeds the lower limits.
fn gentler(planning: &Planning<'_>, candidate: &Candidate, it: &Losing<'_>) -> Option<Retiming> {
    let model = planning.job.model;
    let mut freedom = planning.settings.freedom.clone();
    let allowed = freedom.loads(model);
    let (own, lower) = (Loads::of(model, it.run), Loads::limits(&it.lower.model));
    let less = |own: Joints, lower: Joints, allowed: Joints| -> Joints {
        std::array::from_fn(|j| {
            let reduced = (REDUCTION * own[j]).max(lower[j]);
            if own[j] > lower[j] { reduced.min(allowed[j]) } else { allowed[j] }
        })
    };
    freedom.loads = Some(Loads {
        acceleration: less(own.acceleration, lower.acceleration, allowed.acceleration),
        jerk: allowed.jerk,
        torque: less(own.torque, lower.torque, allowed.torque),
    });
    let within = candidate.retiming()?.duration_s;
    retime(&planning.task(candidate, &freedom)?, Goal::Within(within)).ok()
}

/// The candidates whose streams lose more time under lower limits than their movements. Extra time that a
/// stream received on purpose does not count.
fn losing<'a>(
    original: &'a Original<'_>,
    after: &'a Simulation,
    emitted: &[Simulation],
    candidates: &[Candidate],
) -> Vec<Losing<'a>> {
    let duration = |of: &Simulation, event: usize| Some(of.events.get(event)?.duration);
    let loses = |index: usize, event: usize| {
        let before = duration(&original.cycle.simulation, event)?;
        let given = (duration(after, event)? - before).max(0.0);
        let What::Run(run) = &after.events.get(event)?.what else { return None };
        original.lowered.iter().zip(emitted).find_map(|(lower, emitted)| {
            let before = duration(&lower.simulation, event)?;
            let now = duration(emitted, event)?;
            (now > LONGER * before + given + ROUNDING).then(|| {
                let reason = Reason::NoStream(format!(
                    "with limits {:.0} % lower than assumed it would take {now:.3} s instead of \
                     {:.3} s",
                    100.0 * (1.0 - lower.share),
                    before + given
                ));
                Losing { index, lower, run, reason }
            })
        })
    };
    let first = |(index, candidate): (usize, &Candidate)| {
        original.events(candidate).iter().find_map(|event| loses(index, *event))
    };
    with_stream(candidates).filter_map(first).collect()
}
