//! Derivatives, mass matrix and forward dynamics compared with inverse dynamics.

mod arms;

use arms::{ROBOTS, largest, load, robots, states};
use joulepath::arm::dynamics::{
    Data, JointMatrix, crba, forward_dynamics, gravity, rnea, rnea_derivatives,
};
use joulepath::arm::robot::MAX_DOF;
use proptest::prelude::*;

/// Relative error of the finite differences.
const DIFFERENCES: f64 = 1e-8;
/// Relative error of two exact algorithms.
const EXACT: f64 = 1e-10;
/// Step of the finite differences \[rad, rad/s\].
const H: f64 = 2e-3;

/// Derivative of `f` along `joint`, by central differences of sixth order.
fn slope(at: &[f64], joint: usize, f: impl Fn(&[f64]) -> [f64; MAX_DOF]) -> [f64; MAX_DOF] {
    let moved = |steps: f64| {
        let mut there = at.to_vec();
        there[joint] += steps * H;
        f(&there)
    };
    let weights = [(1.0, 45.0), (2.0, -9.0), (3.0, 1.0)];
    let mut sum = [0.0; MAX_DOF];
    for (steps, weight) in weights {
        let (ahead, behind) = (moved(steps), moved(-steps));
        for i in 0..MAX_DOF {
            sum[i] += weight * (ahead[i] - behind[i]) / (60.0 * H);
        }
    }
    sum
}

fn size(matrix: &JointMatrix) -> f64 {
    largest(matrix.as_slice())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

    #[test]
    fn derivatives_agree_with_finite_differences(state in states(), which in 0..ROBOTS) {
        let model = &robots()[which];
        let [q, qd, qdd] = state.map(|v| v[..model.dof].to_vec());
        let found = rnea_derivatives(model, &mut Data::new(), &load(), &q, &qd, &qdd);
        let tau = |q: &[f64], qd: &[f64]| rnea(model, &mut Data::new(), &load(), q, qd, &qdd);
        for joint in 0..model.dof {
            let by_angle = slope(&q, joint, |at| tau(at, &qd));
            let by_rate = slope(&qd, joint, |at| tau(&q, at));
            for i in 0..model.dof {
                let (a, b) = (found.dq[(i, joint)], found.dqd[(i, joint)]);
                prop_assert!(
                    (a - by_angle[i]).abs() < DIFFERENCES * size(&found.dq),
                    "q {i} {joint}: {a} {}", by_angle[i]
                );
                prop_assert!(
                    (b - by_rate[i]).abs() < DIFFERENCES * size(&found.dqd),
                    "qd {i} {joint}: {b} {}", by_rate[i]
                );
            }
        }
    }

    #[test]
    fn derivatives_return_the_torque_and_the_mass_matrix(state in states(), which in 0..ROBOTS) {
        let model = &robots()[which];
        let [q, qd, qdd] = state.map(|v| v[..model.dof].to_vec());
        let mut data = Data::new();
        let found = rnea_derivatives(model, &mut data, &load(), &q, &qd, &qdd);
        let tau = rnea(model, &mut data, &load(), &q, &qd, &qdd);
        let mass = crba(model, &mut data, &load(), &q);
        let scale = largest(&tau);
        for i in 0..MAX_DOF {
            prop_assert!((found.tau[i] - tau[i]).abs() < EXACT * scale);
        }
        prop_assert!((found.mass - mass).amax() < EXACT * size(&mass));
    }

    #[test]
    fn mass_matrix_columns_are_torques_of_unit_accelerations(state in states(), which in 0..ROBOTS) {
        let model = &robots()[which];
        let mut data = Data::new();
        let q = &state[0][..model.dof];
        let mass = crba(model, &mut data, &load(), q);
        let held = gravity(model, &mut data, &load(), q);
        let scale = largest(&held).max(size(&mass));
        for joint in 0..model.dof {
            let mut unit = vec![0.0; model.dof];
            unit[joint] = 1.0;
            let tau = rnea(model, &mut data, &load(), q, &[], &unit);
            for i in 0..model.dof {
                prop_assert!((tau[i] - held[i] - mass[(i, joint)]).abs() < EXACT * scale);
            }
        }
    }

    #[test]
    fn forward_dynamics_inverts_inverse_dynamics(state in states(), which in 0..ROBOTS) {
        let model = &robots()[which];
        let [q, qd, qdd] = state.map(|v| v[..model.dof].to_vec());
        let mut data = Data::new();
        let tau = rnea(model, &mut data, &load(), &q, &qd, &qdd);
        let found = forward_dynamics(model, &mut data, &load(), &q, &qd, &tau);
        let found = found.expect("a robot with dynamics");
        for i in 0..model.dof {
            prop_assert!((found[i] - qdd[i]).abs() < 1e-8 * largest(&qdd), "{found:?} {qdd:?}");
        }
    }
}

#[test]
fn a_robot_without_dynamics_has_no_forward_dynamics() {
    let model = joulepath::arm::robot::find("IRB6640-180/2.55").expect("in the catalogue");
    let mut data = Data::new();
    let state = [0.1; 6];
    let none = joulepath::arm::dynamics::Load::none();
    assert!(forward_dynamics(&model, &mut data, &none, &state, &state, &state).is_none());
    let found = rnea_derivatives(&model, &mut data, &none, &state, &state, &state);
    assert_eq!((found.dq.amax(), found.mass.amax()), (0.0, 0.0));
}
