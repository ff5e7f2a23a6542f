//! Polynomials of degree 5 over time, one for each joint.

use crate::path::joint_path::{DOF, Joints, quintic};

/// Polynomials of t − begin.
#[derive(Clone, Debug)]
pub(super) struct Quintics {
    begin: f64,
    /// Lowest first.
    coefficients: [[f64; 6]; DOF],
}

impl Quintics {
    /// With these values, first and second derivatives at `begin` and `length` later (s).
    pub(super) fn new(begin: f64, length: f64, from: [Joints; 3], to: [Joints; 3]) -> Quintics {
        let h = length;
        let coefficients = std::array::from_fn(|j| {
            let scaled = |at: &[Joints; 3]| [at[0][j], at[1][j] * h, at[2][j] * h * h];
            let unit = quintic(scaled(&from), scaled(&to));
            let mut scale = 1.0;
            unit.map(|c| {
                let scaled = c * scale;
                scale /= h;
                scaled
            })
        });
        Quintics { begin, coefficients }
    }

    pub(super) fn begin(&self) -> f64 {
        self.begin
    }

    /// Values, first and second derivatives at `t`.
    pub(super) fn at(&self, t: f64) -> [Joints; 3] {
        let x = t - self.begin;
        let mut at = [[0.0; DOF]; 3];
        for (j, [c0, c1, c2, c3, c4, c5]) in self.coefficients.iter().enumerate() {
            at[0][j] = c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * c5))));
            at[1][j] = c1 + x * (2.0 * c2 + x * (3.0 * c3 + x * (4.0 * c4 + x * 5.0 * c5)));
            at[2][j] = 2.0 * c2 + x * (6.0 * c3 + x * (12.0 * c4 + x * 20.0 * c5));
        }
        at
    }

    /// Third derivatives at `t`.
    pub(super) fn third(&self, t: f64) -> Joints {
        let x = t - self.begin;
        self.coefficients.map(|[_, _, _, c3, c4, c5]| 6.0 * c3 + x * (24.0 * c4 + x * 60.0 * c5))
    }
}
