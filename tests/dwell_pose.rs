//! `optimize --dwell-pose`: moves a wait to a pose with less holding power.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;

use std::fs;
use std::path::Path;

use command::{IRB1600 as ROBOT, module, number, parsed, refused, run_in};
use serde_json::Value;

/// Rounding of a sum of times, s.
const TIME: f64 = 1e-6;
/// Relative tolerance of two integrations of the same energy.
const ENERGY: f64 = 1e-6;

const FAR: &str = "[9E9,9E9,9E9,9E9,9E9,9E9]";

/// Two long waits with the arm extended, the second one after an output.
fn program(end_of_line: &str) -> String {
    format!(
        "MODULE M\n\
         CONST jointtarget jA:=[[0,0,0,0,40,0],{FAR}];\n\
         CONST jointtarget jB:=[[40,60,-30,0,30,10],{FAR}];\n\
         PROC main()\n\
         MoveAbsJ jA,v1000,fine,tool0;\n\
         FOR i FROM 1 TO 2 DO\n\
         MoveAbsJ jB,v1000,fine,tool0;\n\
         WaitTime 40; ! cools down\n\
         MoveAbsJ jA,v1000,fine,tool0;\n\
         ENDFOR\n\
         MoveAbsJ jB,v1000,fine,tool0;\n\
         SetDO doSpray,1;\n\
         WaitTime 40;{end_of_line}\n\
         SetDO doSpray,0;\n\
         MoveAbsJ jA,v1000,fine,tool0;\n\
         ENDPROC\n\
         ENDMODULE\n"
    )
}

fn optimize(folder: &Path, text: &str, options: &[&str]) -> Value {
    command::optimize(folder, text, &[&["--robot", ROBOT], options].concat())
}

/// Simulation of the written program.
fn simulate(folder: &Path) -> Value {
    let args = ["simulate", "out", "--robot", ROBOT, "--format", "json", "--quiet"];
    parsed(&run_in(folder, &args))
}

/// Lines of the moved waits.
fn rewritten(result: &Value) -> Vec<u64> {
    let segments = result["segments"].as_array().unwrap();
    let idle = segments.iter().filter(|s| s["kind"] == "idle" && s["rewritten"] == true);
    idle.map(|s| s["line_first"].as_u64().unwrap()).collect()
}

#[test]
fn a_wait_moves_to_a_pose_with_less_holding_power() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let standing = optimize(folder, &program(""), &[]);
    let result = optimize(folder, &program(""), &["--dwell-pose=30"]);
    assert_eq!(rewritten(&standing), [] as [u64; 0]);
    assert_eq!(rewritten(&result), [8], "{result}");
    let energy = |result: &Value| number(result, "/optimized/energy_j");
    assert!(energy(&result) < 0.99 * energy(&standing), "{result}");
    let cycle = |result: &Value| number(result, "/optimized/cycle_s");
    assert!((cycle(&result) - cycle(&standing)).abs() < TIME, "{result}");
    let wait = result["segments"].as_array().unwrap().iter().find(|s| s["line_first"] == 8);
    let [before, after] =
        ["time_before_s", "time_after_s"].map(|key| wait.unwrap()[key].as_f64().unwrap());
    assert!((before - 80.0).abs() < TIME && (after - 80.0).abs() < TIME, "{before} {after}");

    // The original wait remains, for a robot at another position.
    let written = fs::read_to_string(folder.join("out/m.mod")).unwrap();
    let branch =
        "ELSE ! after an edit of these lines: joulepath refresh\nWaitTime 40;\nENDIF ! cools down";
    assert!(written.contains(branch), "{written}");
    // The written program has the predicted energy.
    let simulated = simulate(folder);
    assert!((number(&simulated, "/energy_j") / energy(&result) - 1.0).abs() < ENERGY);
    assert!((number(&simulated, "/cycle_s") - cycle(&result)).abs() < TIME);
    // A second run finds no saving.
    let again = ["optimize", "out", "--robot", ROBOT, "--dwell-pose=30", "--out", "again"];
    run_in(folder, &again);
    assert_eq!(fs::read_to_string(folder.join("again/m.mod")).unwrap(), written);
}

#[test]
fn a_wait_after_an_output_moves_only_with_a_free_comment() {
    let folder = tempfile::tempdir().unwrap();
    let text = program(" ! joulepath: free");
    let result = optimize(folder.path(), &text, &["--dwell-pose"]);
    assert_eq!(rewritten(&result), [8, 13], "{result}");
}

#[test]
fn a_wait_of_variable_length_does_not_move() {
    let folder = tempfile::tempdir().unwrap();
    let constant = "CONST num nCool:=40;\nPROC main()";
    for (declared, lines) in [
        (constant, &[9_u64][..]),
        ("PERS num nCool:=40;\nPROC main()", &[]),
        ("VAR num nCool:=40;\nPROC main()\nnCool:=40;", &[]),
    ] {
        let text = program("").replace("PROC main()", declared);
        let text = text.replace("WaitTime 40; ! cools down", "WaitTime nCool;");
        let result = optimize(folder.path(), &text, &["--dwell-pose=30"]);
        assert_eq!(rewritten(&result), lines, "{declared}: {result}");
    }
}

#[test]
fn dwell_poses_stay_out_of_keep_out_zones() {
    let folder = tempfile::tempdir().unwrap();
    // No part of the arm may rise above its height in the extended pose.
    fs::write(
        folder.path().join("joulepath.toml"),
        "[[keep_out]]\nbox = [[-2.0, -2.0, 0.0], [2.0, 2.0, 3.0]]\n",
    )
    .unwrap();
    let result = optimize(folder.path(), &program(""), &["--dwell-pose=30"]);
    assert_eq!(rewritten(&result), [] as [u64; 0], "{result}");
}

#[test]
fn impossible_distances_are_refused_with_the_way_out() {
    let (folder, path) = module(program(""));
    let out = folder.path().join("out");
    let common = ["optimize", &path, "--robot", ROBOT, "--out", out.to_str().unwrap()];
    let is_refused = |options: &[&str], way_out: &str| {
        refused(&[&common[..], options].concat(), way_out);
    };
    is_refused(&["--dwell-pose=-3"], "more than 0");
    is_refused(&["--dwell-pose=180"], "at most 90");
    is_refused(&["--dwell-pose", "--emit", "retime"], "--emit");
    assert!(!out.exists());
}

#[test]
fn the_original_wait_runs_with_a_changed_tool() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let tool =
        "PERS tooldata tGun:=[TRUE,[[0,0,80],[1,0,0,0]],[2,[0,0,40],[1,0,0,0],0,0,0]];\nPROC main";
    let text = program("").replace("tool0", "tGun").replace("PROC main", tool);
    let result = optimize(folder, &text, &["--dwell-pose=30"]);
    assert_eq!(rewritten(&result), [9], "{result}");
    let path = folder.join("out/m.mod");
    let written = fs::read_to_string(&path).unwrap();
    let moves = || simulate(folder)["moves"].as_array().unwrap().len();
    let with_streams = moves();
    fs::write(&path, written.replace(",[2,[0,0,40]", ",[4,[0,0,40]")).unwrap();
    let programmed = text.matches("MoveAbsJ").count() + 2;
    assert_eq!(moves(), programmed);
    assert!(with_streams > programmed, "{with_streams}");
}
