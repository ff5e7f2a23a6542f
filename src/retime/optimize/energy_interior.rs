//! The speed profile of least energy by an interior point method in b = ṡ² at the nodes alone.
//!
//! Costs and limits of an interval depend on b at its two ends, so the matrix of a Newton step is tridiagonal; the
//! time, which all nodes share, adds a term of rank one. Mehrotra's predictor and corrector as in
//! `banded_program` with the states of `row_state`; lost braking work is the violation of a soft row. A step leaves out the curvature of
//! concave terms, as a tangent does: the matrix stays positive definite.

use super::banded::{Banded, Cholesky};
use super::energy_costs::{IntervalCost, OfEnds, mean_root};
use super::row_state::{BEGIN, Reduction, RowChange, RowState, TO_BOUNDARY, bounded};

/// Σ b `linear` + Σ √b `root` + `constant` ≤ 0 at the ends of an interval.
#[derive(Clone, Copy, Debug)]
pub(super) struct EndRow {
    pub(super) interval: usize,
    pub(super) linear: [f64; 2],
    pub(super) root: [f64; 2],
    pub(super) constant: f64,
    /// Price of a violation by one; infinite for a hard row.
    pub(super) price: f64,
}

/// The solution of a program.
pub(super) struct Interior {
    /// Scaled b at the nodes.
    pub(super) b: Vec<f64>,
    /// The objective.
    pub(super) cost: f64,
    /// Multiplier of the time.
    pub(super) time: f64,
}

/// Largest number of iterations; 8 to 15 are usual.
const MAX_ITERATIONS: usize = 80;
/// Gap at the optimum, relative to the cost.
const GAP: f64 = 1e-7;
/// Share of that gap below which a step does not aim, since residuals are left that it has to reduce.
const LEAST_GAP: f64 = 0.1;
/// Largest violation of a row at the optimum.
const PRIMAL: f64 = 1e-7;
/// Largest change of the cost per relative change of a node at the optimum, relative to the cost.
const DUAL: f64 = 1e-6;
/// Added curvature of a node, relative to its own: rounding leaves the matrix of the last steps not positive definite.
const CURVATURE: f64 = 1e-8;

/// Value, slopes and curvatures (00, 01, 11) of a function of two ends.
#[derive(Clone, Copy, Default)]
struct Pair {
    value: f64,
    slope: [f64; 2],
    curve: [f64; 3],
}

/// √b at the ends with its derivatives; none at a resting end.
#[derive(Clone, Copy)]
struct Roots {
    root: [f64; 2],
    slope: [f64; 2],
    curve: [f64; 2],
}

impl Roots {
    fn of(b: [f64; 2]) -> Roots {
        let root = b.map(f64::sqrt);
        let slope = root.map(|c| if c > 0.0 { 0.5 / c } else { 0.0 });
        let curve = [0, 1].map(|i| if b[i] > 0.0 { -0.5 * slope[i] / b[i] } else { 0.0 });
        Roots { root, slope, curve }
    }

    /// q / (√b₀ + √b₁) for q with these derivatives.
    fn quotient(&self, q: Pair) -> Pair {
        let sum = self.root[0] + self.root[1];
        let value = q.value / sum;
        let slope = [0, 1].map(|i| (q.slope[i] - value * self.slope[i]) / sum);
        let curve = [(0, 0), (0, 1), (1, 1)].map(|(i, j)| {
            let index = i + j;
            let own = if i == j { value * self.curve[i] } else { 0.0 };
            (q.curve[index] - slope[i] * self.slope[j] - slope[j] * self.slope[i] - own) / sum
        });
        Pair { value, slope, curve }
    }
}

/// ‖v‖² of affine functions.
fn square(vectors: &[OfEnds], b: [f64; 2]) -> Pair {
    let mut all = Pair::default();
    for [x, y, rest] in vectors {
        let value = x * b[0] + y * b[1] + rest;
        all.value += value * value;
        all.slope[0] += 2.0 * value * x;
        all.slope[1] += 2.0 * value * y;
        all.curve[0] += 2.0 * x * x;
        all.curve[1] += 2.0 * x * y;
        all.curve[2] += 2.0 * y * y;
    }
    all
}

