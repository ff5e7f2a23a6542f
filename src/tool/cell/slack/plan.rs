//! Arrivals for the waits of a simulated cycle, from recorded ones.

use super::place::{Cycle, Start};
use super::risk::{allowed, delays, longer_by, longer_cycles, needed};
use crate::retime::motion::arrivals::{Anchor, Arrival, anchored};
use crate::retime::motion::timeline::{Event, What};
use crate::retime::motion::{Options, Simulation};
use crate::tool::cell::waits::AT_ONCE_S;
use crate::tool::cell::waits::file::{KindEntry, RecordEntry, WaitEntry, WaitsFile, WayEntry};
use crate::tool::retrofit::Source;

/// Slack below this is left, s.
const LEAST_S: f64 = 0.02;
/// The share of the recorded comings that are earlier than what counts as seen: one visit is not enough.
const SEEN: f64 = 0.95;

/// What recorded waits allow.
#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    /// When what each wait is for comes.
    pub arrivals: Vec<Arrival>,
    /// The slack that may be used up.
    pub uses: Vec<Use>,
    /// Share of the recorded cycles that take the simulated way.
    pub share: f64,
    /// Recorded cycles of this way.
    pub cycles: usize,
    /// What to know about it.
    pub notes: Vec<String>,
}

/// A wait to which the robot may come later.
#[derive(Clone, Debug, PartialEq)]
pub struct Use {
    /// File and line.
    pub place: String,
    /// Its number in the cycle, from 0.
    pub number: usize,
    /// How much later, s.
    pub delay_s: f64,
    /// Its median length, s.
    pub median_s: f64,
    /// Time from the robot's coming to the signal in each recorded cycle, s.
    slack_s: Vec<f64>,
}

impl Planned {
    /// The number of recorded cycles that would have become longer, and the mean time by which, s, if the
    /// robot had come later by these times (s), one for each of `uses`.
    #[must_use]
    pub fn longer(&self, later: &[f64]) -> (usize, f64) {
        let slack: Vec<&[f64]> = self.uses.iter().map(|it| it.slack_s.as_slice()).collect();
        let by = |cycle| longer_by(&slack, later, cycle);
        let sum: f64 = (0..self.cycles).map(by).sum();
        (longer_cycles(&slack, later), sum / self.cycles.max(1) as f64)
    }
}

/// Why recorded waits cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SlackError {
    /// Another program.
    #[error(
        "the waits were recorded with another version of the program (hash {recorded}, this one has {own}): \
         record this version, or give the program that was recorded"
    )]
    OtherProgram {
        /// Hash of the recorded program.
        recorded: String,
        /// Hash of this one.
        own: String,
    },
    /// No way of the log is the simulated cycle.
    #[error(
        "none of the recorded cycles takes the way of the simulated cycle, which comes to {first}: state the \
         levels of its inputs with --assume"
    )]
    OtherWay {
        /// The first wait that no recorded cycle has there.
        first: String,
    },
}

/// A wait of the simulated cycle with its record.
struct Known<'a> {
    event: usize,
    number: usize,
    entry: &'a WaitEntry,
    record: &'a RecordEntry,
}

/// Arrivals for the waits of a cycle. `simulate` runs the program with options.
///
/// # Errors
/// Another program, or another way.
pub fn plan(
    waits: &WaitsFile,
    (files, hash): (&[Source], &str),
    risk: f64,
    options: &Options,
    simulate: &dyn Fn(&Options) -> Simulation,
) -> Result<Planned, SlackError> {
    if let Some(recorded) = waits.program.as_ref().filter(|recorded| *recorded != hash) {
        let (recorded, own) = (recorded.clone(), hash.to_owned());
        return Err(SlackError::OtherProgram { recorded, own });
    }
    let first = simulate(options);
    let cycle = Cycle { files, events: &first.events };
    let way = waits.way.iter().find(|way| missing(&cycle, waits, way).is_none());
    let Some(way) = way else {
        let first = waits.way.first().and_then(|way| missing(&cycle, waits, way));
        return Err(SlackError::OtherWay { first: first.unwrap_or_else(|| "no wait".to_owned()) });
    };
    let known = known(&cycle, waits, way);
    let median = |record: &RecordEntry| quantile(&lengths(record), 0.5).max(0.0);
    let own = |it: &Known<'_>| Arrival {
        wait: it.number,
        after: Anchor::Own,
        delay_s: median(it.record),
    };
    let mut arrivals: Vec<Arrival> = known.iter().map(own).collect();
    let typical = simulate(&Options { arrivals: arrivals.clone(), ..options.clone() });

    let mut notes = Vec::new();
    let cycles = way.cycle_s.len();
    let mut slack: Vec<(usize, Anchor)> = known
        .iter()
        .enumerate()
        .filter(|(_, it)| it.entry.kind == KindEntry::Slack)
        .filter_map(|(index, it)| {
            let anchor = cycle.anchor(it.entry.after.as_ref()?, it.event)?;
            Some((index, anchor))
        })
        .collect();
    keep_starts(&cycle, &mut slack, &known, &mut notes);
    let lists: Vec<Vec<f64>> =
        slack.iter().map(|(index, _)| lengths(known[*index].record)).collect();
    let longer = allowed(cycles, risk);
    if longer.is_none() && !slack.is_empty() {
        notes.push(format!(
            "{cycles} recorded cycles are too few for a risk of {:.3} %: {} are needed; no slack is used up",
            100.0 * risk,
            needed(risk)
        ));
    }
    let mut later = longer.map_or_else(|| vec![0.0; lists.len()], |longer| delays(&lists, longer));
    for ((index, _), delay_s) in slack.iter().zip(&mut later) {
        let it = &known[*index];
        let seen_s = latest_seen(it.record);
        if it.entry.request && *delay_s > seen_s {
            notes.push(format!(
                "{}:{}: the robot sets an output where it waits, which the machine may answer: it comes no later than \
                 it has been seen to wait ({seen_s:.2} s later; the log allows {delay_s:.2} s). joulepath instrument \
                 --late shows more",
                it.record.file, it.record.line
            ));
            *delay_s = seen_s;
        }
    }
    let mut uses = Vec::new();
    for ((index, anchor), delay_s) in slack.iter().zip(&later) {
        let it = &known[*index];
        if *delay_s < LEAST_S {
            continue;
        }
        let Some(from) = start_of(&typical, *anchor) else { continue };
        let came = typical.events.get(it.event).map_or(0.0, |event| event.t_start);
        arrivals[*index] =
            Arrival { wait: it.number, after: *anchor, delay_s: came - from + delay_s };
        uses.push(Use {
            place: format!("{}:{}", it.record.file, it.record.line),
            number: it.number,
            delay_s: *delay_s,
            median_s: median(it.record),
            slack_s: lengths(it.record),
        });
    }
    Ok(Planned { arrivals, uses, share: way.share, cycles, notes })
}

