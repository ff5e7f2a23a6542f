//! Controller backups through the binary: what is chosen, what is said.
#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn joulepath(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_joulepath")).args(args).output().unwrap()
}

/// The fixture away from the configuration that lies above it.
fn backup() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    copy(Path::new("fixtures/backup"), folder.path());
    folder
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
        let target = to.join(entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            copy(&entry.path(), &target);
        } else {
            fs::copy(entry.path(), target).unwrap();
        }
    }
}

/// Instructions that ran, and the notes.
fn simulated(path: &Path) -> (Vec<String>, String) {
    let output = joulepath(&["simulate", path.to_str().unwrap(), "--format", "json"]);
    let notes = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{notes}");
    let value: Value = serde_json::from_slice(&output.stdout).unwrap();
    let moves = value["moves"].as_array().unwrap().iter();
    (moves.map(|step| step["instruction"].as_str().unwrap().to_owned()).collect(), notes)
}

#[test]
fn the_task_that_moves_the_robot_is_run_with_the_robot_of_the_backup() {
    let backup = backup();
    let (moves, notes) = simulated(backup.path());
    assert_eq!(moves, ["MoveAbsJ", "MoveJ", "MoveL", "MoveL", "MoveAbsJ"]);
    assert!(notes.contains("T_ROB1 (RAPID/TASK2)"), "{notes}");
    assert!(notes.contains("ROB1_1600_1.45_10"), "{notes}");
    // From inside and from one named module it is the same robot.
    assert_eq!(simulated(&backup.path().join("RAPID/TASK2")).0, moves);
    let module = backup.path().join("RAPID/TASK2/PROGMOD/MainModule.mod");
    assert_eq!(simulated(&module).0, moves);
}

#[test]
fn several_motion_tasks_are_stated_with_the_way_to_choose() {
    let backup = backup();
    let system = backup.path().join("SYSPAR/SYS.cfg");
    let text = fs::read_to_string(&system).unwrap();
    let text = text.replace("-Type \"SEMISTATIC\"", "-MotionTask").replace("T_WATCH", "T_ROB2");
    fs::write(&system, text).unwrap();
    let info = backup.path().join("BACKINFO/backinfo.txt");
    fs::write(&info, fs::read_to_string(&info).unwrap().replace("T_WATCH", "T_ROB2")).unwrap();
    let (moves, notes) = simulated(backup.path());
    assert_eq!(moves.len(), 5, "T_ROB1 comes before T_ROB2, though its folder is the later one");
    assert!(notes.contains("T_ROB2 (RAPID/TASK1)"), "{notes}");
    assert!(notes.contains("BACKUP/RAPID/TASK1"), "{notes}");
    assert!(simulated(&backup.path().join("RAPID/TASK1")).0.is_empty());
}

#[test]
fn several_backups_are_not_one_program() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["monday", "tuesday"] {
        copy(Path::new("fixtures/backup"), &folder.path().join(name));
    }
    let path = folder.path().to_str().unwrap();
    let output = joulepath(&["simulate", path]);
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2));
    assert!(error.contains("monday") && error.contains("tuesday"), "{error}");
    // Reading them is no problem.
    assert_eq!(joulepath(&["parse", path]).status.code(), Some(0));
}

#[test]
fn a_robot_that_is_not_known_is_named() {
    let backup = backup();
    let motion = backup.path().join("SYSPAR/MOC.cfg");
    let text = fs::read_to_string(&motion).unwrap();
    fs::write(&motion, text.replace("ROB1_1600_1.45_10", "ROB1_9999_1.0_5")).unwrap();
    let output = joulepath(&["simulate", backup.path().to_str().unwrap()]);
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2));
    assert!(error.contains("ROB1_9999_1.0_5") && error.contains("--robot"), "{error}");
}

#[test]
fn parse_reads_every_task_and_tells_what_the_backup_says() {
    let output = joulepath(&["parse", "fixtures/backup", "--format", "json"]);
    let value: Value = serde_json::from_slice(&output.stdout).unwrap();
    let field = |file: &Value, key: &str| file[key].as_str().unwrap_or_default().to_owned();
    let files = value["files"].as_array().unwrap();
    let tasks: Vec<String> = files.iter().map(|file| field(file, "task")).collect();
    assert_eq!(tasks, ["", "T_WATCH", "T_WATCH", "T_ROB1", "T_ROB1", "T_ROB1"]);
    assert_eq!(value["totals"]["lossless"], 6);
    assert_eq!(files[3]["encoded"], true);
    let tasks = value["backups"][0]["tasks"].as_array().unwrap();
    assert_eq!(field(&tasks[1], "robot"), "ROB1_1600_1.45_10");
    assert_eq!(value["backups"][0]["robotware"], "6.08.01.00");
}

#[test]
fn the_retrofit_of_a_backup_is_its_whole_program() {
    let backup = backup();
    let out = backup.path().join("out");
    let path = backup.path().to_str().unwrap();
    let output = joulepath(&["optimize", path, "--out", out.to_str().unwrap(), "--quiet"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    for file in ["PROGMOD/MainModule.mod", "PROGMOD/Locked.mod", "SYSMOD/user.sys"] {
        assert!(out.join("RAPID/TASK2").join(file).is_file(), "{file}");
    }
    assert!(!out.join("RAPID/TASK1").exists(), "another task's program");
    let before = fs::read(backup.path().join("RAPID/TASK2/PROGMOD/Locked.mod")).unwrap();
    assert_eq!(fs::read(out.join("RAPID/TASK2/PROGMOD/Locked.mod")).unwrap(), before);
}
