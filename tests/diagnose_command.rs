//! The command `diagnose`: its JSON, its model, its refusals.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

mod command;

use std::fs;
use std::path::Path;
use std::process::Output;

use command::{joulepath, parsed, refused, run, stderr};
use joulepath::examine::blind::{self, Settings};
use serde_json::Value;

/// A short case of the examination in a folder.
fn case(folder: &Path) {
    let settings = Settings { cycles: 3, period_s: 4.0, ..Settings::new(5) };
    let case = blind::case(&settings, 3).unwrap();
    for (name, text) in &case.files {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
}

#[test]
fn the_json_has_the_fields_of_the_contract() {
    let folder = tempfile::tempdir().unwrap();
    case(folder.path());
    let at = |name: &str| folder.path().join(name).display().to_string();
    let (out, page) = (at("model.toml"), at("page.html"));
    let (robot, logs, held) =
        (at("nominal.toml"), [at("log-1.csv"), at("log-2.csv")], at("heldout.csv"));
    let output = joulepath(&[
        "diagnose",
        "--robot",
        &robot,
        "--log",
        &logs[0],
        &logs[1],
        "--heldout",
        &held,
        "--period",
        "4",
        "--out",
        &out,
        "--format",
        "json",
        "--effects",
        "torque_offset,friction_level",
        "--report",
        &page,
    ]);
    let message = stderr(&output);
    assert!(matches!(output.status.code(), Some(0 | 1)), "{message}");
    let value = parsed(&output);
    for key in
        ["verdict", "effects", "candidates", "generic", "where", "gap", "next_experiment", "model"]
    {
        assert!(value.get(key).is_some(), "no {key}");
    }
    assert_shares_add_up(&value["where"]);
    let gap = &value["gap"][0];
    assert_eq!(gap["per_joint"].as_array().unwrap().len(), 6);
    for key in ["noise", "model", "refit", "refit_plus_effect"] {
        assert!(gap["per_joint"][0][key].is_number(), "no {key}");
    }
    let page = fs::read_to_string(page).unwrap();
    for text in ["How far the gap shrinks", "joint 6, over time", "<polyline", "</html>"] {
        assert!(page.contains(text), "no {text}");
    }
    // The proposed next experiment is a valid command.
    if let Some(command) = value["next_experiment"]["command"].as_str() {
        let words: Vec<&str> = command.split(' ').skip(1).collect();
        let message = stderr(&joulepath(&[&words[..], &["--plane", "none"]].concat()));
        assert!(message.contains("--plane none"), "{command}: {message}");
    }
    // The written model is complete for predictions.
    run(&["predict", "--robot", &out, "--log", &held, "--quiet"]);
}

/// The thirds of a quantity add up to the share of its joint, the effects to that of their third.
fn assert_shares_add_up(places: &Value) {
    let places = places.as_array().unwrap();
    let share = |place: &Value| place["share_percent"].as_f64().unwrap();
    let of_joint = |joint: u64, quantity: &str| -> Vec<&Value> {
        let is_of = |place: &&Value| {
            place["joint"] == joint && place["regime"].as_str().unwrap().starts_with(quantity)
        };
        places.iter().filter(is_of).collect()
    };
    for joint in 1..=6 {
        let whole = of_joint(joint, "all");
        assert_eq!(whole.len(), 1);
        for quantity in ["speed", "position", "load", "time"] {
            let thirds = of_joint(joint, quantity);
            assert_eq!(thirds.len(), 3, "joint {joint}, {quantity}");
            let sum: f64 = thirds.iter().map(|place| share(place)).sum();
            assert!((sum - share(whole[0])).abs() < 1e-6, "joint {joint}, {quantity}: {sum}");
            for third in thirds {
                let effects = third["by_effect_percent"].as_object().unwrap();
                let sum: f64 = effects.values().map(|share| share.as_f64().unwrap()).sum();
                assert!((sum - share(third)).abs() < 1e-6, "{third}");
                assert_eq!(third["t_end_s"].is_number(), quantity == "time");
            }
        }
    }
}

/// Of a single log the last repetitions are held out.
#[test]
fn the_last_cycles_of_a_single_log_are_held_out() {
    let folder = tempfile::tempdir().unwrap();
    let settings = Settings { cycles: 5, period_s: 4.0, ..Settings::new(5) };
    let made = blind::case(&settings, 3).unwrap();
    for name in ["nominal.toml", "log-1.csv"] {
        let (_, text) = made.files.iter().find(|(other, _)| other == name).unwrap();
        fs::write(folder.path().join(name), text).unwrap();
    }
    let noisy = |from: f64| {
        let path = folder.path().join("log-1.csv");
        let text = fs::read_to_string(&path).unwrap();
        let lines = text.lines().map(|line| {
            let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
            if let (Ok(t), Ok(torque)) = (fields[0].parse::<f64>(), fields[7].parse::<f64>())
                && t >= from
            {
                fields[7] = (torque + 5.0).to_string();
            }
            fields.join(",")
        });
        let other = folder.path().join(format!("log-{from}.csv"));
        fs::write(&other, lines.collect::<Vec<_>>().join("\n")).unwrap();
        other.display().to_string()
    };
    let gap = |log: &str| {
        let robot = folder.path().join("nominal.toml").display().to_string();
        let common = ["diagnose", "--robot", &robot, "--period", "4", "--format", "json"];
        let args = [&common[..], &["--effects", "ripple", "--log", log]].concat();
        let value = parsed(&joulepath(&args));
        assert_eq!(value["gap"][0]["heldout"], "cycles");
        value["gap"][0]["per_joint"][0]["model"].as_f64().unwrap()
    };
    // The last repetition is held out, the one before is not.
    let [none, last] = [1e9, 16.0].map(|from| gap(&noisy(from)));
    assert!((last - none).abs() > 1.0, "{none} {last}");
}

/// A wrong stated period causes a note, and the true period is used.
#[test]
fn a_wrong_period_is_reported_and_corrected() {
    let folder = tempfile::tempdir().unwrap();
    case(folder.path());
    let at = |name: &str| folder.path().join(name).display().to_string();
    let (robot, log, held) = (at("nominal.toml"), at("log-1.csv"), at("heldout.csv"));
    let logs = ["diagnose", "--robot", &robot, "--log", &log, "--heldout", &held];
    let rest = ["--effects", "ripple", "--format", "json", "--period"];
    let diagnosed = |period: &str| joulepath(&[&logs[..], &rest, &[period]].concat());
    let [right, wrong] = ["4", "2.9"].map(diagnosed);
    let message = stderr(&wrong);
    let reported = "--period 2.9: the motion repeats every 4.0000 s; that was used";
    assert!(message.contains(reported), "{message}");
    let missed = |output: &Output| -> f64 {
        parsed(output)["gap"][0]["per_joint"][1]["refit"].as_f64().unwrap()
    };
    let (right, wrong) = (missed(&right), missed(&wrong));
    assert!((wrong / right - 1.0).abs() < 1e-6, "{right} {wrong}");
}

#[test]
fn wrong_input_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    case(folder.path());
    let at = |name: &str| folder.path().join(name).display().to_string();
    let (robot, log, itself) = (at("nominal.toml"), at("log-1.csv"), at(""));
    let few = at("few.csv");
    let text = fs::read_to_string(&log).unwrap();
    let five: Vec<String> = text
        .lines()
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            [&fields[..6], &fields[7..12]].concat().join(",")
        })
        .collect();
    fs::write(&few, five.join("\n")).unwrap();
    let (copy, page, program) = (at("copy.csv"), at("page.html"), at("missing.mod"));
    fs::write(&copy, &text).unwrap();
    let (packed, binary) = (at("log-1.csv.gz"), at("log-1.mat"));
    fs::write(&packed, [0x1f, 0x8b, 8, 0]).unwrap();
    fs::write(&binary, b"MATLAB\x00\x01,t,q1").unwrap();
    for (args, way_out) in [
        (vec!["--robot", "IRB1600-6/1.45", "--log", &log], "diagnose needs it"),
        (vec!["--robot", &robot, "--log", &few], "q1 to q6"),
        (vec!["--robot", &robot, "--log", &log, "--effects", "stribek"], "stribeck"),
        (vec!["--robot", &robot, "--log", &log, "--period", "0"], "more than 0"),
        (vec!["--robot", &robot, "--log", "missing.csv"], "cannot read"),
        (vec!["--robot", &robot, "--log", &log, "--plane", "0,0,1,0"], "add --next DIR"),
        (vec!["--robot", &robot, "--log", &packed], "packed: give it as CSV"),
        (vec!["--robot", &robot, "--log", &binary], "no text: give it as CSV"),
        (vec!["--robot", &robot, "--log", &itself], "this is a folder"),
        (vec!["--robot", &robot, "--log", &log, "--heldout", &log], "is in --log too"),
        (vec!["--robot", &robot, "--log", &log, "--baseline", &log], "is in --log too"),
        (vec!["--robot", &robot, "--log", &log, "--out", &robot], "give another name"),
        (vec!["--robot", &robot, "--log", &log, "--report", &log], "give another name"),
        (vec!["--robot", &robot, "--log", &log, "--out", &itself], "name a file in it"),
        (vec!["--robot", &robot, "--log", &log, &log], "is given twice"),
        (vec!["--robot", &robot, "--log", &log, "--heldout", &copy], "the same log as --log"),
        (vec!["--robot", &robot, "--log", &log, "--out", &page, "--report", &page], "another name"),
        (vec!["--robot", &robot, "--log", &log, "--program", &program], "missing.mod"),
    ] {
        refused(&[&["diagnose"], &args[..]].concat(), way_out);
    }
}
