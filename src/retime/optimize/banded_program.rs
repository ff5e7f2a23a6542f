//! Convex quadratic programs with a banded matrix and rows of neighbouring variables.
//!
//! A primal-dual interior point method with Mehrotra's predictor and corrector (Nocedal and
//! Wright, Numerical Optimization, 2006, algorithm 16.4). The outer products of the rows keep the
//! linear system banded, so the time of an iteration is linear in the number of variables.

use super::banded::{Banded, Cholesky};
use super::row_state::{Reduction, RowChange, RowState, TO_BOUNDARY};

/// min ½ xᵀ H x + gᵀ x + Σ price · (violation of a row) subject to the rows.
pub(super) struct BandedProgram {
    /// H, positive definite, with a band that holds the terms of each row.
    pub(super) matrix: Banded,
    /// g.
    pub(super) gradient: Vec<f64>,
    /// The rows.
    pub(super) rows: Vec<Row>,
}

/// Σ weight · x[index] ≤ bound.
#[derive(Clone, Debug, Default)]
pub(super) struct Row {
    /// Indices and weights, each index once.
    pub(super) terms: Vec<(usize, f64)>,
    /// The bound.
    pub(super) bound: f64,
    /// Price of a violation by one; infinite for a hard row.
    pub(super) price: f64,
}

impl Row {
    fn value(&self, x: &[f64]) -> f64 {
        self.terms.iter().map(|(i, weight)| weight * x[*i]).sum()
    }
}

/// An optimum within the required gap.
pub(super) struct Optimum {
    pub(super) x: Vec<f64>,
    /// The whole objective.
    pub(super) cost: f64,
}

/// Largest number of iterations; 8 to 20 are usual.
const MAX_ITERATIONS: usize = 60;
/// Largest residual of the rows and of the gradient at the optimum, relative to their size.
const RESIDUAL: f64 = 1e-7;

/// Violation of the optimality conditions.
struct Residuals {
    /// Gradient of the Lagrangian.
    dual: Vec<f64>,
    /// Residual of the rows with their slacks.
    primal: Vec<f64>,
    /// Sum of the products that vanish at the optimum.
    complement: f64,
    /// The objective.
    cost: f64,
}

/// A Newton step of x and of the state of each row.
struct Direction {
    x: Vec<f64>,
    states: Vec<RowChange>,
}

