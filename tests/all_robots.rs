//! Runs every command that needs dynamics on a program in the workspace of every robot of the
//! catalogue, and of an arm from a URDF without inertias.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;

use std::f64::consts::FRAC_PI_2;
use std::fmt::Write as _;

use command::{joulepath, module, stderr, stdout, written};
use joulepath::arm::kinematics::{fk, limits_ok};
use joulepath::arm::robot::{Model, find, load, names};
use rayon::prelude::*;
use tempfile::TempDir;

/// Least sine of axis 5 at a pose: keeps distance from singularities.
const BENT: f64 = 0.35;
/// Height and distance of the wrist from axis 1 over its largest reach.
const HEIGHT: f64 = 0.15;
const FAR: [f64; 2] = [0.45, 0.9];
/// Number of tried poses per robot.
const TRIES: usize = 20_000;
/// Length of lines over that reach.
const LINE: f64 = 0.08;

/// Reachable poses in front of a robot, away from singularities.
fn poses(model: &Model) -> Vec<[f64; 6]> {
    let mut random = fastrand::Rng::with_seed(27);
    let tries: Vec<([f64; 6], [f64; 3])> = (0..TRIES)
        .map(|_| {
            let mut q: [f64; 6] = std::array::from_fn(|j| {
                let [low, high] = model.limits.position[j];
                let (low, high) = (low.max(-2.0), high.min(2.0));
                low + (high - low) * random.f64()
            });
            q[0] *= 0.5;
            (q, fk(model, &q).translation.vector.into())
        })
        .filter(|(q, _)| limits_ok(model, q).is_ok() && q[4].sin().abs() > BENT)
        .collect();
    let distance = |at: &[f64; 3]| at[0].hypot(at[1]);
    let reach = tries.iter().map(|(_, at)| distance(at)).fold(0.0, f64::max);
    let inside = tries.iter().filter(|(_, at)| {
        at[2] > HEIGHT * reach && (FAR[0]..FAR[1]).contains(&(distance(at) / reach)) && at[0] > 0.0
    });
    inside.map(|(q, _)| *q).collect()
}

fn jointtarget(q: &[f64; 6]) -> String {
    let degrees: Vec<String> = q.iter().map(|x| format!("{:.3}", x.to_degrees())).collect();
    format!("[[{}],[9E9,9E9,9E9,9E9,9E9,9E9]]", degrees.join(","))
}

/// A robtarget at the pose `q`, raised by `up`.
fn robtarget(model: &Model, q: &[f64; 6], up: f64) -> String {
    let pose = fk(model, q);
    let at = pose.translation.vector;
    let r = pose.rotation.quaternion();
    let quarter = |angle: f64| (angle / FRAC_PI_2).floor();
    format!(
        "[[{:.3},{:.3},{:.3}],[{:.8},{:.8},{:.8},{:.8}],[{},{},{},0],[9E9,9E9,9E9,9E9,9E9,9E9]]",
        1e3 * at.x,
        1e3 * at.y,
        1e3 * (at.z + up),
        r.w,
        r.i,
        r.j,
        r.k,
        quarter(q[0]),
        quarter(q[3]),
        quarter(q[5])
    )
}

/// A cycle of joint movements, a line up and down, and waits.
fn program(model: &Model) -> String {
    let poses = poses(model);
    assert!(poses.len() >= 3, "{}: only {} poses", model.name, poses.len());
    let reach = poses.iter().map(|q| fk(model, q).translation.vector.xy().norm());
    let line = LINE * reach.fold(0.0, f64::max);
    let mut text = String::from("MODULE Generated\n");
    for (name, q) in ["jA", "jB", "jC"].into_iter().zip(&poses) {
        let _ = writeln!(text, "  CONST jointtarget {name}:={};", jointtarget(q));
    }
    let _ = writeln!(text, "  CONST robtarget pUp:={};", robtarget(model, &poses[1], line));
    let _ = writeln!(text, "  CONST robtarget pB:={};", robtarget(model, &poses[1], 0.0));
    text += "  PROC main()
    ConfL\\Off;
    MoveAbsJ jA,v1000,fine,tool0;
    MoveAbsJ jB,v1500,fine,tool0;
    MoveL pUp,v200,z10,tool0;
    MoveL pB,v200,fine,tool0;
    WaitTime 2;
    MoveAbsJ jC,v1500,z50,tool0;
    MoveAbsJ jA,v1000,fine,tool0;
    WaitTime 4;
  ENDPROC
ENDMODULE
";
    text
}

