//! Programs that need care: each movement becomes a stream or has a reason that is true.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

const FAR: &str = "[9E9,9E9,9E9,9E9,9E9,9E9]";
/// Two computations of the same energy, J.
const ENERGY: f64 = 1e-6;

fn optimize(input: &Path, out: &Path) -> Value {
    let output = Command::new(env!("CARGO_BIN_EXE_joulepath"))
        .args(["optimize", input.to_str().unwrap(), "--robot", "IRB1600-10/1.45"])
        .args(["--format", "json", "--quiet", "--out", out.to_str().unwrap()])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let result: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(result["verification"]["passed"], true, "{result}");
    result
}

/// The segments of a program that is written down as module-level text and movements.
fn segments(declarations: &str, movements: &[String]) -> Vec<Value> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.mod");
    let movements = movements.join("\n");
    let text = format!("MODULE M\n{declarations}PROC main()\n{movements}\nENDPROC\nENDMODULE\n");
    fs::write(&path, text).unwrap();
    let result = optimize(&path, &folder.path().join("out"));
    result["segments"].as_array().unwrap().clone()
}

fn joints(q: [f64; 6], rest: &str) -> String {
    let [a, b, c, d, e, f] = q;
    format!("MoveAbsJ [[{a},{b},{c},{d},{e},{f}],{FAR}],{rest},tool0;")
}

fn pose(form: &str, [x, y, z]: [f64; 3], rest: &str) -> String {
    let conf = if y < 0.0 { "[-1,0,-1,0]" } else { "[0,0,0,0]" };
    format!("{form} [[{x},{y},{z}],[0,0,1,0],{conf},{FAR}],{rest},tool0;")
}

fn there_and_back() -> Vec<String> {
    let (a, b) = ([0.0, 0.0, 0.0, 0.0, 30.0, 0.0], [40.0, 10.0, 10.0, 0.0, 60.0, 20.0]);
    vec![joints(a, "v1000,fine"), joints(b, "v1000,fine"), joints(a, "v1000,fine")]
}

fn reasons(segments: &[Value]) -> Vec<String> {
    let all = segments.iter().filter_map(|s| s["reason"].as_str());
    all.map(|reason| reason.split(':').next().unwrap().to_owned()).collect()
}

#[test]
fn names_of_rapid_that_the_program_has_otherwise_are_told() {
    // The guard would be true wherever the robot stands.
    let abs = "FUNC num Abs(num x)\nRETURN 0;\nENDFUNC\n";
    let zone = "CONST zonedata z200:=[FALSE,1,1,1,1,1,1];\n";
    for own in [abs, zone] {
        let found = reasons(&segments(own, &there_and_back()));
        assert_eq!(found, ["first-movement", "own-name", "own-name"], "{own}");
    }
    // What only its own module sees is no harm.
    let local = segments(&format!("LOCAL {zone}"), &there_and_back());
    assert_eq!(reasons(&local), ["first-movement"], "{local:?}");
}

#[test]
fn one_joint_that_turns_far_does_not_leave_its_path() {
    let turned = |angle: f64| joints([0.0, 0.0, 0.0, 0.0, 30.0, angle], "vmax,fine");
    let segments = segments("", &[turned(300.0), turned(-300.0), turned(300.0)]);
    assert_eq!(reasons(&segments), ["first-movement"], "{segments:?}");
}

#[test]
fn joints_that_turn_at_the_same_place_make_no_double_node() {
    let movements = [
        joints([0.0, 0.0, 0.0, 0.0, 30.0, 0.0], "v1000,fine"),
        pose("MoveJ", [879.8, 72.6, 453.7], "v1000,fine"),
        pose("MoveL", [933.3, 293.8, 739.3], "v2000,z1"),
        pose("MoveL", [732.8, 43.3, 847.3], "v200,z10"),
        pose("MoveJ", [760.8, 195.5, 719.4], "v500,z50"),
        pose("MoveL", [747.8, 303.5, 633.8], "v1000,fine"),
        pose("MoveL", [812.0, 212.7, 661.8], "v2000,z1"),
    ];
    let segments = segments("", &movements);
    assert_eq!(reasons(&segments), ["first-movement", "flies-on"], "{segments:?}");
}

#[test]
fn short_movements_are_not_said_to_save_what_settling_takes() {
    let bent = |angle: f64, last: f64| joints([0.0, 0.0, 0.0, 0.0, angle, last], "vmax,fine");
    let movements =
        [bent(30.0, 0.0), bent(30.02, 0.0), bent(30.5, 0.0), bent(31.5, 0.0), bent(31.5, 1.0)];
    for segment in segments("", &movements) {
        if segment["rewritten"] == true {
            let figure = |key: &str| segment[key].as_f64().unwrap();
            assert!(figure("points") > 1.0, "{segment}");
            assert!(figure("lower_bound_j") <= figure("energy_after_j") + ENERGY, "{segment}");
        }
    }
}

#[test]
fn what_was_left_stays_left() {
    let folder = tempfile::tempdir().unwrap();
    let movements = [
        joints([0.0, 0.0, 0.0, 0.0, 30.0, 0.0], "v1000,fine"),
        pose("MoveL", [933.3, 293.8, 739.3], "v2000,z1"),
        pose("MoveL", [732.8, 43.3, 847.3], "v200,fine"),
        pose("MoveL", [747.8, 303.5, 633.8], "v50,fine"),
        pose("MoveJ", [812.0, 212.7, 661.8], "v2000,fine"),
    ];
    let path = folder.path().join("m.mod");
    let text = format!("MODULE M\nPROC main()\n{}\nENDPROC\nENDMODULE\n", movements.join("\n"));
    fs::write(&path, text).unwrap();
    let (once, twice) = (folder.path().join("once"), folder.path().join("twice"));
    optimize(&path, &once);
    let again = optimize(&once, &twice);
    for name in ["m.mod", "Joulepath.mod"] {
        let read = |out: &Path| fs::read_to_string(out.join(name)).unwrap();
        assert_eq!(read(&once), read(&twice), "{again}");
    }
    assert!(!twice.join("Joulepath2.mod").exists());
}
