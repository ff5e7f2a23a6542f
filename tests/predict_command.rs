//! `predict` through the binary, and its logs.
#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

mod command;

use std::fs;
use std::process::Output;

use command::{refused, run, stderr, stdout, written};
use joulepath::arm::dynamics::{Data, Load, torque};
use joulepath::arm::robot::from_toml;
use joulepath::learn::log::{Channel, ColumnMap, read_csv};
use nalgebra::Vector3;

/// Effect of the mass of tool0, one gram, in the program.
const TOOL0_NM: f64 = 0.02;
const TOOL0_W: f64 = 0.2;
/// Tolerance of torques from differentiated positions.
const DIFFERENTIATED_NM: f64 = 0.05;
const SEVEN: &str = "fixtures/dynamics/seven.toml";

fn predict(robot: &str, log: &str, more: &[&str]) -> Output {
    run(&[&["predict", "--robot", robot, "--log", log], more].concat())
}

/// Header and rows.
fn table(csv: &str) -> (Vec<&str>, Vec<Vec<&str>>) {
    let mut lines = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
    (lines.next().unwrap(), lines.collect())
}

/// A log of seven joints; `number` formats its values.
fn log_of_seven(separator: &str, angle: &str, number: impl Fn(f64) -> String) -> String {
    let names: Vec<String> = ["q", "qd", "qdd"]
        .iter()
        .flat_map(|kind| (1..=7).map(move |joint| format!("{kind}{joint}{angle}")))
        .collect();
    let mut text = format!("t{separator}{}{separator}note\n", names.join(separator));
    for row in 0..12 {
        let t = 0.01 * f64::from(row);
        let values: Vec<String> = state(t).iter().map(|x| number(*x)).collect();
        let row = [number(t), values.join(separator), "x\n".into()];
        text += &row.join(separator);
    }
    text
}

/// Positions, then velocities, then accelerations.
fn state(t: f64) -> Vec<f64> {
    (0..21).map(|k| (0.7 * f64::from(k) + (1.0 + f64::from(k)) * t).sin() * 2.0).collect()
}

#[test]
fn predictions_agree_with_the_simulation() {
    let folder = tempfile::tempdir().unwrap();
    let program = "MODULE M\nPROC main()\n\
        MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tool0;\n\
        MoveAbsJ [[40,30,-20,50,60,70],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tool0;\n\
        WaitTime 0.1;\nENDPROC\nENDMODULE\n";
    let program = written(&folder, "m.mod", program);
    let motion = folder.path().join("motion.csv").display().to_string();
    let robot = "IRB1600-10/1.45";
    run(&["simulate", &program, "--robot", robot, "--trajectory", &motion]);
    let predicted = stdout(&predict(robot, &motion, &["-q"]));
    let simulated = fs::read_to_string(&motion).unwrap();
    let ((names, rows), (all, expected)) = (table(&predicted), table(&simulated));
    assert_eq!(names, ["t", "tau1", "tau2", "tau3", "tau4", "tau5", "tau6", "p_mech", "p_elec"]);
    assert_eq!(rows.len(), expected.len());
    for (row, expected) in rows.iter().zip(&expected) {
        for (name, value) in names.iter().zip(row) {
            let column = all.iter().position(|known| known == name).unwrap();
            let (value, expected) =
                (value.parse::<f64>().unwrap(), expected[column].parse::<f64>().unwrap());
            let close = if name.starts_with("p_") { TOOL0_W } else { TOOL0_NM };
            assert!((value - expected).abs() < close, "{name} at {} s: {value} {expected}", row[0]);
        }
    }
}

