//! Errors of the logged positions and torques.

/// Differences between logged and true values that a diagnosis found.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensors {
    /// True minus logged position of each joint \[rad\].
    pub position_offset: Vec<f64>,
    /// Added to the logged torque of each joint \[Nm\].
    pub torque_offset: Vec<f64>,
    /// Logged over true torque of each joint, minus 1.
    pub torque_error: Vec<f64>,
    /// Added to the logged torque for each unit of acceleration of the motor that turns with
    /// the joint \[kg m², at the joint\]: delays, filters and elasticity look like an inertia
    /// below 0, which no rotor has.
    pub apparent_inertia: Vec<f64>,
    /// The same for each unit of its rate \[Nm s/rad\].
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
