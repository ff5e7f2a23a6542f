//! From logs to complete cycles with their energies.

use super::error::ProveError;
use super::rest::{Level, Window, windows};
use super::series::{Measure, Series};
use super::side::{EventLog, PowerLog, Side, gap_cause};
use super::spans::{Source, Span, spans};
use super::unit::{Kind, LeftOut, POINTS, Period, Unit, Wait};
use super::waiting::Waiting;
use crate::learn::log::Channel;
use crate::tool::cell::events::{Cycle, Visit, What};

/// Least number of rows of a cycle, and the number below which a note says so.
const ROWS: f64 = 8.0;
const FINE: f64 = 40.0;
/// Payloads are told apart in steps of this size, kg.
const PAYLOAD_KG: f64 = 0.1;

/// The cycles of a side.
pub(super) struct Measured {
    pub(super) units: Vec<Unit>,
    pub(super) left_out: Vec<LeftOut>,
    pub(super) notes: Vec<String>,
    /// Power at rest, W.
    pub(super) level: Option<Level>,
    /// Whether cycles were found by the power alone.
    pub(super) by_power: bool,
    /// Whether the log of events has the waits.
    pub(super) has_events: bool,
    series: Vec<(Series, Vec<Window>)>,
    /// The log and the times of each unit.
    places: Vec<(usize, f64, f64)>,
}

/// Reads the cycles of a side.
pub(super) fn measured(
    side: &Side,
    period: Period,
    measure: Measure,
) -> Result<Measured, ProveError> {
    let option = period.option();
    if side.logs.is_empty() {
        return Err(ProveError::NoPower { side: option });
    }
    let mut found = Measured {
        units: Vec::new(),
        left_out: Vec::new(),
        notes: Vec::new(),
        level: None,
        by_power: false,
        has_events: !side.events.is_empty(),
        series: Vec::new(),
        places: Vec::new(),
    };
    let sessions: Vec<(&EventLog, usize)> = side
        .events
        .iter()
        .flat_map(|of| (0..of.recording.sessions.len()).map(move |session| (of, session)))
        .collect();
    let mut clock = Clock::default();
    let (mut cut, mut unrecorded, mut gaps) = (0, 0, Vec::new());
    for (index, log) in side.logs.iter().enumerate() {
        let series = Series::of(log, measure)?;
        if series.kilowatts {
            found.notes.push(format!("{}: the power is in kW", log.shown));
        }
        let own =
            if sessions.len() == side.logs.len() { index..index + 1 } else { 0..sessions.len() };
        let (source, spans) = spans(log, &series, &sessions[own])?;
        found.by_power |= source == Source::Power;
        if source == Source::Power {
            let text = "no column `cycle`: the cycles were found by the power alone";
            found.notes.push(format!("{}: {text}", log.shown));
        }
        let offset = clock.offset(series.range());
        let shortest = shortest(&spans);
        let has_records = spans.iter().any(|span| span.recorded.is_some());
        for span in spans {
            let lasts = span.end - span.begin;
            if span.is_edge && lasts < shortest - series.step {
                cut += 1;
                continue;
            }
            if has_records && span.recorded.is_none() {
                unrecorded += 1;
                continue;
            }
            if let Some(gap) = series.gap(span.begin, span.end) {
                gaps.push(gap);
                continue;
            }
            if lasts < ROWS * series.step {
                let (file, step_s) = (log.shown.clone(), series.step);
                return Err(ProveError::Rare { file, step_s, cycle_s: lasts });
            }
            found.places.push((index, span.begin, span.end));
            found.units.push(unit(log, &series, &span, offset));
        }
        let windows = if measure == Measure::Cabinet { windows(&series) } else { Vec::new() };
        found.series.push((series, windows));
    }
    if found.units.is_empty() {
        let files: Vec<&str> = side.logs.iter().map(|log| log.shown.as_str()).collect();
        let why = if gaps.is_empty() {
            String::new()
        } else {
            format!(" ({} cycles have gaps in the sampling)", gaps.len())
        };
        return Err(ProveError::NoCycles { file: files.join(", "), why });
    }
    let durations = found.units.iter().map(|unit| unit.duration_s).fold(f64::INFINITY, f64::min);
    let step = found.series.iter().map(|(series, _)| series.step).fold(0.0, f64::max);
    if durations < FINE * step {
        found.notes.push(format!(
            "{option}: a row every {step:.3} s is coarse for cycles of {durations:.2} s; the interval has the \
             scatter that this causes"
        ));
    }
    found.leave(period, cut, "cut by the begin or the end of the log".to_owned());
    found.leave(period, unrecorded, "not complete in the log of events".to_owned());
    let longest = gaps.iter().copied().fold(0.0, f64::max);
    let why = format!("a gap in the sampling, up to {longest:.1} s{}", gap_cause(longest));
    found.leave(period, gaps.len(), why);
    let all: Vec<Window> = found.series.iter().flat_map(|(_, windows)| windows.clone()).collect();
    found.level = Level::of(&all);
    Ok(found)
}

impl Measured {
    fn leave(&mut self, period: Period, count: usize, why: String) {
        if count > 0 {
            self.left_out.push(LeftOut { period, count, why });
        }
    }

