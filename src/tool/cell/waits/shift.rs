//! The cycles of all logs, sorted by the way that each took.

use std::collections::BTreeMap;

use super::error::WaitsError;
use crate::tool::cell::events::{Cycle, Place, Recording, What, cycles};

/// A log that was read.
#[derive(Clone, Debug)]
pub struct Log {
    /// Its name, for messages.
    pub name: String,
    /// What is in it.
    pub recording: Recording,
}

/// Complete cycles of one program.
#[derive(Clone, Debug, Default)]
pub struct Shift {
    /// Hash of the program, if a log has it.
    pub program: Option<String>,
    /// The cycles, in order; their sessions count through all logs.
    pub cycles: Vec<Cycle>,
    /// For each cycle the number of its way, from 0: the most frequent first.
    pub ways: Vec<usize>,
    /// Number of cycles that are left out because events of them were lost.
    pub incomplete: usize,
    /// For each cycle whether the one before it in the list ended where it starts.
    pub follows: Vec<bool>,
    /// For each session its start, s, as if each followed the one before.
    pub offsets: Vec<f64>,
    /// Step of the recorder's clock, s.
    pub step_s: f64,
}

/// Steps that clocks of controllers have, s, and how far a time may be from a multiple.
const STEPS_S: [f64; 9] = [0.1, 0.05, 0.024, 0.02, 0.016, 0.012, 0.01, 0.008, 0.004];
const ROUNDING_S: f64 = 0.0006;

impl Shift {
    /// The cycles of logs that belong together.
    ///
    /// # Errors
    /// Logs of several programs or of another one than `program`; a session twice; no cycle.
    pub fn new(logs: &[Log], program: Option<&str>) -> Result<Shift, WaitsError> {
        let hash = program_of(logs, program)?;
        different(logs)?;
        let mut shift = Shift { program: hash, ..Shift::default() };
        let mut offset = 0.0;
        for log in logs {
            let first = shift.offsets.len();
            for session in &log.recording.sessions {
                shift.offsets.push(offset);
                offset += session.events.last().map_or(0.0, |event| event.t.max(0.0));
            }
            for mut cycle in cycles(&log.recording) {
                cycle.session += first;
                let is_lost = cycle.events.iter().any(|event| matches!(event.what, What::Lost(_)));
                if is_lost || cycle.duration() <= 0.0 {
                    shift.incomplete += 1;
                } else {
                    shift.cycles.push(cycle);
                }
            }
        }
        if shift.cycles.is_empty() {
            let logs: Vec<&str> = logs.iter().map(|log| log.name.as_str()).collect();
            return Err(WaitsError::NoCycles { logs: logs.join(", ") });
        }
        shift.step_s = step(logs);
        shift.ways = ways(&shift.cycles);
        let pairs = shift.cycles.windows(2);
        let follows = pairs.map(|pair| {
            pair[0].session == pair[1].session && (pair[0].end - pair[1].start).abs() < 1e-9
        });
        shift.follows = std::iter::once(false).chain(follows).collect();
        Ok(shift)
    }

    /// Time of a cycle's start since the start of the first session, h.
    #[must_use]
    pub fn hours(&self, cycle: usize) -> f64 {
        let cycle = &self.cycles[cycle];
        (self.offsets[cycle.session] + cycle.start) / 3600.0
    }

    /// Number of cycles of each way.
    #[must_use]
    pub fn frequencies(&self) -> Vec<usize> {
        let count = self.ways.iter().max().map_or(0, |most| most + 1);
        let mut frequencies = vec![0; count];
        for way in &self.ways {
            frequencies[*way] += 1;
        }
        frequencies
    }
}

fn program_of(logs: &[Log], given: Option<&str>) -> Result<Option<String>, WaitsError> {
    let mut known: Option<(&str, &String)> = None;
    for log in logs {
        let Some(hash) = &log.recording.program else { continue };
        if let Some(given) = given
            && given != hash
        {
            let (log, hash) = (log.name.clone(), hash.clone());
            return Err(WaitsError::OtherProgram { log, hash, given: given.to_owned() });
        }
        match known {
            Some((first, first_hash)) if first_hash != hash => {
                return Err(WaitsError::TwoPrograms {
                    first: first.to_owned(),
                    first_hash: first_hash.clone(),
                    log: log.name.clone(),
                    hash: hash.clone(),
                });
            }
            Some(_) => {}
            None => known = Some((&log.name, hash)),
        }
    }
    Ok(known.map(|(_, hash)| hash.clone()))
}

/// Refuses sessions that two logs share.
fn different(logs: &[Log]) -> Result<(), WaitsError> {
    for (index, log) in logs.iter().enumerate() {
        for first in &logs[..index] {
            let same = log.recording.sessions.iter().find(|session| {
                session.events.len() > 1 && first.recording.sessions.contains(session)
            });
            if let Some(session) = same {
                let started = session.started.as_ref();
                return Err(WaitsError::SameSession {
                    first: first.name.clone(),
                    log: log.name.clone(),
                    started: started.map_or(String::new(), |at| format!(" ({at})")),
                });
            }
        }
    }
    Ok(())
}

/// The statements that a cycle came to: its waits and its stop points, each in order. Which of them came
/// first is left out: a coarse clock does not tell.
fn way(cycle: &Cycle) -> [Vec<&Place>; 2] {
    let stops = cycle.events.iter().filter(|event| event.what == What::Arrive);
    let stops = stops.filter_map(|event| event.place.as_ref());
    [cycle.visits.iter().map(|visit| &visit.place).collect(), stops.collect()]
}

/// Numbers of the ways, by falling frequency.
fn ways(cycles: &[Cycle]) -> Vec<usize> {
    let all: Vec<[Vec<&Place>; 2]> = cycles.iter().map(way).collect();
    let mut found: BTreeMap<&[Vec<&Place>; 2], (usize, usize)> = BTreeMap::new();
    for (index, way) in all.iter().enumerate() {
        found.entry(way).or_insert((0, index)).0 += 1;
    }
    let mut order: Vec<_> = found.into_iter().collect();
    order.sort_by_key(|(_, (count, first))| (std::cmp::Reverse(*count), *first));
    let numbers: BTreeMap<&[Vec<&Place>; 2], usize> =
        order.into_iter().enumerate().map(|(number, (way, _))| (way, number)).collect();
    all.iter().map(|way| numbers[way]).collect()
}

/// The largest step of which all times are multiples.
fn step(logs: &[Log]) -> f64 {
    let times = || {
        let sessions = logs.iter().flat_map(|log| &log.recording.sessions);
        sessions.flat_map(|session| &session.events).map(|event| event.t)
    };
    let is_multiple =
        |step: f64| times().all(|t| (t - (t / step).round() * step).abs() < ROUNDING_S);
    STEPS_S.into_iter().find(|step| is_multiple(*step)).unwrap_or(0.001)
}
