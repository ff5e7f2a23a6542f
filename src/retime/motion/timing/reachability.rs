//! The fastest speed profile on a fixed path by two-pass reachability analysis.
//!
//! After Pham and Pham, "A new approach to time-optimal path parameterization based on reachability
//! analysis" (2018): the backward pass finds the interval of b = ṡ² from which the end is
//! reachable; the forward pass takes the largest b in it. Here a stage works in the plane of b at
//! both nodes: its limits are half planes and the feasible set is a convex polygon, which is
//! clipped. No linear program is needed, and points without inertia need no special case.
//!
//! Viscous friction adds √b to the torque rows. It is replaced by its tangent at the previous
//! profile, which is conservative where friction adds to the load; the passes are repeated until
//! the profile converges.

use super::grid::PathGrid;
use super::limits::{PathLimits, binding_rows, worst_ratio};
use super::profile::Profile;
use super::row::Row;

/// Outcome of the search for the fastest profile.
#[derive(Clone, Debug, PartialEq)]
pub enum Reachability {
    /// The fastest profile of the grid, with all limits verified.
    Optimal(Profile),
    /// No profile keeps the limits; the interval at which the backward pass failed.
    Infeasible {
        /// Index of the interval.
        interval: usize,
    },
}

impl Reachability {
    /// The profile, if there is one.
    pub fn into_profile(self) -> Option<Profile> {
        match self {
            Reachability::Optimal(profile) => Some(profile),
            Reachability::Infeasible { .. } => None,
        }
    }
}

/// Accepted relative excess of a limit: rounding and the error of a converged tangent.
const RATIO_TOLERANCE: f64 = 1e-6;
/// Slack of a row in the forward pass: the slope of a row without inertia is a rounding error, and
/// a b on the row must not be bound to it.
const STAGE_SLACK: f64 = 1e-8;
/// Relative change of the duration at which the passes end. As in Newton's method, the next change
/// would be far smaller.
const TIME_TOLERANCE: f64 = 1e-5;
/// Passes before friction that helps to brake is neglected.
const MAX_PASSES: usize = 25;
/// Factor on b at the tangent points while no profile is feasible.
const TANGENT_RETREAT: f64 = 0.25;
/// Such reductions before the limits are infeasible.
const MAX_RETREATS: usize = 12;

