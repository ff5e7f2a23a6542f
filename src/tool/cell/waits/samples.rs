//! The visits of a wait, each with the times of all references before it.

use std::collections::{BTreeMap, BTreeSet};

use super::reference::{AT_ONCE_S, Kind, Moment, Reference, moments};
use super::shift::Shift;
use super::spread::median;
use crate::tool::cell::events::{Place, Visit};

/// A reference is tried if it precedes this share of the visits.
const COVERAGE: f64 = 0.6;
/// A signal belongs to the end of a wait if it changes this near to it, s.
const NEAR_S: f64 = 0.1;

/// A wait: a statement and the signal that it waits for.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Key {
    /// The statement.
    pub place: Place,
    /// The signal, if there is one.
    pub signal: Option<String>,
}

/// A visit that ended because what it waits for came.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Index of the cycle.
    pub cycle: usize,
    /// Which execution of the statement in the cycle.
    pub occurrence: usize,
    /// When the robot came, s since the start of the session.
    pub came: f64,
    /// How long it waited, s.
    pub length: f64,
    /// When the signal changed, if it did so before the robot came, s since the start of the session.
    pub heard: Option<f64>,
}

impl Sample {
    /// Whether what it waits for was there already.
    #[must_use]
    pub fn at_once(&self) -> bool {
        self.length <= AT_ONCE_S
    }

    /// When what it waits for came, as far as known: not later than this, s.
    #[must_use]
    pub fn end(&self) -> f64 {
        match self.heard {
            Some(heard) if self.at_once() => heard,
            _ => self.came + self.length,
        }
    }
}

/// A reference with its time before each sample.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// What happens.
    pub reference: Reference,
    /// Where the program does it, most often, if it is an output.
    pub place: Option<Place>,
    /// When it happened, s since the start of the session; `None` where it did not.
    pub times: Vec<Option<f64>>,
    /// Whether the robot stands still from there to the wait.
    pub stands: bool,
    /// Whether another wait is the answer to it.
    pub answered: bool,
}

/// The samples of a wait.
#[derive(Clone, Debug)]
pub struct Samples {
    /// The wait.
    pub key: Key,
    /// Its samples, by cycle and occurrence.
    pub samples: Vec<Sample>,
    /// References that may tell when what it waits for comes.
    pub candidates: Vec<Candidate>,
    /// Number of visits that a time limit ended.
    pub by_limit: usize,
    /// Number of visits that an error handler left.
    pub left: usize,
}

/// All waits of a shift, in the order of the program's text.
#[must_use]
pub fn samples(shift: &Shift) -> Vec<Samples> {
    let all: Vec<Vec<Moment>> = moments(&shift.cycles);
    let mut by_key: BTreeMap<Key, Vec<(usize, &Visit)>> = BTreeMap::new();
    for (index, cycle) in shift.cycles.iter().enumerate() {
        for visit in &cycle.visits {
            let key = Key { place: visit.place.clone(), signal: visit.signal.clone() };
            by_key.entry(key).or_default().push((index, visit));
        }
    }
    by_key.into_iter().map(|(key, visits)| of_wait(shift, &all, key, &visits)).collect()
}

fn of_wait(shift: &Shift, all: &[Vec<Moment>], key: Key, visits: &[(usize, &Visit)]) -> Samples {
    let by_limit = visits.iter().filter(|(_, visit)| visit.by_limit).count();
    let left = visits.iter().filter(|(_, visit)| visit.ended.is_none()).count();
    let ended = visits.iter().filter(|(_, visit)| !visit.by_limit);
    let ended: Vec<(usize, &Visit, f64)> = ended
        .filter_map(|(cycle, visit)| Some((*cycle, *visit, visit.length()?.max(0.0))))
        .collect();
    let awaited = awaited(all, &key, &ended);
    let samples: Vec<Sample> = ended
        .iter()
        .map(|(cycle, visit, length)| {
            let is_change = |moment: &&Moment| Some(&moment.kind) == awaited.as_ref();
            let mut changes = all[*cycle].iter().rev().filter(is_change);
            let heard = changes.find(|moment| moment.t <= visit.came).map(|moment| moment.t);
            let (came, occurrence) = (visit.came, visit.occurrence);
            Sample { cycle: *cycle, occurrence, came, length: *length, heard }
        })
        .collect();
    let candidates = candidates(shift, all, &samples, awaited.as_ref());
    Samples { key, samples, candidates, by_limit, left }
}

/// The change of the wait's own signal that ends it, if the log has it.
fn awaited(all: &[Vec<Moment>], key: &Key, ended: &[(usize, &Visit, f64)]) -> Option<Kind> {
    let own = key.signal.as_deref()?;
    let mut votes: BTreeMap<&Kind, usize> = BTreeMap::new();
    for (cycle, visit, length) in ended {
        if *length <= AT_ONCE_S {
            continue;
        }
        let near = |moment: &&Moment| (moment.t - visit.came - length).abs() < NEAR_S;
        let is_own = |kind: &Kind| matches!(kind, Kind::Signal(name, _) if name == own);
        for moment in all[*cycle].iter().filter(near).filter(|moment| is_own(&moment.kind)) {
            *votes.entry(&moment.kind).or_default() += 1;
        }
    }
    votes.into_iter().max_by_key(|(_, count)| *count).map(|(kind, _)| kind.clone())
}