impl EndRow {
    fn value(&self, b: [f64; 2], roots: &Roots) -> f64 {
        self.constant
            + (0..2).map(|i| self.linear[i] * b[i] + self.root[i] * roots.root[i]).sum::<f64>()
    }

    fn slope(&self, roots: &Roots) -> [f64; 2] {
        [0, 1].map(|i| self.linear[i] + self.root[i] * roots.slope[i])
    }
}

/// The costs of the intervals and the rows.
pub(super) struct EnergyProgram<'a> {
    pub(super) costs: &'a [IntervalCost],
    pub(super) rows: Vec<EndRow>,
    /// Largest time.
    pub(super) most: f64,
}

/// Costs and rows at a profile.
struct Local {
    cost: f64,
    /// Of the cost, by node.
    slope: Vec<f64>,
    /// Convex curvature of the cost and of the time with its multiplier.
    matrix: Banded,
    time: f64,
    time_slope: Vec<f64>,
    /// Values and slopes of the rows.
    values: Vec<f64>,
    slopes: Vec<[f64; 2]>,
    /// Curvatures of the rows at both ends.
    curves: Vec<[f64; 2]>,
}

/// A Newton step.
struct Direction {
    b: Vec<f64>,
    states: Vec<RowChange>,
    time: RowChange,
}

/// The linear system of a Newton step: K + g gᵀ λ/w with the slope g of the time.
struct System {
    factor: Cholesky,
    /// K⁻¹ g.
    time: Vec<f64>,
    /// The factor of the term of rank one.
    share: f64,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl EnergyProgram<'_> {
    /// Solves the program from the scaled b of a profile. `None` if it does not converge.
    pub(super) fn solve(&self, start: &[f64]) -> Option<Interior> {
        let mut b = start.to_vec();
        let first = self.at(&b, 0.0);
        let mut states: Vec<RowState> = self
            .rows
            .iter()
            .zip(&first.values)
            .map(|(row, value)| RowState::first(row.price, *value))
            .collect();
        let w = (self.most - first.time).max(BEGIN * BEGIN);
        let mut time = RowState::hard(w, BEGIN);
        for _ in 0..MAX_ITERATIONS {
            let local = self.at(&b, time.lambda);
            let cost = local.cost + states.iter().map(RowState::cost).sum::<f64>();
            let dual = self.dual(&local, &states, &time);
            let primal: Vec<f64> =
                local.values.iter().zip(&states).map(|(value, it)| value - it.s + it.w).collect();
            let late = local.time - self.most + time.w;
            let complement =
                states.iter().map(RowState::complement).sum::<f64>() + time.complement();
            let settled = DUAL * (1.0 + cost.abs() + time.lambda);
            if complement <= GAP * (1.0 + cost.abs())
                && primal.iter().all(|r| r.abs() <= PRIMAL)
                && dual.iter().zip(&b[1..]).all(|(r, b)| r.abs() * b <= settled)
                && late.abs() <= PRIMAL
            {
                return Some(Interior { b, cost, time: time.lambda });
            }
            let system = self.system(&local, &states, &time)?;
            let mut reductions: Vec<Reduction> = states.iter().map(RowState::products).collect();
            let mut of_time = time.products();
            let newton = |reductions: &[Reduction], of_time: Reduction| {
                self.direction(
                    &system,
                    &local,
                    (&states, &time),
                    (&dual, &primal, late),
                    (reductions, of_time),
                )
            };
            let ahead = newton(&reductions, of_time);
            let reach = ahead.reach(&b, &states, &time);
            let moved = states.iter().zip(&ahead.states).map(|(it, d)| it.moved(d, reach));
            let left = moved.map(|it| it.complement()).sum::<f64>()
                + time.moved(&ahead.time, reach).complement();
            let pairs = 1 + states.iter().map(|it| 1 + usize::from(it.is_soft())).sum::<usize>();
            let least = LEAST_GAP * GAP * (1.0 + cost.abs());
            let centre = (complement * (left / complement).powi(3)).max(least);
            let centre = centre / pairs as f64;
            for (reduction, change) in reductions.iter_mut().zip(&ahead.states) {
                *reduction = change.corrected(*reduction, centre);
            }
            of_time = ahead.time.corrected(of_time, centre);
            let change = newton(&reductions, of_time);
            let step = (TO_BOUNDARY * change.reach(&b, &states, &time)).min(1.0);
            for (b, d) in b[1..].iter_mut().zip(&change.b) {
                *b += step * d;
            }
            for (state, d) in states.iter_mut().zip(&change.states) {
                *state = state.moved(d, step);
            }
            time = time.moved(&change.time, step);
        }
        None
    }