/// The first wait of the cycle that a way has not, if it waits for a signal or condition.
fn missing(cycle: &Cycle<'_>, waits: &WaitsFile, way: &WayEntry) -> Option<String> {
    let known = known(cycle, waits, way);
    cycle.events.iter().enumerate().find_map(|(index, event)| {
        let What::Wait(record) = &event.what else { return None };
        let is_known = record.wait.duration.is_some() || known.iter().any(|it| it.event == index);
        (!is_known).then(|| crate::tool::retrofit::file_and_line(cycle.files, record.wait.span))
    })
}

/// The waits of the cycle whose length the program does not state, with the records of a way.
fn known<'a>(cycle: &Cycle<'_>, waits: &'a WaitsFile, way: &'a WayEntry) -> Vec<Known<'a>> {
    let found = way.record.iter().filter_map(|record| {
        let (event, number) = cycle.wait(&record.file, record.line, record.occurrence)?;
        let What::Wait(wait) = &cycle.events[event].what else { return None };
        if wait.wait.duration.is_some() {
            return None;
        }
        let is_it = |entry: &&WaitEntry| entry.file == record.file && entry.line == record.line;
        let entry = waits.wait.iter().find(is_it)?;
        Some(Known { event, number, entry, record })
    });
    found.collect()
}

/// Where the slower movements of each slack begin: not before an event from which the time of another
/// machine counts, if its wait comes afterwards, because the robot would start that machine later.
fn keep_starts(
    cycle: &Cycle<'_>,
    slack: &mut Vec<(usize, Anchor)>,
    known: &[Known<'_>],
    notes: &mut Vec<String>,
) {
    let starts = |wait: usize| {
        known.iter().filter(|it| it.entry.kind == KindEntry::Slack).filter_map(move |it| {
            let after = it.entry.after.as_ref()?;
            let until = if after.before { cycle.events.len() } else { it.event };
            match cycle.start(after, until) {
                Start::EndOf(at) if after.before || it.event > wait => Some(at),
                _ => None,
            }
        })
    };
    slack.retain_mut(|(index, anchor)| {
        let wait = known[*index].event;
        let begin = anchored(cycle.events, *anchor);
        let is_within = |at: &usize| begin.is_none_or(|begin| begin < *at) && *at < wait;
        let Some(last) = starts(wait).filter(is_within).max() else { return true };
        let later = cycle.standing(last, wait);
        notes.push(format!(
            "{}:{}: the slack is {}: the time of another machine counts from an event before, and the robot would \
             start it later",
            known[*index].record.file,
            known[*index].record.line,
            if later.is_some() { "used in a part of the way" } else { "not used up" }
        ));
        later.inspect(|later| *anchor = *later).is_some()
    });
}

/// Time from the robot's coming to the signal, s, in each cycle.
fn lengths(record: &RecordEntry) -> Vec<f64> {
    record.came_s.iter().zip(&record.signal_s).map(|(came, signal)| signal - came).collect()
}

/// How much later than usual the robot has come and still had to wait, s.
fn latest_seen(record: &RecordEntry) -> f64 {
    let pairs = record.came_s.iter().zip(&record.signal_s);
    let waited: Vec<f64> =
        pairs.filter(|(came, signal)| **signal - **came > AT_ONCE_S).map(|it| *it.0).collect();
    (quantile(&waited, SEEN) - quantile(&record.came_s, 0.5)).max(0.0)
}

/// Time of an anchor, s from the start of the simulation.
fn start_of(simulation: &Simulation, anchor: Anchor) -> Option<f64> {
    let ends = |event: &Event| event.t_start + event.duration;
    match anchor {
        Anchor::Cycle => {
            let first = simulation.repeats_from.and_then(|first| simulation.events.get(first));
            Some(first.map_or(0.0, |event| event.t_start))
        }
        Anchor::Own => None,
        anchor => simulation.events.get(anchored(&simulation.events, anchor)?).map(ends),
    }
}

/// A quantile of numbers, 0 of none.
fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = share * sorted.len().saturating_sub(1) as f64;
    let (low, high) = (at.floor() as usize, at.ceil() as usize);
    match (sorted.get(low), sorted.get(high)) {
        (Some(a), Some(b)) => a + (b - a) * (at - at.floor()),
        _ => 0.0,
    }
}
