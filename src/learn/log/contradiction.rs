//! Rows in which a series contradicts its motion: spikes, and values that stay while it moves.

use std::ops::Range;

use super::uniform::{median_step, quantile};

/// Least ratio of a jump to the median one.
const UNUSUAL: f64 = 30.0;
/// Least ratio of a jump to the resolution, and of a step before values that stay.
const RESOLVED: f64 = 3.0;
const MOVES: f64 = 10.0;
/// Largest relative difference of a jump and the jump back.
const BACK: f64 = 0.5;
/// An interval longer than the median by this factor is a gap, where the motion is not known.
const GAP: f64 = 5.0;
/// Largest number of rows between a jump and the jump back.
const LONGEST: usize = 50;
/// Largest ratio of a jump after values that stay to what the joint has moved since.
const CAUGHT_UP: f64 = 2.0;
/// Least ratio of the step after values that stay in a steady motion to the motion since.
const MADE_UP: f64 = 0.75;
/// Largest number of rows before the first jump, or after the last one, that count as spike.
const AT_ENDS: usize = 3;
/// Least share of a slope that remains in the next interval of a steady motion, and the largest
/// ratio of two slopes of it.
const STEADY: f64 = 0.5;

/// The sizes of jumps that no robot makes.
#[derive(Clone, Copy, Debug)]
pub struct Jumps {
    /// Any smaller one is possible.
    pub least: f64,
    /// Jumps beyond this times the interval \[s\] to the power of `order` are impossible …
    pub per_time: f64,
    /// … where 2 stands for positions and 1 for rates.
    pub order: i32,
    /// Any larger one is impossible.
    pub most: f64,
}

/// The rows of a series `x` at ascending times `t` \[s\] between a jump and the jump back, each with
/// the reason, which lacks the name of the series.
#[must_use]
pub fn spikes(t: &[f64], x: &[f64], jumps: Jumps) -> Vec<(usize, String)> {
    if x.len() < 2 * AT_ENDS { Vec::new() } else { Steps::new(t, x).spikes(jumps) }
}

/// The rows of positions `x` with the value of the row before in the middle of a motion, as in
/// [`spikes`]; `again` tells which rows have the positions of the row before in all joints.
#[must_use]
pub fn stays(t: &[f64], x: &[f64], again: &[bool]) -> Vec<(usize, String)> {
    if x.len() < 2 * AT_ENDS { Vec::new() } else { Steps::new(t, x).stays(again) }
}

/// The steps from row to row.
struct Steps<'a> {
    t: &'a [f64],
    x: &'a [f64],
    /// Mean slope of each interval.
    slopes: Vec<f64>,
    /// Deviation of the step of each interval from the motion around it.
    jumps: Vec<f64>,
    /// Median size of these.
    usual: f64,
    /// Smallest step.
    resolution: f64,
}