/// Approximation of √b in the rows.
#[derive(Clone, Copy)]
enum Root<'a> {
    /// Zero: no viscous friction.
    Absent,
    /// The tangent at these b.
    Tangent(&'a [f64]),
    /// The tangent at these b where √b adds to the load, zero where it reduces it.
    Pessimistic(&'a [f64]),
}

/// One strip lo ≤ x·`x` + y·`y` ≤ hi in the plane of x = `b_k` and y = `b_{k+1}`.
#[derive(Clone, Copy, Debug)]
struct Strip {
    x: f64,
    y: f64,
    lo: f64,
    hi: f64,
}

/// The fastest profile from rest to rest within the limits at both ends of each interval. Missing
/// torque limits are infinite.
pub fn time_optimal(grid: &PathGrid, limits: &PathLimits) -> Reachability {
    let stages = Stages::new(grid, limits);
    let frictionless = stages.solve(Root::Absent);
    let Ok(mut b) = frictionless else {
        // Friction could only help where the load without it is too high.
        return verified(grid, limits, frictionless);
    };
    if !stages.viscous {
        return verified(grid, limits, Ok(b));
    }
    let mut duration = f64::INFINITY;
    let mut retreats = 0;
    for _ in 0..MAX_PASSES {
        match stages.solve(Root::Tangent(&b)) {
            Ok(next) => {
                b = next;
                let now = duration_of(grid, &b);
                let settled = (now - duration).abs() <= TIME_TOLERANCE * now;
                if settled && worst_ratio(grid, limits, &b) <= 1.0 + RATIO_TOLERANCE {
                    return outcome(grid, b, true);
                }
                duration = now;
            }
            Err(_) if retreats < MAX_RETREATS => {
                retreats += 1;
                retreat(&mut b);
            }
            Err(_) => break,
        }
    }
    let mut pessimistic = stages.solve(Root::Pessimistic(&b));
    while pessimistic.is_err() && retreats < 2 * MAX_RETREATS {
        retreats += 1;
        retreat(&mut b);
        pessimistic = stages.solve(Root::Pessimistic(&b));
    }
    verified(grid, limits, pessimistic)
}

/// Relative slack of the bounds of [`speed_range`] for the slack of all stages.
const RANGE_ROOM: f64 = 1e-6;
/// Passes that narrow the upper bounds, since the help of friction falls with the speed.
const RANGE_PASSES: usize = 3;
/// Bisection steps of each lower bound.
const DIP_STEPS: usize = 14;
/// Relative distance to the upper bound at which a slow profile has returned to it.
const LEFT: f64 = 1e-9;

/// Bounds on ṡ² at the nodes that hold for every profile of at most `duration` (s). Upper bounds:
/// reachability from rest. Lower bounds: a slow profile also loses time around the slow node, since
/// its acceleration is limited. The bounds are safe, not tight: friction helps as much as it can.
pub fn speed_range(grid: &PathGrid, limits: &PathLimits, duration: f64) -> Vec<(f64, f64)> {
    let stages = Stages::new(grid, limits);
    let last = grid.intervals();
    let mut most = stages.b_max.clone();
    (most[0], most[last]) = (0.0, 0.0);
    for _ in 0..RANGE_PASSES {
        for k in 0..last {
            most[k + 1] = most[k + 1].min(stages.largest(k, 0, most[k], &most));
        }
        for k in (0..last).rev() {
            most[k] = most[k].min(stages.largest(k, 1, most[k + 1], &most));
        }
    }
    for b in &mut most {
        *b *= 1.0 + RANGE_ROOM;
    }
    let slack = duration - duration_of(grid, &most);
    let least = |node: usize| {
        let (mut lo, mut hi) = (0.0, most[node]);
        for _ in 0..DIP_STEPS {
            let middle = 0.5 * (lo + hi);
            let lost = stages.lost(grid, &most, node, middle);
            *(if lost > slack { &mut lo } else { &mut hi }) = middle;
        }
        lo
    };
    (0..=last).map(|node| (least(node), most[node])).collect()
}

/// Moves the tangent points towards rest, where a tangent adds the least load.
fn retreat(b: &mut [f64]) {
    for b in b {
        *b *= TANGENT_RETREAT;
    }
}

/// The outcome of the passes after verification.
fn verified(grid: &PathGrid, limits: &PathLimits, b: Result<Vec<f64>, usize>) -> Reachability {
    match b {
        Ok(b) => {
            let kept = worst_ratio(grid, limits, &b) <= 1.0 + RATIO_TOLERANCE;
            outcome(grid, b, kept)
        }
        Err(interval) => Reachability::Infeasible { interval },
    }
}

/// The outcome of a profile; `kept`: it keeps the limits.
fn outcome(grid: &PathGrid, b: Vec<f64>, kept: bool) -> Reachability {
    let slowest = b[1..b.len() - 1].iter().enumerate().min_by(|x, y| x.1.total_cmp(y.1));
    let interval = slowest.map_or(0, |(node, _)| node);
    match Profile::new(grid.s().to_vec(), b) {
        Some(profile) if kept => Reachability::Optimal(profile),
        _ => Reachability::Infeasible { interval },
    }
}

/// Duration of the profile b, s; infinite if it stands still.
fn duration_of(grid: &PathGrid, b: &[f64]) -> f64 {
    (0..grid.intervals()).map(|k| 2.0 * grid.delta(k) / (b[k].sqrt() + b[k + 1].sqrt())).sum()
}

/// The rows of all intervals in terms of b at both nodes.
struct Stages {
    /// First row of each interval; last, the number of rows.
    first: Vec<usize>,
    rows: Vec<StageRow>,
    b_max: Vec<f64>,
    viscous: bool,
}

/// |x·`x` + y·`y` + √(b of the node at `end`)·`root` + `constant`| ≤ 1.
struct StageRow {
    end: usize,
    x: f64,
    y: f64,
    root: f64,
    constant: f64,
}

impl Stages {
    fn new(grid: &PathGrid, limits: &PathLimits) -> Stages {
        let n = grid.intervals();
        let mut stages = Stages {
            first: Vec::with_capacity(n + 1),
            rows: Vec::with_capacity(24 * n),
            b_max: (0..=n).map(|node| grid.b_max(node)).collect(),
            viscous: false,
        };
        stages.first.push(0);
        for (k, pair) in grid.ends().iter().enumerate() {
            let per_u = 0.5 / grid.delta(k);
            for (end, point) in pair.iter().enumerate() {
                let b_max = stages.b_max[k + end];
                binding_rows(point, limits, b_max, |Row { u, b, root, constant }| {
                    let (mut x, mut y) = (-per_u * u, per_u * u);
                    *(if end == 0 { &mut x } else { &mut y }) += b;
                    stages.viscous |= *root != 0.0;
                    stages.rows.push(StageRow { end, x, y, root: *root, constant: *constant });
                });
            }
            stages.first.push(stages.rows.len());
        }
        stages
    }

    /// Calls `take` with each strip of interval k.
    fn strips(&self, k: usize, root: Root<'_>, mut take: impl FnMut(Strip)) {
        let speeds = match root {
            Root::Absent => [0.0; 2],
            Root::Tangent(at) | Root::Pessimistic(at) => [at[k].sqrt(), at[k + 1].sqrt()],
        };
        let halves = speeds.map(|speed| 0.5 / speed);
        for row in &self.rows[self.first[k]..self.first[k + 1]] {
            let (lo, hi) = (-1.0 - row.constant, 1.0 - row.constant);
            let plain = Strip { x: row.x, y: row.y, lo, hi };
            let speed = speeds[row.end];
            if row.root == 0.0 || speed <= 0.0 {
                take(plain);
                continue;
            }
            let (slope, base) = (row.root * halves[row.end], 0.5 * row.root * speed);
            let mut tangent = Strip { lo: lo - base, hi: hi - base, ..plain };
            *(if row.end == 0 { &mut tangent.x } else { &mut tangent.y }) += slope;
            if matches!(root, Root::Tangent(_)) {
                take(tangent);
            } else if row.root > 0.0 {
                take(Strip { lo: f64::NEG_INFINITY, ..tangent });
                take(Strip { hi: f64::INFINITY, ..plain });
            } else {
                take(Strip { hi: f64::INFINITY, ..tangent });
                take(Strip { lo: f64::NEG_INFINITY, ..plain });
            }
        }
    }

    /// Least time, s, that a profile with at most b at a node loses relative to `most`.
    fn lost(&self, grid: &PathGrid, most: &[f64], node: usize, b: f64) -> f64 {
        let time = |k: usize, x: f64, y: f64| 2.0 * grid.delta(k) / (x.sqrt() + y.sqrt());
        let mut lost = 0.0;
        let mut here = b;
        for k in node..grid.intervals() {
            let next = self.largest(k, 0, here, most).min(most[k + 1]);
            lost += time(k, here, next) - time(k, most[k], most[k + 1]);
            here = next;
            if here >= (1.0 - LEFT) * most[k + 1] {
                break;
            }
        }
        here = b;
        for k in (0..node).rev() {
            let before = self.largest(k, 1, here, most).min(most[k]);
            lost += time(k, before, here) - time(k, most[k], most[k + 1]);
            here = before;
            if here >= (1.0 - LEFT) * most[k] {
                break;
            }
        }
        lost
    }

    /// Upper bound of b at the other end of interval k for at most `b` at `end`, with the most
    /// helpful friction below `most`.
    fn largest(&self, k: usize, end: usize, b: f64, most: &[f64]) -> f64 {
        let mut largest = f64::INFINITY;
        for row in &self.rows[self.first[k]..self.first[k + 1]] {
            let root = row.root * most[k + row.end].sqrt();
            let (lo, hi) =
                (-1.0 - row.constant - root.max(0.0), 1.0 - row.constant - root.min(0.0));
            let (here, there) = if end == 0 { (row.x, row.y) } else { (row.y, row.x) };
            // The b in 0 … `b` that permits most.
            if there > 0.0 {
                largest = largest.min((hi - (here * b).min(0.0)) / there);
            } else if there < 0.0 {
                largest = largest.min((lo - (here * b).max(0.0)) / there);
            }
        }
        largest.max(0.0)
    }

    /// The fastest b at the nodes with this approximation of √b, or the interval at which the
    /// backward pass failed.
    fn solve(&self, root: Root<'_>) -> Result<Vec<f64>, usize> {
        let n = self.b_max.len() - 1;
        let mut reachable = vec![(0.0, 0.0); n + 1];
        let mut polygon = Polygon::default();
        for k in (0..n).rev() {
            let x_max = if k == 0 { 0.0 } else { self.b_max[k] };
            polygon.reset(x_max, reachable[k + 1]);
            self.strips(k, root, |strip| polygon.clip(strip));
            reachable[k] = polygon.x_range().ok_or(k)?;
        }
        let mut b = vec![0.0; n + 1];
        for k in 0..n {
            let (mut lo, mut hi) = reachable[k + 1];
            self.strips(k, root, |strip| {
                let rest = strip.x * b[k];
                let a = (strip.lo - STAGE_SLACK - rest) / strip.y;
                let c = (strip.hi + STAGE_SLACK - rest) / strip.y;
                if strip.y > 0.0 {
                    (lo, hi) = (lo.max(a), hi.min(c));
                } else if strip.y < 0.0 {
                    (lo, hi) = (lo.max(c), hi.min(a));
                }
            });
            b[k + 1] = hi.max(lo).min(reachable[k + 1].1);
        }
        Ok(b)
    }
}

/// A convex polygon in the plane of x = b and y = b at the next node.
#[derive(Default)]
struct Polygon {
    vertices: Vec<(f64, f64)>,
    spare: Vec<(f64, f64)>,
}

impl Polygon {
    /// Starts from the rectangle 0 ≤ x ≤ `x_max`, lo ≤ y ≤ hi.
    fn reset(&mut self, x_max: f64, (lo, hi): (f64, f64)) {
        self.vertices.clear();
        self.vertices.extend([(0.0, lo), (x_max, lo), (x_max, hi), (0.0, hi)]);
    }

    /// Keeps the part inside the strip.
    fn clip(&mut self, strip: Strip) {
        // Most strips contain the whole polygon.
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for (x, y) in &self.vertices {
            let value = strip.x * x + strip.y * y;
            least = if value < least { value } else { least };
            most = if value > most { value } else { most };
        }
        if most > strip.hi {
            self.cut(|x, y| strip.hi - (strip.x * x + strip.y * y));
        }
        if least < strip.lo {
            self.cut(|x, y| strip.x * x + strip.y * y - strip.lo);
        }
    }

    /// Keeps the part where `margin` is not negative (Sutherland–Hodgman).
    fn cut(&mut self, margin: impl Fn(f64, f64) -> f64) {
        self.spare.clear();
        let Some(mut to) = self.vertices.first().copied() else { return };
        let first = (to, margin(to.0, to.1));
        let mut b = first.1;
        for i in 1..=self.vertices.len() {
            let (from, a) = (to, b);
            (to, b) = match self.vertices.get(i) {
                Some(next) => (*next, margin(next.0, next.1)),
                None => first,
            };
            if a >= 0.0 {
                self.spare.push(from);
            }
            if (a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0) {
                let x = a / (a - b);
                self.spare.push((from.0 + x * (to.0 - from.0), from.1 + x * (to.1 - from.1)));
            }
        }
        std::mem::swap(&mut self.vertices, &mut self.spare);
    }

    /// Smallest and largest x; `None` if the polygon is empty.
    fn x_range(&self) -> Option<(f64, f64)> {
        let ends = self
            .vertices
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |r, v| (r.0.min(v.0), r.1.max(v.0)));
        (ends.0 <= ends.1).then_some(ends)
    }
}
