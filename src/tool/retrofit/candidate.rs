//! Candidates: the variants of the sites that may become streams.

use crate::retime::optimize::energy_curve::TimeEnergy;
use crate::retime::optimize::reason::Reason;
use crate::retime::optimize::retime::Retiming;
use crate::retime::optimize::site::Site;

/// A variant of a site, with its decision.
pub(super) struct Candidate {
    /// Index of the site.
    pub(super) site: usize,
    /// Index of the variant.
    pub(super) variant: usize,
    pub(super) state: State,
    /// Its energy-time curve; may be empty.
    pub(super) pareto: Vec<TimeEnergy>,
}

/// The decision on a candidate.
#[derive(Debug)]
pub(super) enum State {
    /// No stream has been planned yet.
    Pending,
    /// The movements stay.
    Refused(Reason),
    /// A stream replaces the movements.
    Done(Box<Retiming>),
}

impl From<Result<Retiming, Reason>> for State {
    fn from(outcome: Result<Retiming, Reason>) -> State {
        match outcome {
            Ok(retiming) => State::Done(Box::new(retiming)),
            Err(reason) => State::Refused(reason),
        }
    }
}

impl Candidate {
    /// Its stream, if it has one.
    pub(super) fn retiming(&self) -> Option<&Retiming> {
        match &self.state {
            State::Done(retiming) => Some(retiming),
            State::Pending | State::Refused(_) => None,
        }
    }
}

/// One candidate per variant: pending if nothing refuses it.
pub(super) fn candidates(sites: &[Site]) -> Vec<Candidate> {
    let variants = |(site, s): (usize, &Site)| {
        let candidate = |(variant, reason): (usize, Option<Reason>)| {
            let state = reason.map_or(State::Pending, State::Refused);
            Candidate { site, variant, state, pareto: Vec::new() }
        };
        let reasons = s.variants.iter().map(|v| s.reason.clone().or_else(|| v.reason.clone()));
        reasons.enumerate().map(candidate).collect::<Vec<_>>()
    };
    sites.iter().enumerate().flat_map(variants).collect()
}

/// The candidates that have a stream, with their indices.
pub(super) fn with_stream(candidates: &[Candidate]) -> impl Iterator<Item = (usize, &Candidate)> {
    candidates.iter().enumerate().filter(|(_, candidate)| candidate.retiming().is_some())
}

/// The candidates without a decision, with their indices.
pub(super) fn pending(candidates: &[Candidate]) -> impl Iterator<Item = (usize, &Candidate)> {
    candidates.iter().enumerate().filter(|(_, it)| matches!(it.state, State::Pending))
}

/// Replaces the states at these indices.
pub(super) fn with_states(
    mut candidates: Vec<Candidate>,
    states: impl IntoIterator<Item = (usize, State)>,
) -> Vec<Candidate> {
    for (index, state) in states {
        candidates[index].state = state;
    }
    candidates
}
