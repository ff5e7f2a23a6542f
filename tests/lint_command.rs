//! The commands `lint` and `rule`: exit codes, configuration, baselines, fixes, backups.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use joulepath::retime::motion::memo::key;

use command::{joulepath, joulepath_in, parsed, refused, stderr, stdout};

const ROBOT: [&str; 2] = ["--robot", "IRB1600-10/1.45"];
const UNSAFE: [&str; 3] = ["--unsafe-fixes", "--select", "EW103"];

/// A folder with a program of `fixtures/lint`.
fn folder(name: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let from = Path::new("fixtures/lint").join(name);
    fs::copy(from, folder.path().join("Cell.mod")).unwrap();
    folder
}

fn codes(args: &[&str], folder: &Path) -> Vec<String> {
    let args = [&["lint", ".", "--format", "json", "--quiet"], args].concat();
    let output = joulepath_in(folder, &args);
    assert!(output.status.code() < Some(2), "{}", stderr(&output));
    let value = parsed(&output);
    let findings = value["findings"].as_array().unwrap();
    findings.iter().map(|it| it["code"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn exit_codes_agree_with_the_contract() {
    let folder = folder("EW102_stop_in_line.mod");
    let code = |args: &[&str]| {
        let args = [&["lint", "."], args].concat();
        joulepath_in(folder.path(), &args).status.code().unwrap()
    };
    assert_eq!(code(&ROBOT), 0);
    assert_eq!(code(&[&ROBOT[..], &["--max-waste", "100000J"]].concat()), 0);
    assert_eq!(code(&[&ROBOT[..], &["--max-waste", "1J"]].concat()), 1);
    assert_eq!(code(&[&ROBOT[..], &["--max-waste", "0.1%"]].concat()), 1);
    assert_eq!(code(&[&ROBOT[..], &["--max-waste", "much"]].concat()), 2);
    assert_eq!(code(&[&ROBOT[..], &["--max-waste", "-1J"]].concat()), 2);
    assert_eq!(code(&[&ROBOT[..], &["--threshold", "nan"]].concat()), 2);
    assert_eq!(code(&["--max-waste", "1J"]), 2);
    assert_eq!(code(&["--select", "EW999"]), 2);
    assert_eq!(joulepath_in(folder.path(), &["lint", "gone.mod"]).status.code(), Some(2));
}

#[test]
fn syntax_errors_are_noted() {
    let folder = folder("EW101_unneeded_stop_point.mod");
    let broken = "MODULE B\nPROC b()\nIF x THEN\nWaitTime 1;\nENDPROC\nENDMODULE\n";
    fs::write(folder.path().join("Broken.mod"), broken).unwrap();
    let output = joulepath_in(folder.path(), &["lint", "."]);
    let note = "Broken.mod:5: expected ENDIF";
    let message = stderr(&output);
    assert!(message.contains(note) && message.contains("are not linted"), "{message}");
    assert!(!stderr(&joulepath_in(folder.path(), &["lint", "Cell.mod"])).contains("not linted"));
}

#[test]
fn options_and_configuration_select_rules() {
    let folder = folder("EW101_unneeded_stop_point.mod");
    let only = codes(&["--select", "stops"], folder.path());
    assert!(!only.is_empty() && only.iter().all(|code| code.starts_with("EW1")), "{only:?}");
    let none = codes(&["--select", "EW1", "--ignore", "unneeded-stop-point"], folder.path());
    assert!(!none.iter().any(|code| code == "EW101"), "{none:?}");
    let config = "[lint]\nselect = [\"EW101\"]\nthreshold-j = 0.5\n";
    fs::write(folder.path().join("joulepath.toml"), config).unwrap();
    let found = codes(&ROBOT, folder.path());
    assert!(!found.is_empty() && found.iter().all(|code| code == "EW101"), "{found:?}");
    let more = format!("{config}[lint.thresholds-j]\nEW101 = 1e6\n");
    fs::write(folder.path().join("joulepath.toml"), more).unwrap();
    assert!(codes(&ROBOT, folder.path()).is_empty());
    let wrong = format!("{config}[lint.thresholds-j]\nEW999 = 1.0\n");
    fs::write(folder.path().join("joulepath.toml"), wrong).unwrap();
    let output = joulepath_in(folder.path(), &["lint", "."]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("'EW999'"), "{}", stderr(&output));
    let more = format!("{config}[lint.per-file-ignores]\n\"C*.mod\" = [\"stops\"]\n");
    fs::write(folder.path().join("joulepath.toml"), more).unwrap();
    assert!(codes(&ROBOT, folder.path()).is_empty());
}

#[test]
fn a_baseline_hides_known_findings() {
    let folder = folder("EW101_unneeded_stop_point.mod");
    let before = codes(&["--write-baseline", "known.json"], folder.path());
    assert!(!before.is_empty());
    assert!(codes(&["--baseline", "known.json"], folder.path()).is_empty());
    // Moved findings are known, new ones are not.
    let path = folder.path().join("Cell.mod");
    let moved = fs::read_to_string(&path).unwrap().replacen("    VAR", "\n\n    VAR", 1);
    let new = moved.replacen(
        "        rThrough;",
        "        MoveJ Offs(pAUp,-100,100,50),v800,fine,tGripper;\n        rThrough;",
        1,
    );
    fs::write(&path, &moved).unwrap();
    assert!(codes(&["--baseline", "known.json"], folder.path()).is_empty());
    fs::write(&path, &new).unwrap();
    assert_eq!(codes(&["--baseline", "known.json"], folder.path()), ["EW101"]);
    assert_eq!(
        joulepath_in(folder.path(), &["lint", ".", "--baseline", "x"]).status.code(),
        Some(2)
    );
}

#[test]
fn fixes_are_shown_and_written() {
    let folder = folder("EW103_tiny_zone.mod");
    let path = folder.path().join("Cell.mod");
    let before = fs::read(&path).unwrap();
    let output =
        joulepath_in(folder.path(), &[&["lint", ".", "--diff"], &UNSAFE[..], &ROBOT].concat());
    let diff = stdout(&output);
    assert_eq!(diff.lines().filter(|line| line.starts_with("-  ")).count(), 1, "{diff}");
    assert!(diff.contains("+        MoveJ Offs(pAUp,-50,450,100),v1500,z50,tGripper"), "{diff}");
    assert_eq!(fs::read(&path).unwrap(), before);
    // `--fix` alone does not apply fixes that need a review.
    joulepath_in(folder.path(), &[&["lint", ".", "--fix"], &ROBOT[..]].concat());
    assert_eq!(fs::read(&path).unwrap(), before);
    let output = joulepath_in(folder.path(), &[&["lint", "."], &UNSAFE[..], &ROBOT].concat());
    assert!(stderr(&output).contains("1 fixes applied"), "{}", stderr(&output));
    let after = fs::read(&path).unwrap();
    assert_ne!(after, before);
    joulepath_in(folder.path(), &[&["lint", "."], &UNSAFE[..], &ROBOT].concat());
    assert_eq!(fs::read(&path).unwrap(), after);
    // Without a robot no fix can be verified.
    fs::write(&path, &before).unwrap();
    joulepath_in(folder.path(), &[&["lint", "."], &UNSAFE[..]].concat());
    assert_eq!(fs::read(&path).unwrap(), before);
}

#[cfg(unix)]
#[test]
fn read_only_files_are_kept_and_links_stay_links() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = folder("EW103_tiny_zone.mod");
    let path = folder.path().join("Cell.mod");
    let before = fs::read(&path).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o444)).unwrap();
    let fix = |name: &str| {
        let output = joulepath_in(folder.path(), &[&["lint", name], &UNSAFE[..], &ROBOT].concat());
        (output.status.code(), stderr(&output))
    };
    let (code, message) = fix("Cell.mod");
    assert_eq!(code, Some(2));
    assert!(message.contains("Cell.mod' is read-only"), "{message}");
    assert_eq!(fs::read(&path).unwrap(), before);
    fs::set_permissions(&path, fs::Permissions::from_mode(0o644)).unwrap();
    let link = folder.path().join("Link.mod");
    symlink("Cell.mod", &link).unwrap();
    assert_eq!(fix("Link.mod").0, Some(0));
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_ne!(fs::read(&path).unwrap(), before);
}

