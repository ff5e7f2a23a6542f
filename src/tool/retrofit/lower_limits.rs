//! What happens if a robot can do less than its file assumes.
//!
//! Limits that nobody publishes are assumed. A stream must not lose more than the movements that it
//! stands for where they are too high: it would be a retrofit that makes the cycle longer.

use rayon::prelude::*;

use super::figures::{LowerLimits, OutputFile};
use super::outputs::read_again;
use super::settings::Settings;
use super::work::{Way, read_program};
use crate::arm::robot::Model;
use crate::rapid::ir::program::{Program, RoutineId};
use crate::retime::motion::{Simulation, simulate};
use crate::retime::optimize::reason::Reason;
use crate::retime::optimize::site::Site;

/// Shares of the assumed limits that are looked at.
const SHARES: [f64; 3] = [0.9, 0.8, 0.7];
/// Share by which a stream may take longer than its movements under lower limits.
const LONGER: f64 = 1.005;
/// Rounding of a time, s.
const ROUNDING: f64 = 1e-4;

/// The original under lower limits.
pub(super) struct Lowered {
    share: f64,
    model: Model,
    simulation: Simulation,
}

/// The original under lower limits; empty where no limit is assumed.
pub(super) fn lowered(
    program: &Program,
    entry: RoutineId,
    model: &Model,
    settings: &Settings,
) -> Vec<Lowered> {
    let assumed = ["acceleration", "torque"].map(|key| !model.is_known("limits", key));
    if assumed == [false; 2] {
        return Vec::new();
    }
    let lower = |share: &f64| {
        let scaled = |limits: &Option<Vec<f64>>, is_assumed: bool| {
            let factor = if is_assumed { *share } else { 1.0 };
            limits.as_ref().map(|limits| limits.iter().map(|x| factor * x).collect())
        };
        let mut limits = model.limits.clone();
        limits.acceleration = scaled(&limits.acceleration, assumed[0]);
        limits.torque = scaled(&limits.torque, assumed[1]);
        let model = Model { limits, ..model.clone() };
        let simulation = simulate(program, entry, &model, &settings.options);
        Lowered { share: *share, model, simulation }
    };
    SHARES.par_iter().map(lower).collect()
}

/// How much later the original may come to an event than it is planned to, s, counted from the end
/// of another event or from the start of the cycle.
pub(super) fn lateness(
    planned: &Simulation,
    lowered: &[Lowered],
    since: Option<usize>,
    event: usize,
) -> f64 {
    let way_there = |simulation: &Simulation| {
        let from = match since {
            Some(since) => {
                let since = simulation.events.get(since)?;
                since.t_start + since.duration
            }
            None => 0.0,
        };
        Some(simulation.events.get(event)?.t_start - from)
    };
    let late = |lower: &Lowered| Some(way_there(&lower.simulation)? - way_there(planned)?);
    lowered.iter().filter_map(late).fold(0.0, f64::max)
}

/// How long original and retrofit take under lower limits, and the ways whose streams lose more
/// than their movements. A stream that is slower on purpose may take the time that it was given;
/// what it loses beyond that counts. `planned` are original and retrofit under the assumed limits;
/// `whole` says that the events of both are the same.
pub(super) fn compare(
    lowered: &[Lowered],
    planned: (&Simulation, &Simulation),
    outputs: &[OutputFile],
    settings: &Settings,
    (sites, ways): (&[Site], &[Way]),
    whole: bool,
) -> (Vec<LowerLimits>, Vec<(usize, Reason)>) {
    let emitted = read_again(outputs);
    let Ok((program, entry)) = read_program(&emitted, &settings.entry) else {
        return (Vec::new(), Vec::new());
    };
    let after: Vec<Simulation> = lowered
        .par_iter()
        .map(|lower| simulate(&program, entry, &lower.model, &settings.options))
        .collect();
    let pairs = || lowered.iter().zip(&after);
    let table = pairs()
        .map(|(lower, after)| LowerLimits {
            share: lower.share,
            original_s: lower.simulation.cycle_s,
            optimized_s: after.cycle_s,
        })
        .collect();
    let loses = |way: &Way| {
        let mut events = sites[way.site].variants[way.variant].events.iter();
        events.find_map(|event| {
            let duration = |of: &Simulation| Some(of.events.get(*event)?.duration);
            let given = (duration(planned.1)? - duration(planned.0)?).max(0.0);
            pairs().find_map(|(lower, after)| {
                let before = duration(&lower.simulation)?;
                let now = duration(after)?;
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
    let failed = ways
        .iter()
        .enumerate()
        .filter(|(_, way)| whole && way.outcome.is_ok())
        .filter_map(|(index, way)| Some((index, loses(way)?)))
        .collect();
    (table, failed)
}
