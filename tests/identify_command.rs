//! `identify` through the binary: contract, and unusable logs.
#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

mod command;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use command::{IRB1600 as ROBOT, joulepath, parsed, refused, run, stderr, stdout};
use joulepath::arm::dynamics::{Data, Load, torque};
use joulepath::arm::robot::{Provenance, find, load, to_toml};
use serde_json::Value;

const ROWS: usize = 400;

/// Rows of `t`, positions, rates, accelerations and torques.
fn rows() -> Vec<Vec<f64>> {
    let model = find(ROBOT).unwrap();
    let mut data = Data::new();
    let mut random = fastrand::Rng::with_seed(5);
    let middle = [0.0, 0.3, -1.2, 0.0, 0.1, 0.0];
    let size = [1.0, 0.5, 0.6, 1.2, 0.9, 1.5];
    (0..ROWS)
        .map(|row| {
            let t = 0.025 * row as f64;
            let mut state = [[0.0; 6]; 3];
            for joint in 0..6 {
                for (k, w) in [0.7, 1.9, 3.3].into_iter().enumerate() {
                    let w = w + 0.13 * joint as f64;
                    let (sin, cos) = (w * t + (joint * 3 + k) as f64).sin_cos();
                    let a = size[joint] / (1.0 + k as f64);
                    state[0][joint] += a * sin;
                    state[1][joint] += a * w * cos;
                    state[2][joint] -= a * w * w * sin;
                }
                state[0][joint] += middle[joint];
            }
            let [q, qd, qdd] = &state;
            let parts = torque(&model, &mut data, &Load::none(), q, qd, qdd);
            let tau = (0..6).map(|j| parts.rigid[j] + parts.friction[j] + random.f64() - 0.5);
            let mut values = vec![t];
            values.extend(state.iter().flatten());
            values.extend(tau);
            values
        })
        .collect()
}

fn header() -> Vec<String> {
    let columns = |name: &str| (1..=6).map(|joint| format!("{name}{joint}")).collect::<Vec<_>>();
    [vec!["t".into()], columns("q"), columns("qd"), columns("qdd"), columns("tau")].concat()
}

struct LogFolder {
    folder: tempfile::TempDir,
}

impl LogFolder {
    fn new() -> LogFolder {
        LogFolder { folder: tempfile::tempdir().unwrap() }
    }

    /// A log with the rows of [`rows`], or similar ones.
    fn log(&self, rows: &[Vec<f64>]) -> PathBuf {
        self.write(&header(), &cells(rows), ",")
    }

    fn write(&self, header: &[String], rows: &[Vec<String>], separator: &str) -> PathBuf {
        let mut text = header.join(separator) + "\n";
        for row in rows {
            let _ = writeln!(text, "{}", row.join(separator));
        }
        let path = self.folder.path().join("log.csv");
        fs::write(&path, text).unwrap();
        path
    }
}

