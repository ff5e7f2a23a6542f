//! Convex programs with linear and second-order cones; the only file that names the solver.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SecondOrderConeT, SolverStatus,
    SupportedConeT,
};

/// Relative and absolute gap at which the solver stops. Below it the residuals tend to grow.
const GAP: f64 = 1e-6;
/// Relative residuals at which the solver stops.
const RESIDUAL: f64 = 1e-7;
/// Residuals at which the linear solves inside the solver stop. The default 1e-13 costs an eighth
/// of the time without an effect on the results.
const REFINEMENT: f64 = 1e-10;
/// Largest number of iterations; 10 to 30 are usual.
const MAX_ITERATIONS: u32 = 100;

/// Σ coefficient · x[index] + constant.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Affine {
    terms: Vec<(usize, f64)>,
    constant: f64,
}

impl Affine {
    pub(super) fn constant(constant: f64) -> Affine {
        Affine { terms: Vec::new(), constant }
    }

    /// Adds coefficient · x[variable]; `None` is a variable that was eliminated at 0.
    pub(super) fn add(&mut self, variable: Option<usize>, coefficient: f64) -> &mut Affine {
        if let Some(index) = variable.filter(|_| coefficient != 0.0) {
            self.terms.push((index, coefficient));
        }
        self
    }

    /// self + coefficient · x[variable].
    pub(super) fn plus(mut self, variable: Option<usize>, coefficient: f64) -> Affine {
        self.add(variable, coefficient);
        self
    }

    /// Whether it contains no variable.
    pub(super) fn is_constant(&self) -> bool {
        self.terms.is_empty()
    }

    /// self + constant.
    pub(super) fn shift(mut self, constant: f64) -> Affine {
        self.constant += constant;
        self
    }

    /// self + other.
    pub(super) fn sum(mut self, other: &Affine) -> Affine {
        self.terms.extend(&other.terms);
        self.shift(other.constant)
    }

    /// factor · self.
    pub(super) fn times(mut self, factor: f64) -> Affine {
        self.constant *= factor;
        for term in &mut self.terms {
            term.1 *= factor;
        }
        self
    }
}

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ConeStatus {
    /// To full accuracy.
    Solved,
    /// To reduced accuracy: check the result before use.
    AlmostSolved,
    /// No point satisfies the constraints.
    Infeasible,
    /// The solver stopped without a result.
    Failed,
}

/// The outcome of a solve; values are meaningful for the solved statuses only.
#[derive(Clone, Debug)]
pub(super) struct ConeSolution {
    pub(super) status: ConeStatus,
    pub(super) x: Vec<f64>,
    pub(super) objective: f64,
    /// Value of the dual objective: a lower bound of the optimum.
    pub(super) bound: f64,
    /// Multipliers of the linear rows, in their order, ≥ 0.
    pub(super) multipliers: Vec<f64>,
}

/// min ½ xᵀ P x + cᵀ x subject to linear rows and second-order cones.
#[derive(Clone, Debug)]
pub(super) struct ConeProgram {
    offset: f64,
    linear: Vec<f64>,
    quadratic: Triplets,
    rows: Vec<Affine>,
    cones: Vec<Vec<Affine>>,
}

#[derive(Clone, Debug, Default)]
struct Triplets {
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
}

impl Triplets {
    fn push(&mut self, row: usize, column: usize, value: f64) {
        self.rows.push(row);
        self.columns.push(column);
        self.values.push(value);
    }

    fn matrix(self, rows: usize, columns: usize) -> CscMatrix<f64> {
        CscMatrix::new_from_triplets(rows, columns, self.rows, self.columns, self.values)
    }
}

impl ConeProgram {
    pub(super) fn new(variables: usize) -> ConeProgram {
        ConeProgram {
            offset: 0.0,
            linear: vec![0.0; variables],
            quadratic: Triplets::default(),
            rows: Vec::new(),
            cones: Vec::new(),
        }
    }

    /// Adds `cost` to the objective.
    pub(super) fn minimize(&mut self, cost: &Affine) {
        self.offset += cost.constant;
        for (index, coefficient) in &cost.terms {
            self.linear[*index] += coefficient;
        }
    }

    /// Adds value · x[i] x[j] to the objective for i < j, value/2 · x[i]² for i = j: the entry of
    /// P at (i, j) and (j, i).
    pub(super) fn curve(&mut self, i: usize, j: usize, value: f64) {
        self.quadratic.push(i.min(j), i.max(j), value);
    }

    /// Requires `row` ≤ 0 and returns the index of its multiplier.
    pub(super) fn at_most_zero(&mut self, row: Affine) -> usize {
        self.rows.push(row);
        self.rows.len() - 1
    }

    /// Requires ‖`vector`‖² ≤ y z with y, z ≥ 0.
    pub(super) fn rotated_cone(&mut self, y: &Affine, z: &Affine, vector: Vec<Affine>) {
        let mut cone = vec![y.clone().sum(z), y.clone().sum(&z.clone().times(-1.0))];
        cone.extend(vector.into_iter().map(|v| v.times(2.0)));
        self.cones.push(cone);
    }

    /// Solves the program.
    pub(super) fn solve(self) -> ConeSolution {
        let columns = self.linear.len();
        let quadratic = self.quadratic.matrix(columns, columns);
        let (mut matrix, mut right) = (Triplets::default(), Vec::new());
        // A x + s = b with s in the cones: s = −row for the rows, s = cone entries for the cones.
        for (row, sign) in
            self.rows.iter().map(|r| (r, 1.0)).chain(self.cones.iter().flatten().map(|r| (r, -1.0)))
        {
            for (column, coefficient) in &row.terms {
                matrix.push(right.len(), *column, sign * coefficient);
            }
            right.push(-sign * row.constant);
        }
        let mut cones: Vec<SupportedConeT<f64>> = Vec::new();
        if !self.rows.is_empty() {
            cones.push(NonnegativeConeT(self.rows.len()));
        }
        cones.extend(self.cones.iter().map(|cone| SecondOrderConeT(cone.len())));
        let settings = DefaultSettings {
            verbose: false,
            max_iter: MAX_ITERATIONS,
            tol_gap_abs: GAP,
            tol_gap_rel: GAP,
            tol_feas: RESIDUAL,
            iterative_refinement_reltol: REFINEMENT,
            iterative_refinement_abstol: REFINEMENT,
            max_threads: 1,
            direct_solve_method: "qdldl".to_owned(),
            ..DefaultSettings::default()
        };
        let matrix = matrix.matrix(right.len(), columns);
        let solver =
            DefaultSolver::new(&quadratic, &self.linear, &matrix, &right, &cones, settings);
        let Ok(mut solver) = solver else {
            return ConeSolution {
                status: ConeStatus::Failed,
                x: vec![0.0; columns],
                objective: f64::INFINITY,
                bound: f64::NEG_INFINITY,
                multipliers: vec![0.0; self.rows.len()],
            };
        };
        solver.solve();
        let solution = solver.solution;
        let status = match solution.status {
            SolverStatus::Solved => ConeStatus::Solved,
            SolverStatus::AlmostSolved => ConeStatus::AlmostSolved,
            SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => {
                ConeStatus::Infeasible
            }
            _ => ConeStatus::Failed,
        };
        let mut multipliers = solution.z;
        multipliers.truncate(self.rows.len());
        ConeSolution {
            status,
            x: solution.x,
            objective: self.offset + solution.obj_val,
            bound: self.offset + solution.obj_val_dual,
            multipliers,
        }
    }
}
