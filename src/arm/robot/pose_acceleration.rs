//! Pose-dependent accelerations of the first three axes.
//!
//! In each pose one axis alone can have the acceleration at its drive limit: I(q) q̈ + g(q) = ±1.
//! For a serial arm with a vertical axis 1 and parallel transverse axes 2 and 3 the inertias over
//! the drive torque are, with s₂ = sin q₂, s₂₃ = sin(q₂+q₃) etc.,
//!
//! I₁ = a₁ + a₂ s₂² + a₃ s₂ + a₄ c₂₃ + a₅ s₂₃ + a₆ cos 2(q₂+q₃) + a₇ sin 2(q₂+q₃)
//!      + a₈ s₂ c₂₃ + a₉ s₂ s₂₃,
//! I₂ = b₁ + b₂ c₃ + b₃ s₃,  I₃ = c₁,  g₃ = c₂ c₂₃ + c₃ s₂₃,
//!
//! the general form of the inertias of two rigid links and of the gravity torque of the outer one.
//! Springs balance the gravity torque of axis 2.

use super::error::RobotError;
use super::fields::{Accepts, Fields};

/// Coefficients of these formulas; s²/rad, the last two of axis 3 without unit.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseAcceleration {
    /// a₁ … a₉.
    pub axis_1: [f64; 9],
    /// b₁ … b₃.
    pub axis_2: [f64; 3],
    /// c₁ … c₃.
    pub axis_3: [f64; 3],
}

/// Acceleration capability of an axis in a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capability {
    /// Largest acceleration without gravity \[rad/s²\].
    pub acceleration: f64,
    /// Signed share of gravity in the drive torque.
    pub weight: f64,
}

/// Smallest valid inertia over torque of a formula \[s²/rad\].
const LEAST: f64 = 1e-3;

impl PoseAcceleration {
    /// The capabilities of axes 1 to 3 at the joint angles `q` \[rad\].
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

    pub(super) fn read(fields: &mut Fields) -> Result<PoseAcceleration, RobotError> {
        let axis_1 = fields.array("axis_1", Accepts::Finite)?;
        let axis_2 = fields.array("axis_2", Accepts::Finite)?;
        let axis_3 = fields.array("axis_3", Accepts::Finite)?;
        Ok(PoseAcceleration {
            axis_1: fields.required("axis_1", axis_1)?,
            axis_2: fields.required("axis_2", axis_2)?,
            axis_3: fields.required("axis_3", axis_3)?,
        })
    }
}
