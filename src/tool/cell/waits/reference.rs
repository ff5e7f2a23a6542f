//! Events from which the time of a machine may count.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use crate::tool::cell::events::{Cycle, Event, Place, What};

/// Waits that last no longer found what they wait for already there, s.
pub const AT_ONCE_S: f64 = 0.05;

/// Level of a signal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level(pub f64);

impl Eq for Level {}

impl PartialOrd for Level {
    fn partial_cmp(&self, other: &Level) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Level {
    fn cmp(&self, other: &Level) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

/// What happens at a reference.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// The cycle starts.
    Cycle,
    /// A movement starts at this statement.
    Start(Place),
    /// A movement of this statement ends.
    Arrive(Place),
    /// A wait ends in which the robot has waited.
    End(Place),
    /// The program sets an output.
    Output(String, Level),
    /// A signal changes.
    Signal(String, Level),
}

/// An event of a cycle, the last of its kind before a wait.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Reference {
    /// What happens.
    pub kind: Kind,
    /// Whether it happens in the cycle before.
    pub before: bool,
}

impl fmt::Display for Reference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            Kind::Cycle => write!(f, "the start of the cycle")?,
            Kind::Start(place) => write!(f, "the start of the movement {place}")?,
            Kind::Arrive(place) => write!(f, "the arrival at {place}")?,
            Kind::End(place) => write!(f, "the end of the wait {place}")?,
            Kind::Output(signal, level) => write!(f, "output {signal} = {}", level.0)?,
            Kind::Signal(signal, level) => write!(f, "signal {signal} = {}", level.0)?,
        }
        f.write_str(if self.before { " in the cycle before" } else { "" })
    }
}

/// A moment of a cycle that may be a reference.
#[derive(Clone, Debug)]
pub(super) struct Moment {
    /// s since the start of the session.
    pub(super) t: f64,
    /// Number of movements that were executed.
    pub(super) cmd: u64,
    pub(super) kind: Kind,
    /// Where the program set the output.
    pub(super) place: Option<Place>,
    /// Whether the robot waits for a signal before it moves again, which is the answer to an output; of
    /// the end of a wait and of a signal, whether it is such an answer.
    pub(super) answered: bool,
}

/// Most levels of a signal that are told apart: others are measured values, no events.
const MAX_LEVELS: usize = 8;

/// The moments of each cycle, in order.
pub(super) fn moments(cycles: &[Cycle]) -> Vec<Vec<Moment>> {
    let mut levels: BTreeMap<&str, BTreeSet<Level>> = BTreeMap::new();
    for event in cycles.iter().flat_map(|cycle| &cycle.events) {
        if let (What::Output(level) | What::Signal(level), Some(name)) = (event.what, &event.signal)
        {
            let of = levels.entry(name).or_default();
            if of.len() <= MAX_LEVELS {
                of.insert(Level(level));
            }
        }
    }
    let is_event = |moment: &Moment| match &moment.kind {
        Kind::Output(name, _) | Kind::Signal(name, _) => {
            levels.get(name.as_str()).is_none_or(|of| of.len() <= MAX_LEVELS)
        }
        _ => true,
    };
    let of = |cycle: &Cycle| of_cycle(cycle).into_iter().filter(is_event).collect();
    cycles.iter().map(of).collect()
}

fn of_cycle(cycle: &Cycle) -> Vec<Moment> {
    let first = Moment { t: cycle.start, cmd: 0, kind: Kind::Cycle, place: None, answered: false };
    let of = |event: &Event| {
        let place = event.place.clone();
        let signal = event.signal.clone();
        let kind = match event.what {
            What::Start => Kind::Start(place.clone()?),
            What::Arrive => Kind::Arrive(place.clone()?),
            What::Output(level) => Kind::Output(signal?, Level(level)),
            What::Signal(level) => Kind::Signal(signal?, Level(level)),
            _ => return None,
        };
        Some(Moment { t: event.t, cmd: event.cmd, kind, place, answered: false })
    };
    let mut moments: Vec<Moment> = std::iter::once(first).collect();
    moments.extend(cycle.events.iter().filter_map(of));
    moments.sort_by(|a, b| a.t.total_cmp(&b.t));
    answers(&mut moments, cycle);
    let mut ends = Vec::new();
    let mut answering = BTreeSet::new();
    for visit in &cycle.visits {
        let before = || moments.iter().rev().skip_while(|moment| moment.t > visit.came);
        let answered = before()
            .take_while(|moment| !matches!(moment.kind, Kind::Start(_) | Kind::Arrive(_)))
            .any(|moment| moment.answered);
        if let Some(signal) = visit.signal.as_deref().filter(|_| answered) {
            answering.insert(signal);
        }
        let (Some(t), Some(length)) = (visit.ended, visit.length()) else { continue };
        if !visit.by_limit && length > AT_ONCE_S {
            let cmd = before().next().map_or(0, |moment| moment.cmd);
            let kind = Kind::End(visit.place.clone());
            ends.push(Moment { t, cmd, kind, place: Some(visit.place.clone()), answered });
        }
    }
    for moment in &mut moments {
        if let Kind::Signal(name, _) = &moment.kind {
            moment.answered = answering.contains(name.as_str());
        }
    }
    moments.extend(ends);
    moments.sort_by(|a, b| a.t.total_cmp(&b.t));
    moments
}

/// Marks the outputs that a wait answers before the robot moves again.
fn answers(moments: &mut [Moment], cycle: &Cycle) {
    let moves: Vec<f64> = moments
        .iter()
        .filter(|moment| matches!(moment.kind, Kind::Start(_) | Kind::Arrive(_)))
        .map(|moment| moment.t)
        .collect();
    for moment in moments.iter_mut().filter(|moment| matches!(moment.kind, Kind::Output(..))) {
        let next = moves.iter().copied().find(|t| *t > moment.t).unwrap_or(f64::INFINITY);
        let waits = cycle.visits.iter().filter(|visit| visit.signal.is_some());
        moment.answered =
            waits.map(|visit| visit.came).any(|came| came >= moment.t && came <= next);
    }
}
