//! `instrument` puts a recorder into a program, which does the same as before, and takes it out.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

mod command;

use std::fs;
use std::path::Path;

use command::{IRB1600, files, json, module, number, refused, run, written};
use serde_json::Value;

/// Extra time that a recorder may take, ms for each movement.
const BUDGET_MS: f64 = 5.0;

const PROGRAM: &str = "MODULE Main\r\n\
    VAR bool bLate;\r\n\
    VAR zonedata zHere:=[TRUE,0,0,0,0,0,0];\r\n\
    PERS loaddata lPart:=[2,[0,0,40],[1,0,0,0],0,0,0];\r\n\
    CONST jointtarget jHome:=[[0,-12,14,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\r\n\
    CONST robtarget pNest:=[[850,300,800],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\r\n\
    PROC main()\r\n\
    \x20   MoveAbsJ jHome,v1000,fine,tool0; ! home\r\n\
    \tMoveJ Offs(pNest,0,0,80),v1000,z50,tool0; MoveL pNest,v400,zHere,tool0;\r\n\
    \x20   WaitDI diPart,1\\MaxTime:=5\\TimeFlag:=bLate;SetDO doGrip,1;\r\n\
    \x20   GripLoad lPart;\r\n\
    \x20   IF bLate WaitTime 0.2;\r\n\
    \x20   WaitTime 0.3;\r\n\
    \x20   MoveL Offs(pNest,0,0,80),v400,z50,tool0;\r\n\
    \x20   MoveAbsJ jHome,v1000,fine,tool0;\r\n\
    ENDPROC\r\n\
    ENDMODULE\r\n";

fn instrumented(path: &str, out: &Path, more: &[&str]) -> Value {
    let out = out.to_str().unwrap();
    let args =
        ["instrument", path, "--robot", IRB1600, "--out", out, "--format", "json", "--quiet"];
    json(&[&args[..], more].concat())
}

/// The movements and waits of a simulated cycle.
fn steps(path: &str) -> Vec<(String, Option<f64>)> {
    let result = json(&["simulate", path, "--robot", IRB1600, "--format", "json", "--quiet"]);
    let list = |name: &str| result[name].as_array().unwrap().clone();
    let all = list("moves").into_iter().chain(list("waits"));
    let step =
        |it: Value| (it["instruction"].as_str().unwrap().to_owned(), it["duration_s"].as_f64());
    all.map(step).collect()
}

#[test]
fn every_line_stays_and_the_recorder_comes_out_again() {
    let (folder, path) = module(PROGRAM);
    let out = folder.path().join("recorded");
    let result = instrumented(&path, &out, &[]);
    let text = String::from_utf8(fs::read(out.join("m.mod")).unwrap()).unwrap();
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    for line in PROGRAM.lines().filter(|line| line.matches(';').count() < 2) {
        assert!(lines.contains(&line.trim_end()), "{line}\n{text}");
    }
    let calls = [
        "jrCycle;",
        "jrMove 2;",
        "jrDone 4\\Stops:=zHere.finep;",
        "jrWait 5;",
        "jrEnd 5\\Timeout:=bLate;",
        "jrOut 6,1;",
        "jrLoad 7,lPart.mass;",
    ];
    for call in calls {
        assert!(text.contains(call), "{call}\n{text}");
    }
    assert_eq!(result["signals"], serde_json::json!(["diPart"]));
    assert_eq!(result["left_out"].as_array().unwrap().len(), 1, "{}", result["left_out"]);
    assert!(number(&result, "/extra_time/cycle_ms") > 0.0);
    run(&["parse", out.to_str().unwrap()]);
    assert_eq!(steps(&path), steps(out.to_str().unwrap()));

    let back = folder.path().join("back");
    run(&[
        "instrument",
        out.to_str().unwrap(),
        "--remove",
        "--out",
        back.to_str().unwrap(),
        "--quiet",
    ]);
    assert_eq!(
        files(&back).into_iter().collect::<Vec<_>>(),
        [("m.mod".to_owned(), PROGRAM.into())]
    );
}

#[test]
fn endless_programs_have_a_cycle_for_each_pass() {
    let text = PROGRAM.replace(
        "    MoveAbsJ jHome,v1000,fine,tool0; ! home\r\n",
        "    rInit;\r\n    WHILE TRUE DO\r\n    MoveAbsJ jHome,v1000,fine,tool0;\r\n",
    );
    let text = text.replace(
        "ENDPROC\r\n",
        "    ENDWHILE\r\nENDPROC\r\nPROC rInit()\r\n    Reset doGrip;\r\nENDPROC\r\n",
    );
    let (folder, path) = module(&text);
    let out = folder.path().join("recorded");
    instrumented(&path, &out, &[]);
    let text = fs::read_to_string(out.join("m.mod")).unwrap();
    assert_eq!(text.matches("jrCycle;").count(), 2, "{text}");
    let loop_start = text.find("WHILE TRUE DO").unwrap();
    assert!(text[loop_start..].contains("jrCycle;"), "{text}");
}

