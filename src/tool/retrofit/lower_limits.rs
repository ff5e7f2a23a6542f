//! The retrofit on a robot with lower limits than its file assumes.
//!
//! Unpublished limits are assumed. If they are too high, a stream must not lose more time than its
//! original movements: the retrofit would make the cycle longer.

use rayon::prelude::*;

use super::candidate::{Candidate, State, with_stream};
use super::figures::LowerLimits;
use super::files::{OutputFile, read_again};
use super::job::Original;
use super::lowered::Lowered;
use super::read::read_program;
use super::settings::Settings;
use crate::retime::motion::{Simulation, simulate};
use crate::retime::optimize::reason::Reason;

/// Ratio by which a stream may exceed the time of its movements under lower limits.
const LONGER: f64 = 1.005;
/// Rounding of a time, s.
const ROUNDING: f64 = 1e-4;

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

/// Refuses the candidates whose streams lose more time under lower limits than their movements.
/// Extra time that a stream received on purpose does not count. `after`: the retrofit under the
/// assumed limits, with the events of the original.
pub(super) fn losing(
    original: &Original<'_>,
    after: &Simulation,
    emitted: &[Simulation],
    candidates: &[Candidate],
) -> Vec<(usize, State)> {
    let duration = |of: &Simulation, event: usize| Some(of.events.get(event)?.duration);
    let loses = |candidate: &Candidate| {
        original.events(candidate).iter().find_map(|event| {
            let before = duration(&original.cycle.simulation, *event)?;
            let given = (duration(after, *event)? - before).max(0.0);
            original.lowered.iter().zip(emitted).find_map(|(lower, emitted)| {
                let before = duration(&lower.simulation, *event)?;
                let now = duration(emitted, *event)?;
                (now > LONGER * before + given + ROUNDING).then(|| {
                    Reason::NoStream(format!(
                        "with limits {:.0} % lower than assumed it would take {now:.3} s instead \
                         of {:.3} s",
                        100.0 * (1.0 - lower.share),
                        before + given
                    ))
                })
            })
        })
    };
    let refused = |(index, c): (usize, &Candidate)| Some((index, State::Refused(loses(c)?)));
    with_stream(candidates).filter_map(refused).collect()
}