/// One of this many robots runs the slow commands.
const ONE_IN: usize = 6;

/// Errors of the commands with a robot.
fn faults(model: &Model, robot: &str, slow: bool) -> Vec<String> {
    let (folder, path) = module(program(model));
    let [out, excitation] =
        ["out", "excitation"].map(|name| folder.path().join(name).display().to_string());
    let common = ["--robot", robot, "--format", "json", "--quiet"];
    let with = |own: &[&str]| joulepath(&[own, &common[..]].concat());
    let mut runs = vec![
        ("simulate", with(&["simulate", &path]), "energy_interval_j"),
        ("lint", with(&["lint", &path]), "cycle_energy_j"),
        ("standstill", with(&["standstill", &path]), "holding_interval_w"),
    ];
    if slow {
        let small = ["--cycles", "2", "--harmonics", "1,3", "--spacing", "0.1"];
        let design = with(&[&["excite", "--out", &excitation], &small[..]].concat());
        runs.push(("excite", design, "condition"));
        let optimized = with(&["optimize", &path, "--out", &out]);
        runs.push(("optimize", optimized, "saving_interval_percent"));
    }
    let mut faults = Vec::new();
    for (command, output, key) in runs {
        // The exit code of `lint` reports findings.
        let code = output.status.code();
        let text = stdout(&output);
        let done = code == Some(0) || (command == "lint" && code == Some(1));
        let value = text.split(&format!("\"{key}\":")).nth(1).unwrap_or("null").trim_start();
        // Infinite and undefined numbers are null in JSON.
        let first = value.trim_start_matches(['[', ' ', '\n']);
        if !done || first.starts_with("null") {
            let message = stderr(&output);
            faults.push(format!("{} {command}: {code:?} {message}", model.name));
        }
    }
    faults
}

/// Errors with all robots; one in `one_in` runs the slow commands.
fn faults_of_all(one_in: usize) -> String {
    let all: Vec<Model> = names().map(|name| find(name).unwrap()).filter(|m| m.dof == 6).collect();
    assert!(all.len() >= 70, "{}", all.len());
    let each = all.par_iter().enumerate();
    let faults: Vec<String> =
        each.flat_map_iter(|(i, m)| faults(m, &m.name, i % one_in == 0)).collect();
    faults.join("\n")
}

/// With `ALL_ROBOTS` set (ten minutes in release mode), each robot also runs the slow commands.
#[test]
fn every_six_axis_robot_of_the_catalogue_runs_each_command() {
    let all = std::env::var_os("ALL_ROBOTS").is_some();
    let faults = faults_of_all(if all { 1 } else { ONE_IN });
    assert!(faults.is_empty(), "{faults}");
}

/// Joint origins (m, rad) of an unknown arm; the joints turn about their z axes.
const ARM: [([f64; 3], [f64; 3]); 6] = [
    ([0.0, 0.0, 0.35], [0.0, 0.0, 0.0]),
    ([0.08, 0.0, 0.0], [-FRAC_PI_2, 0.0, 0.0]),
    ([0.0, -0.6, 0.0], [0.0, 0.0, 0.0]),
    ([0.55, 0.0, 0.0], [FRAC_PI_2, 0.0, FRAC_PI_2]),
    ([0.0, 0.0, 0.0], [-FRAC_PI_2, 0.0, 0.0]),
    ([0.0, 0.0, 0.0], [FRAC_PI_2, 0.0, 0.0]),
];

#[test]
fn an_arm_of_a_urdf_without_inertias_runs_each_command() {
    let mut text = String::from("<robot name=\"unknown arm\"><link name=\"l0\"/>");
    for (i, (xyz, rpy)) in ARM.iter().enumerate() {
        let list = |x: &[f64; 3]| format!("{} {} {}", x[0], x[1], x[2]);
        let _ = write!(
            text,
            "<link name=\"l{}\"/><joint name=\"j{}\" type=\"revolute\"><parent link=\"l{i}\"/>\
             <child link=\"l{}\"/><origin xyz=\"{}\" rpy=\"{}\"/><axis xyz=\"0 0 1\"/>\
             <limit lower=\"-2.6\" upper=\"2.6\" velocity=\"3.5\" effort=\"0\"/></joint>",
            i + 1,
            i + 1,
            i + 1,
            list(xyz),
            list(rpy)
        );
    }
    text += "</robot>";
    let folder = TempDir::new().unwrap();
    let path = written(&folder, "arm.urdf", text);
    let faults = faults(&load(&path).unwrap(), &path, true);
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
