//! `\T`: each timed leg of a path takes its own time.
//!
//! A time replaces a speed (RAPID reference, `\T`): the search finds the cap on the path speed of
//! each timed leg at which it takes its time. Neighbouring legs share corners, so all caps change
//! together.

use super::timing::grid::PathGrid;
use super::timing::limits::PathLimits;
use super::timing::profile::Profile;
use super::timing::reachability::time_optimal;

/// Largest number of rounds.
const ROUNDS: usize = 40;
/// Relative tolerance of the time of a leg.
const IN_TIME: f64 = 1e-5;
/// Largest factor on a cap in one round.
const LARGEST_STEP: f64 = 4.0;

/// A leg of a path.
pub(super) struct TimedLeg {
    /// End in s.
    pub end: f64,
    /// Required time, s.
    pub time: Option<f64>,
}

/// Secant search for the inverse of a cap.
struct Search {
    inverse: f64,
    before: Option<(f64, f64)>,
}

/// The fastest profile in which no timed leg is faster than its time; `None` if a round has no
/// profile. A leg that cannot keep its time takes longer.
pub(super) fn timed_profile(
    grid: &PathGrid,
    limits: &PathLimits,
    legs: &[TimedLeg],
    fastest: Profile,
) -> Option<Profile> {
    let lengths: Vec<f64> = (0..legs.len())
        .map(|i| legs[i].end - i.checked_sub(1).map_or(0.0, |before| legs[before].end))
        .collect();
    let leg_of: Vec<usize> = grid
        .s()
        .windows(2)
        .map(|s| legs.partition_point(|leg| leg.end < 0.5 * (s[0] + s[1])).min(legs.len() - 1))
        .collect();
    let mut best = fastest;
    // Start without caps: a leg that is too slow stays uncapped.
    let mut search: Vec<Search> =
        legs.iter().map(|_| Search { inverse: 0.0, before: None }).collect();
    for _ in 0..ROUNDS {
        let mut done = true;
        for (i, (leg, search)) in legs.iter().zip(&mut search).enumerate() {
            // Slightly early, since a profile can be slowed to the exact time but not made faster.
            let Some(time) = leg.time.map(|time| time * (1.0 - 0.5 * IN_TIME)) else { continue };
            let begin = i.checked_sub(1).map_or(0.0, |before| best.time_at(legs[before].end));
            let took = best.time_at(leg.end) - begin;
            let uncapped = search.inverse == 0.0;
            if (took - time).abs() <= 0.5 * IN_TIME * time || (uncapped && took > time) {
                continue;
            }
            done = false;
            search.step(took, time, lengths[i]);
        }
        if done {
            break;
        }
        let caps: Vec<f64> = leg_of.iter().map(|leg| 1.0 / search[*leg].inverse).collect();
        best = time_optimal(&grid.capped(|k| caps[k]), limits).into_profile()?;
    }
    Some(best)
}

impl Search {
    /// The next inverse of the cap by the secant through the last two.
    fn step(&mut self, took: f64, time: f64, length: f64) {
        // At this cap the leg takes all its time at constant speed.
        let slowest = time / length;
        if self.inverse == 0.0 {
            self.inverse = 0.5 * slowest;
            return;
        }
        let slope = match self.before {
            Some((inverse, took_before)) if inverse != self.inverse => {
                (took - took_before) / (self.inverse - inverse)
            }
            _ => length,
        };
        // The slope is at most the length of the leg; it is 0 while the cap does not bind.
        let slope = if slope > 0.01 * length { slope.min(length) } else { length };
        self.before = Some((self.inverse, took));
        let next = self.inverse + (time - took) / slope;
        self.inverse =
            next.clamp(self.inverse / LARGEST_STEP, self.inverse * LARGEST_STEP).min(slowest);
    }
}
