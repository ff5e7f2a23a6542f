//! Torques and derivatives compared with Pinocchio for three robots in 1,000 states each;
//! `benches/peers/pinocchio/vectors.py` writes the fixtures.
#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

use joulepath::arm::dynamics::{Data, JointMatrix, Load, crba, rnea, rnea_derivatives};
use joulepath::arm::robot::{MAX_DOF, Model, find, load};

/// Tolerance relative to the largest torque of a row; the fixtures have 13 digits.
const EXACT: f64 = 1e-9;
/// Largest angle \[rad\], velocity \[rad/s\] and acceleration \[rad/s²\].
const REACH: [f64; 3] = [3.0, 4.0, 20.0];
const PRIMES: [f64; 21] = [
    2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0, 23.0, 29.0, 31.0, 37.0, 41.0, 43.0, 47.0, 53.0,
    59.0, 61.0, 67.0, 71.0, 73.0,
];

/// The states of the script, bit for bit.
fn state(dof: usize, index: usize) -> [Vec<f64>; 3] {
    let spread = |channel: usize| 2.0 * ((index + 1) as f64 * PRIMES[channel].sqrt()).fract() - 1.0;
    std::array::from_fn(|kind| {
        (0..dof).map(|joint| REACH[kind] * spread(MAX_DOF * kind + joint)).collect()
    })
}

fn close(found: &[f64], expected: &[f64], what: &str) {
    let scale = expected.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= EXACT * scale, "{what}: {found:?} {expected:?}");
    }
}

fn times_across(matrix: &JointMatrix, dof: usize) -> Vec<f64> {
    let term = |row: usize, column: usize| matrix[(row, column)] / (column as f64 + 1.0);
    (0..dof).map(|row| (0..dof).map(|column| term(row, column)).sum()).collect()
}

fn compare(model: &Model, fixture: &str) {
    let n = model.dof;
    let (mut data, none) = (Data::new(), Load::none());
    let (mut states, mut with_derivatives) = (0, 0);
    for (index, line) in fixture.lines().enumerate() {
        let row: Vec<f64> = line.split(',').map(|text| text.parse().unwrap()).collect();
        let [q, qd, qdd] = state(n, index);
        close(&rnea(model, &mut data, &none, &q, &qd, &qdd)[..n], &row[..n], "torque");
        states += 1;
        if row.len() > n {
            let found = rnea_derivatives(model, &mut data, &none, &q, &qd, &qdd);
            close(&times_across(&found.dq, n), &row[n..2 * n], "by angle");
            close(&times_across(&found.dqd, n), &row[2 * n..3 * n], "by rate");
            let mass = crba(model, &mut data, &none, &q);
            close(&times_across(&mass, n), &row[3 * n..], "mass");
            with_derivatives += 1;
        }
    }
    assert_eq!((states, with_derivatives), (1000, 100));
}

#[test]
fn torques_of_six_joints_agree_with_pinocchio() {
    let fixture = include_str!("../fixtures/dynamics/six.csv");
    compare(&find("IRB1600-10/1.45").unwrap(), fixture);
}

#[test]
fn torques_of_three_joints_agree_with_pinocchio() {
    let fixture = include_str!("../fixtures/dynamics/skew.csv");
    compare(&load("fixtures/dynamics/skew.toml").unwrap(), fixture);
}

#[test]
fn torques_of_seven_joints_agree_with_pinocchio() {
    let fixture = include_str!("../fixtures/dynamics/seven.csv");
    compare(&load("fixtures/dynamics/seven.toml").unwrap(), fixture);
}
