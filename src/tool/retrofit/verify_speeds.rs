//! Verifies other programmed speeds: the same path, and no speed above a ceiling.

use super::figures::Verification;
use super::job::Original;
use super::settings::Settings;
use super::speed_slots::Slot;
use crate::arm::dynamics::Data;
use crate::arm::robot::Model;
use crate::retime::energy::power::power;
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::{Run, What};
use crate::retime::optimize::check::Check;
use crate::retime::optimize::freedom::{Bound, Freedom};
use crate::retime::path::joint_path::are_close;

/// Time step of the samples, s.
const STEP: f64 = 0.002;
/// Maximum distance of the ends of the same target, rad.
const SAME_END: f64 = 1e-6;

/// Compares the runs of an emitted program that has the events of the original, and adds the result
/// to `verification`. `factors`: one for each slot.
pub(super) fn compare_speeds(
    original: &Original<'_>,
    emitted: &Simulation,
    model: &Model,
    settings: &Settings,
    (slots, factors): (&[Slot], &[f64]),
    verification: &mut Verification,
) {
    let (mut same_paths, mut keep_ceilings) = (true, true);
    let before = &original.cycle.simulation;
    for (slot, factor) in slots.iter().zip(factors).filter(|(s, f)| s.is_changed(**f)) {
        for event in &slot.events {
            let runs = (&before.events[*event].what, &emitted.events[*event].what);
            let (What::Run(was), What::Run(now)) = runs else { continue };
            same_paths &= now.problem.is_none() && same_path(was, now);
            keep_ceilings &= *factor <= 1.0 || keeps_ceilings(was, now, &settings.freedom);
            verification.worst = verification.worst.max(&shares(model, now));
        }
    }
    verification.note("targets and zones are those of before", same_paths);
    verification.note("no programmed speed is exceeded", keep_ceilings);
}

fn same_path(was: &Run, now: &Run) -> bool {
    was.legs.len() == now.legs.len()
        && was.legs.iter().zip(&now.legs).all(|(a, b)| {
            a.zone == b.zone && a.target == b.target && are_close(&a.end, &b.end, SAME_END)
        })
}

fn keeps_ceilings(was: &Run, now: &Run, freedom: &Freedom) -> bool {
    was.moves.iter().zip(&now.moves).all(|(a, b)| {
        freedom.bound(&a.movement) == Bound::Robot || b.movement.speed.tcp <= a.movement.speed.tcp
    })
}

/// The largest share of a limit that a joint uses; 0 without limits.
pub(in crate::tool) fn largest_share(values: &[f64], limits: Option<&Vec<f64>>) -> f64 {
    let limits = limits.into_iter().flatten();
    values.iter().zip(limits).map(|(x, limit)| x.abs() / limit).fold(0.0, f64::max)
}

/// The peak shares of the limits in a run, as the virtual controller plans it.
fn shares(model: &Model, run: &Run) -> Check {
    let limits = &model.limits;
    let mut data = Data::new();
    let mut check = Check::none();
    let count = (run.duration() / STEP).ceil().max(1.0) as usize;
    for i in 0..=count {
        let state = run.at(run.duration() * i as f64 / count as f64);
        let tau = power(model, &mut data, &run.load, &state).tau;
        check = check.max(&Check {
            velocity: largest_share(&state.qd, limits.velocity.as_ref()),
            acceleration: largest_share(&state.qdd, limits.acceleration.as_ref()),
            torque: largest_share(&tau, limits.torque.as_ref()),
            ..Check::none()
        });
    }
    check
}
