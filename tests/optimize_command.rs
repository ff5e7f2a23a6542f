//! The main job through the binary: the contract of its JSON, what it writes, what it says.
#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

/// End points may differ from the programmed ones by this, rad.
const ENDPOINT_TOLERANCE: f64 = 1e-4;
/// Share of the eligible moving time that has to be rewritten.
const REWRITTEN_SHARE: f64 = 0.8;

fn joulepath(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_joulepath")).args(args).output().unwrap()
}

fn json(args: &[&str]) -> Value {
    let output = joulepath(args);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn number(value: &Value, path: &str) -> f64 {
    value.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("no number at {path}"))
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Settings under which snapshots do not hang on the last digits of a platform's sine.
fn snapshots() -> insta::Settings {
    let mut settings = insta::Settings::clone_current();
    settings.add_filter(r"(\d+\.\d)\d+", "$1…");
    settings.add_filter(r"[\d.]+…?e-\d+", "[tiny]");
    settings.add_filter(r" +", " ");
    settings.add_filter(r"-{20,}", "---");
    settings
}

#[test]
fn pick_place_keeps_the_contract() {
    let result = json(&["optimize", "fixtures/pick_place", "--format", "json"]);
    assert_eq!(result["verification"]["passed"], true);
    for limit in ["velocity", "acceleration", "torque", "tcp_speed"] {
        let ratio = number(&result, &format!("/verification/max_ratio/{limit}"));
        assert!(ratio > 0.0 && ratio <= 1.0, "{limit}: {ratio}");
    }
    assert!(number(&result, "/verification/endpoint_error_rad") <= ENDPOINT_TOLERANCE);
    assert!(number(&result, "/motion_saving_percent") > 0.0);
    assert!(number(&result, "/optimized/cycle_s") <= number(&result, "/original/cycle_s"));
    assert!(number(&result, "/potential_j") > 0.0, "the long wait for the mill pays for a brake");

    let (mut eligible, mut rewritten) = (0.0, 0.0);
    for segment in result["segments"].as_array().unwrap() {
        let time = number(segment, "/time_before_s");
        if segment["kind"] != "timing" {
            assert_eq!(segment["rewritten"], false, "a dwell needs a setting of the controller");
            continue;
        }
        if segment["rewritten"] == true {
            eligible += time;
            rewritten += time;
            assert!(number(segment, "/points") > 0.0);
            assert!(number(segment, "/energy_after_j") < number(segment, "/energy_before_j"));
            assert!(number(segment, "/time_after_s") <= time);
            let bound = number(segment, "/lower_bound_j");
            assert!(bound <= number(segment, "/energy_after_j"), "{segment}");
        } else {
            let reason = segment["reason"].as_str().unwrap();
            if reason.starts_with("no-s") {
                eligible += time;
            }
        }
    }
    assert!(rewritten >= REWRITTEN_SHARE * eligible, "{rewritten} s of {eligible} s");
}

#[test]
fn what_was_written_simulates_as_promised() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let out = out.to_str().unwrap();
    let result = json(&["optimize", "fixtures/pick_place", "--format", "json", "--out", out]);
    let robot = "IRB1600-10/1.45";
    let simulated = json(&["simulate", out, "--robot", robot, "--format", "json"]);
    for key in ["/cycle_s", "/energy_j", "/motion_energy_j"] {
        let promised = number(&result, &format!("/optimized{key}"));
        assert!((number(&simulated, key) - promised).abs() < 1e-6 * promised, "{key}");
    }
    let moves = simulated["moves"].as_array().unwrap();
    let waits = simulated["waits"].as_array().unwrap();
    let sum: f64 = moves.iter().chain(waits).map(|entry| number(entry, "/duration_s")).sum();
    assert!((sum - number(&simulated, "/cycle_s")).abs() < 1e-9, "moves and waits tile the cycle");
    // Untouched files are the same bytes.
    for name in ["CellData.mod", "Pallet.sys"] {
        let original = fs::read(Path::new("fixtures/pick_place").join(name)).unwrap();
        assert_eq!(fs::read(Path::new(out).join(name)).unwrap(), original, "{name}");
    }
    // A second time there is nothing left to do.
    let again = json(&["optimize", out, "--robot", robot, "--format", "json"]);
    assert_eq!(number(&again, "/saving_percent"), 0.0);
}

#[test]
fn output_is_the_same_bytes_each_time() {
    let args = ["optimize", "fixtures/hard/waits.mod", "--format", "json"];
    assert_eq!(joulepath(&args).stdout, joulepath(&args).stdout);
}

