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
//! A cycle may get at most 0.1 s longer.

use super::super::context::Context;
use super::super::edits::{fix, replace, slower};
use super::super::rule::{Applicability, Finding};
use super::super::saving::Weighed;
use super::racing_to_wait::{waits_behind, with_speed};
use crate::arm::dynamics::{Data, Load};
use crate::arm::robot::Model;
use crate::retime::energy::account::base;
use crate::retime::energy::power::power;
use crate::retime::motion::pace::Pace;
use crate::retime::motion::timed::JointState;
use crate::retime::motion::timing::grid::SpeedBound;

rule!("EW202", "unreached-speed", Speed, Robot, Info, "unreached_speed.rs");

/// Share of the reached speed from which a programmed speed is never reached.
const BEYOND: f64 = 1.5;
/// Share of the reached speed that is looked for.
const BELOW: f64 = 0.9;
/// Longest time that is given for it, s.
const LONGER: f64 = 0.1;
/// Name of the pace that the turning of the tool sets.
const TURNING: &str = "reorientation";
/// Looks at a movement.
const LOOKS: usize = 16;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for (index, site) in context.sites.iter().enumerate() {
        let Some(speed) = site.facts.speed else { continue };
        if !site.is_plain() || waits_behind(context, index).is_some() {
            continue;
        }
        // Where the programmed speed limits the movement, it is reached.
        let programmed = |step: &usize| {
            let pace = context.record(*step).map(|(_, record, _)| record.pace);
            pace == Some(Pace::Speed(SpeedBound::Programmed))
        };
        if site.executions.iter().any(programmed) {
            continue;
        }
        let looks = site.executions.iter().map(|step| looks(context, *step));
        let Some(looks) = looks.collect::<Option<Vec<Looks<'_>>>>() else { continue };
        let speeds = looks.iter().flat_map(|looks| &looks.states).map(|(_, speed)| *speed);
        let reached = speeds.fold(0.0, f64::max);
        // A movement that reorients for longer than it translates is slow for that reason.
        let turns = |step: &usize| {
            context.record(*step).is_some_and(|(_, record, _)| record.pace.name() == TURNING)
        };
        if reached <= 0.0 || speed.tcp <= BEYOND * reached || site.executions.iter().any(turns) {
            continue;
        }
        let Some((name, below)) = slower(BELOW * reached).next() else { continue };
        if !context.model.is_some_and(|model| may_save(model, &looks, below)) {
            continue;
        }
        let weighed = context.weigh(&[site.stmt.span], &|step| with_speed(step, below));
        let Weighed::Saves(saving) = weighed else { continue };
        if saving.time_s < -LONGER {
            continue;
        }
        let written = context.text(site.speed.span);
        let message = format!(
            "{} with {written} gets to {:.0} mm/s and is braked again",
            site.name,
            reached * 1e3
        );
        let mut finding = Finding::new(&RULE, site.stmt.span, message);
        finding.change = format!("{name} in place of {written}");
        finding.saving = Some(saving);
        finding.fix = Some(fix(Applicability::Unsafe, replace(site.speed.span, &name)));
        findings.push(finding);
    }
}

/// Samples of one execution.
struct Looks<'c> {
    load: &'c Load,
    /// Time that each sample stands for, s.
    each: f64,
    /// States, with the speed of the tool, m/s.
    states: Vec<(JointState, f64)>,
}

fn looks<'c>(context: &Context<'c>, step: usize) -> Option<Looks<'c>> {
    let (run, record, leg) = context.record(step)?;
    let model = context.model?;
    let each = record.duration / LOOKS as f64;
    let look = |i: usize| {
        let state = run.at(record.t_start + each * (i as f64 + 0.5));
        let rate = leg.tool.twist(model, &state.q, &state.qd);
        (state, rate.fixed_rows::<3>(0).norm())
    };
    let states = || (0..LOOKS).map(look).collect();
    run.problem.is_none().then(|| Looks { load: &run.load, each, states: states() })
}

/// Estimates whether limiting a movement to the speed `below` (m/s) saves more than the longer time
/// costs. It seldom does, and the estimate is far cheaper than a simulation.
fn may_save(model: &Model, looks: &[Looks<'_>], below: f64) -> bool {
    let mut data = Data::new();
    let mut saved = 0.0;
    for Looks { load, each, states } in looks {
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
