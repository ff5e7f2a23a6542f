//! Controller backups through the binary: selected task and messages.
#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

mod command;

use std::fs;
use std::path::Path;

use command::{files, joulepath, parsed, refused, run, stderr};
use serde_json::Value;

/// The fixture without the configuration in its parent folders.
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

/// Executed instructions, and the notes.
fn simulated(path: &Path) -> (Vec<String>, String) {
    let output = run(&["simulate", path.to_str().unwrap(), "--format", "json"]);
    let (notes, value) = (stderr(&output), parsed(&output));
    let moves = value["moves"].as_array().unwrap().iter();
    (moves.map(|step| step["instruction"].as_str().unwrap().to_owned()).collect(), notes)
}

#[test]
fn a_backup_runs_its_motion_task_with_its_own_robot() {
    let backup = backup();
    let (moves, notes) = simulated(backup.path());
    assert_eq!(moves, ["MoveAbsJ", "MoveJ", "MoveL", "MoveL", "MoveAbsJ"]);
    assert!(notes.contains("T_ROB1 (RAPID/TASK2)"), "{notes}");
    assert!(notes.contains("ROB1_1600_1.45_10"), "{notes}");
    // A subfolder or a single module selects the same robot.
    assert_eq!(simulated(&backup.path().join("RAPID/TASK2")).0, moves);
    let module = backup.path().join("RAPID/TASK2/PROGMOD/MainModule.mod");
    assert_eq!(simulated(&module).0, moves);
}

#[test]
fn several_motion_tasks_cause_a_note_that_names_them() {
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
fn several_backups_in_one_folder_cannot_be_simulated() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["monday", "tuesday"] {
        copy(Path::new("fixtures/backup"), &folder.path().join(name));
    }
    let path = folder.path().to_str().unwrap();
    let error = refused(&["simulate", path], "monday");
    assert!(error.contains("tuesday"), "{error}");
    // Reading them is no problem.
    assert_eq!(joulepath(&["parse", path]).status.code(), Some(0));
}

#[test]
fn an_unknown_robot_of_a_backup_is_named_in_the_error() {
    let backup = backup();
    let motion = backup.path().join("SYSPAR/MOC.cfg");
    let text = fs::read_to_string(&motion).unwrap();
    fs::write(&motion, text.replace("ROB1_1600_1.45_10", "ROB1_9999_1.0_5")).unwrap();
    let error = refused(&["simulate", backup.path().to_str().unwrap()], "ROB1_9999_1.0_5");
    assert!(error.contains("--robot"), "{error}");
}

#[test]
fn parse_reads_every_task_and_lists_robot_and_version() {
    let value = parsed(&joulepath(&["parse", "fixtures/backup", "--format", "json"]));
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

/// The task lists the new module; every other byte is unchanged.
fn assert_lists_the_new_module(before: &[u8], after: &[u8]) {
    let line = "PROGMOD/Locked.mod @ ";
    let before = String::from_utf8(before.to_vec()).unwrap();
    let end = if before.contains("\r\n") { "\r\n" } else { "\n" };
    let longer = format!("{line}{end}PROGMOD/Joulepath.mod @ {end}");
    assert_eq!(String::from_utf8_lossy(after), before.replace(&format!("{line}{end}"), &longer));
}

const INFO: &str = "BACKINFO/backinfo.txt";
const NEW: &str = "RAPID/TASK2/PROGMOD/Joulepath.mod";

#[test]
fn the_output_for_a_backup_is_a_complete_backup() {
    for end in ["\n", "\r\n"] {
        let backup = backup();
        let info = backup.path().join(INFO);
        let text = fs::read_to_string(&info).unwrap().replace("\r\n", "\n").replace('\n', end);
        fs::write(&info, text).unwrap();
        let before = files(backup.path());
        // Also inside the backup.
        let out = backup.path().join("out");
        let path = backup.path().to_str().unwrap();
        run(&["optimize", path, "--out", out.to_str().unwrap(), "--quiet"]);
        let mut after = files(&out);
        assert_lists_the_new_module(&before[INFO], &after.remove(INFO).unwrap());
        assert!(after.remove(NEW).is_some());
        let main = "RAPID/TASK2/PROGMOD/MainModule.mod";
        assert_ne!(after.remove(main).unwrap(), before[main]);
        after.remove("joulepath_brakes.txt");
        for (path, bytes) in &after {
            assert_eq!(before.get(path), Some(bytes), "{path}");
        }
        assert_eq!(after.len() + 2, before.len(), "{:?}", after.keys());
        // The output is a readable backup.
        let (moves, notes) = simulated(&out);
        assert!(moves.len() >= 5 && notes.contains("T_ROB1 (RAPID/TASK2)"), "{moves:?} {notes}");
    }
}

#[test]
fn undo_restores_a_backup_that_was_changed_in_place() {
    let folder = tempfile::tempdir().unwrap();
    let backup = folder.path().join("monday");
    copy(Path::new("fixtures/backup"), &backup);
    let before = files(folder.path());
    // Also with the name of a task or of its module.
    for named in ["", "RAPID/TASK2", "RAPID/TASK2/PROGMOD/MainModule.mod"] {
        let path = if named.is_empty() { backup.clone() } else { backup.join(named) };
        let path = path.to_str().unwrap();
        run(&["optimize", path, "--in-place", "--quiet"]);
        let after = files(&backup);
        assert_lists_the_new_module(&before["monday/BACKINFO/backinfo.txt"], &after[INFO]);
        assert!(after.contains_key(NEW));
        assert!(!after.keys().any(|path| path.contains(".bak") || path.contains("undo")));
        let kept = files(&folder.path().join("monday.joulepath-undo"));
        assert!(kept.contains_key("manifest.json") && kept.contains_key(&format!("files/{INFO}")));
        run(&["optimize", path, "--undo"]);
        assert_eq!(files(folder.path()), before, "{named}");
    }
}
