//! `excite` through the binary: what it writes keeps the limits and is RAPID.
#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

use std::fs;
use std::process::{Command, Output};

use joulepath::dynamics::Load;
use joulepath::excite::{Design, Focus, Plane, random_feasible};
use joulepath::kinematics::fk;
use joulepath::robot::find;
use joulepath::syntax;
use nalgebra::Vector3;
use serde_json::Value;

const ROBOT: &str = "IRB1600-10/1.45";
/// What the issue asks for.
const CONDITION: f64 = 20.0;
/// Random motions that a design has to be as good as.
const RANDOM: usize = 200;

fn joulepath(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_joulepath")).args(args).output().unwrap()
}

fn excite(folder: &tempfile::TempDir, more: &[&str]) -> Value {
    let out = folder.path().to_str().unwrap();
    let args = ["excite", "--robot", ROBOT, "--out", out, "-q", "--format", "json"];
    let output = joulepath(&[&args[..], more].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The modules parse without errors and without a tolerance.
fn is_rapid(folder: &tempfile::TempDir) {
    for name in ["JoulepathExcitation.mod", "JoulepathLogger.mod"] {
        let bytes = fs::read(folder.path().join(name)).unwrap();
        let parse = syntax::parse(&bytes);
        assert!(parse.errors.is_empty(), "{name}: {:?}", parse.errors);
        assert!(parse.tolerances.is_empty(), "{name}: {:?}", parse.tolerances);
    }
}

#[test]
fn the_motion_tells_all_parameters_within_all_limits() {
    let folder = tempfile::tempdir().unwrap();
    let found = excite(&folder, &["--plane", "1,0,0,-0.8"]);
    assert_eq!(found["rank"], 58);
    assert!(found["condition"]["scaled"].as_f64().unwrap() <= CONDITION, "{found}");
    is_rapid(&folder);

    let model = find(ROBOT).unwrap();
    let csv = fs::read_to_string(folder.path().join("excitation.csv")).unwrap();
    let limits = &model.limits;
    let (velocity, acceleration) =
        (limits.velocity.as_ref().unwrap(), limits.acceleration.as_ref().unwrap());
    let torque = limits.torque.as_ref().unwrap();
    let mut rows = 0;
    for line in csv.lines().skip(1) {
        let x: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        assert!((x[0] - 0.001 * f64::from(rows)).abs() < 1e-9);
        for j in 0..6 {
            let [low, high] = limits.position_at(&x[1..7], j);
            assert!((low..=high).contains(&x[1 + j]));
            assert!(x[7 + j].abs() <= 0.8 * velocity[j]);
            assert!(x[13 + j].abs() <= acceleration[j]);
            assert!(x[19 + j].abs() <= torque[j]);
        }
        assert!(fk(&model, &x[1..7]).translation.x >= -0.8);
        rows += 1;
    }
    assert_eq!(rows, 10_000);

    let design = Design {
        focus: Focus::All,
        base_frequency: 0.1,
        harmonics: vec![1, 4, 7],
        speed_share: 0.8,
        planes: vec![
            Plane { normal: Vector3::x(), distance: -0.8 },
            Plane { normal: Vector3::z(), distance: 0.0 },
        ],
        tool: Vector3::zeros(),
        load: Load::none(),
        seed: 5,
    };
    let random = random_feasible(&model, &design, RANDOM).unwrap();
    assert!(found["log_det"].as_f64().unwrap() >= random, "{random} {found}");
}

#[test]
fn small_experiments_are_rapid_too() {
    for variant in ["friction", "wrist"] {
        let folder = tempfile::tempdir().unwrap();
        let found = excite(&folder, &["--variant", variant]);
        for (what, ratio) in found["max_ratio"].as_object().unwrap() {
            assert!(ratio.as_f64().unwrap() <= 1.0, "{variant}: {what} {ratio}");
        }
        assert!(found["self_margin_m"].as_f64().unwrap() >= 0.0);
        is_rapid(&folder);
    }
}

#[test]
fn wrong_options_say_the_way_out() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    for (more, message) in [
        (&["--plane", "1,0,0"][..], "a normal and a distance"),
        (&["--plane", "0,0,0,1"], "the normal is 0"),
        (&["--plane", "1,0,0,5"], "move the planes"),
        (&["--harmonics", "0,1"], "whole multiples"),
        (&["--speed-share", "1.5"], "at most 1"),
        (&["--spacing", "nan"], "above 0"),
        (&["--cycles", "0"], "1 or more"),
    ] {
        let args = ["excite", "--robot", ROBOT, "--out", out, "-q", "--variant", "friction"];
        let output = joulepath(&[&args[..], more].concat());
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{more:?}: {text}");
        assert!(text.contains(message), "{more:?}: {text}");
    }
}
