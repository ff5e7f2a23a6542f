//! Quintic polynomials over time, one per joint.

use crate::retime::path::joint_path::{DOF, Joints, quintic};

/// Polynomials of t − begin.
#[derive(Clone, Debug)]
pub(super) struct Quintics {
    begin: f64,
    /// Per power, lowest first, of all joints, for vectorised evaluation.
    coefficients: [Joints; 6],
}

impl Quintics {
    /// With these values, first and second derivatives at `begin` and `length` later (s).
    pub(super) fn new(begin: f64, length: f64, from: [Joints; 3], to: [Joints; 3]) -> Quintics {
        let mut coefficients = [[0.0; DOF]; 6];
        for j in 0..DOF {
            let unit = quintic(length, from.map(|x| x[j]), to.map(|x| x[j]));
            let mut scale = 1.0;
            for (power, c) in unit.into_iter().enumerate() {
                coefficients[power][j] = c * scale;
                scale /= length;
            }
        }
        Quintics { begin, coefficients }
    }

    pub(super) fn begin(&self) -> f64 {
        self.begin
    }

    /// Values, first and second derivatives at `t`.
    #[inline]
    pub(super) fn at(&self, t: f64) -> [Joints; 3] {
        let x = t - self.begin;
        let [c0, c1, c2, c3, c4, c5] = &self.coefficients;
        let mut at = [[0.0; DOF]; 3];
        for j in 0..DOF {
            at[0][j] = c0[j] + x * (c1[j] + x * (c2[j] + x * (c3[j] + x * (c4[j] + x * c5[j]))));
        }
        at[1] = self.first(t);
        for j in 0..DOF {
            at[2][j] = 2.0 * c2[j] + x * (6.0 * c3[j] + x * (12.0 * c4[j] + x * 20.0 * c5[j]));
        }
        at
    }

    /// First derivatives at `t`.
    #[inline]
    pub(super) fn first(&self, t: f64) -> Joints {
        let x = t - self.begin;
        let [_, c1, c2, c3, c4, c5] = &self.coefficients;
        std::array::from_fn(|j| {
            let rest = 3.0 * c3[j] + x * (4.0 * c4[j] + x * 5.0 * c5[j]);
            c1[j] + x * (2.0 * c2[j] + x * rest)
        })
    }

    /// Third derivatives at `t`.
    pub(super) fn third(&self, t: f64) -> Joints {
        let x = t - self.begin;
        let [_, _, _, c3, c4, c5] = &self.coefficients;
        std::array::from_fn(|j| 6.0 * c3[j] + x * (24.0 * c4[j] + x * 60.0 * c5[j]))
    }
}