impl BandedProgram {
    /// The rows with their states.
    fn rows<'a>(&'a self, states: &'a [RowState]) -> impl Iterator<Item = (&'a Row, &'a RowState)> {
        self.rows.iter().zip(states)
    }

    /// Solves the program to a gap relative to 1 + |objective|. None if it does not converge.
    pub(super) fn solve(&self, gap: f64) -> Option<Optimum> {
        let mut x = vec![0.0; self.gradient.len()];
        let mut states: Vec<RowState> =
            self.rows.iter().map(|row| RowState::first(row.price, -row.bound)).collect();
        for _ in 0..MAX_ITERATIONS {
            let residuals = self.residuals(&x, &states);
            if residuals.are_within(gap) {
                return Some(Optimum { x, cost: residuals.cost });
            }
            let factor = self.factor(&states)?;
            let mut reductions: Vec<Reduction> = states.iter().map(RowState::products).collect();
            let mut direction = self.direction(&factor, &states, &residuals, &reductions);
            if !self.rows.is_empty() {
                reductions = corrected(&reductions, &states, &residuals, &direction);
                direction = self.direction(&factor, &states, &residuals, &reductions);
            }
            let step = (TO_BOUNDARY * reach(&states, &direction.states)).min(1.0);
            for (x, d) in x.iter_mut().zip(&direction.x) {
                *x += step * d;
            }
            for (state, change) in states.iter_mut().zip(&direction.states) {
                *state = state.moved(change, step);
            }
        }
        None
    }

    fn residuals(&self, x: &[f64], states: &[RowState]) -> Residuals {
        let curved = self.matrix.times(x);
        let mut dual: Vec<f64> = curved.iter().zip(&self.gradient).map(|(h, g)| h + g).collect();
        for (row, state) in self.rows(states) {
            for (i, weight) in &row.terms {
                dual[*i] += weight * state.lambda;
            }
        }
        let primal = |(row, state): (&Row, &RowState)| row.value(x) - state.s + state.w - row.bound;
        Residuals {
            dual,
            primal: self.rows(states).map(primal).collect(),
            complement: states.iter().map(RowState::complement).sum(),
            cost: self.cost(x, &curved, states),
        }
    }

    /// The factor of H with the rows eliminated. None if it is not positive definite.
    fn factor(&self, states: &[RowState]) -> Option<Cholesky> {
        let mut matrix = self.matrix.clone();
        for (row, state) in self.rows(states) {
            let weight = 1.0 / state.compliance();
            for (n, (i, a)) in row.terms.iter().enumerate() {
                for (j, b) in &row.terms[..=n] {
                    matrix.add(*i, *j, weight * a * b);
                }
            }
        }
        matrix.factor()
    }

    /// The Newton step that lowers the products λ w and (price − λ) s of each row by `reductions`.
    fn direction(
        &self,
        factor: &Cholesky,
        states: &[RowState],
        residuals: &Residuals,
        reductions: &[Reduction],
    ) -> Direction {
        let shifts: Vec<f64> = states
            .iter()
            .zip(reductions.iter().zip(&residuals.primal))
            .map(|(state, (reduction, primal))| state.shift(*primal, *reduction))
            .collect();
        let mut right: Vec<f64> = residuals.dual.iter().map(|r| -r).collect();
        for (row, shift) in self.rows.iter().zip(&shifts) {
            for (i, weight) in &row.terms {
                right[*i] -= weight * shift;
            }
        }
        let x = factor.solve(right);
        let states = self
            .rows(states)
            .zip(reductions.iter().zip(&shifts))
            .map(|((row, state), (reduction, shift))| {
                state.change(row.value(&x) / state.compliance() + shift, *reduction)
            })
            .collect();
        Direction { x, states }
    }

    fn cost(&self, x: &[f64], curved: &[f64], states: &[RowState]) -> f64 {
        let smooth: f64 =
            x.iter().zip(curved).zip(&self.gradient).map(|((x, h), g)| x * (0.5 * h + g)).sum();
        smooth + states.iter().map(RowState::cost).sum::<f64>()
    }
}

/// The reductions with Mehrotra's correction: the second-order terms of the predictor and the
/// centring that follows from its step length.
fn corrected(
    reductions: &[Reduction],
    states: &[RowState],
    residuals: &Residuals,
    predictor: &Direction,
) -> Vec<Reduction> {
    let pairs: usize = states.iter().map(|state| if state.is_soft() { 2 } else { 1 }).sum();
    let reach = reach(states, &predictor.states);
    let ahead = states.iter().zip(&predictor.states);
    let ahead: f64 = ahead.map(|(state, change)| state.moved(change, reach).complement()).sum();
    let mean = residuals.complement / pairs as f64;
    let centre = mean * (ahead / residuals.complement).powi(3);
    reductions
        .iter()
        .zip(&predictor.states)
        .map(|(reduction, change)| change.corrected(*reduction, centre))
        .collect()
}

/// The largest step, at most slightly over 1, that keeps all slacks and multipliers positive.
fn reach(states: &[RowState], changes: &[RowChange]) -> f64 {
    let pairs = states.iter().zip(changes);
    pairs.fold(1.0 / TO_BOUNDARY, |reach, (state, change)| state.reach(change, reach))
}

impl Residuals {
    /// Whether the complement is at most the gap and the residuals are at rounding level.
    fn are_within(&self, gap: f64) -> bool {
        let size = 1.0 + self.cost.abs();
        self.complement <= gap * size
            && self.primal.iter().all(|r| r.abs() <= RESIDUAL)
            && self.dual.iter().all(|r| r.abs() <= RESIDUAL * size)
    }
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

