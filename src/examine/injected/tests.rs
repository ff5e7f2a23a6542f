//! The laws on a synthetic motion.
#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use std::f64::consts::TAU;

use nalgebra::{Matrix3, Vector3};

use super::arm::Arm;
use super::catalogue::EFFECTS;
use super::law::{Draw, Law, shares};
use super::motion::{Joints, rms};
use super::visible::nats;
use super::{environment, friction, measurement, transmission};
use crate::arm::dynamics::Load;
use crate::arm::robot::{MAX_DOF, Model, find};
use crate::examine::blind::random::Random;
use crate::learn::log::Log;

/// Interval of the rows \[s\] and their number.
const STEP_S: f64 = 0.004;
const ROWS: usize = 2500;
/// Relative tolerance of torques whose derivatives are fitted.
const CLOSE: f64 = 0.02;

/// A robot that turns all joints, with torques of rigid bodies, friction and noise.
fn arm() -> Arm {
    let mut model = find("IRB1600-10/1.45").unwrap();
    model.friction.coulomb = vec![20.0, 20.0, 15.0, 6.0, 6.0, 4.0];
    model.friction.viscous = vec![10.0, 10.0, 8.0, 3.0, 3.0, 2.0];
    moved(model, 0.5)
}

fn moved(model: Model, noise: f64) -> Arm {
    let t: Vec<f64> = (0..ROWS).map(|row| STEP_S * row as f64).collect();
    let wave = |joint: usize, t: f64| {
        let slow = TAU * (0.31 + 0.05 * joint as f64);
        0.7 * (slow * t + joint as f64).sin() + 0.12 * (3.1 * slow * t).sin()
    };
    let q: Vec<Vec<f64>> =
        (0..model.dof).map(|joint| t.iter().map(|t| wave(joint, *t)).collect()).collect();
    let names: Vec<String> = (1..=model.dof).map(|joint| format!("q{joint}")).collect();
    let mut columns: Vec<(&str, &[f64])> = vec![("t", &t)];
    columns.extend(names.iter().map(String::as_str).zip(q.iter().map(Vec::as_slice)));
    let log = Log::from_columns(&columns).unwrap();
    // The torques of the model are what its residual lacks without any.
    let still = vec![vec![0.0; ROWS]; model.dof];
    let without = Arm::of(model.clone(), &log, &still);
    assert_eq!(without.tau.len(), ROWS);
    let mut random = Random::new(3, 1, "noise");
    let tau = |joint: usize| -> Vec<f64> {
        let rows = without.residual.iter();
        rows.map(|row| noise * random.normal() - row[joint]).collect()
    };
    let tau: Vec<Vec<f64>> = (0..model.dof).map(tau).collect();
    Arm::of(model, &log, &tau)
}

fn law<'a>(arm: &'a Arm, draw: Draw, joint: usize, form: &str) -> Law<'a> {
    let mut random = Random::new(1, 1, "law");
    let mut laws = (0..32).filter_map(|_| draw(arm, joint, &mut random));
    laws.find(|law| law.truth.form == form).unwrap()
}

fn of(torques: &[Joints], joint: usize) -> Vec<f64> {
    torques.iter().map(|torque| torque[joint]).collect()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    rms(a.iter().zip(b).map(|(a, b)| a - b)) / rms(b.iter().copied())
}

#[test]
fn each_effect_adds_finite_torques_that_grow_with_its_size() {
    let arm = arm();
    let rows: Vec<usize> = (0..ROWS).collect();
    let mut random = Random::new(2, 1, "effects");
    for entry in EFFECTS {
        let mut laws = (0..arm.dof()).filter_map(|joint| (entry.draw)(&arm, joint, &mut random));
        let law = laws.next().unwrap_or_else(|| panic!("{}", entry.id));
        assert_eq!(law.truth.id, entry.id);
        let share = |size: f64| law.share(&shares(&arm, &rows, &law.torques(size)));
        let [least, most] = law.sizes.map(share);
        assert!(least.is_finite() && most.is_finite() && least < most, "{}", entry.id);
        let parameters = law.truth(law.sizes[1]).parameters;
        assert!(!parameters.is_empty(), "{}", entry.id);
    }
}

