//! Logs without torques on the command line.

use std::fmt::Write;
use std::fs;

use joulepath::gap::Run;

use crate::command::{IRB1600, joulepath, parsed, refused, run, stderr};
use crate::planner::{BEFORE, HEALTHY, NOW, PROGRAM, Robot};

/// A log without torques, of a robot of six joints.
fn csv(run: &Run) -> String {
    let mut text = String::from("t,q1,q2,q3,q4,q5,q6,cmd\n");
    for (row, t) in run.t.iter().enumerate() {
        let [a, b, c] = [0, 1, 2].map(|joint: usize| run.q[joint][row]);
        let _ = writeln!(text, "{t:.5},{a:.5},{b:.5},{c:.5},0,0,0,{}", run.command[row]);
    }
    text
}

/// The program of the logs; its first movement is in line 3.
fn module() -> String {
    let moves = PROGRAM.map(|(target, stops, wait)| {
        let [a, b, c] = target.map(f64::to_degrees);
        let zone = if stops { "fine" } else { "z50" };
        let wait = if wait > 0.0 { format!(" WaitTime {wait};") } else { String::new() };
        let external = "[9E9,9E9,9E9,9E9,9E9,9E9]";
        let target = format!("[[{a:.3},{b:.3},{c:.3},0,0,0],{external}]");
        format!("MoveAbsJ {target}, v500, {zone}, tool0;{wait}\n")
    });
    format!("MODULE Cell\nPROC main()\n{}ENDPROC\nENDMODULE\n", moves.concat())
}

#[test]
fn logs_without_torques_tell_the_line_of_a_wait() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let mut waits = [0.0; 8];
    waits[4] = 0.2;
    let now = Robot { waits, ..HEALTHY };
    fs::write(at("before.csv"), csv(&HEALTHY.log(BEFORE))).unwrap();
    fs::write(at("log.csv"), csv(&now.log(NOW))).unwrap();
    fs::write(at("cell.mod"), module()).unwrap();
    let [log, before, cell] = [at("log.csv"), at("before.csv"), at("cell.mod")];
    let [model, page] = [at("model.toml"), at("page.html")];
    let common = ["diagnose", "--robot", IRB1600, "--format", "json", "--program", &cell];
    let outputs = ["--out", &model, "--report", &page];
    let args = [&common[..], &outputs, &["--log", &log, "--baseline", &before]].concat();
    let output = joulepath(&args);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let value = parsed(&output);
    assert_eq!(value["verdict"], "effect");
    assert_eq!(value["effects"][0]["id"], "program_wait");
    assert_eq!(value["effects"][0]["parameters"]["wait"]["unit"], "s");
    assert_eq!(value["where"][0]["movement"], 5);
    assert_eq!(value["where"][0]["line"], 7);
    let gap = value["gap"].as_array().unwrap();
    assert_eq!(gap.len(), 1);
    assert_eq!(
        [&gap[0]["channel"], &gap[0]["unit"], &gap[0]["heldout"]],
        ["motion", "s", "cycles"]
    );
    // The model is the nominal one, and can be read; the page shows the line.
    run(&["robots", "show", &model]);
    let page = fs::read_to_string(page).unwrap();
    assert!(page.contains("cell.mod:7") && !page.contains("stated probabilities"));
}

#[test]
fn a_motion_alone_asks_for_a_baseline_with_its_movements() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let text = csv(&HEALTHY.log(BEFORE));
    let [log, bare] = [at("log.csv"), at("bare.csv")];
    fs::write(&log, &text).unwrap();
    fs::write(&bare, text.replace("cmd", "remark")).unwrap();
    let common = ["diagnose", "--robot", IRB1600, "--log", &log];
    let message = refused(&common, "give --baseline");
    assert!(message.contains("log.csv"), "{message}");
    refused(&[&common[..], &["--baseline", &bare]].concat(), "bare.csv: no column cmd");
}
