//! `excite` through the binary: its program is RAPID and keeps the limits.
#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

mod command;

use std::fs;

use command::{IRB1600 as ROBOT, json, refused, rows};
use joulepath::arm::dynamics::Load;
use joulepath::arm::kinematics::{Body, KeepOut, Obstacle, Plane, fk};
use joulepath::arm::robot::find;
use joulepath::learn::excite::{Design, Designed, Focus, STEP, State, design_for, random_feasible};
use joulepath::rapid::syntax;
use nalgebra::{Point3, Vector3};
use serde_json::Value;

/// Required condition number.
const CONDITION: f64 = 20.0;
/// Number of random motions that a design has to match.
const RANDOM: usize = 2000;

fn excite(folder: &tempfile::TempDir, more: &[&str]) -> Value {
    let out = folder.path().to_str().unwrap();
    let args = ["excite", "--robot", ROBOT, "--out", out, "-q", "--format", "json"];
    json(&[&args[..], more].concat())
}

/// The modules parse without errors and without tolerances.
fn assert_valid_rapid(folder: &tempfile::TempDir) {
    for name in ["JoulepathExcitation.mod", "JoulepathLogger.mod"] {
        let bytes = fs::read(folder.path().join(name)).unwrap();
        let parse = syntax::parse(&bytes);
        assert!(parse.errors.is_empty(), "{name}: {:?}", parse.errors);
        assert!(parse.tolerances.is_empty(), "{name}: {:?}", parse.tolerances);
    }
}

/// A search for any worth finds motions that are worth more, within the limits.
#[test]
fn motions_are_found_for_any_worth() {
    let model = find(ROBOT).unwrap();
    let design = Design {
        focus: Focus::All,
        base_frequency: 0.1,
        harmonics: vec![1, 3, 7],
        speed_share: 0.8,
        obstacles: vec![Obstacle::Plane(Plane { normal: Vector3::z(), distance: 0.0 })],
        tool: Vector3::zeros(),
        load: Load::none(),
        seed: 1,
    };
    // Mean square of the rate of joint 5.
    let worth = |states: &[State]| {
        states.iter().map(|of| of[1][4].powi(2)).sum::<f64>() / states.len() as f64
    };
    let wanted = design_for(&model, &design, &worth, &|_, _| {}).unwrap();
    let plain = design_for(&model, &design, &|_| 0.0, &|_, _| {}).unwrap();
    // That of one harmonic at the limit of the rate.
    let limit = 0.8 * model.limits.velocity.as_ref().unwrap()[4];
    let share = |found: &Designed| {
        let count = (found.series.period() / STEP).round() as usize;
        worth(&found.series.sampled(count)) / (0.5 * limit * limit)
    };
    assert!(share(&wanted) > REACHED, "{}", share(&wanted));
    // A search without a worth does not get there.
    assert!(share(&plain) < REACHED, "{}", share(&plain));
    for found in [wanted, plain] {
        let ratios = found.checked.ratios;
        let largest = [ratios.position, ratios.velocity / 0.8, ratios.acceleration, ratios.torque];
        assert!(largest.iter().all(|ratio| *ratio <= 1.0), "{ratios:?}");
        assert!(found.checked.to_obstacles >= 0.0 && found.checked.to_itself >= 0.0);
    }
}

/// Share of the largest mean square of a rate that a search for it has to reach.
const REACHED: f64 = 0.8;

#[test]
fn the_motion_determines_all_parameters_within_all_limits() {
    let folder = tempfile::tempdir().unwrap();
    let found = excite(&folder, &["--plane", "1,0,0,-0.8"]);
    assert_eq!(found["rank"], 58);
    assert!(found["condition"]["scaled"].as_f64().unwrap() <= CONDITION, "{found}");
    assert_valid_rapid(&folder);

    let model = find(ROBOT).unwrap();
    let csv = fs::read_to_string(folder.path().join("excitation.csv")).unwrap();
    let limits = &model.limits;
    let (velocity, acceleration) =
        (limits.velocity.as_ref().unwrap(), limits.acceleration.as_ref().unwrap());
    let torque = limits.torque.as_ref().unwrap();
    let motion = rows(&csv);
    for (row, x) in motion.iter().enumerate() {
        assert!((x[0] - 0.001 * row as f64).abs() < 1e-9);
        for j in 0..6 {
            let [low, high] = limits.position_at(&x[1..7], j);
            assert!((low..=high).contains(&x[1 + j]));
            assert!(x[7 + j].abs() <= 0.8 * velocity[j]);
            assert!(x[13 + j].abs() <= acceleration[j]);
            assert!(x[19 + j].abs() <= torque[j]);
        }
        assert!(fk(&model, &x[1..7]).translation.x >= -0.8);
    }
    assert_eq!(motion.len(), 10_000);

    let design = Design {
        focus: Focus::All,
        base_frequency: 0.1,
        harmonics: vec![1, 4, 7],
        speed_share: 0.8,
        obstacles: vec![
            Obstacle::Plane(Plane { normal: Vector3::x(), distance: -0.8 }),
            Obstacle::Plane(Plane { normal: Vector3::z(), distance: 0.0 }),
        ],
        tool: Vector3::zeros(),
        load: Load::none(),
        seed: 5,
    };
    let random = random_feasible(&model, &design, RANDOM).unwrap();
    assert!(found["log_det"].as_f64().unwrap() >= random, "{random} {found}");
}

