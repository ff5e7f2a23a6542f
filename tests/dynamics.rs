//! Inverse dynamics compared with energies and derivatives of the Lagrangian. The energies are
//! computed in the base frame, independently of the inverse dynamics.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod arms;

use arms::{ROBOTS, largest, load, robots, states};
use joulepath::arm::dynamics::{
    Data, Load, friction, gravity, kinetic_energy, potential_energy, rnea,
};
use joulepath::arm::robot::{MAX_DOF, find};
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;

/// Relative error of the central differences used here.
const DIFFERENCES: f64 = 1e-6;
/// Relative error of two exact algorithms.
const EXACT: f64 = 1e-11;
/// Step of the central differences \[rad, rad/s, s\].
const H: f64 = 1e-5;

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

    #[test]
    fn joint_power_is_the_rate_of_change_of_energy(state in states(), which in 0..ROBOTS) {
        let model = &robots()[which];
        let [q, qd, qdd] = state.map(|v| v[..model.dof].to_vec());
        let tau = rnea(model, &mut Data::new(), &load(), &q, &qd, &qdd);
        let energy = |t: f64| {
            let at: Vec<f64> =
                (0..model.dof).map(|i| q[i] + t * qd[i] + 0.5 * t * t * qdd[i]).collect();
            let rate: Vec<f64> = (0..model.dof).map(|i| qd[i] + t * qdd[i]).collect();
            kinetic_energy(model, &load(), &at, &rate) + potential_energy(model, &load(), &at)
        };
        let change = (energy(H) - energy(-H)) / (2.0 * H);
        let power = dot(&tau, &qd);
        let scale = dot(&tau.map(f64::abs), &state[1].map(f64::abs)).max(1.0);
        prop_assert!((change - power).abs() < DIFFERENCES * scale, "{change} {power}");
    }

    #[test]
    fn torque_agrees_with_the_lagrangian(state in states(), which in 0..ROBOTS) {
        let model = &robots()[which];
        let [q, qd, qdd] = state.map(|v| v[..model.dof].to_vec());
        let tau = rnea(model, &mut Data::new(), &load(), &q, &qd, &qdd);
        let lagrangian = |q: &[f64], qd: &[f64]| {
            kinetic_energy(model, &load(), q, qd) - potential_energy(model, &load(), q)
        };
        // Large steps are exact: the kinetic energy is quadratic in the velocities.
        let momentum = |t: f64, joint: usize| {
            let at: Vec<f64> =
                (0..model.dof).map(|i| q[i] + t * qd[i] + 0.5 * t * t * qdd[i]).collect();
            let mut rate: Vec<f64> = (0..model.dof).map(|i| qd[i] + t * qdd[i]).collect();
            rate[joint] += 1.0;
            let ahead = lagrangian(&at, &rate);
            rate[joint] -= 2.0;
            (ahead - lagrangian(&at, &rate)) / 2.0
        };
        let scale = largest(&tau);
        for joint in 0..model.dof {
            let momentum_rate = (momentum(H, joint) - momentum(-H, joint)) / (2.0 * H);
            let mut moved = q.clone();
            moved[joint] += H;
            let ahead = lagrangian(&moved, &qd);
            moved[joint] -= 2.0 * H;
            let slope = (ahead - lagrangian(&moved, &qd)) / (2.0 * H);
            let expected = momentum_rate - slope;
            prop_assert!(
                (tau[joint] - expected).abs() < DIFFERENCES * scale,
                "joint {joint}: {} {expected}", tau[joint]
            );
        }
    }

    #[test]
    fn mass_matrix_and_bias_give_the_torque(state in states(), which in 0..ROBOTS) {
        let model = &robots()[which];
        let [q, qd, qdd] = state.map(|v| v[..model.dof].to_vec());
        let mut data = Data::new();
        let held = gravity(model, &mut data, &load(), &q);
        let columns: Vec<[f64; MAX_DOF]> = (0..model.dof)
            .map(|joint| {
                let mut unit = vec![0.0; model.dof];
                unit[joint] = 1.0;
                let tau = rnea(model, &mut data, &load(), &q, &[], &unit);
                std::array::from_fn(|i| tau[i] - held[i])
            })
            .collect();
        let bias = rnea(model, &mut data, &load(), &q, &qd, &[]);
        let tau = rnea(model, &mut data, &load(), &q, &qd, &qdd);
        let scale = largest(&tau).max(largest(&bias));
        let mut twice_kinetic = 0.0;
        for i in 0..model.dof {
            let row: Vec<f64> = columns.iter().map(|column| column[i]).collect();
            prop_assert!((dot(&row, &qdd) + bias[i] - tau[i]).abs() < EXACT * scale);
            prop_assert!((0..model.dof).all(|j| (row[j] - columns[i][j]).abs() < EXACT * 100.0));
            twice_kinetic += qd[i] * dot(&row, &qd);
        }
        let kinetic = kinetic_energy(model, &load(), &q, &qd);
        prop_assert!((0.5 * twice_kinetic - kinetic).abs() < EXACT * kinetic.max(1.0));
    }
}

#[test]
fn a_load_acts_at_its_lever_arm_and_loads_can_be_merged() {
    let model = find("IRB1600-10/1.45").unwrap();
    let q = [0.2, 0.4, -0.3, 0.5, 0.7, 0.1];
    let held = |load: &Load| gravity(&model, &mut Data::new(), load, &q);
    let point = Load { mass: 10.0, com: Vector3::new(0.0, 0.0, 0.1), inertia: Matrix3::zeros() };
    // 10 kg at 0.1 m from the flange: manual lever arm about axis 2.
    let tcp = joulepath::arm::kinematics::fk(&model, &q)
        * nalgebra::Isometry3::translation(0.0, 0.0, 0.1);
    let radius = tcp.translation.x * 0.2_f64.cos() + tcp.translation.y * 0.2_f64.sin();
    let added = held(&point)[1] - held(&Load::none())[1];
    let expected = -10.0 * joulepath::arm::robot::GRAVITY * (radius - 0.15);
    assert!((added - expected).abs() < 1e-9, "{added} {expected}");

    let halves = Load { mass: 5.0, ..point.clone() };
    let merged = halves.with(&halves);
    assert!((merged.mass - 10.0).abs() < 1e-12 && (merged.com - point.com).norm() < 1e-12);
}

#[test]
fn friction_follows_the_sign_of_the_velocity() {
    let model = find("IRB1600-10/1.45").unwrap();
    let tau = friction(&model, &[1e-12, -1.0, 0.0, -0.0, 2.0, 0.0], &[0.0; MAX_DOF]);
    assert_eq!(tau, [25.0 + 48.0 * 1e-12, -87.0, 0.0, 0.0, 6.6 + 7.0, 0.0, 0.0]);
}

#[test]
fn a_robot_without_dynamics_has_zero_torques() {
    let model = find("IRB6640-180/2.55").unwrap();
    assert!(!model.has_dynamics());
    let tau = rnea(&model, &mut Data::new(), &load(), &[0.3; 6], &[1.0; 6], &[1.0; 6]);
    assert_eq!(tau, [0.0; MAX_DOF]);
}
