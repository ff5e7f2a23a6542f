//! `refresh` computes streams again from the current data.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

mod command;

use std::fs;
use std::path::{Path, PathBuf};

use command::{IRB1600, files, refused, run, stdout};

/// A program with CRLF, a compact IF before a load, and two files.
const MAIN: &str = "MODULE Main\r\n\
    PERS loaddata lPart:=[2,[0,0,40],[1,0,0,0],0,0,0];\r\n\
    PERS bool bPart:=TRUE;\r\n\
    PROC main()\r\n\
    \x20   MoveAbsJ jHome,v1000,fine,tool0;\r\n\
    \x20   IF bPart GripLoad lPart; ! with the part\r\n\
    \x20   MoveJ Offs(pNest,0,0,80),v1000,z50,tool0;\r\n\
    \x20   MoveL pNest,v400,fine,tool0;\r\n\
    \x20   SetDO doGrip,1;\r\n\
    \x20   WaitTime 0.3;\r\n\
    \tMoveL Offs(pNest,0,0,80),v400,z50,tool0;\r\n\
    \tMoveAbsJ jHome,v1000,fine,tool0;\r\n\
    ENDPROC\r\n\
    ENDMODULE\r\n";
const DATA: &str = "MODULE CellData\n\
    CONST jointtarget jHome:=[[0,-12,14,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    CONST robtarget pNest:=[[850,300,800],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    ENDMODULE\n";
const STREAMS: &str = "Joulepath.mod";

/// Standard output of a command for a program.
fn done(arguments: &[&str], path: &Path) -> String {
    let common = [path.to_str().unwrap(), "--robot", IRB1600, "--quiet"];
    stdout(&run(&[arguments, &common].concat()))
}

/// A folder with the program; in its data `from` is replaced.
fn cell(folder: &Path, name: &str, from: &str, to: &str) -> PathBuf {
    let cell = folder.join(name);
    fs::create_dir(&cell).unwrap();
    fs::write(cell.join("Main.mod"), MAIN).unwrap();
    fs::write(cell.join("CellData.mod"), DATA.replace(from, to)).unwrap();
    cell
}

fn edit(path: &Path, from: &str, to: &str) {
    let text = fs::read_to_string(path).unwrap();
    assert!(text.contains(from), "{from}: {text}");
    fs::write(path, text.replace(from, to)).unwrap();
}

#[test]
fn refreshing_an_unchanged_program_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let cell = cell(folder.path(), "cell", "", "");
    done(&["optimize", "--in-place"], &cell);
    let before = files(&cell);
    assert!(before["Main.mod"] != MAIN.as_bytes());
    assert_eq!(done(&["refresh"], &cell), "");
    assert_eq!(done(&["refresh", "--in-place"], &cell), "");
    assert_eq!(files(&cell), before);
    done(&["optimize", "--undo"], &cell);
    assert_eq!(files(&cell)["Main.mod"], MAIN.as_bytes());
}

#[test]
fn a_changed_position_gets_new_streams() {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = ("[850,300,800]", "[850,300,812.5]");
    let changed = cell(folder.path(), "changed", from, to);
    let original = files(&changed);
    done(&["optimize", "--in-place"], &changed);
    let refreshed = cell(folder.path(), "refreshed", "", "");
    done(&["optimize", "--in-place"], &refreshed);
    edit(&refreshed.join("CellData.mod"), from, to);

    let difference = done(&["refresh"], &refreshed);
    let lines = |sign: &str, part: &str| {
        difference.lines().any(|line| line.starts_with(sign) && line.contains(part))
    };
    assert!(lines("-", "[850,300,800]") && lines("+", "[850,300,812.5]"), "{difference}");
    assert!(!difference.contains("CellData.mod"), "{difference}");
    done(&["refresh", "--in-place"], &refreshed);
    assert_eq!(files(&refreshed), files(&changed));
    // The output in another folder is the same.
    let out = folder.path().join("out");
    done(&["refresh", "--out", out.to_str().unwrap()], &refreshed);
    assert_eq!(files(&out), files(&changed));
    // Undoing gives the program with the current data.
    done(&["optimize", "--undo"], &refreshed);
    assert_eq!(files(&refreshed), original);
}

#[test]
fn refresh_keeps_edited_movements_and_a_stated_serial_number() {
    let folder = tempfile::tempdir().unwrap();
    let cell = cell(folder.path(), "cell", "", "");
    done(&["optimize", "--in-place"], &cell);
    edit(&cell.join("Main.mod"), "MoveL pNest,v400", "MoveL pNest,v200");
    edit(&cell.join(STREAMS), "SerialNo:=\"\"", "SerialNo:=\"1600-501234\"");
    edit(&cell.join(STREAMS), "RobotType:=\"1600-10/1.45\"", "RobotType:=\"IRB 1600\"");
    done(&["refresh", "--in-place"], &cell);
    let text = |name: &str| fs::read_to_string(cell.join(name)).unwrap();
    assert!(text(STREAMS).contains("SerialNo:=\"1600-501234\""));
    assert!(text(STREAMS).contains("RobotType:=\"IRB 1600\""));
    done(&["optimize", "--undo"], &cell);
    assert_eq!(text("Main.mod"), MAIN.replace("MoveL pNest,v400", "MoveL pNest,v200"));
}

#[test]
fn streams_whose_data_may_change_are_removed() {
    let folder = tempfile::tempdir().unwrap();
    let cell = cell(folder.path(), "cell", "", "");
    done(&["optimize", "--in-place"], &cell);
    // From here on an interrupt routine may write the target of the movement.
    edit(&cell.join("CellData.mod"), "CONST robtarget", "PERS robtarget");
    edit(&cell.join("CellData.mod"), "CONST jointtarget", "PERS jointtarget");
    let trap = "TRAP tMove\r\n pNest.trans.z:=800; jHome.robax.rax_1:=1;\r\nENDTRAP\r\nENDMODULE";
    edit(&cell.join("Main.mod"), "ENDMODULE", trap);
    let connect = "VAR intnum i1;\r\nPROC main()\r\nCONNECT i1 WITH tMove; ISignalDI di1,1,i1;";
    edit(&cell.join("Main.mod"), "PROC main()", connect);
    done(&["refresh", "--in-place"], &cell);
    let text = fs::read_to_string(cell.join("Main.mod")).unwrap();
    let without = MAIN.replace("ENDMODULE", trap).replace("PROC main()", connect);
    assert_eq!(text, without);
    assert!(!cell.join(STREAMS).exists());
}

#[test]
fn a_program_without_streams_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let cell = cell(folder.path(), "cell", "", "");
    let before = files(&cell);
    for (arguments, says) in [
        (&["refresh"][..], "no streams of joulepath"),
        (&["refresh", "--in-place"], "joulepath optimize"),
        (&["refresh", "--undo"], "optimize --undo"),
    ] {
        let common = [cell.to_str().unwrap(), "--robot", IRB1600, "--quiet"];
        refused(&[arguments, &common].concat(), says);
    }
    assert_eq!(files(&cell), before);
    // A program with streams does not get streams again.
    done(&["optimize", "--in-place"], &cell);
    let result = done(&["optimize", "--format", "json"], &cell);
    assert!(result.contains("joulepath refresh"), "{result}");
}
