//! `joulepath check`: planted faults, legal near misses, shipped and generated programs.

#![expect(clippy::unwrap_used, reason = "what cannot be run or read fails the test")]

mod command;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use command::{IRB1600, joulepath, parsed, refused, run, stdout};
use serde_json::Value;

/// Least number of planted faults.
const PLANTED: usize = 60;

fn check(paths: &[&str]) -> Output {
    joulepath(&[&["check", "--format", "json", "--quiet"], paths].concat())
}

fn entries(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut paths: Vec<PathBuf> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

fn modules(path: &Path) -> Vec<PathBuf> {
    if path.is_file() {
        return vec![path.to_path_buf()];
    }
    let mut paths: Vec<PathBuf> =
        fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "mod"));
    paths
}

/// `! error: text`, `! warning: text` in the lines of a module: file, line, severity and a part of
/// the message.
fn expected(path: &Path) -> Vec<(String, u64, String, String)> {
    let name = path.file_name().unwrap().to_str().unwrap();
    let text = fs::read_to_string(path).unwrap();
    let mut all = Vec::new();
    for (index, line) in text.lines().enumerate() {
        for part in line.split("! ").skip(1) {
            if let Some((severity, message)) = part.split_once(": ")
                && ["error", "warning"].contains(&severity)
            {
                let message = message.trim().to_owned();
                all.push((name.to_owned(), index as u64 + 1, severity.to_owned(), message));
            }
        }
    }
    all
}

/// Checks a module or folder, and compares the findings with those that its comments expect.
/// Returns their number.
fn assert_expected(path: &Path) -> usize {
    let output = check(&[path.to_str().unwrap()]);
    let value = parsed(&output);
    let mut found: Vec<&Value> = value["findings"].as_array().unwrap().iter().collect();
    let wanted: Vec<_> = modules(path).iter().flat_map(|path| expected(path)).collect();
    for (file, line, severity, message) in &wanted {
        let place = found.iter().position(|finding| {
            finding["file"].as_str().unwrap().ends_with(&format!("/{file}"))
                && finding["line"] == *line
                && finding["severity"] == severity.as_str()
                && finding["message"].as_str().unwrap().contains(message)
        });
        let Some(place) = place else {
            panic!("{}: {file}:{line}: no {severity}: {message}\n{found:#?}", path.display())
        };
        let finding = found.remove(place);
        assert!(!finding["help"].as_str().unwrap().is_empty(), "{finding} has no way out");
    }
    assert!(found.is_empty(), "{}: not expected: {found:#?}", path.display());
    let fails = wanted.iter().any(|(_, _, severity, _)| severity == "error");
    assert_eq!(output.status.code(), Some(i32::from(fails)), "{}", path.display());
    wanted.len()
}

#[test]
fn planted_faults_are_found_and_nothing_else() {
    let mut count = 0;
    for path in entries("fixtures/check/faults") {
        let here = assert_expected(&path);
        assert!(here > 0, "{} expects nothing", path.display());
        count += here;
    }
    for path in entries("fixtures/check/tasks") {
        count += assert_expected(&path);
    }
    assert!(count >= PLANTED, "only {count} planted faults");
}

#[test]
fn legal_programs_have_no_findings() {
    for path in entries("fixtures/check/legal") {
        assert_eq!(assert_expected(&path), 0, "{}", path.display());
    }
}

fn assert_no_error(paths: &[&str]) {
    let value = parsed(&check(paths));
    let errors: Vec<&Value> = value["findings"].as_array().unwrap().iter().collect();
    let errors: Vec<&&Value> = errors.iter().filter(|it| it["severity"] == "error").collect();
    assert!(errors.is_empty(), "{paths:?}: {errors:#?}");
}

#[test]
fn shipped_programs_have_no_errors() {
    for folder in ["backup", "cells", "changes", "hard", "lint", "paper", "pick_place"] {
        if folder != "hard" {
            assert_no_error(&[&format!("fixtures/{folder}")]);
        }
        for path in entries(&format!("fixtures/{folder}")) {
            // Its one syntax error is what this program is about.
            let broken = path.ends_with("unknown_instruction.mod");
            if path.extension().is_some_and(|it| it == "mod" || it == "sys") && !broken {
                assert_no_error(&[path.to_str().unwrap()]);
            }
        }
    }
}