    /// Fills in the power at rest and, without a log of events, the time at rest: the time by a level that both
    /// sides may share, the power by the side's own one, because the band around a shared level would hide a
    /// part of their difference.
    pub(super) fn rest(&mut self, level: Option<Level>, with_events: bool) {
        for (unit, (log, begin, end)) in self.units.iter_mut().zip(&self.places) {
            let (Some(level), Some(own)) = (level, self.level) else {
                if !with_events {
                    unit.rest_s = 0.0;
                }
                continue;
            };
            let (series, windows) = &self.series[*log];
            unit.rest_w = own.within(series, windows, *begin, *end).1;
            let [first, last] = [*begin, *end].map(|at| series.t.partition_point(|t| *t < at));
            unit.level_w = own.floor_within(windows, first..last);
            if !with_events {
                unit.rest_s = level.within(series, windows, *begin, *end).0;
            }
        }
    }

    /// The cycles with their logs.
    pub(super) fn cycles(&self) -> impl Iterator<Item = (&Unit, &Series)> {
        self.units.iter().zip(self.places.iter().map(|(log, ..)| &self.series[*log].0))
    }

    /// Fills in what waits of these cycles would have taken before, from the log of events.
    pub(super) fn wait(&mut self, of: &Waiting) {
        for (unit, (log, ..)) in self.units.iter_mut().zip(&self.places) {
            unit.waiting_s = of.energy_j(unit) / of.mean_w;
            unit.level_w = of.level_w(unit, &self.series[*log].0);
        }
    }
}

/// The times of several logs on one clock: a log that begins before the end of the last one follows it.
#[derive(Default)]
struct Clock {
    end: Option<f64>,
}

impl Clock {
    fn offset(&mut self, [first, last]: [f64; 2]) -> f64 {
        let offset = self.end.map_or(0.0, |end| (end - first).max(0.0));
        self.end = Some(last + offset);
        offset
    }
}

/// The shortest cycle that the log has not cut; without one, nothing tells whether the others are whole.
fn shortest(spans: &[Span]) -> f64 {
    let inner = spans.iter().filter(|span| !span.is_edge);
    inner.map(|span| span.end - span.begin).fold(f64::INFINITY, f64::min)
}

fn unit(of: &PowerLog, series: &Series, span: &Span, offset: f64) -> Unit {
    let (begin, end) = (span.begin, span.end);
    let rows = series.t.partition_point(|t| *t < begin)..series.t.partition_point(|t| *t < end);
    let column = |channel: Channel| of.log.column(channel).map(|values| &values[rows.clone()]);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len().max(1) as f64;
    let payload = column(Channel::Payload).map(|x| x.iter().copied().fold(0.0, f64::max));
    let recorded = span.recorded.as_ref();
    let payload = payload.or_else(|| recorded.and_then(heaviest));
    let part = column(Channel::Part).and_then(most_frequent).map(|number| {
        let named = of.scan.parts.iter().find(|(known, _)| *known == number);
        named.map_or_else(|| number.to_string(), |(_, name)| name.clone())
    });
    let waits = recorded.map_or_else(Vec::new, |cycle| {
        let clock = begin - cycle.start;
        let wait = |(place, visit): (usize, &Visit)| {
            let to = visit.ended? + clock;
            Some(Wait { place, from: visit.came + clock, to })
        };
        cycle.visits.iter().enumerate().filter_map(wait).collect()
    });
    let lasts = end - begin;
    let at = |point: usize| begin + lasts * point as f64 / POINTS as f64;
    Unit {
        file: of.shown.clone(),
        t: begin + offset,
        energy_j: series.energy(end) - series.energy(begin),
        duration_s: lasts,
        rest_s: waits.iter().map(|wait| wait.to - wait.from).sum(),
        waits,
        waiting_s: 0.0,
        rest_w: None,
        level_w: None,
        temperature: column(Channel::Temperature(0)).map(mean),
        kind: Kind {
            part,
            payload: payload.map(|kg| (kg / PAYLOAD_KG).round() as i64),
            way: recorded.map(way),
        },
        course: (0..POINTS).map(|point| series.mean(at(point), at(point + 1))).collect(),
    }
}

/// The most frequent value.
fn most_frequent(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let most = sorted.chunk_by(|a, b| a == b).max_by_key(|same| same.len());
    most.map(|same| same[0])
}

/// The heaviest load of a cycle, kg.
fn heaviest(cycle: &Cycle) -> Option<f64> {
    let loads = cycle.events.iter().filter_map(|event| match event.what {
        What::Load(mass) => Some(mass),
        _ => None,
    });
    loads.reduce(f64::max)
}

/// Waits, outputs and loads in order. Lines are not compared: a retrofit inserts some.
fn way(cycle: &Cycle) -> String {
    let signal = |signal: &Option<String>| signal.clone().unwrap_or_default();
    let waits =
        cycle.visits.iter().map(|visit| (visit.came, format!("wait {}", signal(&visit.signal))));
    let events = cycle.events.iter().filter_map(|event| match event.what {
        What::Output(level) => Some((event.t, format!("{}={level}", signal(&event.signal)))),
        What::Load(mass) => Some((event.t, format!("load {mass}"))),
        _ => None,
    });
    let mut steps: Vec<(f64, String)> = waits.chain(events).collect();
    steps.sort_by(|a, b| a.0.total_cmp(&b.0));
    let steps: Vec<String> = steps.into_iter().map(|(_, step)| step).collect();
    steps.join(", ")
}