#[test]
fn logs_of_seven_joints_may_have_any_form_of_csv() {
    let folder = tempfile::tempdir().unwrap();
    let model = from_toml(SEVEN, &fs::read_to_string(SEVEN).unwrap()).unwrap();
    let degrees = |x: f64| format!("{}", x.to_degrees());
    let comma = |x: f64| format!("{x}").replace('.', ",");
    let plain = written(&folder, "plain.csv", log_of_seven(",", "", |x| x.to_string()));
    let excel = written(&folder, "excel.csv", log_of_seven(";", "", comma));
    let tabs = log_of_seven("\t", "", |x| x.to_string()).replace('\n', "\r\n");
    let tabs = written(&folder, "tabs.txt", format!("\u{feff}{tabs}"));
    // Only angles have degrees; the time is unchanged.
    let turned = log_of_seven(",", "_deg", degrees);
    let turned: Vec<String> = turned
        .lines()
        .enumerate()
        .map(|(row, line)| {
            let (_, rest) = line.split_once(',').unwrap();
            let t = row.checked_sub(1).map_or("t".into(), |i| (0.01 * i as f64).to_string());
            format!("{t},{rest}")
        })
        .collect();
    let turned = written(&folder, "degrees.csv", turned.join("\n"));
    let wide: Vec<u8> = format!("\u{feff}{}", fs::read_to_string(&plain).unwrap())
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    let utf_16 = written(&folder, "utf16.csv", wide);
    for path in [plain, excel, tabs, turned, utf_16] {
        let text = stdout(&predict(SEVEN, &path, &[]));
        let (names, rows) = table(&text);
        assert_eq!((names.len(), rows.len()), (1 + 7 + 2, 12));
        for (index, row) in rows.iter().enumerate() {
            let values = state(0.01 * index as f64);
            let (q, qd, qdd) = (&values[..7], &values[7..14], &values[14..]);
            let found = torque(&model, &mut Data::new(), &Load::none(), q, qd, qdd);
            for joint in 0..7 {
                let value: f64 = row[1 + joint].parse().unwrap();
                let expected = found.rigid[joint] + found.friction[joint];
                assert!((value - expected).abs() < 1e-9, "{path}: {value} {expected}");
            }
        }
    }
}

/// Rates and accelerations are computed from positions with other names and in degrees.
#[test]
fn positions_alone_are_sufficient() {
    let folder = tempfile::tempdir().unwrap();
    let model = from_toml(SEVEN, &fs::read_to_string(SEVEN).unwrap()).unwrap();
    let swing = |joint: usize, t: f64| {
        let (a, w) = (0.5 + 0.1 * joint as f64, 1.5 + 0.4 * joint as f64);
        let phase = w * t + joint as f64;
        [a * phase.sin(), a * w * phase.cos(), -a * w * w * phase.sin()]
    };
    let mut text = String::from("Time,A1,A2,A3,A4,A5,A6,A7\n");
    let rows = 600;
    let time = |row: usize| 0.004 * row as f64;
    for row in 0..rows {
        let q: Vec<String> =
            (0..7).map(|joint| swing(joint, time(row))[0].to_degrees().to_string()).collect();
        text += &[time(row).to_string(), q.join(",")].join(",");
        text.push('\n');
    }
    let path = written(&folder, "positions.csv", &text);
    let joints: Vec<String> = (1..=7).map(|joint| format!("q{joint}_deg=A{joint}")).collect();
    let map = format!("t=Time,{}", joints.join(","));
    let load = "3,10,-20,150";
    let output = predict(SEVEN, &path, &["--map", &map, "--load", load]);
    assert!(stderr(&output).contains("rates and accelerations"));
    let found = stdout(&output);
    let (_, cells) = table(&found);
    assert_eq!(cells.len(), rows);
    let load = Load { mass: 3.0, com: Vector3::new(0.01, -0.02, 0.15), ..Load::none() };
    for (row, cells) in cells.iter().enumerate().skip(60).take(rows - 120) {
        let state: [Vec<f64>; 3] = std::array::from_fn(|order| {
            (0..7).map(|joint| swing(joint, time(row))[order]).collect()
        });
        let exact = torque(&model, &mut Data::new(), &load, &state[0], &state[1], &state[2]);
        for joint in 0..7 {
            let value: f64 = cells[1 + joint].parse().unwrap();
            let expected = exact.rigid[joint] + exact.friction[joint];
            assert!((value - expected).abs() < DIFFERENTIATED_NM, "{value} {expected}");
        }
    }
}

