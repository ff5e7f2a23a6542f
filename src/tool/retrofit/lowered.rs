//! The original program on a robot with lower limits than its file assumes.

use rayon::prelude::*;

use super::settings::Settings;
use crate::arm::robot::Model;
use crate::rapid::ir::program::{Program, RoutineId};
use crate::retime::motion::{Simulation, simulate};

/// Simulated limits as shares of the assumed ones.
const SHARES: [f64; 3] = [0.9, 0.8, 0.7];

/// The original under lower limits.
pub(super) struct Lowered {
    /// Ratio of the lower limits to the assumed ones.
    pub(super) share: f64,
    pub(super) model: Model,
    pub(super) simulation: Simulation,
}

/// The original under lower limits; empty if no limit is assumed.
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

/// Maximum delay of the original at an event under lower limits, s, relative to the end of another
/// event or to the start of the cycle.
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