#[test]
fn written_programs_have_no_errors() {
    let folder = tempfile::tempdir().unwrap();
    let out = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let points = out("points.csv");
    fs::write(&points, "q1,q2,q3,q4,q5,q6\n0,0,0,0,0.5,0\n0.2,0.1,0,0,0.5,0\n").unwrap();
    let (generated, instrumented) = (out("generated"), out("instrumented"));
    let (excited, optimized) = (out("excited"), out("optimized"));
    run(&["generate", &points, "--robot", IRB1600, "--out", &generated, "--quiet"]);
    run(&["excite", "--robot", IRB1600, "--out", &excited, "--quiet"]);
    run(&["instrument", "fixtures/pick_place", "--robot", IRB1600, "--out", &instrumented]);
    run(&["optimize", "fixtures/paper", "--robot", IRB1600, "--out", &optimized, "--quiet"]);
    for written in [generated, excited, instrumented, optimized] {
        assert_no_error(&[&written]);
    }
}

#[test]
fn a_complete_backup_knows_the_signals() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let write = |name: &str, text: &str| {
        fs::create_dir_all(path(name).parent().unwrap()).unwrap();
        fs::write(path(name), text).unwrap();
    };
    write(
        "SYSPAR/EIO.cfg",
        "EIO:CFG_1.0:6:0::\n#\nEIO_SIGNAL:\n\n      -Name \"doGrip\" -SignalType \"DO\"\n",
    );
    let text = "MODULE Main\n  PROC main()\n    Set doGrip;\n    Set doGirp;\n    Set doOther;\n    rGone;\n  ENDPROC\nENDMODULE\n";
    write("RAPID/TASK1/PROGMOD/Main.mod", text);
    let messages = |path: &str| -> Vec<String> {
        let value = parsed(&check(&[path]));
        let findings = value["findings"].as_array().unwrap();
        findings
            .iter()
            .map(|it| format!("{}:{}: {}", it["line"], it["severity"], it["message"]))
            .collect()
    };
    let found = messages(folder.path().to_str().unwrap());
    assert_eq!(found.len(), 3, "{found:?}");
    assert!(found[0].starts_with("4:\"error\"") && found[0].contains("doGirp"), "{found:?}");
    assert!(found[1].starts_with("5:\"warning\"") && found[1].contains("doOther"), "{found:?}");
    assert!(found[2].starts_with("6:\"warning\"") && found[2].contains("rGone"), "{found:?}");
    // One module of a task of which others are not given.
    write("RAPID/TASK1/SYSMOD/Other.sys", "MODULE Other\nENDMODULE\n");
    let found = messages(path("RAPID/TASK1/PROGMOD/Main.mod").to_str().unwrap());
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].starts_with("6:\"warning\""), "{found:?}");
}

#[test]
fn formats_and_exit_codes() {
    let fault = "fixtures/check/faults/entry_function.mod";
    let output = joulepath(&["check", fault, "--quiet"]);
    assert_eq!(output.status.code(), Some(1));
    let text = stdout(&output);
    assert!(text.contains("error[entry]: main, which starts the program, is no PROC"), "{text}");
    assert!(text.contains("help: declare it as PROC"), "{text}");
    assert!(text.ends_with("1 file: 1 error, 0 warnings\n"), "{text}");
    let output = joulepath(&["check", fault, "--quiet", "--format", "concise"]);
    let line = format!(
        "{fault}:2:12: error[entry]: main, which starts the program, is no PROC; declare it as PROC\n"
    );
    assert_eq!(stdout(&output), line);
    assert_eq!(joulepath(&["check", "fixtures/pick_place"]).status.code(), Some(0));
    refused(&["check", "gone.mod"], "gone.mod");
    refused(&["check", "fixtures/backup/RAPID/TASK2/PROGMOD/Locked.mod"], "only encoded modules");
}

/// Damaged programs give findings, and always the same.
#[test]
fn damaged_programs_are_checked() {
    let text = fs::read("fixtures/pick_place/PickPlace.mod").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("damaged.mod");
    let mut codes = BTreeSet::new();
    for cut in (0..text.len()).step_by(text.len() / 12) {
        let mut damaged = text[..cut].to_vec();
        damaged.extend_from_slice(&text[(cut + 40).min(text.len())..]);
        fs::write(&path, &damaged).unwrap();
        let first = check(&[path.to_str().unwrap()]);
        let second = check(&[path.to_str().unwrap()]);
        assert_eq!(first.stdout, second.stdout);
        codes.extend(first.status.code());
    }
    assert!(codes.contains(&1) && codes.iter().all(|code| *code <= 1), "{codes:?}");
}
