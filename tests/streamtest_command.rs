//! `streamtest` through the binary: its program runs as predicted, and it detects logs of
//! controllers with another behaviour. These motions are computed independently from the text.
#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

mod command;

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;

use command::{IRB1600 as ROBOT, joulepath, json, parsed, refused, run, written};
use joulepath::rapid::syntax;
use serde_json::Value;
use tempfile::TempDir;

const TESTS: usize = 4;
/// Interval of the logs [s], and the pause around each test.
const STEP: f64 = 0.004;
const REST: f64 = 0.2;
/// Servo lag of an accurate robot [s], and the noise of its positions [deg].
const LAG: f64 = 0.01;
const NOISE: f64 = 0.02;

fn test_program() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    run(&["streamtest", "--robot", ROBOT, "--out", folder.path().to_str().unwrap()]);
    folder
}

/// A point with its `\T`: [q1…q6 in degrees, s].
type Timed = ([f64; 6], f64);

/// The points of each test, read from the text of the module.
fn points(folder: &TempDir) -> Vec<Vec<Timed>> {
    let text = fs::read_to_string(folder.path().join("JoulepathTest.mod")).unwrap();
    let body = |name: String| {
        let from = text.find(&name).unwrap();
        let rest = &text[from..];
        rest[rest.find(":=[").unwrap() + 3..rest.find(';').unwrap()].to_owned()
    };
    let numbers = |text: &str| -> Vec<f64> {
        let parts = text.split(|c: char| !(c.is_ascii_digit() || "+-.E".contains(c)));
        parts.filter_map(|part| part.parse().ok()).collect()
    };
    (1..=TESTS)
        .map(|test| {
            let times = numbers(&body(format!("jpTestTime{test}{{")));
            let points = numbers(&body(format!("jpTestPoint{test}{{")));
            assert_eq!(points.len(), 12 * times.len());
            let point = |of: &[f64]| -> [f64; 6] { of[..6].try_into().unwrap() };
            points.chunks(12).map(point).zip(times).collect()
        })
        .collect()
}

/// Positions as a function of time [deg].
type Motion = Box<dyn Fn(f64) -> [f64; 6]>;

/// A log of motions, one for each test: positions as a function of time, and duration.
fn log(motions: &[(Motion, f64)]) -> String {
    let mut csv = String::from("t,cmd,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg\n");
    let mut t = 0.0;
    for (test, (motion, duration)) in motions.iter().enumerate() {
        let begin = t + REST;
        while t < begin + duration + REST {
            write!(csv, "{t:.4},{}", test + 1).unwrap();
            for (joint, x) in motion(t - begin).iter().enumerate() {
                let noise = NOISE * (TAU * (13.7 + joint as f64) * t * 17.0).sin();
                write!(csv, ",{:.5}", x + noise).unwrap();
            }
            csv.push('\n');
            t += STEP;
        }
        for _ in 0..20 {
            writeln!(csv, "{t:.4},0,0,0,0,0,30,0").unwrap();
            t += STEP;
        }
    }
    csv
}

/// The emitted points as control points of a quadratic B-spline, by the de Boor recursion on
/// clamped knots, independent of the closed form of the program.
fn b_spline(start: [f64; 6], points: &[Timed]) -> impl Fn(f64) -> [f64; 6] + use<> {
    let total: f64 = points.iter().map(|(_, d)| d).sum();
    let n = points.len();
    let mut knots = vec![0.0; 3];
    let mut begin = 0.0;
    for (i, (_, d)) in points.iter().enumerate() {
        let middle = if i == 0 {
            2.0 / 3.0 * d
        } else if i == n - 1 {
            total - 2.0 / 3.0 * d
        } else {
            begin + 0.5 * d
        };
        knots.push(middle);
        begin += d;
    }
    knots.extend([total; 3]);
    // At rest at both ends: the end points are repeated.
    let mut control = vec![start; 2];
    control.extend(points.iter().map(|(q, _)| *q));
    control.push(points[n - 1].0);
    move |t: f64| {
        let t = t.clamp(0.0, total - 1e-9);
        let k = (2..knots.len() - 3).rev().find(|k| knots[*k] <= t).unwrap();
        let mut d: Vec<[f64; 6]> = (0..3).map(|j| control[j + k - 2]).collect();
        for r in 1..3 {
            for j in (r..3).rev() {
                let i = j + k - 2;
                let a = (t - knots[i]) / (knots[i + 3 - r] - knots[i]);
                d[j] = std::array::from_fn(|x| (1.0 - a) * d[j - 1][x] + a * d[j][x]);
            }
        }
        d[2]
    }
}

/// The robot stops at each point: corner zones have no effect.
fn with_stops(start: [f64; 6], points: &[Timed]) -> impl Fn(f64) -> [f64; 6] + use<> {
    let points = points.to_vec();
    move |t: f64| {
        let (mut from, mut t) = (start, t.max(0.0));
        for (to, d) in &points {
            if t < *d {
                let x = t / d;
                let share = x * x * (3.0 - 2.0 * x);
                return std::array::from_fn(|j| from[j] + share * (to[j] - from[j]));
            }
            t -= d;
            from = *to;
        }
        from
    }
}

