//! The cycles of a recording, with the waits of each.

use std::collections::BTreeMap;

use super::event::{Event, Place, What};
use super::read::{Recording, Session};

/// A cycle that was recorded from its start to the start of the next one.
#[derive(Clone, Debug, PartialEq)]
pub struct Cycle {
    /// Index of the session.
    pub session: usize,
    /// Its number in the log.
    pub number: u64,
    /// Its start and the start of the next one, s since the start of the session.
    pub start: f64,
    /// See `start`.
    pub end: f64,
    /// Time that the recorder took to write, s.
    pub flush_s: f64,
    /// Its waits, in the order in which the program came to them.
    pub visits: Vec<Visit>,
    /// Its other events, in order.
    pub events: Vec<Event>,
}

/// One execution of a wait.
#[derive(Clone, Debug, PartialEq)]
pub struct Visit {
    /// The statement.
    pub place: Place,
    /// Which execution of the statement in its cycle, from 0.
    pub occurrence: usize,
    /// The signal that it waits for, if there is one.
    pub signal: Option<String>,
    /// When the program came, s since the start of the session.
    pub came: f64,
    /// When the wait ended, s since the start of the session; `None` if an error handler left it.
    pub ended: Option<f64>,
    /// Whether its time limit ended it.
    pub by_limit: bool,
}

impl Visit {
    /// How long it lasted, s.
    #[must_use]
    pub fn length(&self) -> Option<f64> {
        self.ended.map(|ended| ended - self.came)
    }
}

impl Cycle {
    /// Its duration without the time that the recorder took to write, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.end - self.start - self.flush_s
    }
}

/// The complete cycles of a recording: each ends with the start of the next one in its session.
#[must_use]
pub fn cycles(recording: &Recording) -> Vec<Cycle> {
    let sessions = recording.sessions.iter().enumerate();
    sessions.flat_map(|(index, session)| of_session(index, session)).collect()
}

fn of_session(index: usize, session: &Session) -> Vec<Cycle> {
    let events = &session.events;
    let starts: Vec<usize> = (0..events.len()).filter(|i| events[*i].what == What::Cycle).collect();
    let mut cycles = Vec::new();
    for pair in starts.windows(2) {
        let (first, next) = (&events[pair[0]], &events[pair[1]]);
        cycles.push(cycle(index, first, &events[pair[0] + 1..pair[1]], next.t));
    }
    cycles
}

fn cycle(session: usize, first: &Event, events: &[Event], end: f64) -> Cycle {
    let mut cycle = Cycle {
        session,
        number: first.cycle,
        start: first.t,
        end,
        flush_s: 0.0,
        visits: Vec::new(),
        events: Vec::new(),
    };
    let mut occurrences: BTreeMap<&Place, usize> = BTreeMap::new();
    for event in events {
        match (event.what, &event.place) {
            (What::Wait, Some(place)) => {
                let occurrence = occurrences.entry(place).or_default();
                cycle.visits.push(Visit {
                    place: place.clone(),
                    occurrence: *occurrence,
                    signal: event.signal.clone(),
                    came: event.t,
                    ended: None,
                    by_limit: false,
                });
                *occurrence += 1;
            }
            (What::End { by_limit }, Some(place)) => {
                let of = cycle.visits.iter_mut().rev().find(|visit| visit.place == *place);
                if let Some(visit) = of.filter(|visit| visit.ended.is_none()) {
                    visit.ended = Some(event.t);
                    visit.by_limit = by_limit;
                }
            }
            (What::Flush(seconds), _) => cycle.flush_s += seconds,
            _ => cycle.events.push(event.clone()),
        }
    }
    cycle
}
