//! The state of the joints at one time.

use crate::retime::path::joint_path::{DOF, Joints};

/// q, q̇, q̈ at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointState {
    /// rad.
    pub q: Joints,
    /// rad/s.
    pub qd: Joints,
    /// rad/s².
    pub qdd: Joints,
}

impl JointState {
    /// At rest at `q`.
    pub fn rest(q: Joints) -> JointState {
        JointState { q, qd: [0.0; DOF], qdd: [0.0; DOF] }
    }

    /// q, q̇, q̈ as a list.
    pub fn list(&self) -> [Joints; 3] {
        [self.q, self.qd, self.qdd]
    }
}
