//! Triangular factors of a log's equations by joint and part of the time. Joints can be weighted
//! and parts left out without reading the log again.

use nalgebra::{DMatrix, DVector};

use super::equations::{Equations, Layout};
use super::samples::Samples;
use super::triangle::Triangle;

/// Factors by part of the time and joint.
#[derive(Clone, Debug)]
pub struct Factors {
    /// The columns of each joint.
    pub layout: Layout,
    /// For each part and joint, the triangular factor with the right side in its last column.
    pub parts: Vec<Vec<DMatrix<f64>>>,
    /// Usable equations, by part and joint.
    pub rows: Vec<Vec<usize>>,
    /// Sums of the squared torques of these equations, by part and joint \[N²m²\].
    pub squares: Vec<Vec<f64>>,
}

impl Factors {
    /// The factors of `samples` in `parts` parts of equal duration.
    #[must_use]
    pub fn new(equations: &Equations<'_>, samples: &Samples, parts: usize) -> Factors {
        let layout = equations.layout();
        let joints = layout.columns.len();
        let new = || layout.columns.iter().map(|of| Triangle::new(of.len())).collect();
        let mut triangles: Vec<Vec<Triangle>> = (0..parts).map(|_| new()).collect();
        let mut squares = vec![vec![0.0; joints]; parts];
        let (first, duration) = span(samples);
        equations.each(samples, &layout, &mut |instant| {
            let share = if duration > 0.0 { (instant.t - first) / duration } else { 0.0 };
            let part = ((share * parts as f64) as usize).min(parts - 1);
            for (joint, _, place) in layout.joints().filter(|(joint, ..)| instant.usable[*joint]) {
                triangles[part][joint].push(&instant.x[place], instant.y[joint]);
                squares[part][joint] += instant.tau[joint] * instant.tau[joint];
            }
        });
        let rows = triangles.iter().map(|of| of.iter().map(Triangle::rows).collect()).collect();
        let parts =
            triangles.iter_mut().map(|of| of.iter_mut().map(Triangle::factor).collect()).collect();
        Factors { layout, parts, rows, squares }
    }

    /// All parts except `without`, merged into one.
    #[must_use]
    pub fn merged(&self, without: Option<usize>) -> Factors {
        let joints = self.layout.columns.len();
        let merge = |joint: usize| {
            let unknowns = self.layout.columns[joint].len();
            let mut triangle = Triangle::new(unknowns);
            for (part, of) in self.parts.iter().enumerate() {
                if Some(part) == without {
                    continue;
                }
                for row in of[joint].row_iter() {
                    let values: Vec<f64> = row.iter().copied().collect();
                    triangle.push(&values[..unknowns], values[unknowns]);
                }
            }
            triangle.factor()
        };
        Factors {
            layout: self.layout.clone(),
            parts: vec![(0..joints).map(merge).collect()],
            rows: vec![self.rows_without(without)],
            squares: vec![self.sum(without, |part, joint| self.squares[part][joint])],
        }
    }

    /// Usable equations of each joint in all parts except `without`.
    #[must_use]
    pub fn rows_without(&self, without: Option<usize>) -> Vec<usize> {
        self.sum(without, |part, joint| self.rows[part][joint])
    }

    /// Sum of the squared residuals of each joint in `part`, or in all parts.
    #[must_use]
    pub fn residual_squares(&self, beta: &DVector<f64>, part: Option<usize>) -> Vec<f64> {
        let of = |part: usize, joint: usize| {
            let columns = &self.layout.columns[joint];
            let mut with_minus_one = DVector::zeros(columns.len() + 1);
            for (to, column) in columns.iter().enumerate() {
                with_minus_one[to] = beta[*column];
            }
            with_minus_one[columns.len()] = -1.0;
            (&self.parts[part][joint] * with_minus_one).norm_squared()
        };
        match part {
            Some(part) => (0..self.layout.columns.len()).map(|joint| of(part, joint)).collect(),
            None => self.sum(None, of),
        }
    }

    fn sum<T: std::iter::Sum>(
        &self,
        without: Option<usize>,
        of: impl Fn(usize, usize) -> T,
    ) -> Vec<T> {
        let parts = || (0..self.parts.len()).filter(|part| Some(*part) != without);
        (0..self.layout.columns.len())
            .map(|joint| parts().map(|part| of(part, joint)).sum())
            .collect()
    }

    /// The weighted equations of all joints and parts, `unknowns` columns and the right side.
    #[must_use]
    pub fn stacked(&self, weights: &[f64], unknowns: usize) -> DMatrix<f64> {
        let all = || {
            self.parts
                .iter()
                .flat_map(|joints| joints.iter().zip(&self.layout.columns).zip(weights))
        };
        let height = all().map(|((factor, _), _)| factor.nrows()).sum();
        let mut stacked = DMatrix::zeros(height, unknowns + 1);
        let mut row = 0;
        for ((factor, columns), weight) in all() {
            for (from, values) in factor.column_iter().enumerate() {
                let to = columns.get(from).copied().unwrap_or(unknowns);
                for (k, value) in values.iter().enumerate() {
                    stacked[(row + k, to)] = weight * value;
                }
            }
            row += factor.nrows();
        }
        stacked
    }
}

/// First time and duration of all samples \[s\].
fn span(samples: &Samples) -> (f64, f64) {
    let times = || samples.blocks.iter().flat_map(|block| block.t.iter().copied());
    let first = times().fold(f64::INFINITY, f64::min);
    let last = times().fold(f64::NEG_INFINITY, f64::max);
    (first, last - first)
}
