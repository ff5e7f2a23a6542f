//! The features in which the torque of a joint is linear.

use nalgebra::DMatrix;

use crate::arm::dynamics::{
    Data, Load, RIGID, Regressor, laws, motor_rates, regressor, sign, torque,
};
use crate::arm::robot::{MAX_DOF, Model};

/// Number of parameters of a joint: rotor, viscous and Coulomb friction, spring.
pub(super) const OF_JOINT: usize = 4;

/// Number of features of a joint: torque of the model, parameters of the links from the joint on,
/// parameters of the joint.
pub(super) fn count(model: &Model, joint: usize) -> usize {
    1 + RIGID * (model.dof - joint) + OF_JOINT
}

/// Writes the features of each joint in a state into a row, `[joint][(row, feature)]`, and returns
/// the torques of the model \[Nm\].
pub(super) fn write(
    model: &Model,
    (data, regressors): (&mut Data, &mut Regressor),
    load: &Load,
    [q, qd, qdd]: [&[f64]; 3],
    (features, row): (&mut [DMatrix<f64>], usize),
) -> [f64; MAX_DOF] {
    let all = torque(model, data, load, q, qd, qdd);
    regressor(model, regressors, q, qd, qdd);
    let signs = motor_rates(model, qd).map(sign);
    let [springs, _] = laws(model, f64::INFINITY, [q, qd], &all.rigid, &signs);
    let tau = std::array::from_fn(|j| all.rigid[j] + all.friction[j]);
    for (j, features) in features.iter_mut().enumerate() {
        let mut row = features.row_mut(row);
        row[0] = tau[j];
        for link in j..model.dof {
            for (p, x) in regressors.rows[j][link].iter().enumerate() {
                row[1 + RIGID * (link - j) + p] = *x;
            }
        }
        let own = 1 + RIGID * (model.dof - j);
        for (p, x) in [qdd[j], qd[j], sign(qd[j]), springs[j]].into_iter().enumerate() {
            row[own + p] = x;
        }
    }
    tau
}
