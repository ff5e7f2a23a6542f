//! Accelerations of the first three axes that depend on where the arm is.
//!
//! In a pose each axis alone can have the acceleration that uses up its drive: I(q) q̈ + g(q) = ±1.
//! For a serial arm with axis 1 upright and axes 2 and 3 parallel across it the inertias over the
//! drive's torque are, with s₂ = sin q₂, s₂₃ = sin(q₂+q₃) and so on,
//!
//! I₁ = a₁ + a₂ s₂² + a₃ s₂ + a₄ c₂₃ + a₅ s₂₃ + a₆ cos 2(q₂+q₃) + a₇ sin 2(q₂+q₃)
//!      + a₈ s₂ c₂₃ + a₉ s₂ s₂₃,
//! I₂ = b₁ + b₂ c₃ + b₃ s₃,  I₃ = c₁,  g₃ = c₂ c₂₃ + c₃ s₂₃,
//!
//! the form of the moments of inertia of two rigid links in any position, and of the weight of the
//! outer one. The weight of both on axis 2 is balanced by springs.

use super::error::RobotError;
use super::fields::{Accepts, Fields};
use super::provenance::Origin;

/// Coefficients of the formulas in the module's text; s²/rad, the last two of axis 3 without unit.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseAcceleration {
    /// a₁ … a₉.
    pub axis_1: [f64; 9],
    /// b₁ … b₃.
    pub axis_2: [f64; 3],
    /// c₁ … c₃.
    pub axis_3: [f64; 3],
}

/// Acceleration of an axis in a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capability {
    /// Largest acceleration without weight \[rad/s²\].
    pub acceleration: f64,
    /// Share of the drive's torque that the weight takes, with its sign.
    pub weight: f64,
}

/// Least inertia over torque of a formula \[s²/rad\]: what lies below is outside of its range.
const LEAST: f64 = 1e-3;

impl PoseAcceleration {
    /// The capabilities of axes 1 to 3 at the joints `q` \[rad\].
    #[must_use]
    pub fn at(&self, q: &[f64]) -> [Capability; 3] {
        let (q2, q3) = (q[1], q[2]);
        let (s2, (s3, c3), (s23, c23)) = (q2.sin(), q3.sin_cos(), (q2 + q3).sin_cos());
        let (double_s, double_c) = (2.0 * (q2 + q3)).sin_cos();
        let basis = [1.0, s2 * s2, s2, c23, s23, double_c, double_s, s2 * c23, s2 * s23];
        let about_1: f64 = self.axis_1.iter().zip(basis).map(|(a, x)| a * x).sum();
        let [b1, b2, b3] = self.axis_2;
        let [inertia_3, along, across] = self.axis_3;
        let capability = |inertia: f64, weight: f64| Capability {
            acceleration: 1.0 / inertia.max(LEAST),
            weight,
        };
        [
            capability(about_1, 0.0),
            capability(b1 + b2 * c3 + b3 * s3, 0.0),
            capability(inertia_3, along * c23 + across * s23),
        ]
    }

    pub(super) fn read(
        mut fields: Fields,
        origins: &mut Vec<Origin>,
    ) -> Result<PoseAcceleration, RobotError> {
        let axis_1 = fields.array("axis_1", Accepts::Finite)?;
        let axis_2 = fields.array("axis_2", Accepts::Finite)?;
        let axis_3 = fields.array("axis_3", Accepts::Finite)?;
        let read = PoseAcceleration {
            axis_1: fields.required("axis_1", axis_1)?,
            axis_2: fields.required("axis_2", axis_2)?,
            axis_3: fields.required("axis_3", axis_3)?,
        };
        origins.extend(fields.finish()?);
        Ok(read)
    }
}
