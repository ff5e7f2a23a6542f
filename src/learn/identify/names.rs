//! Names of estimated parameter combinations.

use std::fmt::Write;

use super::identified::Identified;

/// Least share of a column in a combination that is named.
const PART: f64 = 1e-4;

impl Identified {
    /// The combination of parameters that base parameter `row` represents, including those that
    /// this motion does not separate from it.
    #[must_use]
    pub fn name(&self, row: usize) -> String {
        let mut name = self.base.name(row);
        let solution = &self.fit.solution;
        for (column, parts) in &solution.dependent {
            let Some((_, factor)) = parts.iter().find(|(of, _)| *of == row) else { continue };
            if solution.share(parts, row) > PART {
                let _ = write!(name, " {}", term(*factor, &self.base.name(*column)));
            }
        }
        name
    }
}

/// A term of a sum with its sign.
fn term(factor: f64, name: &str) -> String {
    let sign = if factor < 0.0 { '-' } else { '+' };
    let size = (factor.abs() * 1e6).round() / 1e6;
    let size = if size == 1.0 { String::new() } else { format!("{size} ") };
    if name.contains(' ') {
        format!("{sign} {size}({name})")
    } else {
        format!("{sign} {size}{name}")
    }
}
