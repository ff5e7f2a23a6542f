//! The command `diff`: sides, revisions, cycles, forms of the result, exit codes.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use command::{IRB1600, files, joulepath_in, number, parsed, refused, stderr, stdout};
use serde_json::Value;
use tempfile::TempDir;

const OLD: &str = "MODULE Cell
  CONST jointtarget jHome:=[[0,-12,14,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget p10:=[[700,0,600],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget p20:=[[700,200,600],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveAbsJ jHome,v1000,fine,tool0;
    MoveJ p10,v1000,fine,tool0;
    rWork;
  ENDPROC
  PROC rWork()
    MoveL p20,v100,fine,tool0;
    WaitTime 0.5;
    MoveL p10,v100,fine,tool0;
  ENDPROC
  PROC rNever()
    WaitTime 3;
  ENDPROC
ENDMODULE
";

/// A folder with two files.
fn pair(old: &str, new: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("old.mod"), old).unwrap();
    fs::write(folder.path().join("new.mod"), new).unwrap();
    folder
}

fn diff(folder: &Path, args: &[&str]) -> Output {
    joulepath_in(folder, &[&["diff"], args].concat())
}

fn json(folder: &Path, args: &[&str]) -> Value {
    let output = diff(folder, &[args, &["--format", "json", "--quiet"]].concat());
    assert!(output.status.code() < Some(2), "{}", stderr(&output));
    let value = parsed(&output);
    assert_eq!(value["same"].as_bool().unwrap(), output.status.success());
    value
}

fn git(folder: &Path, args: &[&str]) -> Output {
    let identity = ["-c", "user.name=x", "-c", "user.email=x@example.com"];
    let output =
        Command::new("git").args(identity).args(args).current_dir(folder).output().unwrap();
    assert!(output.status.success(), "git {args:?}: {}", stderr(&output));
    output
}

/// A repository whose last commit moved a target, and whose working tree changed a wait.
fn repository() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    fs::create_dir(root.join("cell")).unwrap();
    git(root, &["init", "-q"]);
    fs::write(root.join("cell/Main.mod"), OLD).unwrap();
    git(root, &["add", "."]);
    git(root, &["commit", "-qm", "one"]);
    let moved = OLD.replace("[700,200,600]", "[700,210,600]");
    fs::write(root.join("cell/Main.mod"), &moved).unwrap();
    git(root, &["commit", "-qam", "two"]);
    fs::write(root.join("cell/Main.mod"), moved.replace("WaitTime 0.5", "WaitTime 0.8")).unwrap();
    folder
}

fn messages(value: &Value) -> Vec<&str> {
    value["changes"].as_array().unwrap().iter().map(|c| c["message"].as_str().unwrap()).collect()
}

#[test]
fn exit_codes_tell_whether_the_meaning_is_the_same() {
    let folder = pair(OLD, &OLD.to_lowercase().replace('\n', "\r\n\r\n! comment\r\n"));
    let code = |args: &[&str]| diff(folder.path(), args).status.code().unwrap();
    assert_eq!(code(&["old.mod", "new.mod"]), 0);
    fs::write(folder.path().join("new.mod"), OLD.replace("0.5", "0.6")).unwrap();
    assert_eq!(code(&["old.mod", "new.mod"]), 1);
    assert_eq!(code(&["old.mod"]), 2);
    assert_eq!(code(&["old.mod", "gone.mod"]), 2);
    assert_eq!(code(&["old.mod", "new.mod", "--robot", "nobody"]), 2);
    assert_eq!(code(&["old.mod", "new.mod", "--report", "new.mod"]), 2);
    // A file that was added or deleted, as git names it.
    assert_eq!(code(&["/dev/null", "new.mod"]), 1);
    assert_eq!(code(&["old.mod", "/dev/null"]), 1);
}

#[test]
fn each_change_is_a_line_with_both_places() {
    let folder = pair(OLD, &format!("\n\n{}", OLD.replace("p20,v100", "p20,v50")));
    let output = diff(folder.path(), &["old.mod", "new.mod"]);
    let text = stdout(&output);
    let expected = "Cell.rWork\n  changed speed        MoveL p20: speed v100 → v50 (v_tcp 100 → 50)  \
                    [old.mod:11 → new.mod:13]\n";
    assert!(text.starts_with(expected), "{text}");
    assert!(text.contains("the cycles are not compared: no robot is known"), "{text}");
    let same = stdout(&diff(folder.path(), &["old.mod", "old.mod"]));
    assert!(same.starts_with("Nothing changed in meaning.\n"), "{same}");
}

#[test]
fn cycles_are_those_of_two_simulations() {
    let folder = pair(OLD, &OLD.replace("p20,v100", "p20,v50").replace("WaitTime 3", "WaitTime 4"));
    let options = ["--robot", IRB1600];
    let value = json(folder.path(), &[&["old.mod", "new.mod"], &options[..]].concat());
    let simulated = |name: &str| {
        let args = [&["simulate", name, "--format", "json", "--quiet"], &options[..]].concat();
        let value = parsed(&joulepath_in(folder.path(), &args));
        [number(&value, "/cycle_s"), number(&value, "/energy_j")]
    };
    let (old, new) = (simulated("old.mod"), simulated("new.mod"));
    assert!((number(&value, "/totals/delta_s") - (new[0] - old[0])).abs() < 1e-9);
    assert!((number(&value, "/totals/delta_j") - (new[1] - old[1])).abs() < 1e-6);
    assert!(number(&value, "/totals/delta_s") > 1.0);
    let procedures = value["cycles"][0]["procedures"].as_array().unwrap();
    let of = |name: &str| procedures.iter().find(|row| row["name"] == name).unwrap();
    // The change is in the procedure with the slower movement.
    let sum: f64 = procedures.iter().filter_map(|row| row["delta_j"].as_f64()).sum();
    assert!((sum - number(&value, "/totals/delta_j")).abs() < 1e-6);
    assert!((of("rWork")["delta_s"].as_f64().unwrap() - (new[0] - old[0])).abs() < 1e-6);
    assert_eq!(of("main")["delta_s"], 0.0);
    let never = of("rNever");
    assert!(never["old"].is_null() && never["delta_j"].is_null());
    assert_eq!(never["reason"], "without movements and waits of its own in both cycles");
    let interval = value["cycles"][0]["delta_interval_j"].as_array().unwrap();
    let [low, high] = [0, 1].map(|i| interval[i].as_f64().unwrap());
    assert!(low < number(&value, "/totals/delta_j") && number(&value, "/totals/delta_j") < high);
    // Without a robot there are no figures, and a reason.
    let value = json(folder.path(), &["old.mod", "new.mod"]);
    assert!(value["totals"]["delta_j"].is_null());
    let row = &value["cycles"][0]["procedures"][0];
    assert!(row["old"].is_null() && row["reason"].as_str().unwrap().contains("--robot"), "{row}");
    // A program that does not start.
    let value =
        json(folder.path(), &["old.mod", "new.mod", "--robot", IRB1600, "--entry", "nothing"]);
    assert!(value["cycles"][0]["reason"].as_str().unwrap().contains("nothing"));
}

#[test]
fn revisions_of_git_are_sides() {
    let folder = repository();
    let root = folder.path();
    let moved = "p20 moved by 10 mm (y +10)";
    let waits = "WaitTime 0.8: Time 0.5 → 0.8";
    let check = |folder: &Path, args: &[&str], expected: &[&str]| {
        assert_eq!(messages(&json(folder, args)), expected, "{args:?}");
    };
    check(root, &["HEAD~1", "HEAD"], &[moved]);
    check(root, &["HEAD~1:cell/Main.mod", "HEAD:cell"], &[moved]);
    check(root, &["--git", "HEAD"], &[waits]);
    check(root, &["--git", "HEAD~1", "cell/Main.mod"], &[moved, waits]);
    check(root, &["HEAD", "cell"], &[waits]);
    check(&root.join("cell"), &["HEAD:./Main.mod", "Main.mod"], &[waits]);
    check(&root.join("cell"), &["--git", "HEAD"], &[waits]);
    // A file that is gone.
    fs::rename(root.join("cell/Main.mod"), root.join("kept")).unwrap();
    let gone = json(root, &["--git", "HEAD", "cell/Main.mod"]);
    assert!(messages(&gone)[0].starts_with("module Cell with 3 routines"), "{gone}");
    fs::rename(root.join("kept"), root.join("cell/Main.mod")).unwrap();
    // From outside.
    let outside = tempfile::tempdir().unwrap();
    let path = root.join("cell");
    check(outside.path(), &["--git", "HEAD~1", path.to_str().unwrap()], &[moved, waits]);
    let value = json(root, &["HEAD~1", "HEAD"]);
    assert_eq!(value["changes"][0]["old"]["file"], "HEAD~1:cell/Main.mod");
    assert_eq!(value["changes"][0]["old"]["line"], 4);
    let says = |args: &[&str], way_out: &str| {
        let output = diff(root, args);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(way_out), "{message}");
    };
    says(&["--git", "nobody"], "no revision 'nobody'");
    says(&["nobody", "HEAD"], "'nobody' is no file or folder, and no git revision");
    says(&["HEAD:other", "HEAD"], "no RAPID in 'other'");
    says(&["--git", "HEAD", "a", "b"], "name one");
    let output = diff(outside.path(), &["--git", "HEAD"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("not a git repository"), "{}", stderr(&output));
    // Without git.
    let output = Command::new(env!("CARGO_BIN_EXE_joulepath"))
        .args(["diff", "--git", "HEAD"])
        .current_dir(root)
        .env("PATH", outside.path())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("the command git is not there"), "{}", stderr(&output));
}

#[test]
fn git_shows_the_meaning_by_textconv_and_difftool() {
    let folder = repository();
    let root = folder.path();
    let program = env!("CARGO_BIN_EXE_joulepath");
    fs::write(root.join(".gitattributes"), "*.mod diff=rapid\n").unwrap();
    git(root, &["config", "diff.rapid.textconv", &format!("{program} diff --textconv")]);
    git(root, &["config", "difftool.rapid.cmd", &format!("{program} diff \"$LOCAL\" \"$REMOTE\"")]);
    let shown = stdout(&git(root, &["diff", "HEAD"]));
    let changed: Vec<&str> = shown
        .lines()
        .filter(|line| {
            line.starts_with(['+', '-']) && !line.starts_with("++") && !line.starts_with("--")
        })
        .collect();
    assert_eq!(changed, ["-    WaitTime 0.5;", "+    WaitTime 0.8;"], "{shown}");
    let shown = git(root, &["difftool", "--tool=rapid", "--no-prompt", "HEAD"]);
    assert!(stdout(&shown).contains("WaitTime 0.8: Time 0.5 → 0.8"), "{}", stdout(&shown));
    // Another layout alone is nothing.
    let head = stdout(&git(root, &["show", "HEAD:cell/Main.mod"]));
    fs::write(root.join("cell/Main.mod"), head.replace("  ", "\t").replace("PROC", "proc"))
        .unwrap();
    let shown = stdout(&git(root, &["diff", "HEAD"]));
    assert!(!shown.contains("@@"), "{shown}");
    // Whatever the file is, git gets a text.
    fs::write(root.join("x.mod"), b"\xFC\x01").unwrap();
    let output = diff(root, &["--textconv", "x.mod"]);
    assert!(output.status.success() && stdout(&output) == "encoded module fc01\n");
    refused(&["diff", "--textconv", "gone.mod"], "--textconv needs one file");
}

#[test]
fn backups_are_compared_task_by_task() {
    let folder = tempfile::tempdir().unwrap();
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/backup");
    for side in ["old", "new"] {
        for (path, bytes) in files(&from) {
            let target = folder.path().join(side).join(&path);
            if path.ends_with('/') {
                fs::create_dir_all(target).unwrap();
            } else {
                fs::create_dir_all(target.parent().unwrap()).unwrap();
                fs::write(target, bytes).unwrap();
            }
        }
    }
    let value = json(folder.path(), &["old", "new"]);
    assert_eq!(value["same"], true, "{value:#}");
    // The backup names its robot.
    assert!(value["robot"].as_str().unwrap().contains("1600"));
    let tasks: Vec<&str> =
        value["cycles"].as_array().unwrap().iter().filter_map(|c| c["task"].as_str()).collect();
    assert!(tasks.contains(&"T_ROB1"), "{tasks:?}");
}

#[test]
fn the_page_is_complete_in_itself() {
    let folder = pair(OLD, &OLD.replace("p20,v100", "p20,v50").replace("rNever", "<b>"));
    let args = ["old.mod", "new.mod", "--robot", IRB1600, "--report", "page.html", "--quiet"];
    assert_eq!(diff(folder.path(), &args).status.code(), Some(1));
    let page = fs::read_to_string(folder.path().join("page.html")).unwrap();
    assert!(page.contains("MoveL p20: speed v100 → v50") && page.contains("old.mod:11"));
    assert!(!page.contains("src=") && !page.contains("href=\"http") && !page.contains("<script"));
    assert!(!page.contains("<b>"), "text of the program is escaped");
}
