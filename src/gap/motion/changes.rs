//! How movements differ from those of the baseline.

use super::features::{Feature, Measured, measured};
use super::landmarks::Landmarks;
use super::run::{Run, Span};
use super::smooth::Smooth;
use crate::learn::log::{median_step, quantile};

/// Repetitions for which the spread of all movements stands beside those of one.
const LENT: f64 = 4.0;

/// A difference from the baseline with its standard deviation, in the unit of its feature.
#[derive(Clone, Copy, Debug)]
pub(super) struct Change {
    pub value: f64,
    pub sd: f64,
}

/// A movement in the baseline and in the logs.
#[derive(Clone, Debug)]
pub(super) struct Movement {
    /// Its points.
    pub landmarks: Landmarks,
    /// What the baseline shows.
    pub before: Measured,
    /// What the logs show.
    pub now: Measured,
    /// Differences by feature.
    pub changes: [Option<Change>; Feature::COUNT],
}

impl Movement {
    /// The difference of a feature.
    pub(super) fn change(&self, feature: Feature) -> Option<Change> {
        self.changes[feature as usize]
    }

    /// Whether logs and baseline have it.
    pub(super) fn is_compared(&self) -> bool {
        self.changes.iter().any(Option::is_some)
    }

    /// Whether it ended at rest in the baseline.
    pub(super) fn stops(&self) -> bool {
        self.landmarks.end.is_some() || self.landmarks.middle.is_none()
    }

    /// Whether it began at rest in the baseline.
    pub(super) fn starts(&self) -> bool {
        self.landmarks.start.is_some() || self.landmarks.middle.is_none()
    }

    /// Its duration in the baseline without the rest behind it \[s\].
    pub(super) fn moving(&self) -> f64 {
        let duration = self.before.mean(Feature::Duration).unwrap_or(0.0);
        (duration - self.before.mean(Feature::Rest).unwrap_or(0.0)).max(0.0)
    }
}

/// The movements of a program in the order of their numbers, as logs and a baseline show them.
pub(super) fn movements(baseline: &[Run], train: &[Run]) -> Vec<Movement> {
    let step = baseline.iter().chain(train).map(|run| median_step(&run.t)).fold(0.0, f64::max);
    let landmarks = landmarks(baseline, step);
    let before = measured(&landmarks, baseline, step);
    let now = measured(&landmarks, train, step);
    let mut movements: Vec<Movement> = landmarks
        .into_iter()
        .zip(before)
        .zip(now)
        .map(|((landmarks, before), now)| {
            let changes = [None; Feature::COUNT];
            Movement { landmarks, before, now, changes }
        })
        .collect();
    for feature in Feature::ALL {
        let [a, b] = [baseline, train].map(|runs| sampled(runs, feature));
        let pooled = [
            pooled(movements.iter().map(|of| &of.before), feature),
            pooled(movements.iter().map(|of| &of.now), feature),
        ];
        for movement in &mut movements {
            let before = movement.before.estimate(feature, pooled[0], a);
            let now = movement.now.estimate(feature, pooled[1], b);
            movement.changes[feature as usize] = before.zip(now).map(|(before, now)| Change {
                value: now.value - before.value,
                sd: before.sd.hypot(now.sd),
            });
        }
    }
    movements
}

/// The points of each movement in the repetition that took neither short nor long.
fn landmarks(baseline: &[Run], step: f64) -> Vec<Landmarks> {
    let logs: Vec<(Smooth, Vec<Span>)> =
        baseline.iter().map(|run| (Smooth::of(run, step), run.spans())).collect();
    let mut numbers: Vec<usize> =
        logs.iter().flat_map(|(_, spans)| spans.iter().map(|span| span.number)).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let typical = |number: usize| {
        let mut all: Vec<(f64, usize, usize)> = Vec::new();
        for (log, (run, (_, spans))) in baseline.iter().zip(&logs).enumerate() {
            let own = spans.iter().enumerate().filter(|(_, span)| span.number == number);
            for (k, span) in own.filter(|(_, span)| span.is_whole()) {
                all.push((run.start(span.to) - run.start(span.from), log, k));
            }
        }
        // Its corner shows where the next movement is there as a whole.
        let follows = |log: usize, k: usize| logs[log].1.get(k + 1).is_some_and(Span::is_whole);
        if all.iter().any(|(_, log, k)| follows(*log, *k)) {
            all.retain(|(_, log, k)| follows(*log, *k));
        }
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (_, log, k) = *all.get(all.len() / 2)?;
        let (motion, spans) = &logs[log];
        Some(Landmarks::of(motion, spans, k))
    };
    numbers.into_iter().filter_map(typical).collect()
}

/// The variance of a time that sampling alone gives.
fn sampled(runs: &[Run], feature: Feature) -> f64 {
    let step = runs.iter().map(|run| median_step(&run.t)).fold(0.0, f64::max);
    feature.sampled() * step * step
}

/// The variance of a feature from repetition to repetition that a movement usually has.
fn pooled<'m>(movements: impl Iterator<Item = &'m Measured>, feature: Feature) -> f64 {
    let own = movements.map(|of| of.squares(feature)).filter(|(_, free)| *free > 0.0);
    quantile(own.map(|(squares, free)| squares / free), 0.5)
}

impl Measured {
    /// The mean of a feature, where `pooled` is the variance that others have and `least` the
    /// least one.
    fn estimate(&self, feature: Feature, pooled: f64, least: f64) -> Option<Change> {
        let value = self.mean(feature)?;
        let (squares, free) = self.squares(feature);
        let variance = ((squares + LENT * pooled) / (free + LENT)).max(least);
        Some(Change { value, sd: (variance / (free + 1.0)).sqrt() })
    }
}
