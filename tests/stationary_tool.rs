//! A stationary tool; the robot moves the work.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod arms;
mod command;

use std::fs;

use command::{IRB1600, joulepath, module, run, stderr, stdout};
use joulepath::arm::kinematics::{Tcp, fk, jacobian};
use joulepath::arm::robot::{Model, find};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use proptest::prelude::*;

/// Tolerance of poses \[m\] and \[rad\].
const SAME_POSE: f64 = 1e-10;
/// Largest distance of the TCP from the line on the work \[m\]: the moving average of the joints
/// bends the path slightly.
const ON_LINE: f64 = 2e-5;
/// Relative tolerance of the TCP speed along the work.
const SPEED: f64 = 1e-3;

fn stationary() -> Isometry3<f64> {
    Isometry3::from_parts(
        Translation3::new(1.1, -0.2, 0.6),
        UnitQuaternion::from_euler_angles(0.3, 0.5, -0.2),
    )
}

/// A serial arm, and one with rods.
fn robots() -> [Model; 2] {
    let [serial, _, rods, ..] = arms::robots();
    [serial, rods]
}

fn difference(a: &Isometry3<f64>, b: &Isometry3<f64>) -> [Vector3<f64>; 2] {
    [a.translation.vector - b.translation.vector, (a.rotation * b.rotation.inverse()).scaled_axis()]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

    #[test]
    fn pose_and_flange_are_inverse_for_held_and_stationary_tools(
        q in prop::array::uniform6(-2.5..2.5)
    ) {
        let flange = fk(&robots()[0], &q);
        for tcp in [Tcp::Held(stationary()), Tcp::Stationary(stationary())] {
            let [linear, angular] = difference(&tcp.flange(&tcp.pose(&flange)), &flange);
            prop_assert!(linear.norm() < SAME_POSE && angular.norm() < SAME_POSE);
        }
        // The tool has the same pose relative to work and base.
        let seen = flange * Tcp::Stationary(stationary()).pose(&flange);
        let [linear, angular] = difference(&seen, &stationary());
        prop_assert!(linear.norm() < SAME_POSE && angular.norm() < SAME_POSE);
    }

    #[test]
    fn jacobian_is_the_derivative_of_the_pose(
        q in prop::array::uniform6(-2.5..2.5),
        qd in prop::array::uniform6(-3.0..3.0),
        which in 0usize..2,
    ) {
        let model = &robots()[which];
        let h = 1e-6;
        for tcp in [Tcp::Held(stationary()), Tcp::Stationary(stationary())] {
            let at = |t: f64| -> [f64; 6] { std::array::from_fn(|i| q[i] + t * qd[i]) };
            let pose = |t: f64| tcp.pose(&fk(model, &at(t)));
            let [linear, angular] = difference(&pose(h), &pose(-h)).map(|x| x / (2.0 * h));
            let twist = tcp.jacobian(model, &q) * nalgebra::Vector6::from(qd);
            prop_assert!((twist.fixed_rows::<3>(0) - linear).norm() < 1e-7);
            prop_assert!((twist.fixed_rows::<3>(3) - angular).norm() < 1e-7);
            let change =
                (tcp.jacobian(model, &at(h)) - tcp.jacobian(model, &at(-h))) / (2.0 * h);
            let found = tcp.jacobian_dot(model, &q, &qd);
            prop_assert!((found - change).amax() < 1e-6, "{found} {change}");
        }
        prop_assert!(
            Tcp::Held(stationary()).jacobian(model, &q) == jacobian(model, &q, &stationary())
        );
    }
}

/// A stationary glue gun; the robot moves a plate under it along two lines.
const GLUE: &str = "MODULE M\n\
    PERS tooldata tGlue:=[FALSE,[[900,100,700],[1,0,0,0]],[2,[0,0,50],[1,0,0,0],0,0,0]];\n\
    PERS wobjdata wPlate:=[TRUE,TRUE,\"\",[[0,0,120],[0.7071067812,0,-0.7071067812,0]],\
    [[0,0,0],[1,0,0,0]]];\n\
    CONST robtarget pA:=[[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    CONST robtarget pB:=[[0,150,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    CONST robtarget pC:=[[80,150,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    PROC main()\n\
    ConfL\\Off;\nConfJ\\Off;\n\
    MoveJ pA,v200,fine,tGlue\\WObj:=wPlate;\n\
    MoveL pB,v100,z20,tGlue\\WObj:=wPlate;\n\
    MoveL pC,v100,fine,tGlue\\WObj:=wPlate;\n\
    ENDPROC\nENDMODULE\n";

#[test]
fn the_workpiece_moves_along_the_line() {
    let (folder, program) = module(GLUE);
    let motion = folder.path().join("motion.csv");
    let args = ["simulate", &program, "--robot", IRB1600, "--start", "0,0,0,0,30,0"];
    let message = stderr(&run(&[&args[..], &["--trajectory", motion.to_str().unwrap()]].concat()));
    assert!(!message.contains("not simulated"), "{message}");

    let model = find("IRB1600-10/1.45").unwrap();
    let tool = Isometry3::translation(0.9, 0.1, 0.7);
    let plate = Isometry3::from_parts(
        Translation3::new(0.0, 0.0, 0.12),
        UnitQuaternion::from_euler_angles(0.0, -std::f64::consts::FRAC_PI_2, 0.0),
    );
    let text = fs::read_to_string(&motion).unwrap();
    let names: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let column = |name: &str| names.iter().position(|known| *known == name).unwrap();
    let (mut along, mut cruising) = (0, 0);
    for line in text.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |name: &str| cells[column(name)].parse::<f64>().unwrap();
        // The first line of the program before its zone.
        if cells[column("line")] != "11" {
            continue;
        }
        let q: [f64; 6] = std::array::from_fn(|i| number(&format!("q{}", i + 1)));
        let seen = plate.inverse() * (fk(&model, &q).inverse() * tool);
        let t = seen.translation.vector;
        // The moving average starts the zone 0.01 m early.
        if t.y < 0.119 {
            assert!(t.x.hypot(t.z) < ON_LINE && seen.rotation.angle() < ON_LINE, "{seen}");
            along += 1;
            let speed = number("tcp_speed");
            assert!(speed < 0.1 * (1.0 + SPEED), "{speed}");
            cruising += usize::from(speed > 0.1 * (1.0 - SPEED));
        }
    }
    assert!(along > 100 && cruising > 100, "{along} {cruising}");
}

#[test]
fn a_robot_that_holds_neither_tool_nor_work_object_is_reported() {
    let (_folder, program) = module(GLUE.replace("[TRUE,TRUE", "[FALSE,TRUE"));
    let output = joulepath(&["simulate", &program, "--robot", IRB1600]);
    let message = stdout(&output) + &stderr(&output);
    assert!(message.contains("the robot holds neither"), "{message}");
}