#[test]
fn paper_order_holds() {
    let energy = json(&["optimize", "fixtures/paper", "--format", "json"]);
    let time = json(&["optimize", "fixtures/paper", "--format", "json", "--objective", "time"]);
    let segment = |result: &Value, line: u64, key: &str| -> f64 {
        let segments = result["segments"].as_array().unwrap();
        let found = segments.iter().find(|s| s["line_first"] == line).unwrap();
        found[key].as_f64().unwrap()
    };
    // B at vmax stands in line 78, D at vmax in line 94, B at v300 in line 68.
    let (straight, joint, slow) = (78, 94, 68);
    let fastest = segment(&time, joint, "time_after_s");
    assert!(fastest < segment(&time, straight, "time_before_s"), "time-optimal beats the line");
    for line in [straight, joint] {
        assert!(
            segment(&energy, line, "energy_after_j") < segment(&energy, line, "energy_before_j"),
            "energy-optimal is below the controller's move at equal time"
        );
    }
    // Slowing down: from vmax to v1000 the same line costs less motion energy.
    let half = 72;
    let idle_w = 210.0;
    let motion = |line| {
        segment(&energy, line, "energy_before_j") - idle_w * segment(&energy, line, "time_before_s")
    };
    assert!(motion(half) < 0.8 * motion(straight), "{} {}", motion(half), motion(straight));
    assert!(segment(&energy, slow, "time_before_s") > segment(&energy, half, "time_before_s"));
}

#[test]
fn in_place_keeps_a_copy() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("waits.mod");
    fs::copy("fixtures/hard/waits.mod", &program).unwrap();
    let path = program.to_str().unwrap();
    let args = ["optimize", path, "--robot", "IRB1600-10/1.45", "--in-place", "--quiet"];
    assert!(joulepath(&args).status.success());
    let original = fs::read("fixtures/hard/waits.mod").unwrap();
    assert_eq!(fs::read(folder.path().join("waits.mod.bak")).unwrap(), original);
    assert_ne!(fs::read(&program).unwrap(), original);
    assert!(folder.path().join("Joulepath.mod").is_file());
}

#[test]
fn refusals_are_exit_code_one_only_when_strict() {
    let args = ["optimize", "fixtures/hard/unreachable.mod", "--quiet"];
    assert_eq!(joulepath(&args).status.code(), Some(0));
    let strict = ["optimize", "fixtures/hard/unreachable.mod", "--quiet", "--strict"];
    assert_eq!(joulepath(&strict).status.code(), Some(1));
}

#[test]
fn unusable_input_names_the_way_out() {
    let folder = tempfile::tempdir().unwrap();
    let broken = folder.path().join("broken.mod");
    fs::write(&broken, "MODULE m\nPROC main()\nMoveJ p1 v100,,;\nENDPROC\nENDMODULE\n").unwrap();
    let headless = folder.path().join("headless.mod");
    fs::write(&headless, "MODULE m\nPROC other()\nENDPROC\nENDMODULE\n").unwrap();
    let empty = folder.path().join("empty");
    fs::create_dir(&empty).unwrap();
    let robot = "IRB1600-10/1.45";
    let cases: Vec<Vec<&str>> = vec![
        vec!["optimize", "no/such/file.mod", "--robot", robot],
        vec!["optimize", empty.to_str().unwrap(), "--robot", robot],
        vec!["optimize", broken.to_str().unwrap(), "--robot", robot],
        vec!["optimize", headless.to_str().unwrap(), "--robot", robot],
        vec!["optimize", "fixtures/pick_place", "--robot", "IRB1600-99"],
        vec!["optimize", broken.to_str().unwrap()],
        vec!["optimize", "fixtures/hard/waits.mod", "--takt", "10"],
        vec!["optimize", "fixtures/hard/waits.mod", "--spacing", "0"],
        vec!["simulate", "fixtures/hard/waits.mod", "--start", "1,2,3"],
        vec!["simulate", "fixtures/hard/waits.mod", "--input", "diReady"],
    ];
    let mut said = String::new();
    for args in cases {
        let output = joulepath(&args);
        assert_eq!(output.status.code(), Some(2), "{args:?}");
        assert!(output.stdout.is_empty(), "{args:?}");
        let message = text(&output.stderr).replace(folder.path().to_str().unwrap(), "[folder]");
        let messages = message.lines().filter(|line| !line.starts_with("note:"));
        for line in messages {
            said.push_str(line);
            said.push('\n');
        }
    }
    snapshots().bind(|| insta::assert_snapshot!("messages", said));
}

#[test]
fn text_diff_and_module_read_well() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let args = ["optimize", "fixtures/hard/encoding.mod", "--quiet"];
    snapshots().bind(|| insta::assert_snapshot!("text", text(&joulepath(&args).stdout)));
    let args = ["optimize", "fixtures/hard/encoding.mod", "--quiet", "--diff"];
    snapshots().bind(|| insta::assert_snapshot!("diff", text(&joulepath(&args).stdout)));
    let args =
        ["optimize", "fixtures/hard/encoding.mod", "--quiet", "--out", out.to_str().unwrap()];
    assert!(joulepath(&args).status.success());
    let module = fs::read(out.join("Joulepath.mod")).unwrap();
    snapshots().bind(|| insta::assert_snapshot!("module", text(&module)));
}

#[test]
fn json_has_the_contracts_fields() {
    let args = ["optimize", "fixtures/hard/encoding.mod", "--quiet", "--format", "json"];
    snapshots().bind(|| insta::assert_snapshot!("json", text(&joulepath(&args).stdout)));
    let args = ["simulate", "fixtures/hard/encoding.mod", "--quiet", "--format", "json"];
    snapshots().bind(|| insta::assert_snapshot!("simulate", text(&joulepath(&args).stdout)));
}