    fn ends(b: &[f64], k: usize) -> [f64; 2] {
        [b[k], b[k + 1]]
    }

    fn at(&self, b: &[f64], time_price: f64) -> Local {
        let n = self.costs.len();
        let mut matrix = Banded::zeros(n - 1, 1);
        let [mut slope, mut time_slope] = [0; 2].map(|_| vec![0.0; n - 1]);
        let (mut cost, mut time) = (0.0, 0.0);
        let roots: Vec<Roots> = (0..n).map(|k| Roots::of(Self::ends(b, k))).collect();
        for (k, (of, roots)) in self.costs.iter().zip(&roots).enumerate() {
            let ends = Self::ends(b, k);
            let constant = Pair { value: 1.0, ..Pair::default() };
            let lasts = roots.quotient(constant);
            let copper = roots.quotient(square(&of.copper, ends));
            cost += copper.value + of.base * lasts.value + of.cross[2];
            time += of.time * lasts.value;
            let shares = mean_root(k, n).map(|(_, share)| of.viscous * share);
            for i in 0..2 {
                cost += of.cross[i] * ends[i] + shares[i] * roots.root[i];
                if let Some(node) = inner(k + i, n) {
                    let own = of.cross[i] + shares[i] * roots.slope[i];
                    slope[node] += copper.slope[i] + of.base * lasts.slope[i] + own;
                    time_slope[node] += of.time * lasts.slope[i];
                }
            }
            let of_time = of.base + time_price * of.time;
            let curve = [0, 1, 2].map(|i| copper.curve[i] + of_time * lasts.curve[i]);
            add(&mut matrix, k, n, curve);
        }
        let of_row = |row: &EndRow| {
            let roots = &roots[row.interval];
            let curve = [0, 1].map(|i| row.root[i] * roots.curve[i]);
            (row.value(Self::ends(b, row.interval), roots), (row.slope(roots), curve))
        };
        let (values, (slopes, curves)) = self.rows.iter().map(of_row).unzip();
        Local { cost, slope, matrix, time, time_slope, values, slopes, curves }
    }

    fn dual(&self, local: &Local, states: &[RowState], time: &RowState) -> Vec<f64> {
        let pairs = local.slope.iter().zip(&local.time_slope);
        let mut dual: Vec<f64> = pairs.map(|(g, t)| g + time.lambda * t).collect();
        for ((row, state), slope) in self.rows.iter().zip(states).zip(&local.slopes) {
            spread(&mut dual, row.interval, self.costs.len(), *slope, state.lambda);
        }
        dual
    }