/// Diagnosed sensor effects apply to a log's torques; powers do not contain them.
#[test]
fn predicted_torques_contain_sensor_effects() {
    let folder = tempfile::tempdir().unwrap();
    let motion = written(&folder, "motion.csv", log_of_seven(",", "", |x| x.to_string()));
    let seven = fs::canonicalize(SEVEN).unwrap();
    let overlay = |effects: &str| {
        let text = format!("extends = \"{}\"\nname = \"x\"\n{effects}", seven.display());
        written(&folder, "robot.toml", &text)
    };
    let predicted = |effects: &str| stdout(&predict(&overlay(effects), &motion, &["-q"]));
    let plain = predicted("");
    let changed = predicted(
        "[effects.torque_offset]\noffset_j2 = 1.5\n\
                      [effects.torque_constant]\nerror_j3 = 0.1\n",
    );
    let moved = predicted("[effects.encoder_offset]\noffset_j2 = 0.01\n");
    assert_ne!(plain, moved);
    let ((_, before), (_, after)) = (table(&plain), table(&changed));
    for (before, after) in before.iter().zip(&after) {
        let at = |row: &[&str], column: usize| row[column].parse::<f64>().unwrap();
        assert!((at(after, 2) - at(before, 2) - 1.5).abs() < 1e-9);
        assert!((at(after, 3) - 1.1 * at(before, 3)).abs() < 1e-9 * at(after, 3).abs().max(1.0));
        assert_eq!((before[1], &before[4..]), (after[1], &after[4..]));
    }
}

/// Suspicious units cause a note, but not a refusal.
#[test]
fn doubtful_units_are_noted() {
    let folder = tempfile::tempdir().unwrap();
    let notes = |text: &str, rows: usize| {
        let output = predict(SEVEN, &written(&folder, "log.csv", text), &[]);
        assert_eq!(table(&stdout(&output)).1.len(), rows);
        stderr(&output)
    };
    let good = log_of_seven(",", "", |x| x.to_string());
    let row = |t: f64, angle: f64| format!("{t}{}\n", format!(",{angle}").repeat(7));
    let header = "t,q1,q2,q3,q4,q5,q6,q7\n";
    let slow = |unit: f64, step: f64| -> String {
        let rows = (0..12).map(|i| row(step * f64::from(i), unit * (0.015 * f64::from(i))));
        [header.to_owned()].into_iter().chain(rows).collect()
    };
    let plain = notes(&slow(1.0, 0.04), 12);
    assert!(!plain.contains("_deg") && !plain.contains("milliseconds"), "{plain}");
    let degrees = notes(&slow(57.3, 0.04), 12);
    assert!(degrees.contains("name the column q1_deg"), "{degrees}");
    let milliseconds = notes(&slow(1.0, 40.0), 12);
    assert!(milliseconds.contains("divide it by 1000"), "{milliseconds}");
    // Overflowing rates prevent a prediction in their row only.
    let mut lines: Vec<String> = good.lines().map(str::to_owned).collect();
    let mut cells: Vec<&str> = lines[5].split(',').collect();
    cells[8] = "1e200";
    lines[5] = cells.join(",");
    let beyond = notes(&lines.join("\n"), 11);
    assert!(beyond.contains("row 6 left out"), "{beyond}");
}

