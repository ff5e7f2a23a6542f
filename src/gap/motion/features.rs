//! What is measured of each movement, and how it differs from the baseline.

use super::landmarks::{Landmarks, Point};
use super::run::{Run, Span};
use super::smooth::{Passage, Smooth};

/// A measured quantity of a movement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Feature {
    /// From its beginning to that of the next one \[s\].
    Duration,
    /// Rest behind it \[s\].
    Rest,
    /// Logarithm of its speed at half of its way \[1\].
    Speed,
    /// The same at a point of the ramp from a rest.
    Start,
    /// The same of the ramp to a rest.
    End,
    /// How much later than half of its duration it is at half of its way \[s\].
    Shift,
    /// How far from the corner to the next one it turns off \[rad\].
    Corner,
}

impl Feature {
    pub(super) const ALL: [Feature; 7] = [
        Feature::Duration,
        Feature::Rest,
        Feature::Speed,
        Feature::Start,
        Feature::End,
        Feature::Shift,
        Feature::Corner,
    ];
    pub(super) const COUNT: usize = Feature::ALL.len();

    /// Variance that the sampling alone gives, in squares of its interval: a difference of two
    /// times that are each known to half of it, or their mean.
    pub(super) fn sampled(self) -> f64 {
        match self {
            Feature::Duration | Feature::Rest => 1.0 / 6.0,
            Feature::Shift => 1.0 / 24.0,
            Feature::Speed | Feature::Start | Feature::End | Feature::Corner => 0.0,
        }
    }
}

/// Measured values by feature, one for each time that the movement ran.
#[derive(Clone, Debug, Default)]
pub(super) struct Measured {
    pub values: [Vec<f64>; Feature::COUNT],
}

impl Measured {
    fn add(&mut self, feature: Feature, value: Option<f64>) {
        self.values[feature as usize].extend(value.filter(|value| value.is_finite()));
    }

    /// The mean of a feature.
    pub(super) fn mean(&self, feature: Feature) -> Option<f64> {
        let values = &self.values[feature as usize];
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    }

    /// Squares of the deviations from the mean, and how many of them are free.
    pub(super) fn squares(&self, feature: Feature) -> (f64, f64) {
        let mean = self.mean(feature).unwrap_or(0.0);
        let values = &self.values[feature as usize];
        let squares = values.iter().map(|value| (value - mean).powi(2)).sum();
        (squares, (values.len() as f64 - 1.0).max(0.0))
    }
}

/// Share of a duration by which a movement may reach its middle later than it ends \[1\].
const LATE: f64 = 0.25;
/// Share of a movement's way by which it may miss its middle \[1\].
const ASTRAY: f64 = 0.2;

/// The movements `of` as some runs show them.
pub(super) fn measured(of: &[Landmarks], runs: &[Run], step: f64) -> Vec<Measured> {
    let mut all = vec![Measured::default(); of.len()];
    for run in runs {
        let motion = Smooth::of(run, step);
        let spans = run.spans();
        let known = |span: &Span| of.iter().position(|of| of.number == span.number);
        let middles: Vec<Option<Passage>> = spans
            .iter()
            .map(|span| known(span).and_then(|k| passed(&motion, span, &of[k])))
            .collect();
        let row = |k: usize| middles.get(k)?.map(|passage| passage.row);
        for (k, span) in spans.iter().enumerate() {
            let Some(at) = known(span) else { continue };
            let follows = spans.get(k + 1).is_some_and(|next| of[at].next == Some(next.number));
            let around = Around {
                before: k.checked_sub(1).and_then(row).unwrap_or(span.from),
                middle: middles[k],
                after: row(k + 1).filter(|_| follows),
            };
            measure(&mut all[at], &of[at], &Seen { run, motion: &motion }, span, &around);
        }
    }
    all
}

/// A log with its motion.
struct Seen<'a> {
    run: &'a Run,
    motion: &'a Smooth,
}

/// Where the robot passes the middle of a movement, and rows of the middles beside it.
struct Around {
    before: usize,
    middle: Option<Passage>,
    after: Option<usize>,
}

/// Where the robot passes the middle of a movement.
fn passed(motion: &Smooth, span: &Span, of: &Landmarks) -> Option<Passage> {
    let point = of.middle.as_ref()?;
    let late = (LATE * (span.to - span.from) as f64) as usize;
    let passage = motion.nearest(span.from, span.to + late, point)?;
    (passage.instant.distance(point) < ASTRAY * of.way).then_some(passage)
}

/// Adds what a log shows of a movement once.
fn measure(into: &mut Measured, of: &Landmarks, log: &Seen<'_>, span: &Span, around: &Around) {
    let Seen { run, motion } = log;
    let times = span.is_whole().then(|| [span.from, span.to].map(|row| run.start(row)));
    into.add(Feature::Duration, times.map(|[from, to]| to - from));
    let Some(middle) = around.middle else { return };
    into.add(Feature::Shift, times.map(|[from, to]| middle.instant.t - 0.5 * (from + to)));
    into.add(Feature::Speed, Some(middle.instant.speed.ln()));
    // On the way back the robot passes a ramp again.
    let rows = around.before..around.after.unwrap_or(span.to);
    let moving = motion.moving(rows, middle.row, of.rest);
    let speed = |from: usize, to: usize, point: Option<&Point>| {
        Some(motion.nearest(from, to, point?)?.instant.speed.ln())
    };
    into.add(Feature::Start, speed(moving.start, middle.row + 1, of.start.as_ref()));
    into.add(Feature::End, speed(middle.row, moving.end, of.end.as_ref()));
    let Some(after) = around.after else { return };
    into.add(Feature::Rest, Some(motion.resting(middle.row, after, of.rest)));
    let Some(corner) = &of.corner else { return };
    let passage = motion.nearest(middle.row, after, corner);
    into.add(Feature::Corner, passage.map(|of| of.instant.distance(corner)));
}