const START: [f64; 6] = [0.0, 0.0, 0.0, 0.0, 30.0, 0.0];

fn duration(points: &[Timed]) -> f64 {
    points.iter().map(|(_, d)| d).sum()
}

/// The judgement of a log, with the exit code.
fn judged(folder: &TempDir, log: &str) -> (Value, Option<i32>) {
    let path = written(folder, "log.csv", log);
    let output =
        joulepath(&["streamtest", "--robot", ROBOT, "--log", &path, "--format", "json", "-q"]);
    (parsed(&output), output.status.code())
}

fn findings(found: &Value) -> Vec<&str> {
    let tests = found["tests"].as_array().unwrap();
    tests.iter().map(|test| test["finding"].as_str().unwrap()).collect()
}

#[test]
fn the_modules_are_valid_rapid_and_run() {
    let folder = test_program();
    for name in ["JoulepathTest.mod", "JoulepathTestLogger.mod"] {
        let parse = syntax::parse(&fs::read(folder.path().join(name)).unwrap());
        assert!(parse.errors.is_empty(), "{name}: {:?}", parse.errors);
        assert!(parse.tolerances.is_empty(), "{name}: {:?}", parse.tolerances);
    }
    let module = folder.path().join("JoulepathTest.mod");
    let module = module.to_str().unwrap();
    let args = ["simulate", module, "--entry", "jpTestRun", "--robot", ROBOT, "--format", "json"];
    let found = json(&args);
    assert_eq!(found["unresolved"].as_array().map(Vec::len), Some(0), "{found}");
    let tests: f64 = points(&folder).iter().map(|points| duration(points)).sum();
    let waits = 0.9 * TESTS as f64;
    let cycle = found["cycle_s"].as_f64().unwrap();
    assert!((cycle - tests - waits).abs() < 0.1, "{cycle} s for {tests} s");
}

#[test]
fn the_predicted_log_and_one_with_lag_and_noise_pass() {
    let folder = test_program();
    let own = fs::read_to_string(folder.path().join("streamtest.csv")).unwrap();
    assert_eq!(judged(&folder, &own).1, Some(0));
    let motions: Vec<_> = points(&folder)
        .iter()
        .map(|points| {
            let law = b_spline(START, points);
            let motion: Motion = Box::new(move |t| law(t - LAG));
            (motion, duration(points) + LAG)
        })
        .collect();
    let (found, code) = judged(&folder, &log(&motions));
    assert_eq!(code, Some(0), "{found}");
    assert_eq!(found["law_holds"], true);
}

#[test]
fn a_controller_that_visits_the_points_is_recognised() {
    let folder = test_program();
    let motions: Vec<_> = points(&folder)
        .iter()
        .map(|points| {
            let motion: Motion = Box::new(with_stops(START, points));
            (motion, duration(points))
        })
        .collect();
    let (found, code) = judged(&folder, &log(&motions));
    assert_eq!(code, Some(1));
    for test in [0, 1, 3] {
        assert_eq!(findings(&found)[test], "the points are visited", "{found}");
    }
}

#[test]
fn a_slower_or_wider_motion_is_not_as_expected() {
    let folder = test_program();
    for (slower, wider) in [(1.05, 1.0), (1.0, 1.4)] {
        let motions: Vec<_> = points(&folder)
            .iter()
            .map(|points| {
                let (law, visits) = (b_spline(START, points), with_stops(START, points));
                let motion: Motion = Box::new(move |t| {
                    let (a, b) = (law(t / slower), visits(t / slower));
                    std::array::from_fn(|j| b[j] + wider * (a[j] - b[j]))
                });
                (motion, slower * duration(points))
            })
            .collect();
        let (found, code) = judged(&folder, &log(&motions));
        assert_eq!(code, Some(1), "{found}");
        for test in [0, 1] {
            assert_eq!(findings(&found)[test], "not as expected", "{found}");
        }
    }
}

#[test]
fn unusable_input_is_refused_with_the_way_out() {
    let folder = test_program();
    let log = folder.path().join("streamtest.csv");
    let log = log.to_str().unwrap();
    let is_refused = |args: &[&str], words: &str| {
        refused(&[&["streamtest"], args].concat(), words);
    };
    is_refused(&["--robot", ROBOT], "--out");
    is_refused(&["--robot", ROBOT, "--log", log, "--start", "20,0,0,0,30,0"], "--start");
    is_refused(&["--robot", ROBOT, "--out", "x", "--start", "0,0,0,0,300,0"], "--start");
    is_refused(&["--robot", ROBOT, "--log", "nowhere.csv"], "nowhere.csv");
    // A test below the resolution of a log would pass with any controller.
    is_refused(&["--robot", ROBOT, "--out", "x", "--start", "179.5,0,0,0,30,0"], "another --start");
    let text = fs::read_to_string(log).unwrap();
    let sparse: Vec<&str> = text.lines().step_by(10).collect();
    fs::write(log, sparse.join("\n")).unwrap();
    is_refused(&["--robot", ROBOT, "--log", log], "0.02 s apart");
    let text = text.replace("cmd", "remark");
    fs::write(log, text).unwrap();
    is_refused(&["--robot", ROBOT, "--log", log], "cmd");
}
