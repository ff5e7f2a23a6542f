//! `joulepath simulate` through the binary.

#![expect(clippy::unwrap_used, reason = "a failed set-up fails the test")]

mod command;

use std::fs;

use command::{json, module, number, refused, run};
use serde_json::Value;

const ROBOT: [&str; 2] = ["--robot", "IRB1600-10/1.45"];

#[test]
fn the_report_is_one_self_contained_page() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("cycle.html");
    let path = page.to_str().unwrap();
    let [robot, name] = ROBOT;
    run(&["simulate", "fixtures/hard/waits.mod", robot, name, "--report", path]);
    let html = fs::read_to_string(page).unwrap();
    for part in [
        "Cycle by instruction",
        "Electrical power",
        "Joint positions",
        "Source",
        "waits.mod",
        "6 waits of unknown length counted as 0 s",
        ">waits.mod:14 MoveAbsJ<",
    ] {
        assert!(html.contains(part), "{part}");
    }
    assert!(!html.contains("<script") && !html.contains("http"), "nothing is loaded");
    assert_eq!(html.matches("<svg").count(), html.matches("</svg>").count());
}

#[test]
fn wrong_options_name_the_way_out() {
    let [robot, name] = ROBOT;
    let program = ["simulate", "fixtures/hard/waits.mod", robot, name];
    for (option, value, hint) in [
        ("--assume", "diPart", "SIGNAL=LEVEL"),
        ("--speed-override", "0", "above 0"),
        ("--max-time", "-1", "above 0"),
        ("--input", "diPart", "SIGNAL=SECONDS"),
        ("--passes", "0", "1.."),
        ("--assume", "diPrt=1", "names no signal"),
        ("--input", "diStrat=1", "did you mean diStart?"),
        ("--assume", "diStart=7", "0 or 1"),
        ("--start", "0,0,0,0,900,0", "joint 5"),
    ] {
        let given = format!("{option}={value}");
        refused(&[&program[..], &[&given]].concat(), hint);
    }
}

#[test]
fn levels_and_passes_change_the_simulated_cycle() {
    let none = "[9E9,9E9,9E9,9E9,9E9,9E9]";
    let program = format!(
        "MODULE M\nPROC main()\nMoveAbsJ [[0,0,0,0,60,0],{none}],v1000,fine,tool0;\n\
         WHILE TRUE DO\nIF diLeft=1 THEN\nMoveAbsJ [[20,0,0,0,60,0],{none}],v1000,fine,tool0;\n\
         ENDIF\nMoveAbsJ [[0,0,0,0,60,0],{none}],v1000,fine,tool0;\nWaitTime 1;\nENDWHILE\n\
         ENDPROC\nENDMODULE"
    );
    let (_folder, path) = module(program);
    let [robot, name] = ROBOT;
    let moves = |options: &[&str]| {
        let base = ["simulate", &path, robot, name, "--format", "json"];
        let result = json(&[&base[..], options].concat());
        let places = result["unresolved"].as_array().unwrap().clone();
        (result["moves"].as_array().unwrap().len(), places)
    };
    let (count, notes) = moves(&[]);
    assert_eq!(count, 2);
    assert!(notes.iter().any(|note| note["line"] == 5), "the other branch is named: {notes:?}");
    assert_eq!(moves(&["--assume", "diLeft=1"]).0, 3);
    assert_eq!(moves(&["--assume", "diLeft=1", "--passes", "4"]).0, 9);
    let (_, notes) = moves(&["--passes", "1000", "--max-time", "30"]);
    let stopped = notes.iter().any(|note| note["reason"].as_str().unwrap().contains("--max-time"));
    assert!(stopped, "{notes:?}");
}

/// The answer of an operator decides a branch; without it the note names the way out.
#[test]
fn answers_of_the_operator_can_be_stated() {
    let none = "[9E9,9E9,9E9,9E9,9E9,9E9]";
    let home = format!("MoveAbsJ [[0,0,0,0,60,0],{none}],v1000,fine,tool0;\n");
    let (_folder, path) = module(format!(
        "MODULE M\nVAR num nAns;\nPROC main()\n{home}TPReadNum nAns, \"how many\";\nTEST nAns\nCASE 2:\n\
         MoveAbsJ [[20,0,0,0,60,0],{none}],v1000,fine,tool0;\n{home}ENDTEST\nENDPROC\nENDMODULE"
    ));
    let [robot, name] = ROBOT;
    let base = ["simulate", &path, robot, name, "--format", "json"];
    let result = |options: &[&str]| json(&[&base[..], options].concat());
    let moves = |result: &Value| result["moves"].as_array().unwrap().len();
    let unknown = result(&[]);
    assert_eq!(moves(&unknown), 1);
    assert!(unknown["unresolved"].to_string().contains("--assume NAME=NUMBER"), "{unknown}");
    let stated = result(&["--assume", "nAns=2"]);
    assert_eq!(moves(&stated), 3);
    assert!(stated["assumed"].to_string().contains("nAns is 2"), "{stated}");
    refused(&[&base[..], &["--assume", "nAnz=2"]].concat(), "did you mean nAns?");
}

#[test]
fn movements_with_actions_are_marked_and_energies_add_up() {
    let [robot, name] = ROBOT;
    let result = json(&["simulate", "fixtures/hard/trigger.mod", robot, name, "--format", "json"]);
    let marks: Vec<(&str, &Value)> = result["moves"]
        .as_array()
        .unwrap()
        .iter()
        .map(|m| (m["instruction"].as_str().unwrap(), &m["mark"]))
        .collect();
    for (instruction, mark) in &marks {
        let wanted = match instruction.get(..5) {
            Some("Trigg") => Value::from("trigger"),
            Some("Searc") => Value::from("search"),
            _ if instruction.ends_with("Sync") => Value::from("call"),
            _ if instruction.ends_with("DO") => Value::from("output"),
            _ => Value::Null,
        };
        assert_eq!(**mark, wanted, "{instruction}");
    }
    assert!(marks.iter().any(|(_, mark)| !mark.is_null()), "{marks:?}");
    let result = json(&["simulate", "fixtures/hard/waits.mod", robot, name, "--format", "json"]);
    let moves = result["moves"].as_array().unwrap().iter();
    let all = moves.chain(result["waits"].as_array().unwrap());
    let sum: f64 = all.map(|part| part["energy_j"].as_f64().unwrap()).sum();
    let total = number(&result, "/energy_j");
    assert!((sum - total).abs() < 1e-9 * total, "{sum} {total}");
}