#[test]
fn the_cells_do_the_same_with_a_recorder() {
    let folder = tempfile::tempdir().unwrap();
    let cells = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/cells");
    let mut programs: Vec<_> = fs::read_dir(cells).unwrap().map(|it| it.unwrap().path()).collect();
    programs.retain(|path| path.is_dir() || path.extension().is_some_and(|it| it == "mod"));
    programs.push(Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/pick_place"));
    programs.sort();
    assert!(programs.len() > 60);
    for (index, program) in programs.iter().enumerate() {
        let path = program.to_str().unwrap();
        // The command compares both cycles itself, and refuses a recorder that changes them.
        let out = folder.path().join(format!("{index}"));
        let result = instrumented(path, &out, &["--axes", "1,2,3"]);
        assert!(number(&result, "/extra_time/cycle_ms") > 0.0, "{path}");
        let back = folder.path().join(format!("{index}-back"));
        run(&[
            "instrument",
            out.to_str().unwrap(),
            "--remove",
            "--out",
            back.to_str().unwrap(),
            "--quiet",
        ]);
        let original = if program.is_dir() {
            files(program)
        } else {
            let name = program.file_name().unwrap().to_str().unwrap().to_owned();
            [(name, fs::read(program).unwrap())].into()
        };
        for (name, bytes) in files(&back) {
            assert_eq!(original.get(&name), Some(&bytes), "{path}: {name}");
        }
    }
}

#[test]
fn the_extra_time_of_the_example_is_within_the_budget() {
    let folder = tempfile::tempdir().unwrap();
    let result = instrumented("fixtures/pick_place", &folder.path().join("out"), &[]);
    let each = number(&result, "/extra_time/movement_ms");
    assert!(each > 0.0 && each <= BUDGET_MS, "{each}");
}

#[test]
fn a_retrofitted_program_is_recorded_at_its_streams() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let optimized = path("optimized");
    run(&["optimize", "fixtures/pick_place", "--point-estimate", "--out", &optimized, "--quiet"]);
    let out = folder.path().join("recorded");
    instrumented(&optimized, &out, &[]);
    let text = String::from_utf8_lossy(&fs::read(out.join("PickPlace.mod")).unwrap()).into_owned();
    let run_at = text.find("jpRun").unwrap();
    let before = text[..run_at].trim_end().lines().last().unwrap().trim().to_owned();
    assert!(before.starts_with("jrMove "), "{before}");
    let streams = |of: &Path| fs::read(of.join("Joulepath.mod")).unwrap();
    assert_eq!(streams(&out), streams(Path::new(&optimized)));
}

#[test]
fn wrong_requests_are_refused() {
    let (folder, path) = module(PROGRAM);
    let out = folder.path().join("recorded");
    let args = ["instrument", &path, "--robot", IRB1600, "--out", out.to_str().unwrap()];
    let with = |more: &[&str], way_out: &str| refused(&[&args[..], more].concat(), way_out);
    with(&["--signals", "diPrat"], "did you mean diPart?");
    with(&["--axes", "7"], "give axes from 1 to 6");
    with(&["--axes", "1", "--rate", "500"], "give 0.1 to 20 samples");
    with(&["--late", "m.mod:9"], "write it as FILE:LINE=SECONDS");
    with(&["--late", "m.mod:8=0.5"], "name a wait");
    with(&["--remove"], "no recorder is among these files");
    assert!(!out.exists());
    instrumented(&path, &out, &["--late", "m.mod:10=0.5"]);
    let recorder = fs::read_to_string(out.join("JlpRecorder.mod")).unwrap();
    assert!(recorder.contains("MOD 2=0 WaitTime 0.5;"), "{recorder}");
    let twice = folder.path().join("twice");
    let args = ["instrument", out.to_str().unwrap(), "--robot", IRB1600, "--out"];
    refused(&[&args[..], &[twice.to_str().unwrap()]].concat(), "is a recorder already");
    let empty = written(&folder, "empty.mod", "MODULE e\nPROC main()\nENDPROC\nENDMODULE\n");
    refused(&["instrument", &empty, "--robot", IRB1600, "--out", "x"], "no movements and no waits");
}
