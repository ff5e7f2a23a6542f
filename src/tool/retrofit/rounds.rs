//! Rounds of emitting and verifying: each leaves out what did not hold in the emitted text.

use super::candidate::{Candidate, State, with_states};
use super::emission_context::EmissionContext;
use super::error::RetrofitError;
use super::figures::LowerLimits;
use super::guard_cost::costly;
use super::job::Job;
use super::lower_limits;
use super::outputs::{Outputs, emitted};
use super::planning::Planning;
use super::relocated_waits::{RelocatedWait, mended};
use super::rewritten::Rewritten;
use super::settings::{Budget, Objective};
use super::torque_demand::TorqueBound;
use super::uncertainty::uncertain;
use super::verify::{Attempt, Rewrite, verify};
use crate::retime::optimize::allowed::Loads;
use crate::retime::optimize::reason::Reason;

/// Rounds of leaving out what did not hold; in the last one nothing is kept.
const MOST_ROUNDS: usize = 12;

/// The program with the streams and waits that hold in the emitted text.
pub(super) fn verified(
    planning: &Planning<'_>,
    context: &EmissionContext<'_>,
    mut candidates: Vec<Candidate>,
    mut waits: Vec<RelocatedWait>,
) -> Result<Rewritten, RetrofitError> {
    let Job { original, model, settings, .. } = planning.job;
    let mut torque_bound = TorqueBound::new(planning.job);
    // No more is asked of robots of whose limits nothing is known than what they do already.
    let mut settings = settings.clone();
    if let (Some(_), Some(loads)) = (&torque_bound, &mut settings.freedom.loads) {
        loads.torque = Loads::limits(model).torque;
    }
    let mut rounds = 0;
    loop {
        let outputs = emitted(context, original, &candidates, &waits)?;
        let rewrite = Rewrite::Streams { candidates: &candidates, waits: &waits };
        let attempt = verify(original, &outputs.files, model, &settings, rewrite);
        let is_unchanged = waits.is_empty() && candidates.iter().all(|c| c.retiming().is_none());
        if attempt.verification.passed || is_unchanged {
            let bound = torque_bound.as_mut();
            let (lower_limits, changes) =
                changes(planning, bound, (&outputs, &attempt), &candidates, waits.is_empty());
            if changes.is_empty() {
                return Ok(Rewritten {
                    candidates,
                    waits,
                    respeeded: std::collections::BTreeSet::new(),
                    outputs,
                    simulated: attempt.simulated,
                    verification: attempt.verification,
                    lower_limits,
                });
            }
            candidates = with_states(candidates, changes);
            continue;
        }
        rounds += 1;
        if !attempt.wait_faults.is_empty() {
            waits = mended(waits, &attempt.wait_faults, rounds == 1);
            continue;
        }
        let mut failed = attempt.failed;
        if failed.is_empty() || rounds == MOST_ROUNDS {
            // No single stream is at fault: none is kept.
            let why = attempt.verification.broken().unwrap_or("the verification failed");
            let reason = Reason::Verification(format!("did not hold: {why}"));
            let streams = candidates.iter().enumerate().filter(|(_, c)| c.retiming().is_some());
            let all: Vec<_> = streams.map(|(index, _)| (index, reason.clone())).collect();
            failed.splice(0..0, all);
        }
        let refused = failed.into_iter().map(|(index, reason)| (index, State::Refused(reason)));
        candidates = with_states(candidates, refused);
    }
}

/// Both cycles under lower limits, and new states of candidates whose streams hold but are not worth
/// it, or ask for too much.
fn changes(
    planning: &Planning<'_>,
    torque_bound: Option<&mut TorqueBound<'_>>,
    (outputs, attempt): (&Outputs, &Attempt),
    candidates: &[Candidate],
    is_without_waits: bool,
) -> (Vec<LowerLimits>, Vec<(usize, State)>) {
    let Job { original, model, settings, robots, .. } = planning.job;
    let after = &attempt.simulated;
    let lowered = lower_limits::emitted_under(&original.lowered, &outputs.files, settings);
    let mut changes = Vec::new();
    if is_without_waits {
        changes = lower_limits::losing(original, &after.simulation, &lowered, candidates);
    }
    // Where more or less time is asked for, runs may take more energy on purpose.
    let must_save = settings.budget == Budget::AsBefore && settings.objective == Objective::Energy;
    if let (Some(robots), true) = (robots, changes.is_empty() && is_without_waits && must_save) {
        changes = uncertain(model, robots, original, after, candidates);
    }
    if let (Some(bound), true) = (torque_bound, changes.is_empty()) {
        changes = bound.replanned(&after.simulation, candidates, planning);
    }
    if changes.is_empty() {
        changes = costly(planning.job, candidates, &outputs.guards);
    }
    (lower_limits::cycles(&original.lowered, &lowered), changes)
}