/// A channel that is logged for some joints is used for these.
#[test]
fn accelerations_of_some_joints_are_used() {
    let folder = tempfile::tempdir().unwrap();
    let good = log_of_seven(",", "", |x| x.to_string());
    let whole = stdout(&predict(SEVEN, &written(&folder, "a.csv", &good), &["-q"]));
    let without = good.replacen("qdd6", "none6", 1).replacen("qdd7", "none7", 1);
    let output = predict(SEVEN, &written(&folder, "b.csv", &without), &[]);
    let notes = stderr(&output);
    assert!(notes.contains("accelerations of joints 6, 7 are not logged"), "{notes}");
    let none = (1..=7).fold(good, |text, n| text.replacen(&format!("qdd{n}"), "none", 1));
    let none = stdout(&predict(SEVEN, &written(&folder, "c.csv", &none), &["-q"]));
    let tau1 = |text: &str| table(text).1[6][1].parse::<f64>().unwrap();
    let (whole, some, none) = (tau1(&whole), tau1(&stdout(&output)), tau1(&none));
    assert!((some - whole).abs() < 0.1 * (none - whole).abs(), "{whole} {some} {none}");
}

#[test]
fn bad_rows_are_named_and_left_out() {
    let mut lines: Vec<String> =
        log_of_seven(",", "", |x| x.to_string()).lines().map(str::to_owned).collect();
    let repeated = lines[4].clone();
    lines.insert(5, repeated);
    lines.insert(3, "0.015,1,2".into());
    let broken = lines[2].replacen(',', ",none,", 1).replace(",x", "");
    lines.insert(3, broken);
    lines.insert(2, "-1".to_owned() + lines[1].strip_prefix('0').unwrap());
    let log = read_csv(lines.join("\n").as_bytes(), &ColumnMap::default()).unwrap();
    let rejected: Vec<String> =
        log.rejected.iter().map(|row| format!("{}: {}", row.row, row.reason)).collect();
    insta::assert_snapshot!(rejected.join("\n"));
    assert_eq!((log.time().len(), log.joints()), (12, 7));
    assert!(log.column(Channel::Power).is_none());

    let folder = tempfile::tempdir().unwrap();
    let path = written(&folder, "bad.csv", lines.join("\n"));
    let output = predict(SEVEN, &path, &[]);
    assert_eq!(table(&stdout(&output)).1.len(), 12);
    assert!(stderr(&output).contains("row 3 left out"));
}

#[test]
fn unusable_logs_are_refused_with_the_way_out() {
    let folder = tempfile::tempdir().unwrap();
    let good = log_of_seven(",", "", |x| x.to_string());
    // Each interval is ten times the previous one.
    let mut sparse = "t,q1,q2,q3,q4,q5,q6,q7\n".to_owned();
    for i in 0..14 {
        sparse += &[10_i64.pow(i).to_string().as_str(), "0,0,0,0,0,0,0\n"].join(",");
    }
    let cut = |count: usize| good.lines().take(count).collect::<Vec<_>>().join("\n");
    for (text, way_out) in [
        (String::new(), "the first row names the columns"),
        (good.replacen('t', "time", 1), "the first row names the columns"),
        (cut(10), "only 9 usable rows, 10 are needed"),
        (sparse, "rows have others near enough to differentiate"),
        (good.replacen("q7", "p7", 1), "positions of 6 joints are logged, seven has 7"),
        (good.replacen("q3", "p3", 1), "none for joint 3"),
        (good.replacen("q3", "q2_deg", 1), "same quantity"),
    ] {
        let log = written(&folder, "log.csv", &text);
        refused(&["predict", "--robot", SEVEN, "--log", &log, "-q"], way_out);
    }
    refused(&["predict", "--robot", SEVEN, "--log", "none.csv"], "none.csv");
}

#[test]
fn predictions_of_an_estimated_robot_have_a_note() {
    let folder = tempfile::tempdir().unwrap();
    let rows = (0..200).map(|i| {
        let t = 0.01 * f64::from(i);
        let q = 0.4 * (2.0 * t).sin();
        format!("{t},{q},{q},{q},{q},{q},{q}\n")
    });
    let text = "t,q1,q2,q3,q4,q5,q6\n".to_owned() + &rows.collect::<String>();
    let output = predict("IRB6640-180/2.55", &written(&folder, "l.csv", &text), &[]);
    let notes = stderr(&output);
    assert!(notes.contains("estimated: ") && notes.contains("robots show"), "{notes}");
}