    use super::super::cone::{Affine, ConeProgram, ConeStatus};
    use super::*;

    const WIDTH: usize = 4;
    /// The other solver stops at 1e-6 of the objective.
    const AGREEMENT: f64 = 1e-5;

    /// Pseudo-random numbers between −1 and 1 from a fixed seed.
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (self.0 >> 33) as f64 / f64::from(1u32 << 30) - 1.0
        }
    }

    fn random(seed: u64, size: usize) -> BandedProgram {
        let mut numbers = Numbers(seed);
        let mut matrix = Banded::zeros(size, WIDTH);
        // Sums of outer products of neighbours, and a small diagonal.
        for i in 0..size {
            let v: Vec<f64> = (i..size.min(i + WIDTH + 1)).map(|_| numbers.next()).collect();
            for (n, a) in v.iter().enumerate() {
                for (m, b) in v[..=n].iter().enumerate() {
                    matrix.add(i + n, i + m, a * b);
                }
            }
            matrix.add(i, i, 1e-3);
        }
        let gradient = (0..size).map(|_| numbers.next()).collect();
        let rows = (0..3 * size)
            .map(|k| {
                let first = k / 3;
                let terms = (first..size.min(first + WIDTH)).map(|i| (i, numbers.next())).collect();
                let soft = k % 2 == 0;
                // x = 0 satisfies the hard rows; it violates some of the soft rows.
                let bound = if soft { numbers.next() } else { 0.1 + numbers.next().abs() };
                Row { terms, bound, price: if soft { 0.7 } else { f64::INFINITY } }
            })
            .collect();
        BandedProgram { matrix, gradient, rows }
    }

    fn by_cones(program: &BandedProgram) -> f64 {
        let size = program.gradient.len();
        let mut cones = ConeProgram::new(size + program.rows.len());
        for (i, j, value) in program.matrix.entries() {
            cones.curve(i, j, value);
        }
        for (i, slope) in program.gradient.iter().enumerate() {
            cones.minimize(&Affine::default().plus(Some(i), *slope));
        }
        for (k, row) in program.rows.iter().enumerate() {
            let mut affine = Affine::constant(-row.bound);
            for (i, weight) in &row.terms {
                affine.add(Some(*i), *weight);
            }
            if row.price.is_finite() {
                let slack = Some(size + k);
                cones.minimize(&Affine::default().plus(slack, row.price));
                cones.at_most_zero(Affine::default().plus(slack, -1.0));
                affine.add(slack, -1.0);
            }
            cones.at_most_zero(affine);
        }
        let solution = cones.solve();
        assert_eq!(solution.status, ConeStatus::Solved);
        solution.objective
    }

    #[test]
    fn another_solver_finds_the_same_cost() {
        for seed in 0..40 {
            let program = random(seed, 5 + 3 * seed as usize);
            let optimum = program.solve(1e-8).unwrap();
            let other = by_cones(&program);
            let difference = (optimum.cost - other).abs();
            assert!(difference < AGREEMENT * (1.0 + other.abs()), "{seed}: {difference:e}");
            for row in program.rows.iter().filter(|row| !row.price.is_finite()) {
                assert!(row.value(&optimum.x) <= row.bound + 10.0 * RESIDUAL);
            }
        }
    }

    #[test]
    fn without_rows_it_is_a_linear_system() {
        let program = BandedProgram { rows: Vec::new(), ..random(3, 20) };
        let x = program.solve(1e-8).unwrap().x;
        for (h, g) in program.matrix.times(&x).iter().zip(&program.gradient) {
            assert!((h + g).abs() < 1e-6);
        }
    }

    #[test]
    fn contradictory_rows_have_no_optimum() {
        let row = |sign: f64| Row { terms: vec![(0, sign)], bound: -1.0, price: f64::INFINITY };
        let program = BandedProgram { rows: vec![row(1.0), row(-1.0)], ..random(3, 4) };
        assert!(program.solve(1e-8).is_none());
    }
}
