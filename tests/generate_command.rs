//! `joulepath generate` through the binary.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Output;

use command::{IRB1600 as ROBOT, joulepath_in, parsed, run_in, stderr};
use joulepath::retime::motion::stream::Stream;

/// Tolerance of the realised joints, rad: 1 mm at the reach of the arm.
const JOINT_TOLERANCE: f64 = 1e-3;

fn generate(folder: &Path, csv: &str, options: &[&str]) -> Output {
    fs::write(folder.join("points.csv"), csv).unwrap();
    let args = ["generate", "points.csv", "--robot", ROBOT, "--out", "out", "--quiet"];
    joulepath_in(folder, &[&args[..], options].concat())
}

fn simulate(folder: &Path) -> serde_json::Value {
    let args = ["simulate", "out", "--robot", ROBOT, "--format", "json", "--quiet"];
    parsed(&run_in(folder, &args))
}

/// Position in a smooth motion of `duration` at a time, rad.
fn position(t: f64, duration: f64) -> [f64; 6] {
    let x = (t / duration).clamp(0.0, 1.0);
    let s = x * x * x * (10.0 - 15.0 * x + 6.0 * x * x);
    let (a, b) = ([0.1, -0.2, 0.3, 0.0, 0.5, 0.0], [0.9, 0.3, 0.1, 0.4, 0.9, -0.5]);
    std::array::from_fn(|j| a[j] + (b[j] - a[j]) * s)
}

fn trajectory(duration: f64) -> String {
    let mut text = "t,q1,q2,q3,q4,q5,q6\n".to_owned();
    for i in 0..=200 {
        let t = duration * f64::from(i) / 200.0;
        let q = position(t, duration).map(|x| x.to_string()).join(",");
        writeln!(text, "{t},{q}").unwrap();
    }
    text
}

/// The numbers in a text.
fn numbers(text: &str) -> Vec<f64> {
    let is_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-');
    text.split(|c| !is_number(c)).filter_map(|word| word.parse().ok()).collect()
}

#[test]
fn a_trajectory_becomes_a_stream_that_follows_it() {
    let folder = tempfile::tempdir().unwrap();
    let output = generate(folder.path(), &trajectory(2.0), &["--format", "json"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let report = parsed(&output);
    assert_eq!(report["verification"]["passed"], true);
    for ratio in report["verification"]["max_ratio"].as_object().unwrap().values() {
        assert!(ratio.as_f64().unwrap() <= 1.0);
    }
    // Plays back the text alone.
    let text = fs::read_to_string(folder.path().join("out/pointsMod.mod")).unwrap();
    let mut points = Vec::new();
    let mut times = Vec::new();
    for line in text.lines().filter(|line| line.contains("MoveAbsJ")) {
        let degrees = numbers(line.split("],[").next().unwrap());
        points.push(std::array::from_fn(|j| degrees[j].to_radians()));
        times.extend(line.split("\\T:=").nth(1).map(|rest| numbers(rest)[0]));
    }
    let stream = Stream::new(points[0], points[1..].to_vec(), times).unwrap();
    assert!((stream.duration() - 2.0).abs() < 1e-9);
    for i in 0..=2000 {
        let t = f64::from(i) / 1000.0;
        let (q, wanted) = (stream.eval(t).0, position(t, 2.0));
        assert!((0..6).all(|j| (q[j] - wanted[j]).abs() < JOINT_TOLERANCE), "{t} s: {q:?}");
    }
}

#[test]
fn points_become_movements_that_reach_them() {
    let joints = "q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg,speed,zone\n\
                  0,0,0,0,30,0,v500,z10\n30,10,5,0,40,0,v500,z10\n30,20,5,15,40,0,200,fine\n";
    let poses = "x,y,z,w,i,j,k\n0.8,0,0.9,0,0,1,0\n0.8,0.3,0.9,0,0,1,0\n0.7,0.3,1.1,0,0,1,0\n";
    for (csv, form, instruction) in [
        (joints, "absj", "MoveAbsJ"),
        (joints, "movej", "MoveJ"),
        (joints, "movel", "MoveL"),
        (poses, "movel", "MoveL"),
        (poses, "absj", "MoveAbsJ"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let output = generate(folder.path(), csv, &["--as", form]);
        assert!(output.status.success(), "{}", stderr(&output));
        let simulation = simulate(folder.path());
        let moves = simulation["moves"].as_array().unwrap();
        assert_eq!(moves.len(), 3);
        assert_eq!(moves[2]["instruction"], instruction);
        assert_eq!(simulation["unresolved"].as_array().unwrap().len(), 0);
    }
}

#[test]
fn externally_guided_motion_gets_positions_and_a_module() {
    let folder = tempfile::tempdir().unwrap();
    let output = generate(folder.path(), &trajectory(2.0), &["--as", "egm"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let rows = fs::read_to_string(folder.path().join("out/pointsMod.csv")).unwrap();
    assert_eq!(rows.lines().count(), 1 + 501);
    let module = fs::read_to_string(folder.path().join("out/pointsMod.mod")).unwrap();
    assert!(module.contains("EGMRunJoint"));
    assert!(module.contains(r"EGMActJoint egmId\Tool:=tool0\WObj:=wobj0\J1:="), "{module}");
    assert!(module.contains(r"\MaxSpeedDeviation:="), "{module}");
}

#[test]
fn unusable_input_is_refused_without_output() {
    for (csv, options, part) in [
        (trajectory(0.4), &[][..], "times as long"),
        (trajectory(2.0), &["--as", "movej"], "timed trajectory becomes joint targets"),
        ("q1,q2,q3,q4,q5,q6\n90,0,0,0,30,0\n".into(), &[], "name them q1_deg"),
        ("q1,q2,q3,q4,q5,q6\n0,0,0,0,0.5,0\n".into(), &["--as", "egm"], "give a column t"),
        (
            "q1,q2,q3,q4,q5,q6,speed\n0,0,0,0,0.5,0,z10\n".into(),
            &[],
            "row 2: 'z10' is not a predefined speed",
        ),
        ("x,y,z,w,i,j,k\n8,0,1,0,0,1,0\n".into(), &["--as", "movel"], "row 2: the pose is out"),
        ("a,b\n1,2\n".into(), &[], "give the columns"),
        (
            "t,q1,q2,q3,q4,q5,q6\n0,0,0,0,0,0.5,0\n0.5,0.4,0,0,0,0.5,0\n1,0.8,0,0,0,0.5,0\n".into(),
            &[],
            "add a ramp",
        ),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let output = generate(folder.path(), &csv, options);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(part), "{message}");
        assert_eq!(message.matches(part).count(), 1, "{message}");
        assert!(!folder.path().join("out").exists());
    }
}
