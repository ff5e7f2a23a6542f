//! The result of a lint run.

use std::collections::BTreeMap;

use super::coverage::Coverage;
use super::rule::Finding;
use crate::rapid::syntax::SyntaxError;

/// The result of a lint run.
#[derive(Debug, Default)]
pub struct Report {
    /// In file order.
    pub findings: Vec<Finding>,
    /// Energy of the simulated cycles, J; `None` without any, or without dynamics.
    pub cycle_energy_j: Option<f64>,
    /// Number of unresolved places.
    pub unresolved: usize,
    /// How many movements are simulated, and why others are not.
    pub coverage: Coverage,
    /// The files with syntax errors by number, in file order. Filled by [`lint`] only.
    pub syntax_errors: Vec<(usize, Vec<SyntaxError>)>,
}

impl Report {
    /// Sum of the savings, J. Findings at one place are alternatives: only the largest counts.
    #[must_use]
    pub fn saving_j(&self) -> f64 {
        let mut best: BTreeMap<_, f64> = BTreeMap::new();
        for finding in &self.findings {
            if let Some(saving) = &finding.saving {
                let most = best.entry(finding.span).or_insert(0.0);
                *most = most.max(saving.energy_j);
            }
        }
        best.values().fold(0.0, |sum, saving| sum + saving)
    }
}
