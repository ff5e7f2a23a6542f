//! Where the cycles of a log begin and end.

use super::error::ProveError;
use super::periodic;
use super::series::Series;
use super::side::{EventLog, PowerLog};
use crate::learn::log::Channel;
use crate::tool::cell::events::{Cycle, cycles};

/// A cycle in a log of power.
#[derive(Clone, Debug)]
pub(super) struct Span {
    pub(super) begin: f64,
    pub(super) end: f64,
    pub(super) number: Option<f64>,
    /// Whether the log may have cut it: it is the first or the last one.
    pub(super) is_edge: bool,
    /// What the recorder saw of it.
    pub(super) recorded: Option<Cycle>,
}

/// How the cycles of a log were found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    Column,
    Events,
    Power,
}

/// Returns to a number before which a file is of two robots.
const RETURNS: usize = 3;

/// The cycles of a log, by its column `cycle`, by the log of events, or by the power alone. Of the given
/// sessions of the recorder, those are used that the log covers.
pub(super) fn spans(
    of: &PowerLog,
    series: &Series,
    sessions: &[(&EventLog, usize)],
) -> Result<(Source, Vec<Span>), ProveError> {
    let recorded: Vec<Vec<Cycle>> = sessions
        .iter()
        .map(|(events, session)| {
            let all = cycles(&events.recording).into_iter();
            all.filter(|cycle| cycle.session == *session).collect()
        })
        .collect();
    if let Some(numbers) = of.log.column(Channel::Cycle) {
        let mut spans = by_number(of, series, numbers)?;
        pair(&mut spans, &recorded);
        return Ok((Source::Column, spans));
    }
    let [first, last] = series.range();
    let common = |cycles: &&Vec<Cycle>| {
        let ends = cycles.first().zip(cycles.last());
        ends.map_or(0.0, |(a, b)| (b.end.min(last) - a.start.max(first)).max(0.0))
    };
    let covered = recorded.iter().max_by(|a, b| common(a).total_cmp(&common(b)));
    if let Some(recorded) = covered.filter(|cycles| !cycles.is_empty()).cloned() {
        let inside = recorded.into_iter().filter(|cycle| cycle.start >= first && cycle.end <= last);
        let span = |cycle: Cycle| Span {
            begin: cycle.start,
            end: cycle.end,
            number: Some(cycle.number as f64),
            is_edge: false,
            recorded: Some(cycle),
        };
        return Ok((Source::Events, inside.map(span).collect()));
    }
    let starts = periodic::starts(series);
    if starts.is_empty() {
        let why = ": there is no column `cycle`, and the power alone has no cycles that resemble each other";
        return Err(ProveError::NoCycles { file: of.shown.clone(), why: why.to_owned() });
    }
    let span = |pair: &[f64]| Span {
        begin: pair[0],
        end: pair[1],
        number: None,
        is_edge: false,
        recorded: None,
    };
    Ok((Source::Power, starts.windows(2).map(span).collect()))
}

/// Finds the recorded cycles of the spans by their numbers. A recorder begins again at 1 after a restart, and the
/// log may begin with any session: the one counts with which most cycles are found, then the one whose
/// durations fit best.
fn pair(spans: &mut [Span], recorded: &[Vec<Cycle>]) {
    let mut best: (usize, f64, Vec<Option<&Cycle>>) = (0, 0.0, Vec::new());
    for first in 0..recorded.len() {
        let (mut session, mut last) = (first, None);
        let (mut count, mut difference) = (0, 0.0);
        let mut found = Vec::new();
        for span in spans.iter() {
            session += usize::from(span.number <= last);
            last = span.number;
            let same = |cycle: &&Cycle| span.number == Some(cycle.number as f64);
            let cycle = recorded.get(session).and_then(|cycles| cycles.iter().find(same));
            if let Some(cycle) = cycle {
                count += 1;
                difference += (cycle.end - cycle.start - (span.end - span.begin)).abs();
            }
            found.push(cycle);
        }
        if count > best.0 || count == best.0 && difference < best.1 {
            best = (count, difference, found);
        }
    }
    for (span, cycle) in spans.iter_mut().zip(best.2) {
        span.recorded = cycle.cloned();
    }
}

/// Runs of rows with the same number.
fn by_number(of: &PowerLog, series: &Series, numbers: &[f64]) -> Result<Vec<Span>, ProveError> {
    let t = &series.t;
    let mut runs: Vec<(usize, f64)> = Vec::new();
    for (row, number) in numbers.iter().enumerate() {
        if runs.last().is_none_or(|(_, last)| last != number) {
            runs.push((row, *number));
        }
    }
    let returns = runs.windows(3).filter(|three| three[0].1 == three[2].1);
    if let Some(three) = returns.clone().next().filter(|_| returns.count() >= RETURNS) {
        let line = of.log.rows[three[2].0];
        return Err(ProveError::TwoRobots { file: of.shown.clone(), line });
    }
    let last = runs.len().saturating_sub(1);
    let span = |(index, (row, number)): (usize, &(usize, f64))| {
        let next = runs.get(index + 1).map(|(row, _)| *row);
        // The recorder may pause between cycles; then the cycle ends with its last row.
        let end = match next {
            Some(next) if series.gap(t[next - 1], t[next]).is_none() => t[next],
            Some(next) => t[next - 1],
            None => t[t.len() - 1],
        };
        Span {
            begin: t[*row],
            end,
            number: Some(*number),
            is_edge: index == 0 || index == last,
            recorded: None,
        }
    };
    Ok(runs.iter().enumerate().map(span).filter(|span| span.end > span.begin).collect())
}