#[test]
fn joints_without_the_effect_keep_their_torques() {
    let arm = arm();
    let law = law(&arm, friction::stribeck, 3, "lorentzian");
    let torques = law.torques(1.0);
    for joint in 0..MAX_DOF {
        assert_eq!(torques.iter().any(|torque| torque[joint] != 0.0), joint == 3);
    }
}

#[test]
fn a_stribeck_curve_has_its_size_where_the_joint_is_slow() {
    let arm = arm();
    let torques = law(&arm, friction::stribeck, 1, "lorentzian").torques(7.0);
    let largest = torques.iter().map(|torque| torque[1].abs()).fold(0.0, f64::max);
    let row =
        (0..ROWS).max_by(|a, b| arm.motion.qd[*a][1].abs().total_cmp(&arm.motion.qd[*b][1].abs()));
    assert!((5.0..=7.0).contains(&largest), "{largest}");
    assert!(torques[row.unwrap()][1].abs() < 0.1 * largest);
}

#[test]
fn presliding_lasts_for_its_distance_after_a_reversal() {
    let arm = arm();
    for form in ["lugre", "iwan"] {
        let law = law(&arm, friction::presliding, 0, form);
        let torques = law.torques(0.01);
        let coulomb = arm.model.friction.coulomb[0];
        let mut since = f64::INFINITY;
        let mut near: f64 = 0.0;
        for row in 1..ROWS {
            let turns = arm.motion.qd[row][0] * arm.motion.qd[row - 1][0] <= 0.0;
            since = if turns {
                0.0
            } else {
                since + (arm.motion.q[row][0] - arm.motion.q[row - 1][0]).abs()
            };
            near = near.max(if since < 0.005 { torques[row][0].abs() } else { 0.0 });
            let is_built_up = since > 0.1 && since.is_finite();
            assert!(!is_built_up || torques[row][0].abs() < 0.05 * coulomb, "{form}, row {row}");
        }
        assert!(near > coulomb, "{form}: {near}");
    }
}

#[test]
fn a_soft_joint_swings_little_where_it_is_stiff() {
    let arm = arm();
    let law = law(&arm, transmission::elasticity, 1, "swinging_link");
    let [stiff, soft] = law.sizes.map(|size| rms(of(&law.torques(size), 1).into_iter()));
    assert!(stiff > 0.0 && soft > 10.0 * stiff, "{stiff} {soft}");
}

#[test]
fn backlash_acts_on_a_joint_whose_torque_changes_its_sign() {
    let arm = arm();
    for form in ["hertz_contact", "sticky_play"] {
        let torques = law(&arm, transmission::backlash, 0, form).torques(1e-3);
        assert!(rms(of(&torques, 0).into_iter()) > 0.0, "{form}");
    }
}

#[test]
fn a_contact_acts_in_its_window_in_proportion_to_its_force() {
    let arm = arm();
    let law = law(&arm, environment::contact, 0, "steady");
    let window = law.truth.window.unwrap();
    let middle = f64::midpoint(window[0], window[1]);
    let row = arm.motion.t.iter().position(|t| *t >= middle).unwrap();
    let [once, twice] = [10.0, 20.0].map(|force| law.torques(force)[row]);
    for joint in 0..arm.dof() {
        assert!((twice[joint] - 2.0 * once[joint]).abs() < 1e-9);
    }
    assert!(once.iter().any(|torque| torque.abs() > 0.1));
    let before = law.torques(10.0)[0];
    assert!(before.iter().all(|torque| torque.abs() < 1e-3), "{before:?}");
}

