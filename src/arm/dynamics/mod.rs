//! Inverse dynamics, its derivatives and regressor, mass matrix, forward dynamics, friction, energy.
//!
//! Algorithms read a [`Model`](crate::arm::robot::Model), use a scratch [`Data`] and return values
//! without allocation. Results have [`MAX_DOF`] entries; those beyond the joints are 0. Gravity is
//! 9.81 m/s² along −z of the world frame.
//!
//! [`MAX_DOF`]: crate::arm::robot::MAX_DOF

mod base_parameters;
mod crba;
mod data;
mod derivatives;
mod energy;
mod forward;
mod friction;
mod joint_matrix;
mod laws;
mod load;
mod motor_side;
mod parameters;
mod pseudo_inertia;
mod regressor;
mod rnea;
mod spatial;
mod torque;

pub use base_parameters::{
    BaseParameters, base_parameters, base_parameters_among, base_parameters_at_rest, write_rows,
};
pub use crba::crba;
pub use data::Data;
pub use derivatives::{Derivatives, rnea_derivatives};
pub use energy::{kinetic_energy, potential_energy};
pub use forward::forward_dynamics;
pub use friction::{friction, friction_with_signs, sign};
pub use joint_matrix::JointMatrix;
pub use laws::laws;
pub use load::Load;
pub use motor_side::{apparent_torques, motor_rates, motor_torques};
pub use parameters::{JOINT, RIGID, link_parameters, parameter_count, parameter_name, parameters};
pub use pseudo_inertia::{body_parameters, link_of, pseudo_inertia};
pub use regressor::{Regressor, regressor};
pub use rnea::{gravity, rigid_bodies, rnea, rnea_each};
pub use torque::{Torque, torque, torque_each};
