//! Emits and verifies repeatedly: each round removes the pieces that failed the verification.

use super::candidate::{Candidate, State, with_states, with_stream};
use super::emission_context::EmissionContext;
use super::error::RetrofitError;
use super::figures::LowerLimits;
use super::guard_cost::costly;
use super::job::Job;
use super::lower_limits::{self, Gentler};
use super::outputs::{Outputs, emitted};
use super::planning::Planning;
use super::relocated_waits::{RelocatedWait, repaired};
use super::rewritten::Rewritten;
use super::settings::{Budget, Objective};
use super::torque_demand::TorqueBound;
use super::uncertainty::uncertain;
use super::verify::{Attempt, Rewrite, verify};
use super::verify_streams::all_failed;
use crate::retime::optimize::allowed::Loads;

/// Maximum number of rounds; the last one keeps no stream.
const MAX_ROUNDS: usize = 12;

/// The program with the streams and waits that pass the verification.
pub(super) fn verified(
    planning: &Planning<'_>,
    context: &EmissionContext<'_>,
    mut candidates: Vec<Candidate>,
    mut waits: Vec<RelocatedWait>,
) -> Result<Rewritten, RetrofitError> {
    let Job { original, model, settings, .. } = planning.job;
    let mut bounds = (Gentler::default(), TorqueBound::new(planning.job));
    // With estimated torque limits, `TorqueBound` limits the torques to those of the original.
    let mut settings = settings.clone();
    if let (Some(_), Some(loads)) = (&bounds.1, &mut settings.freedom.loads) {
        loads.torque = Loads::limits(model).torque;
    }
    let mut rounds = 0;
    loop {
        let outputs = emitted(context, original, &candidates, &waits)?;
        let rewrite = Rewrite::Streams { candidates: &candidates, waits: &waits };
        let attempt = verify(original, &outputs.files, model, &settings, rewrite);
        let is_unchanged = waits.is_empty() && with_stream(&candidates).next().is_none();
        if attempt.verification.passed || is_unchanged {
            let is_without_waits = waits.is_empty();
            let (lower_limits, changes) =
                changes(planning, &mut bounds, (&outputs, &attempt), &candidates, is_without_waits);
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
            waits = repaired(waits, &attempt.wait_faults, rounds == 1);
            continue;
        }
        let mut failed = attempt.failed;
        if failed.is_empty() || rounds == MAX_ROUNDS {
            // The fault has no single cause: all streams are refused.
            let why = attempt.verification.broken().unwrap_or("the verification failed");
            failed.splice(0..0, all_failed(&candidates, &format!("did not hold: {why}")));
        }
        let refused = failed.into_iter().map(|(index, reason)| (index, State::Refused(reason)));
        candidates = with_states(candidates, refused);
    }
}

/// Both cycles under lower limits, and new states of candidates whose streams pass the verification
/// but do not pay or load a joint too much.
fn changes(
    planning: &Planning<'_>,
    (gentler, torque_bound): &mut (Gentler, Option<TorqueBound<'_>>),
    (outputs, attempt): (&Outputs, &Attempt),
    candidates: &[Candidate],
    is_without_waits: bool,
) -> (Vec<LowerLimits>, Vec<(usize, State)>) {
    let Job { original, model, settings, robots, .. } = planning.job;
    let after = &attempt.simulated;
    let lowered = lower_limits::emitted_under(&original.lowered, &outputs.files, settings);
    let mut changes = Vec::new();
    if is_without_waits {
        changes = gentler.replanned(planning, &after.simulation, &lowered, candidates);
    }
    // With another budget or objective, runs may deliberately take more energy.
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