impl Steps<'_> {
    fn new<'a>(t: &'a [f64], x: &'a [f64]) -> Steps<'a> {
        let count = x.len() - 1;
        let slopes: Vec<f64> = (0..count).map(|k| (x[k + 1] - x[k]) / (t[k + 1] - t[k])).collect();
        let jump = |k: usize| {
            let before = k.checked_sub(1).map(|k| slopes[k]);
            let after = slopes.get(k + 1).copied();
            let middle = before.zip(after).map(|(a, b)| 0.5 * (a + b));
            let off = [before, after, middle].into_iter().flatten().map(|slope| slopes[k] - slope);
            let least = off.min_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0);
            least * (t[k + 1] - t[k])
        };
        let jumps: Vec<f64> = (0..count).map(jump).collect();
        let sizes = x.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|size| *size > 0.0);
        Steps {
            t,
            x,
            usual: quantile(jumps.iter().map(|jump| jump.abs()), 0.5),
            resolution: sizes.fold(f64::INFINITY, f64::min),
            slopes,
            jumps,
        }
    }

    /// Rows between a jump and the jump back, between a jump and an end, and rows with the value of
    /// the row before, before a jump.
    fn spikes(&self, possible: Jumps) -> Vec<(usize, String)> {
        let longest = GAP * median_step(self.t);
        let is_jump = |k: &usize| {
            let interval = self.t[k + 1] - self.t[*k];
            let most = (possible.per_time * interval.powi(possible.order)).min(possible.most);
            let least = most.max(possible.least).max(RESOLVED * self.resolution);
            interval <= longest && self.jumps[*k].abs() > least.max(UNUSUAL * self.usual)
        };
        let jumps: Vec<usize> = (0..self.jumps.len()).filter(is_jump).collect();
        let (mut rows, mut stays) = (Vec::new(), Vec::new());
        let mut open: Option<usize> = None;
        for k in jumps {
            let size = self.jumps[k];
            match open {
                Some(from)
                    if k - from <= LONGEST
                        && (self.jumps[from] + size).abs() < BACK * size.abs() =>
                {
                    rows.extend(from + 1..=k);
                    open = None;
                }
                None if k < AT_ENDS && !self.returns(k, &is_jump) => rows.extend(0..=k),
                _ => {
                    stays.extend(self.caught_up(k));
                    open = Some(k);
                }
            }
        }
        if let Some(last) = open.filter(|last| self.x.len() - 1 - last <= AT_ENDS) {
            rows.extend(last + 1..self.x.len());
        }
        let jumps = rows.into_iter().map(|row| (row, format!("jumps to {}", self.x[row])));
        jumps.chain(stays.into_iter().map(|row| (row, self.stay(row)))).collect()
    }

    /// Whether a jump back follows soon.
    fn returns(&self, k: usize, is_jump: &dyn Fn(&usize) -> bool) -> bool {
        let soon = k + 1..self.jumps.len().min(k + LONGEST + 1);
        let back =
            |other: &usize| (self.jumps[*other] + self.jumps[k]).abs() < BACK * self.jumps[k].abs();
        soon.filter(is_jump).any(|other| back(&other))
    }

    /// The rows with the value of the row before, before a jump by what the joint has moved since.
    fn caught_up(&self, k: usize) -> Range<usize> {
        let same = (0..k).rev().take_while(|row| self.x[*row] == self.x[k]).count();
        let first = k - same;
        let Some(before) = first.checked_sub(1).filter(|_| same <= LONGEST) else { return 0..0 };
        let share = self.jumps[k] / (self.slopes[before] * (self.t[k + 1] - self.t[first]));
        if (0.0..CAUGHT_UP).contains(&share) { first + 1..k + 1 } else { 0..0 }
    }

    fn stay(&self, row: usize) -> String {
        format!("stays at {} while the joint moves", self.x[row])
    }

    /// Rows with the value of the row before, in the middle of a steady motion.
    fn stays(&self, again: &[bool]) -> Vec<(usize, String)> {
        let mut found = Vec::new();
        let mut first = 0;
        for end in 1..self.x.len() {
            if self.x[end] == self.x[first] {
                continue;
            }
            // The rows from `first` up to `end` have the same value. One row of a single series may
            // have it by its resolution.
            let stays = end - first > 2 || again[first + 1..end].contains(&true);
            if stays && self.is_steady_around(first, end - 1) {
                found.extend((first + 1..end).map(|row| (row, self.stay(row))));
            }
            first = end;
        }
        found
    }

    /// Whether the motion is steady before row `first` and after row `last`, and the step between
    /// makes up for the time in which the series stayed: a joint that rested would go on from there.
    fn is_steady_around(&self, first: usize, last: usize) -> bool {
        let Some(before) = first.checked_sub(2) else { return false };
        if !self.is_steady([first - 1, before]) || !self.is_steady([last + 1, last + 2]) {
            return false;
        }
        let slope = 0.5 * (self.slopes[first - 1] + self.slopes[last + 1]);
        let moved = slope * (self.t[last + 1] - self.t[first]);
        (self.x[last + 1] - self.x[last]) / moved > MADE_UP
    }

    /// Whether the slope of an interval, and of the one beyond it, would go on.
    fn is_steady(&self, [near, far]: [usize; 2]) -> bool {
        let (Some(slope), Some(beyond)) = (self.slopes.get(near), self.slopes.get(far)) else {
            return false;
        };
        let step = slope.abs() * (self.t[near + 1] - self.t[near]);
        let next = 2.0 * slope - beyond;
        (STEADY..1.0 / STEADY).contains(&(slope / beyond))
            && next / slope >= STEADY
            && step > (MOVES * self.resolution).max(UNUSUAL * self.usual)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ANGLES: Jumps = Jumps { least: 1e-3, per_time: 100.0, order: 2, most: 0.1 };

    fn times(count: u32, step: f64) -> Vec<f64> {
        (0..count).map(|row| step * f64::from(row)).collect()
    }

    fn rows(found: Vec<(usize, String)>) -> Vec<usize> {
        found.into_iter().map(|(row, _)| row).collect()
    }

    #[test]
    fn spikes_are_found_and_motions_are_none() {
        let t = times(200, 0.008);
        let mut x: Vec<f64> = t.iter().map(|t| (5.0 * t).sin()).collect();
        assert!(rows(spikes(&t, &x, ANGLES)).is_empty());
        for row in [0, 80, 120, 121, 122, 199] {
            x[row] += 0.5;
        }
        assert_eq!(rows(spikes(&t, &x, ANGLES)), [0, 80, 120, 121, 122, 199]);
        // A step that stays is no spike.
        let step: Vec<f64> = t.iter().map(|t| if *t < 0.8 { 0.0 } else { 0.5 }).collect();
        assert!(rows(spikes(&t, &step, ANGLES)).is_empty());
    }

    #[test]
    fn rows_that_stay_in_a_motion_are_found_and_rests_are_none() {
        let t = times(200, 0.01);
        let moving: Vec<f64> = t.iter().map(|t| (3.0 * t).sin()).collect();
        let found = |x: &[f64]| {
            let again: Vec<bool> = (0..x.len()).map(|k| k > 0 && x[k] == x[k - 1]).collect();
            rows(stays(&t, x, &again))
        };
        let mut stuck = moving.clone();
        stuck[21] = stuck[20];
        stuck[101..104].fill(moving[100]);
        assert_eq!(found(&stuck), [21, 101, 102, 103]);
        // A stop within one row of a slow log, and steps of the resolution.
        let stop = |t: f64| t.min(0.5) + (t - 1.2).max(0.0);
        assert!(found(&t.iter().map(|t| stop(*t)).collect::<Vec<_>>()).is_empty());
        let coarse: Vec<f64> = moving.iter().map(|x| (x * 100.0).round() / 100.0).collect();
        assert!(rows(stays(&t, &coarse, &vec![false; t.len()])).is_empty());
    }
}