#[test]
fn a_payload_adds_its_weight() {
    let arm = arm();
    let law = law(&arm, environment::payload, 0, "box");
    let parameters = law.truth(2.0).parameters;
    let value = |name: &str| parameters.iter().find(|of| of.name == name).unwrap().value;
    let com = Vector3::new(value("com_x"), value("com_y"), value("com_z"));
    let point = Load { mass: value("mass"), com, inertia: Matrix3::zeros() };
    let [found, expected] = [law.torques(2.0), arm.changed(&arm.model, &point)];
    assert!(apart(&of(&found, 1), &of(&expected, 1)) < CLOSE);
}

#[test]
fn an_encoder_offset_is_the_torque_of_the_shifted_robot() {
    let arm = arm();
    let law = law(&arm, environment::encoder_offset, 2, "constant");
    let offset = law.truth(0.01).parameters[0].value;
    let expected = arm.moved(|row| {
        let mut q = arm.motion.q[row];
        q[2] += offset;
        [q, arm.motion.qd[row], arm.motion.qdd[row]]
    });
    assert_eq!(law.torques(0.01), expected);
}

#[test]
fn a_tilted_base_pulls_at_axis_1() {
    let arm = arm();
    let torques = law(&arm, environment::base_tilt, 0, "leaning").torques(0.05);
    assert!(rms(of(&torques, 0).into_iter()) > 1.0);
    // A level base has no weight at axis 1.
    let weight = arm.moved(|row| [arm.motion.q[row], [0.0; MAX_DOF], [0.0; MAX_DOF]]);
    let held: Vec<f64> =
        weight.iter().zip(&arm.gears).map(|(more, all)| more[0] + all[0]).collect();
    assert!(held.iter().all(|torque| torque.abs() < 1e-9));
}

#[test]
fn late_torques_are_those_of_before() {
    // Without friction the torques are smooth.
    let mut model = find("IRB1600-10/1.45").unwrap();
    model.friction.coulomb.fill(0.0);
    model.friction.stribeck = None;
    model.friction.load_friction = None;
    let arm = moved(model, 0.0);
    let delay = 0.012;
    for (draw, form) in [
        (measurement::time_delay as Draw, "wandering"),
        (measurement::time_delay, "held"),
        (measurement::filter_lag, "butterworth"),
        (measurement::filter_lag, "critically_damped"),
    ] {
        let torques = law(&arm, draw, 0, form).torques(delay);
        // τ(t − d) − τ(t) ≈ −d τ̇ where the torque is smooth.
        let (mut product, mut squares) = (0.0, 0.0);
        for row in 100..ROWS - 1 {
            let slope = (arm.tau[row + 1][0] - arm.tau[row - 1][0]) / (2.0 * STEP_S);
            product -= torques[row][0] * slope;
            squares += slope * slope;
        }
        let found = product / squares;
        assert!((found / delay - 1.0).abs() < 0.2, "{form}: {found}");
    }
}

#[test]
fn a_coupled_wrist_acts_on_axes_5_and_6_alone() {
    let arm = arm();
    let law = law(&arm, transmission::wrist_coupling, 0, "algebraic_sign");
    let torques = law.torques(0.3);
    assert!([4, 5].iter().all(|joint| rms(of(&torques, *joint).into_iter()) > 0.0));
    assert!((0..4).all(|joint| of(&torques, joint).iter().all(|torque| *torque == 0.0)));
}

#[test]
fn a_parameter_within_its_spread_is_less_visible_than_an_offset() {
    let arm = arm();
    let run = [(0..ROWS).collect::<Vec<usize>>()];
    let seen = |torque: &dyn Fn(usize) -> f64| {
        let added: Vec<Joints> = (0..ROWS).map(|row| super::law::at(1, torque(row))).collect();
        nats(&arm, &run, &added)
    };
    let viscous = 0.05 * arm.model.friction.viscous[1];
    let parameter = seen(&|row| viscous * arm.motion.qd[row][1]);
    assert!(parameter > 0.0 && parameter < 0.51, "{parameter}");
    let size = rms((0..ROWS).map(|row| viscous * arm.motion.qd[row][1]));
    let other = seen(&|row| size * (40.0 * arm.motion.q[row][1]).cos());
    assert!(other > 20.0 * parameter, "{other}");
}