pub(super) fn candidates(
    shift: &Shift,
    all: &[Vec<Moment>],
    samples: &[Sample],
    awaited: Option<&Kind>,
) -> Vec<Candidate> {
    let mut found: BTreeMap<Reference, Vec<Option<(&Moment, bool)>>> = BTreeMap::new();
    for (index, sample) in samples.iter().enumerate() {
        let mut enter = |reference: Reference, moment, stands| {
            let times = found.entry(reference).or_insert_with(|| vec![None; samples.len()]);
            times[index] = Some((moment, stands));
        };
        let mut seen: BTreeSet<&Kind> = BTreeSet::new();
        let mut moved = false;
        // A movement that starts when the robot comes is the next one.
        let is_earlier = |moment: &&Moment| {
            let starts = matches!(moment.kind, Kind::Start(_));
            moment.t < sample.came || moment.t == sample.came && !starts
        };
        let earlier = || all[sample.cycle].iter().rev().filter(is_earlier);
        let cmd = earlier().next().map_or(0, |moment| moment.cmd);
        for moment in earlier() {
            let starts = matches!(moment.kind, Kind::Start(_));
            let stands = !moved && !starts && moment.cmd == cmd;
            moved |= starts || matches!(moment.kind, Kind::Arrive(_));
            if seen.insert(&moment.kind) && Some(&moment.kind) != awaited {
                enter(Reference { kind: moment.kind.clone(), before: false }, moment, stands);
            }
        }
        if !shift.follows[sample.cycle] {
            continue;
        }
        for moment in all[sample.cycle - 1].iter().rev() {
            if moment.kind != Kind::Cycle && seen.insert(&moment.kind) {
                enter(Reference { kind: moment.kind.clone(), before: true }, moment, false);
            }
        }
    }
    let usable = found.into_iter().filter_map(|(reference, times)| {
        let known: Vec<(&Moment, bool)> = times.iter().copied().flatten().collect();
        covers(samples, times.iter().map(Option::is_some)).then(|| {
            let standing = known.iter().filter(|(_, stands)| *stands).count();
            Candidate {
                reference,
                place: most_frequent(known.iter().filter_map(|(moment, _)| moment.place.as_ref())),
                times: times.iter().map(|of| of.map(|(moment, _)| moment.t)).collect(),
                stands: 2 * standing > known.len(),
                answered: 2 * known.iter().filter(|(moment, _)| moment.answered).count()
                    > known.len(),
            }
        })
    });
    usable.collect()
}

/// Whether a reference is known for enough visits, and for enough of those in which the robot waited.
fn covers(samples: &[Sample], known: impl Iterator<Item = bool>) -> bool {
    let mut counts = [[0.0; 2]; 2];
    for (sample, known) in samples.iter().zip(known) {
        counts[usize::from(known)][usize::from(sample.at_once())] += 1.0;
    }
    let [[without_waited, without], [with_waited, with]] = counts;
    let of_all = without_waited + without + with_waited + with;
    with_waited + with >= COVERAGE * of_all
        && with_waited >= COVERAGE * (with_waited + without_waited)
        && with_waited > 0.0
}

fn most_frequent<'a>(places: impl Iterator<Item = &'a Place>) -> Option<Place> {
    let mut votes: BTreeMap<&Place, usize> = BTreeMap::new();
    for place in places {
        *votes.entry(place).or_default() += 1;
    }
    votes.into_iter().max_by_key(|(_, count)| *count).map(|(place, _)| place.clone())
}

impl Samples {
    /// Lengths of all samples, s.
    #[must_use]
    pub fn lengths(&self) -> Vec<f64> {
        self.samples.iter().map(|sample| sample.length).collect()
    }

    /// Median time from a reference to what the wait is for, where the robot has waited, s.
    #[must_use]
    pub fn median_after(&self, candidate: &Candidate) -> f64 {
        let pairs = self.samples.iter().zip(&candidate.times);
        let waited = pairs.filter(|(sample, _)| !sample.at_once());
        median(waited.filter_map(|(sample, t)| Some(sample.end() - (*t)?)))
    }

    /// Whether the program sets an output where the robot stands at the wait.
    #[must_use]
    pub fn has_request(&self) -> bool {
        let is_output = |of: &&Candidate| matches!(of.reference.kind, Kind::Output(..));
        self.candidates.iter().filter(is_output).any(|of| of.stands)
    }
}

impl Samples {
    /// The samples of one execution of the statement in each cycle.
    #[must_use]
    pub fn of_occurrence(&self, occurrence: usize) -> Samples {
        let is_kept: Vec<bool> =
            self.samples.iter().map(|sample| sample.occurrence == occurrence).collect();
        let kept = |of: &[Option<f64>]| {
            let pairs = of.iter().zip(&is_kept);
            pairs.filter(|(_, kept)| **kept).map(|(t, _)| *t).collect::<Vec<_>>()
        };
        let samples: Vec<Sample> =
            self.samples.iter().filter(|sample| sample.occurrence == occurrence).cloned().collect();
        let candidates = self.candidates.iter().filter_map(|of| {
            let times = kept(&of.times);
            let covers = covers(&samples, times.iter().map(Option::is_some));
            covers.then(|| Candidate { times, ..of.clone() })
        });
        let candidates = candidates.collect();
        Samples { samples, candidates, ..self.clone() }
    }
}
