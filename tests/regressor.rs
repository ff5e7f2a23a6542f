//! The regressor compared with inverse dynamics, and the base parameters.

mod arms;

use arms::{ROBOTS, largest, load, robots, states};
use joulepath::arm::dynamics::{
    BaseParameters, Data, Load, RIGID, Regressor, base_parameters, base_parameters_among,
    parameter_count, parameters, rnea, torque, write_rows,
};
use joulepath::arm::robot::{MAX_DOF, Model, find};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

/// Relative error of two exact algorithms.
const EXACT: f64 = 1e-10;

fn rows(model: &Model, state: &[[f64; MAX_DOF]; 3]) -> DMatrix<f64> {
    let n = model.dof;
    let mut rows = DMatrix::zeros(n, parameter_count(n));
    let [q, qd, qdd] = state;
    let state = [&q[..n], &qd[..n], &qdd[..n]];
    write_rows(model, &mut Regressor::new(), state, &mut rows, 0);
    rows
}

/// The base parameters of the rigid bodies.
fn rigid_bodies(model: &Model) -> BaseParameters {
    let among: Vec<usize> = (0..RIGID * model.dof).collect();
    base_parameters_among(model, &among)
}

/// Removes the friction laws that are not linear in four parameters per joint.
fn linear(mut model: Model) -> Model {
    model.friction.coulomb_asymmetry = None;
    model.friction.viscous_asymmetry = None;
    model.friction.stribeck = None;
    model.friction.load_friction = None;
    model
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

    #[test]
    fn torque_is_linear_in_the_parameters(state in states(), which in 0..ROBOTS) {
        let model = linear(robots()[which].clone());
        let n = model.dof;
        let [q, qd, qdd] = state.map(|v| v[..n].to_vec());
        let rows = rows(&model, &state);
        let values = DVector::from(parameters(&model, &load()));
        let linear = &rows * &values;
        let found = torque(&model, &mut Data::new(), &load(), &q, &qd, &qdd);
        let rotors_left_out = {
            let mut model = model.clone();
            model.motors = None;
            rnea(&model, &mut Data::new(), &load(), &q, &qd, &qdd)
        };
        let bodies = rows.columns(0, RIGID * n) * values.rows(0, RIGID * n);
        let scale = largest(&found.rigid);
        for i in 0..n {
            let expected = found.rigid[i] + found.friction[i];
            prop_assert!((linear[i] - expected).abs() < EXACT * scale, "{} {expected}", linear[i]);
            prop_assert!((bodies[i] - rotors_left_out[i]).abs() < EXACT * scale);
        }
    }

    #[test]
    fn base_parameters_give_the_same_torque(state in states(), which in 0..ROBOTS) {
        let model = linear(robots()[which].clone());
        let base = base_parameters(&model);
        let full = rows(&model, &state);
        let values = parameters(&model, &load());
        let picked = full.select_columns(&base.independent);
        let torque = &full * DVector::from(values.clone());
        let grouped = picked * DVector::from(base.of_parameters(&values));
        let scale = largest(torque.as_slice());
        prop_assert!((torque - grouped).amax() < 1e-9 * scale);
    }
}

#[test]
fn ranks_agree_with_the_literature() {
    let [six, skew, rods, wrist, seven, one, tilted] = robots();
    let ranks = |model: &Model| [rigid_bodies(model), base_parameters(model)].map(|b| b.rank());
    assert_eq!(ranks(&six), [36, 58]);
    assert_eq!(ranks(&rods)[0], 36);
    assert_eq!(ranks(&wrist), [36, 58]);
    // Joint 1 determines zz; mx and my only if its axis is not vertical.
    assert_eq!(ranks(&one), [3, 6]);
    assert_eq!(ranks(&skew)[0], 3 + 7 + 7);
    assert!(ranks(&seven)[0] <= 1 + 6 * 7);
    // On a slope gravity acts on joint 1: mx and my are determined, too.
    assert_eq!(ranks(&tilted), [38, 60]);
}

#[test]
fn base_parameters_have_names() {
    let model = find("IRB1600-10/1.45").expect("in the catalogue");
    let base = rigid_bodies(&model);
    let names: Vec<String> = (0..base.rank()).map(|row| base.name(row)).collect();
    insta::assert_snapshot!(names.join("\n"));
    assert_eq!(base.of_parameters(&parameters(&model, &Load::none())).len(), 36);
}
