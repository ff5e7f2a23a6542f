//! The command `format`: in place, `--check`, `--diff`, configuration.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;

use std::fs;

use command::{joulepath_in, refused, stderr, stdout};

const UGLY: &str = "MODULE m\r\nproc main()\r\nMoveJ p10 , v100 ,fine , tool0 ; ! first\r\nENDPROC\r\nENDMODULE\r\n";
const PRETTY: &str = "MODULE m\r\n  PROC main()\r\n    MoveJ p10,v100,fine,tool0; ! first\r\n  ENDPROC\r\nENDMODULE\r\n";

#[test]
fn files_are_formatted_in_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("a.mod"), UGLY).unwrap();
    fs::write(path("b.mod"), PRETTY).unwrap();
    let wide = |text: &str| -> Vec<u8> {
        std::iter::once(0xFEFF).chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect()
    };
    fs::write(path("c.mod"), wide(UGLY)).unwrap();
    let run = |args: &[&str]| joulepath_in(folder.path(), &[&["format", "."], args].concat());
    // Nothing is written.
    let checked = run(&["--check"]);
    assert_eq!(checked.status.code(), Some(1));
    assert_eq!(stdout(&checked), "./a.mod\n./c.mod\n");
    let shown = run(&["--diff"]);
    assert_eq!(shown.status.code(), Some(0));
    assert!(stdout(&shown).contains("+    MoveJ p10,v100,fine,tool0; ! first"));
    assert_eq!(fs::read(path("a.mod")).unwrap(), UGLY.as_bytes());
    // All is written.
    let written = run(&[]);
    assert!(written.status.success(), "{}", stderr(&written));
    assert!(stderr(&written).contains("2 of 3 files changed"));
    assert_eq!(fs::read_to_string(path("a.mod")).unwrap(), PRETTY);
    assert_eq!(fs::read(path("c.mod")).unwrap(), wide(PRETTY));
    assert_eq!(run(&["--check"]).status.code(), Some(0));
}

#[test]
fn the_style_is_in_the_configuration() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("a.mod"), UGLY).unwrap();
    let configure = |text: &str| fs::write(path("joulepath.toml"), text).unwrap();
    let run = || joulepath_in(folder.path(), &["format", "a.mod", "--quiet"]);
    configure("[format]\nindent-width = 4\nkeyword-case = \"keep\"\n");
    assert!(run().status.success());
    let text = fs::read_to_string(path("a.mod")).unwrap();
    assert!(text.contains("\r\n    proc main()\r\n        MoveJ"), "{text}");
    configure("[format]\nindent-style = \"tabs\"\n");
    assert!(run().status.success());
    assert!(fs::read_to_string(path("a.mod")).unwrap().contains("\r\n\tPROC main()\r\n\t\tMoveJ"));
    configure("[format]\nindent-width = 40\n");
    let output = run();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("give 1 to 16 spaces"), "{}", stderr(&output));
}

#[test]
fn what_cannot_be_read_stays() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mod");
    let broken = "MODULE m\nPROC main()\n   x := ;\nENDPROC\nENDMODULE\n";
    fs::write(&path, broken).unwrap();
    fs::write(folder.path().join("e.mod"), b"\xFC\x01 \x02").unwrap();
    let output = joulepath_in(folder.path(), &["format", "."]);
    assert!(output.status.success());
    assert!(stderr(&output).contains("e.mod' is an encoded module: it stays as it is"));
    let text = fs::read_to_string(&path).unwrap();
    assert_eq!(text, broken.replace("\nPROC", "\n  PROC").replace("\nENDPROC", "\n  ENDPROC"));
    assert_eq!(fs::read(folder.path().join("e.mod")).unwrap(), b"\xFC\x01 \x02");
    refused(&["format", "nowhere"], "nowhere");
}