/// Points on the axis of every capsule, compared with the box by clamping.
#[test]
fn arm_and_tool_stay_out_of_a_box() {
    let folder = tempfile::tempdir().unwrap();
    let tool = ["--tool", "0,0,250"];
    let found = excite(&folder, &[&["--box", "0.7,-1.5,0,1.2,1.5,0.7"], &tool[..]].concat());
    assert!(found["condition"]["scaled"].as_f64().unwrap() <= CONDITION, "{found}");
    assert!(found["workspace_margin_m"].as_f64().unwrap() >= 0.0);
    let model = find(ROBOT).unwrap();
    let keep_out = KeepOut::between(Point3::new(0.7, -1.5, 0.0), Point3::new(1.2, 1.5, 0.7));
    let body = Body::new(&model, Vector3::new(0.0, 0.0, 0.25), &[]);
    let csv = fs::read_to_string(folder.path().join("excitation.csv")).unwrap();
    for row in rows(&csv) {
        let q = &row[1..7];
        for capsule in body.capsules(q).iter().skip(1) {
            for share in 0..=10 {
                let p = keep_out.pose.inverse_transform_point(&capsule.at(f64::from(share) / 10.0));
                let outside = p.coords.abs() - keep_out.half;
                assert!(outside.map(|x| x.max(0.0)).norm() >= capsule.radius, "{q:?}");
            }
        }
    }
}

#[test]
fn small_experiments_are_valid_rapid() {
    for (variant, more) in
        [("friction", &[][..]), ("wrist", &["--torque", "motor-torque", "--spacing", "adaptive"])]
    {
        let folder = tempfile::tempdir().unwrap();
        let found = excite(&folder, &[&["--variant", variant], more].concat());
        for (what, ratio) in found["max_ratio"].as_object().unwrap() {
            assert!(ratio.as_f64().unwrap() <= 1.0, "{variant}: {what} {ratio}");
        }
        assert!(found["self_margin_m"].as_f64().unwrap() >= 0.0);
        assert_valid_rapid(&folder);
        let logger = fs::read_to_string(folder.path().join("JoulepathLogger.mod")).unwrap();
        assert_eq!(logger.contains("TestSignDefine"), more.is_empty());
        let ratio = find(ROBOT).unwrap().motors.unwrap().ratio[3];
        let line = format!("tau.rax_4:={ratio}*GetMotorTorque(\\MecUnit:=ROB_1,4);");
        assert_eq!(logger.contains(&line), !more.is_empty(), "{logger}");
    }
}

#[test]
fn wrong_options_are_refused_with_the_way_out() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    for (more, message) in [
        (&["--plane", "1,0,0"][..], "a normal and a distance"),
        (&["--plane", "0,0,0,1"], "the normal is 0"),
        (&["--plane", "1,0,0,5"], "move these"),
        (&["--box", "0,0,0,1"], "two corners"),
        (&["--box", "0,0,0,1,1,0"], "no volume"),
        (&["--harmonics", "0,1"], "whole multiples"),
        (&["--speed-share", "1.5"], "from 0.001 to 1"),
        (&["--spacing", "nan"], "above 0"),
        (&["--cycles", "0"], "give 1 to 10000"),
    ] {
        let args = ["excite", "--robot", ROBOT, "--out", out, "-q", "--variant", "friction"];
        refused(&[&args[..], more].concat(), message);
    }
}

/// Impossible values, and similar possible ones.
#[test]
fn impossible_numbers_are_refused_at_once() {
    let folder = tempfile::tempdir().unwrap();
    for (option, value) in [
        ("--spacing", "5"),
        ("--spacing", "1e-9"),
        ("--spacing", "-1"),
        ("--base-frequency", "0.0001"),
        ("--base-frequency", "-1"),
        ("--base-frequency", "1e300"),
        ("--speed-share", "1e-300"),
        ("--speed-share", "-1"),
        ("--cycles", "0"),
        ("--cycles", "18446744073709551615"),
        ("--cycles", "-1"),
        ("--harmonics", "-1"),
        ("--seed", "-1"),
        ("--tool", "0,0,1e300"),
        ("--plane", "1,0,0,3"),
    ] {
        let out = folder.path().to_str().unwrap();
        let message =
            refused(&["excite", "--robot", ROBOT, "--out", out, option, value], "error: ");
        assert!(!message.contains("unexpected argument"), "{option} {value}: {message}");
        assert!(!folder.path().join("excitation.csv").exists());
    }
}

/// Repetitions of points with rounded intervals would exceed the period.
#[test]
fn adaptive_intervals_add_up_to_the_period() {
    let folder = tempfile::tempdir().unwrap();
    let found = excite(&folder, &["--spacing", "adaptive", "--plane", "1,0,0,-0.8"]);
    let text = fs::read_to_string(folder.path().join("JoulepathExcitation.mod")).unwrap();
    let stated = text.split("interval:=").nth(1).unwrap();
    let stated: f64 = stated.split('*').next().unwrap().parse().unwrap();
    let points = found["points"].as_f64().unwrap();
    assert!(
        (stated * points - found["period_s"].as_f64().unwrap()).abs() < 1e-9,
        "{stated} {points}"
    );
}