    /// The system with the rows eliminated. `None` if it is not positive definite.
    fn system(&self, local: &Local, states: &[RowState], time: &RowState) -> Option<System> {
        let n = self.costs.len();
        let mut matrix = local.matrix.clone();
        let rows = self.rows.iter().zip(states).zip(local.slopes.iter().zip(&local.curves));
        for ((row, state), ([x, y], curve)) in rows {
            let weight = 1.0 / state.compliance();
            let [first, last] = curve.map(|curve| state.lambda * curve.max(0.0));
            let own = [weight * x * x + first, weight * x * y, weight * y * y + last];
            add(&mut matrix, row.interval, n, own);
        }
        let own: Vec<(usize, f64)> = matrix
            .entries()
            .filter_map(|(i, j, value)| (i == j).then_some((i, CURVATURE * value)))
            .collect();
        for (node, own) in own {
            matrix.add(node, node, own);
        }
        let factor = matrix.factor()?;
        let solved = factor.solve(local.time_slope.clone());
        let share = time.lambda / time.w;
        let share = share / (1.0 + share * dot(&local.time_slope, &solved));
        Some(System { factor, time: solved, share })
    }

    fn direction(
        &self,
        system: &System,
        local: &Local,
        (states, time): (&[RowState], &RowState),
        (dual, primal, late): (&[f64], &[f64], f64),
        (reductions, of_time): (&[Reduction], Reduction),
    ) -> Direction {
        let n = self.costs.len();
        let mut right: Vec<f64> = dual.iter().map(|r| -r).collect();
        let shifts: Vec<f64> = states
            .iter()
            .zip(reductions.iter().zip(primal))
            .map(|(state, (reduction, primal))| state.shift(*primal, *reduction))
            .collect();
        for ((row, slope), shift) in self.rows.iter().zip(&local.slopes).zip(&shifts) {
            spread(&mut right, row.interval, n, *slope, -shift);
        }
        let time_shift = time.shift(late, of_time);
        for (right, slope) in right.iter_mut().zip(&local.time_slope) {
            *right -= slope * time_shift;
        }
        let mut b = system.factor.solve(right);
        let along = system.share * dot(&local.time_slope, &b);
        for (b, time) in b.iter_mut().zip(&system.time) {
            *b -= along * time;
        }
        let at = |node: usize| inner(node, n).map_or(0.0, |index| b[index]);
        let states = self
            .rows
            .iter()
            .zip(states)
            .zip(local.slopes.iter().zip(reductions.iter().zip(&shifts)))
            .map(|((row, state), (slope, (reduction, shift)))| {
                let value = slope[0] * at(row.interval) + slope[1] * at(row.interval + 1);
                state.change(value / state.compliance() + shift, *reduction)
            })
            .collect();
        let lambda = dot(&local.time_slope, &b) / time.compliance() + time_shift;
        Direction { b, states, time: time.change(lambda, of_time) }
    }
}

impl Direction {
    /// The largest step, at most slightly over 1, that keeps what has to be positive so.
    fn reach(&self, b: &[f64], states: &[RowState], time: &RowState) -> f64 {
        let nodes = b[1..].iter().zip(&self.b);
        let reach = nodes.fold(1.0 / TO_BOUNDARY, |reach, (b, d)| bounded(*b, *d, reach));
        let rows = states.iter().zip(&self.states);
        let reach = rows.fold(reach, |reach, (state, change)| state.reach(change, reach));
        time.reach(&self.time, reach)
    }
}

/// The index of a node among those that move.
fn inner(node: usize, n: usize) -> Option<usize> {
    (node > 0 && node < n).then(|| node - 1)
}

/// Adds factor · slope at the ends of interval k.
fn spread(sum: &mut [f64], k: usize, n: usize, slope: [f64; 2], factor: f64) {
    for i in 0..2 {
        if let Some(node) = inner(k + i, n) {
            sum[node] += factor * slope[i];
        }
    }
}

/// Adds the curvatures (00, 01, 11) at the ends of interval k.
fn add(matrix: &mut Banded, k: usize, n: usize, [first, mixed, last]: [f64; 3]) {
    let ends = [inner(k, n), inner(k + 1, n)];
    if let Some(node) = ends[0] {
        matrix.add(node, node, first);
    }
    if let Some(node) = ends[1] {
        matrix.add(node, node, last);
    }
    if let [Some(a), Some(b)] = ends {
        matrix.add(b, a, mixed);
    }
}