fn arguments<'a>(log: &'a Path, more: &[&'a str]) -> Vec<&'a str> {
    [&["identify", "--robot", ROBOT, "--log", log.to_str().unwrap()], more].concat()
}

fn identify(log: &Path, more: &[&str]) -> Output {
    run(&arguments(log, more))
}

/// The JSON of an identification.
fn identified(log: &Path, more: &[&str]) -> Value {
    parsed(&identify(log, &[more, &["--format", "json"]].concat()))
}

fn cells(rows: &[Vec<f64>]) -> Vec<Vec<String>> {
    rows.iter().map(|row| row.iter().map(f64::to_string).collect()).collect()
}

#[test]
fn the_result_has_the_fields_of_the_contract_and_the_model_predicts() {
    let logs = LogFolder::new();
    let log = logs.log(&rows());
    let model = logs.folder.path().join("model.toml");
    let page = logs.folder.path().join("page.html");
    let out = ["--out", model.to_str().unwrap(), "--report", page.to_str().unwrap()];
    let found = identified(&log, &out);
    assert_eq!(found["rank"], 58);
    assert_eq!(found["base_parameters"].as_array().unwrap().len(), 58);
    assert_eq!(found["physically_consistent"], true);
    assert_eq!(found["quality"]["grade"], "good");
    // The simulated noise is white.
    for of in found["whiteness"].as_array().unwrap() {
        assert!(of["p_value"].as_f64().unwrap() > 1e-4, "{of}");
    }
    assert!(fs::read_to_string(&model).unwrap().contains("quality = \"good: explains"));
    for part in ["train", "validation"] {
        assert_eq!(found["rms"][part].as_array().unwrap().len(), 6);
    }
    assert!(found["condition"]["scaled"].as_f64().unwrap() > 1.0);
    assert!(fs::read_to_string(&page).unwrap().contains("not determined") || page.exists());

    // `predict` and the JSON report the same error.
    let args = ["predict", "--robot", model.to_str().unwrap(), "--log", log.to_str().unwrap()];
    let text = stdout(&run(&[&args[..], &["-q"]].concat()));
    let all = rows();
    for joint in 0..6 {
        let mut sum = 0.0;
        for (line, row) in text.lines().skip(1).zip(&all) {
            let predicted: f64 = line.split(',').nth(1 + joint).unwrap().parse().unwrap();
            sum += (predicted - row[19 + joint]).powi(2);
        }
        let rms = (sum / all.len() as f64).sqrt();
        let reported = found["rms"]["train"][joint].as_f64().unwrap();
        assert!((rms / reported - 1.0).abs() < 1e-6, "{rms} {reported}");
    }
    assert_eq!(identified(&log, &[])["base_parameters"], found["base_parameters"]);
}

#[test]
fn repairs_of_a_log_are_reported() {
    let logs = LogFolder::new();
    let mut broken = cells(&rows());
    broken[10][3] = "NaN".into();
    broken[20][5] = "abc".into();
    broken[30][20] = String::new();
    broken.swap(40, 41);
    for cell in &mut broken[50][1..] {
        *cell = "1e200".into();
    }
    broken[60][0] = "-1e200".into();
    broken[70][0] = "5000".into();
    let log = logs.write(&header(), &broken, ",");
    let message = stderr(&identify(&log, &[]));
    for text in [
        "row 12 left out: q3 is 'NaN'",
        "row 22",
        "row 32",
        "row 43",
        "row 52 left out: q1 is 1e200",
        "row 62 left out: t is -1e200 s",
        "row 72 left out: the time leaps",
    ] {
        assert!(message.contains(text), "{text}: {message}");
    }
    // A note reports rates of only some joints as unusable.
    let mut few = header();
    few[12] = "other".into();
    let message = stderr(&identify(&logs.write(&few, &cells(&rows()), ","), &[]));
    assert!(message.contains("no column qd6: qd1, qd2, qd3, qd4, qd5 not used"), "{message}");
    // Semicolons and decimal commas give the same result.
    let plain = logs.log(&rows());
    let expected = identify(&plain, &["-q"]).stdout;
    let commas: Vec<Vec<String>> = cells(&rows())
        .iter()
        .map(|row| row.iter().map(|cell| cell.replace('.', ",")).collect())
        .collect();
    let log = logs.write(&header(), &commas, ";");
    assert_eq!(identify(&log, &["-q"]).stdout, expected);
    let log = logs.write(&header(), &cells(&rows()), "|");
    assert_eq!(identify(&log, &["-q"]).stdout, expected);
}

#[test]
fn unusable_logs_are_refused_with_the_way_out() {
    let logs = LogFolder::new();
    let scaled = |columns: std::ops::Range<usize>, by: &dyn Fn(usize) -> f64| {
        let mut all = rows();
        for row in &mut all {
            for column in columns.clone() {
                row[column] *= by(column - columns.start);
            }
        }
        (header(), cells(&all))
    };
    let without = |names: &[&str]| {
        let kept: Vec<usize> =
            (0..header().len()).filter(|i| !names.contains(&header()[*i].as_str())).collect();
        let pick = |of: &[String]| kept.iter().map(|i| of[*i].clone()).collect::<Vec<_>>();
        let all = cells(&rows());
        (pick(&header()), all.iter().map(|row| pick(row)).collect::<Vec<_>>())
    };
    let model = find(ROBOT).unwrap();
    let ratio = model.motors.as_ref().unwrap().ratio.clone();
    let degrees = |_: usize| 180.0 / std::f64::consts::PI;
    let sixth = ["q6", "qd6", "qdd6", "tau6"];
    let mut more = header();
    more.push("tau7".into());
    let mut longer = cells(&rows());
    for row in &mut longer {
        row.push("1".into());
    }
    let torques = ["tau1", "tau2", "tau3", "tau4", "tau5", "tau6"];
    let (mut in_degrees, radians) = without(&[
        "qd1", "qd2", "qd3", "qd4", "qd5", "qd6", "qdd1", "qdd2", "qdd3", "qdd4", "qdd5", "qdd6",
    ]);
    for name in &mut in_degrees[1..7] {
        name.push_str("_deg");
    }
    let mut swapped = header();
    swapped.swap(8, 11);
    for ((header, rows), message) in [
        (scaled(1..7, &degrees), "name the column q1_deg"),
        (scaled(7..13, &degrees), "name the column qd1_deg"),
        (scaled(19..25, &|joint| 1.0 / ratio[joint]), "those of the motors"),
        (scaled(22..23, &|_| 1.0 / ratio[3]), "tau4 seems to be that of the motor"),
        ((in_degrees, radians), "they seem to be in radians"),
        ((swapped, cells(&rows())), "qd2 has little to do with"),
        (scaled(16..17, &|_| 0.0), "qdd4 is 0.000 times"),
        (scaled(7..13, &|_| -1.0), "opposite sign"),
        (scaled(17..18, &degrees), "name the column qdd5_deg"),
        (scaled(0..1, &|_| 1000.0), "in ms"),
        (scaled(21..22, &|_| 0.0), "tau3 never changes"),
        (scaled(19..25, &|_| 1000.0), "mNm"),
        (without(&["tau4"]), "joint 4"),
        (without(&sixth), "positions of 5 joints"),
        (without(&torques), "no torques"),
        (without(&["t"]), "no column t"),
        ((more, longer), "tau7"),
        ((header(), cells(&rows()[..3])), "3 usable rows"),
        ((header(), cells(&rows()[..15])), "usable equations"),
    ] {
        let log = logs.write(&header, &rows, ",");
        refused(&arguments(&log, &[]), message);
    }
}

/// Torques unrelated to the motion: reversed, delayed, or noise.
#[test]
fn torques_unrelated_to_the_motion_are_refused() {
    let logs = LogFolder::new();
    let tau = 19..25;
    let all = rows();
    let reversed: Vec<Vec<f64>> = all
        .iter()
        .map(|row| row.iter().enumerate().map(|(k, x)| if k < 19 { *x } else { -x }).collect())
        .collect();
    let mut random = fastrand::Rng::with_seed(9);
    let mixed: Vec<Vec<f64>> = all
        .iter()
        .map(|row| [&row[..19], &all[random.usize(..all.len())][19..25]].concat())
        .collect();
    for (rows, message) in [(reversed, "would give power"), (mixed, "explains")] {
        let log = logs.log(&rows);
        let text = refused(&arguments(&log, &[]), message);
        assert!(text.contains("no physically possible robot"), "{text}");
    }
    // Half a second has 20 rows.
    let late: Vec<Vec<f64>> = all
        .iter()
        .zip(&all[20..])
        .map(|(old, new)| [&new[..19], &old[tau.clone()]].concat())
        .collect();
    let log = logs.log(&late);
    let text = stderr(&joulepath(&arguments(&log, &[])));
    assert!(text.contains("0.50 s later than the positions"), "{text}");
}

/// The many parameters explain a disturbance of three seconds, but do not predict it.
#[test]
fn an_overfitted_model_is_not_graded_good() {
    let logs = LogFolder::new();
    let mut all = rows();
    all.truncate(120);
    for row in &mut all {
        let astray = 6.0 * (2.0 * row[0]).sin();
        row[22] += astray;
    }
    let log = logs.log(&all);
    let found = identified(&log, &[]);
    let quality = &found["quality"];
    let share = |key: &str| quality[key][3].as_f64().unwrap();
    assert!(share("explained") > 0.7 && share("predicted") < 0.7, "{quality}");
    assert_ne!(quality["grade"], "good", "{quality}");
}

#[test]
fn a_joint_that_does_not_move_is_reported() {
    let logs = LogFolder::new();
    let mut all = rows();
    for row in &mut all {
        row[4] = 0.3;
        row[10] = 0.0;
        row[16] = 0.0;
    }
    let log = logs.log(&all);
    let output = identify(&log, &["--format", "json"]);
    assert!(stderr(&output).contains("joint 4 does not move"));
    let found = parsed(&output);
    let missing = found["not_determined"].as_array().unwrap();
    assert!(missing.iter().any(|entry| entry["name"] == "fc4"), "{missing:?}");
    assert_eq!(found["joints"][3]["coulomb"], Value::Null);
    assert_eq!(found["joints"][3]["excited"], false);
}

/// The fit of the paper cannot be better than the unconstrained one; it starts with the true
/// parameters of the robot file.
#[test]
fn the_descent_of_the_paper_is_close_to_the_unconstrained_fit() {
    let logs = LogFolder::new();
    let log = logs.log(&rows());
    let found = identified(&log, &["--method", "ordinary", "--descent"]);
    let numbers = |list: &Value| -> Vec<f64> {
        list.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
    };
    let total = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let free = total(&numbers(&found["unconstrained_rms"]["train"]));
    let descent = total(&numbers(&found["descent"]["rms_by_joint"]));
    assert!((1.0..1.1).contains(&(descent / free)), "{descent} {free}");
    let [first, last] = ["first_rms", "rms"].map(|key| found["descent"][key].as_f64().unwrap());
    assert!(last <= first, "{first} {last}");
}

/// A robot file with masses and without gear ratios.
fn without_motors(logs: &LogFolder) -> PathBuf {
    let robot = logs.folder.path().join("direct.toml");
    let text = to_toml(&find(ROBOT).unwrap());
    let mut lines: Vec<&str> = Vec::new();
    let mut of_motors = false;
    for line in text.lines() {
        if line.starts_with('[') {
            of_motors = line == "[motors]";
        }
        if !of_motors {
            lines.push(line);
        }
    }
    fs::write(&robot, lines.join("\n")).unwrap();
    robot
}

/// Without gear ratios, motor torques are recognised only by the carried weight.
#[test]
fn torques_too_small_for_the_weight_are_graded_poor() {
    let logs = LogFolder::new();
    let robot = without_motors(&logs);
    let ratio = find(ROBOT).unwrap().motors.unwrap().ratio;
    let mut all = rows();
    for row in &mut all {
        row[19..25].iter_mut().zip(&ratio).for_each(|(tau, ratio)| *tau /= ratio);
    }
    let log = logs.log(&all);
    let [robot, log] = [&robot, &log].map(|path| path.to_str().unwrap());
    let output = joulepath(&["identify", "--robot", robot, "--log", log, "--format", "json"]);
    let message = stderr(&output);
    assert!(message.contains("multiply each tau by its ratio"), "{message}");
    let found = parsed(&output);
    assert_eq!(found["quality"]["grade"], "poor", "{}", found["quality"]);
    assert!(found["quality"]["statement"].as_str().unwrap().contains("weight"));
}

/// With a URDF without gear ratios the rotors are at the joints; the written model can be read.
#[test]
fn a_model_without_gear_ratios_can_be_read_back() {
    let logs = LogFolder::new();
    let robot = without_motors(&logs);
    // Heavy rotors on all joints.
    let mut all = rows();
    for row in &mut all {
        for joint in 0..6 {
            row[19 + joint] += 3.0 * row[13 + joint];
        }
    }
    let log = logs.log(&all);
    let model = logs.folder.path().join("model.toml");
    let [robot, log, model] = [&robot, &log, &model].map(|path| path.to_str().unwrap());
    run(&["identify", "--robot", robot, "--log", log, "--out", model]);
    run(&["predict", "--robot", model, "--log", log]);
    let rotors = load(model).unwrap().motors.unwrap().rotor_inertia;
    assert!(rotors.iter().any(|inertia| *inertia > 1.0), "{rotors:?}");
}

#[test]
fn a_log_without_motion_is_refused() {
    let logs = LogFolder::new();
    let first = rows().remove(0);
    let still: Vec<Vec<f64>> = (0..ROWS)
        .map(|k| {
            let noise = (k as f64).sin();
            let mut row = [&[0.025 * k as f64], &first[1..7], &first[19..25]].concat();
            row[7..].iter_mut().for_each(|tau| *tau += noise);
            row
        })
        .collect();
    let names = header();
    let names = [&names[..7], &names[19..25]].concat();
    let log = logs.write(&names, &cells(&still), ",");
    refused(&arguments(&log, &[]), "no joint moves");
}

#[test]
fn options_that_do_not_fit_the_logs_are_reported() {
    let logs = LogFolder::new();
    let log = logs.log(&rows());
    let log = log.to_str().unwrap();
    let args = ["identify", "--robot", ROBOT, "--log", log, log];
    let message = stderr(&run(&[&args[..], &["--validate", log, "--period", "3"]].concat()));
    for text in ["it counts twice", "that the model was fitted to", "--period 3 is not used"] {
        assert_eq!(message.matches(text).count(), 1, "{text}: {message}");
    }
    for (option, value, text) in [
        ("--date", "2026-02-29", "2026-11-30"),
        ("--date", "1.2.2026", "2026-11-30"),
        ("--map", "tau1=x,tau2=x", "column x is given for tau1 and for tau2"),
        ("--period", "-1", "more than 0"),
        ("--period", "1e300", "at most 100000"),
    ] {
        refused(&[&args[..], &[option, value]].concat(), text);
    }
}

/// With a delay of 10 to 100 ms torques are still explained well; the delay is reported.
#[test]
fn a_short_delay_is_reported() {
    let logs = LogFolder::new();
    for (delay, least, most) in [(0, f64::NAN, f64::NAN), (1, 0.015, 0.035), (3, 0.06, 0.09)] {
        let all = rows();
        let late: Vec<Vec<f64>> = all
            .iter()
            .zip(&all[delay..])
            .map(|(old, new)| [&new[..19], &old[19..25]].concat())
            .collect();
        let found = identified(&logs.log(&late), &[]);
        let reported = found["quality"]["torques_late_s"].as_f64();
        if delay == 0 {
            assert_eq!(reported, None);
            assert_eq!(found["quality"]["grade"], "good");
        } else {
            assert!((least..most).contains(&reported.unwrap()), "{reported:?}");
            assert_eq!(found["quality"]["grade"], "fair");
        }
    }
}

/// One motor-side joint makes a model bad, independent of the other joints.
#[test]
fn the_worst_joint_determines_the_grade() {
    let logs = LogFolder::new();
    let mut all = rows();
    let mut random = fastrand::Rng::with_seed(3);
    for row in &mut all {
        row[21] = 200.0 * (random.f64() - 0.5);
    }
    let log = logs.log(&all);
    let found = identified(&log, &[]);
    assert_eq!(found["quality"]["grade"], "poor", "{}", found["quality"]);
}

/// The held-out error is that of the written model, not of the unconstrained fit.
#[test]
fn the_validation_error_is_that_of_the_written_model() {
    let logs = LogFolder::new();
    let mut all = rows();
    // Negative friction, which no physical model has.
    for row in &mut all {
        row[20] -= 200.0 * row[8].signum();
    }
    let log = logs.log(&all);
    let found = identified(&log, &[]);
    let validation = |key: &str| found[key]["validation"][1].as_f64().unwrap();
    assert!(validation("rms") > 2.0 * validation("unconstrained_rms"), "{found}");
}

#[test]
fn many_rejected_rows_are_summarised() {
    let logs = LogFolder::new();
    let mut broken = cells(&rows());
    for row in broken.iter_mut().step_by(20) {
        row[3] = "NaN".into();
    }
    let message = stderr(&identify(&logs.write(&header(), &broken, ","), &[]));
    assert_eq!(message.matches("left out: q3").count(), 3, "{message}");
    assert!(message.contains("17 more rows left out"), "{message}");
}

#[test]
fn values_of_a_resting_joint_are_not_called_identified() {
    let logs = LogFolder::new();
    let mut all = rows();
    for row in &mut all {
        (row[4], row[10], row[16]) = (0.3, 0.0, 0.0);
    }
    let log = logs.log(&all);
    let model = logs.folder.path().join("model.toml");
    identify(&log, &["--out", model.to_str().unwrap(), "-q"]);
    let found = load(model.to_str().unwrap()).unwrap();
    let coulomb = found.origins.iter().find(|o| o.table == "friction" && o.key == "coulomb");
    let coulomb = coulomb.unwrap();
    assert_ne!(coulomb.provenance, Some(Provenance::Identified), "{coulomb:?}");
    assert!(coulomb.source.as_ref().unwrap().contains("of joints 4"), "{coulomb:?}");
}
