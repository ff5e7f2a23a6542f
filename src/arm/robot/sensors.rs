//! Errors of logged positions and torques.

/// Diagnosed differences between logged and true values.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensors {
    /// True minus logged position of each joint \[rad\].
    pub position_offset: Vec<f64>,
    /// Offset of the logged torque of each joint \[Nm\].
    pub torque_offset: Vec<f64>,
    /// Logged over true torque of each joint, minus 1.
    pub torque_error: Vec<f64>,
    /// Addition to the logged torque per motor acceleration at the joint \[kg m²\]: delays, filters
    /// and elasticity act like an inertia, which may be negative.
    pub apparent_inertia: Vec<f64>,
    /// The same per motor speed \[Nm s/rad\].
    pub apparent_viscous: Vec<f64>,
}

impl Sensors {
    pub(super) fn exact(dof: usize) -> Sensors {
        Sensors {
            position_offset: vec![0.0; dof],
            torque_offset: vec![0.0; dof],
            torque_error: vec![0.0; dof],
            apparent_inertia: vec![0.0; dof],
            apparent_viscous: vec![0.0; dof],
        }
    }
}
