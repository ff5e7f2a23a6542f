//! The programmed speed is never reached: the robot accelerates and brakes all the way.
//!
//! ## What it does
//! Finds movements whose programmed TCP speed is more than half again the largest speed that the
//! tool gets to.
//!
//! ## Why it wastes energy
//! All of the way is acceleration and braking. A speed a little below the one that is reached
//! takes the peaks of torque and speed away and costs almost no time.
//!
//! ## How the saving is computed
//! The movement is laid on a time line with the largest predefined speed below the one that is
//! reached; the joules include the base load of the longer time. That is done only where an estimate
//! says that the parts above that speed take less energy at that speed.
//!
//! ## Example
//! ```text
//! MoveL pNear, v5000, fine, tGrip;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveL pNear, v800, fine, tGrip;
//! ```
//!
//! ## Safety
//! Unsafe: same path and same order, but the cycle may take some hundredths of a second more.
//!
//! ## Assumptions
//! A cycle may get at most 0.1 s longer. Movements of a process are left alone.

use super::super::context::Context;
use super::super::edits::{replace, slower, with_speed};
use super::super::rule::Finding;
use super::racing_to_wait::waits_behind;
use crate::arm::dynamics::{Data, Load};
use crate::arm::robot::Model;
use crate::retime::energy::account::base;
use crate::retime::energy::power::power;
use crate::retime::motion::pace::Pace;
use crate::retime::motion::timed::JointState;
use crate::retime::motion::timing::grid::SpeedBound;

rule!("EW202", "unreached-speed", Speed, Robot, Info, "unreached_speed.rs");

/// Share of the reached speed from which a programmed speed is never reached.
const MIN_PROGRAMMED_SHARE: f64 = 1.5;
/// Share of the reached speed that is looked for.
const PROPOSED_SHARE: f64 = 0.9;
/// Longest time that is given for it, s.
const MAX_DELAY: f64 = 0.1;
/// Name of the pace that the turning of the tool sets.
const TURNING: &str = "reorientation";
/// Samples of a movement.
const SAMPLES: usize = 16;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let found = |index| slower_speed(context, index);
    findings.extend((0..context.sites.len()).filter_map(found));
}

fn slower_speed(context: &Context<'_>, index: usize) -> Option<Finding> {
    let site = &context.sites[index];
    let speed = site.facts.speed?;
    if !site.is_plain() || context.is_process(index) || waits_behind(context, index).is_some() {
        return None;
    }
    let mut paces = site.executions.iter().filter_map(|step| Some(context.record(*step)?.1.pace));
    // Where the programmed speed limits the movement, it is reached.
    if paces.clone().any(|pace| pace == Pace::Speed(SpeedBound::Programmed)) {
        return None;
    }
    let samples = site.executions.iter().map(|step| samples(context, *step));
    let samples = samples.collect::<Option<Vec<Samples<'_>>>>()?;
    let speeds = samples.iter().flat_map(|samples| &samples.states).map(|(_, speed)| *speed);
    let reached = speeds.fold(0.0, f64::max);
    // A movement that reorients for longer than it translates is slow for that reason.
    if reached <= 0.0
        || speed.tcp <= MIN_PROGRAMMED_SHARE * reached
        || paces.any(|pace| pace.name() == TURNING)
    {
        return None;
    }
    let (name, below) = slower(PROPOSED_SHARE * reached).next()?;
    if !context.model.is_some_and(|model| may_save(model, &samples, below)) {
        return None;
    }
    let evaluation = context.evaluate(&[site.stmt.span], &|step| with_speed(step, below));
    let saving = evaluation.ok()?.filter(|saving| saving.time_s >= -MAX_DELAY)?;
    let written = context.text(site.speed.span);
    let message = format!(
        "{} with {written} gets to {:.0} mm/s and is braked again",
        site.name,
        reached * 1e3
    );
    let finding = Finding::new(&RULE, site.stmt.span, message)
        .with_saving(format!("{name} in place of {written}"), saving)
        .with_unsafe_fix([replace(site.speed.span, &name)]);
    Some(finding)
}

/// Samples of one execution.
struct Samples<'c> {
    load: &'c Load,
    /// Time that each sample stands for, s.
    each: f64,
    /// States, with the speed of the tool, m/s.
    states: Vec<(JointState, f64)>,
}

fn samples<'c>(context: &Context<'c>, step: usize) -> Option<Samples<'c>> {
    let (run, record, leg) = context.record(step)?;
    let model = context.model?;
    let each = record.duration / SAMPLES as f64;
    let sample = |i: usize| {
        let state = run.at(record.t_start + each * (i as f64 + 0.5));
        let rate = leg.tool.twist(model, &state.q, &state.qd);
        (state, rate.fixed_rows::<3>(0).norm())
    };
    let states = || (0..SAMPLES).map(sample).collect();
    run.problem.is_none().then(|| Samples { load: &run.load, each, states: states() })
}

/// Estimates whether limiting a movement to the speed `below` (m/s) saves more than the longer time
/// costs. It seldom does, and the estimate is far cheaper than a simulation.
fn may_save(model: &Model, samples: &[Samples<'_>], below: f64) -> bool {
    let mut data = Data::new();
    let mut saved = 0.0;
    for Samples { load, each, states } in samples {
        for (state, speed) in states.iter().filter(|(_, speed)| *speed > below) {
            let share = below / speed;
            let qd = state.qd.map(|rate| rate * share);
            let even = JointState { qd, ..JointState::rest(state.q) };
            let [fast, slow] = [state, &even].map(|state| {
                let power = power(model, &mut data, load, state);
                power.friction_w + power.copper_w + power.drive_w
            });
            saved += each * (fast - slow / share);
            saved -= base(model, each * (1.0 / share - 1.0)).energy_j();
        }
    }
    saved > 0.0
}