/// With a cache the result is the same, and what has not changed is not linted again.
#[test]
fn a_cache_keeps_the_findings_of_unchanged_programs() {
    let folder = folder("EW102_stop_in_line.mod");
    fs::copy("fixtures/lint/EW101_unneeded_stop_point.mod", folder.path().join("Other.mod"))
        .unwrap();
    let lint = |more: &[&str]| {
        let args = [&["lint", ".", "--format", "json"], &ROBOT[..], more].concat();
        let output = joulepath_in(folder.path(), &args);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        stdout(&output)
    };
    let cache = folder.path().join(".joulepath_cache");
    let reports = || {
        let all = fs::read_dir(&cache).unwrap().map(|entry| entry.unwrap().path());
        all.filter(|path| path.file_name().unwrap() != ".gitignore").collect::<Vec<_>>()
    };
    let plain = lint(&[]);
    assert!(!cache.exists());
    assert_eq!(lint(&["--cache"]), plain);
    assert_eq!(reports().len(), 2);
    assert_eq!(lint(&["--cache"]), plain);

    // A mark in the kept findings shows where they are used: nobody else knows the key of a text.
    let mark = || {
        for path in reports() {
            let text = fs::read_to_string(&path).unwrap();
            let (_, text) = text.split_once('\n').unwrap();
            let text = text.replace("\"message\":\"", "\"message\":\"kept: ");
            let half: [u8; 16] = key(&text.as_str())[..16].try_into().unwrap();
            let sum = format!("{:032x}", u128::from_be_bytes(half));
            fs::write(path, format!("{sum}\n{text}")).unwrap();
        }
    };
    mark();
    let marked = lint(&["--cache"]);
    assert_eq!(marked.replace("kept: ", ""), plain);
    assert_eq!(marked.matches("\"kept: ").count(), plain.matches("\"message\"").count());
    assert!(!lint(&["--cache", "--threshold", "2"]).contains("kept: "));
    let other = folder.path().join("Other.mod");
    let text = fs::read_to_string(&other).unwrap();
    fs::write(&other, format!("! A comment\n{text}")).unwrap();
    let half = lint(&["--cache"]);
    assert_eq!(half.replace("kept: ", ""), lint(&[]));
    assert!(
        half.contains("kept: ")
            && half.matches("kept: ").count() < marked.matches("kept: ").count()
    );

    // A damaged file is no error, and not believed.
    for path in reports() {
        let text = fs::read_to_string(&path).unwrap();
        fs::write(path, text.replace("EW10", "EW20")).unwrap();
    }
    assert_eq!(lint(&["--cache"]), lint(&[]));
    let output =
        joulepath_in(folder.path(), &["lint", ".", "--format", "json", "--cache=Cell.mod"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(stderr(&output).contains("--cache=FOLDER names another one"), "{}", stderr(&output));
}

/// A program with an absurd number does not use up the budget of the others.
#[test]
fn infinite_energies_are_left_out_of_the_total() {
    let folder = folder("EW101_unneeded_stop_point.mod");
    let endless = "MODULE M\nPROC main()\n  MoveAbsJ [[0,0,0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],\
                   v1000,fine,tool0;\n  WaitTime 1E308;\n  WaitTime 1E308;\nENDPROC\nENDMODULE\n";
    fs::write(folder.path().join("Endless.mod"), endless).unwrap();
    let args = [&["lint", ".", "--format", "json", "--max-waste", "0.001%"], &ROBOT[..]].concat();
    let output = joulepath_in(folder.path(), &args);
    let value = parsed(&output);
    assert!(value["totals"]["cycle_energy_j"].as_f64().is_some_and(|energy| energy > 0.0));
    assert_eq!(output.status.code(), Some(1));
}

#[test]
fn a_closed_output_pipe_is_no_error() {
    let folder = tempfile::tempdir().unwrap();
    let text = "MODULE M\nPROC main()\n  MoveJ pGone,v100,fine,tool0;\nENDPROC\nENDMODULE\n";
    for index in 0..1_000 {
        fs::write(folder.path().join(format!("{index}.mod")), text).unwrap();
    }
    for format in ["concise", "json"] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_joulepath"))
            .args(["lint", ".", "--format", format, "--quiet"])
            .current_dir(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!((output.status.code(), output.stderr), (Some(0), Vec::new()), "{format}");
    }
}

/// Without a robot, unknown joules are not 0 J.
#[test]
fn statistics_show_joules_only_with_a_robot() {
    let folder = folder("EW102_stop_in_line.mod");
    let last = |args: &[&str]| {
        let args = [&["lint", ".", "--statistics", "--select", "EW102"], args].concat();
        let table = stderr(&joulepath_in(folder.path(), &args));
        let row = table.lines().find(|line| line.trim_start().starts_with("EW102")).unwrap();
        row.split_whitespace().last().unwrap().to_owned()
    };
    assert_eq!(last(&[]), "-");
    assert!(last(&ROBOT).parse::<f64>().unwrap() > 1.0);
}

#[test]
fn the_reason_for_missing_joules_is_reported() {
    let folder = folder("EW102_stop_in_line.mod");
    let messages = |args: &[&str]| stderr(&joulepath_in(folder.path(), args));
    let lint = |more: &[&str]| messages(&[&["lint", "Cell.mod"], more].concat());
    assert!(lint(&[]).contains("findings have no joules: no robot is named"));
    let bare = "extends = \"IRB120-3/0.58\"\nname = \"another\"\n";
    fs::write(folder.path().join("bare.toml"), bare).unwrap();
    // An arm with unknown bodies has estimated ones.
    assert_eq!(lint(&["--robot", "bare.toml"]), "");
    assert!(lint(&[&ROBOT[..], &["--entry", "nowhere"]].concat()).contains("--entry NAME"));
    assert_eq!(lint(&ROBOT), "");
    let locked = fs::canonicalize("fixtures/backup/RAPID/TASK2/PROGMOD/Locked.mod").unwrap();
    assert!(messages(&["lint", locked.to_str().unwrap()]).contains("is an encoded module"));
}

/// A backup with or without use of a signal for energy saving, and with or without a brake timeout.
fn backup(io: &str, motion: &str) -> tempfile::TempDir {
    let program = "MODULE M\n    PROC main()\n        WaitTime 60;\n        WaitTime 5;\n    \
                   ENDPROC\nENDMODULE\n";
    backup_with_program(program, io, motion)
}

/// A backup of a program.
fn backup_with_program(program: &str, io: &str, motion: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let modules = folder.path().join("RAPID/TASK1/PROGMOD");
    fs::create_dir_all(&modules).unwrap();
    fs::create_dir_all(folder.path().join("SYSPAR")).unwrap();
    fs::write(modules.join("M.mod"), program).unwrap();
    fs::write(folder.path().join("SYSPAR/EIO.cfg"), io).unwrap();
    fs::write(folder.path().join("SYSPAR/MOC.cfg"), motion).unwrap();
    folder
}

#[test]
fn backups_without_energy_saving_settings_have_findings() {
    let signal = "EIO:CFG_1.0:6:1::\n#\nEIO_SIGNAL:\n\n      -Name \"diSyEnEnSav\" -SignalType \
                  \"DI\" -Label \"System Enable Energy Saving\"\n";
    let unused = backup(signal, "MOC:CFG_1.0:6:0::\n");
    assert_eq!(codes(&["--select", "system"], unused.path()), ["EW801", "EW802"]);
    // A label with the same name does not connect the signal; a statement of another task does.
    let labelled = signal.replace("System Enable Energy Saving", "diSyEnEnSav");
    let labelled = backup(&labelled, "MOC:CFG_1.0:6:0::\n");
    assert_eq!(codes(&["--select", "EW802"], labelled.path()), ["EW802"]);
    let other = labelled.path().join("RAPID/TASK2/PROGMOD");
    fs::create_dir_all(&other).unwrap();
    let text = "MODULE N\n    PROC main()\n        WaitDI diSyEnEnSav,1;\n    ENDPROC\nENDMODULE\n";
    fs::write(other.join("N.mod"), text).unwrap();
    assert!(codes(&["--select", "EW802"], labelled.path()).is_empty());
    let used = format!("{signal}#\nSYSSIG_IN:\n\n      -Signal \"diSyEnEnSav\" -Action \"X\"\n");
    let motion = "MOC:CFG_1.0:6:0::\n#\nMOTION_PLANNER:\n\n      -brake_on_timeout 10\n";
    let used = backup(&used, motion);
    assert!(codes(&["--select", "system"], used.path()).is_empty());
}

/// Three planted faults and three near misses of each rule that needs a backup.
#[test]
fn backup_rules_find_planted_faults_and_no_near_misses() {
    let motion = "MOC:CFG_1.0:6:0::\n";
    let timeout = "MOC:CFG_1.0:6:0::\n#\nMOTION_PLANNER:\n\n      -brake_on_timeout 10\n";
    let io = "EIO:CFG_1.0:6:1::\n";
    let program = |body: &str| format!("MODULE M\nPROC main()\n{body}\nENDPROC\nENDMODULE\n");
    let brakes = [
        ("WaitTime 45;", motion, true),
        ("Set doCool;\nWaitTime 120;\nReset doCool;", motion, true),
        ("FOR i FROM 1 TO 3 DO\nWaitTime 90;\nENDFOR", motion, true),
        ("WaitTime 2;", motion, false),
        ("WaitTime 45;", timeout, false),
        ("WaitDI diDone,1;", motion, false),
    ];
    for (body, motion, fires) in brakes {
        let folder = backup_with_program(&program(body), io, motion);
        let found = codes(&["--select", "EW801"], folder.path());
        assert_eq!(found.contains(&"EW801".to_owned()), fires, "{body} {motion}");
    }
    let signal = |name: &str, label: &str| {
        format!(
            "{io}#\nEIO_SIGNAL:\n\n      -Name \"{name}\" -SignalType \"DI\" -Label \"{label}\"\n"
        )
    };
    let tied = format!(
        "{}#\nSYSSIG_IN:\n\n      -Signal \"diSave\" -Action \"X\"\n",
        signal("diSave", "Energy saving")
    );
    let signals = [
        (signal("diEnSave", "Enable energy saving"), "WaitTime 1;", true),
        (signal("diSleep", "PROFIenergy pause"), "WaitTime 1;", true),
        (signal("diSpar", "Energie sparen"), "Set doLamp;", true),
        (tied, "WaitTime 1;", false),
        (signal("diEnSave", "Enable energy saving"), "WaitDI diEnSave,0;", false),
        (signal("diDoor", "Door closed"), "WaitTime 1;", false),
    ];
    for (io, body, fires) in signals {
        let folder = backup_with_program(&program(body), &io, motion);
        let found = codes(&["--select", "EW802"], folder.path());
        assert_eq!(found.contains(&"EW802".to_owned()), fires, "{body} {io}");
    }
}

#[test]
fn rule_shows_the_manual() {
    let output = stdout(&joulepath(&["rule", "EW101"]));
    assert!(output.starts_with("# EW101 unneeded-stop-point"), "{output}");
    assert!(output.contains("## Why it wastes energy"));
    let list = stdout(&joulepath(&["rule"]));
    assert!(list.lines().count() > 30 && list.contains("EW802"), "{list}");
    refused(&["rule", "EW1011"], "did you mean EW101");
}

/// A folder of unrelated programs with an entry each is linted file by file.
#[test]
fn unrelated_programs_are_linted_separately() {
    let args = [&["lint", "fixtures/lint", "--format", "json", "--quiet"], &ROBOT[..]].concat();
    let value = parsed(&joulepath(&args));
    let findings = value["findings"].as_array().unwrap();
    let has = |code: &str| findings.iter().any(|finding| finding["code"] == code);
    assert!(has("EW101") && has("EW405") && has("EW703"));
}

/// No file content makes the command fail.
#[test]
fn broken_programs_are_linted_too() {
    for folder in ["fixtures/syntax/err", "fixtures/syntax/ok", "fixtures/hard", "fixtures/backup"]
    {
        for robot in [&ROBOT[..], &[]] {
            let args = [&["lint", folder, "--format", "concise", "--quiet"], robot].concat();
            let output = joulepath(&args);
            assert_eq!(output.status.code(), Some(0), "{folder}: {}", stderr(&output));
        }
    }
}

/// The pre-commit hook receives the changed files and also reads the rest of their program.
#[test]
fn the_pre_commit_hook_reads_whole_programs() {
    let hook = fs::read_to_string(".pre-commit-hooks.yaml").unwrap();
    let field = |name: &str| hook.lines().find_map(|line| line.trim().strip_prefix(name)).unwrap();
    assert_eq!(field("pass_filenames:").trim(), "false");
    let paths = field("args:").trim().trim_matches(['[', ']']);
    let entry = field("entry:").trim().strip_prefix("joulepath ").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let data = "MODULE Data\n  CONST jointtarget jHome:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nENDMODULE\n";
    let main =
        "MODULE Cell\n  PROC main()\n    MoveAbsJ jHome,v500,fine,tool0;\n  ENDPROC\nENDMODULE\n";
    fs::write(folder.path().join("Data.mod"), data).unwrap();
    fs::write(folder.path().join("Cell.mod"), main).unwrap();
    let args: Vec<&str> = entry.split_whitespace().chain([paths]).collect();
    let output = joulepath_in(folder.path(), &args);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(stdout(&output), "");
    // A single file alone would have a finding.
    let alone = joulepath_in(folder.path(), &["lint", "Cell.mod", "--format", "concise"]);
    assert!(stdout(&alone).contains("EW704"), "{}", stdout(&alone));
}
