//! `joulepath parse`: contract of its JSON, text and exit codes.

#![expect(clippy::unwrap_used, reason = "what cannot be run or read fails the test")]

mod command;

use std::path::Path;
use std::process::Output;

use command::{joulepath, parsed, stderr, stdout};
use joulepath::rapid::syntax::{self, TokenKind};
use serde_json::Value;

fn parse(arguments: &[&str]) -> Output {
    joulepath(&[&["parse"], arguments].concat())
}

fn json(arguments: &[&str]) -> Value {
    parsed(&parse(&[&["--format", "json"], arguments].concat()))
}

fn folder(files: &[(&str, &[u8])]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (path, bytes) in files {
        let path = folder.path().join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
    folder
}

fn shown(path: &Path) -> &str {
    path.to_str().unwrap()
}

const GOOD: &[u8] = b"MODULE Good\r\n  PROC main()\r\n    MoveJ p1, v100, fine, tool0;\r\n    \
    IF a SearchL di1, p, q, v10, tool0;\r\n    ! MoveL in a comment\r\n    TPWrite \"MoveL\";\r\n  \
    ENDPROC\r\nENDMODULE\r\n";
const BAD: &[u8] = b"MODULE Bad\n  PROC main()\n    ! gr\xFC\xDFe\n    reg\xFC := 1 2;\n    \
    MoveL p1 v100, z10, tool0;\n  ENDPROC\nENDMODULE\n";

#[test]
fn json_has_the_fields_of_the_contract() {
    let folder = folder(&[("b/bad.mod", BAD), ("a.MOD", GOOD), ("c.modx", b"\xFCbinary")]);
    let root = shown(folder.path());
    let value = json(&[root]);
    let files = value["files"].as_array().unwrap();
    let paths: Vec<&str> = files.iter().map(|file| file["path"].as_str().unwrap()).collect();
    let expected = ["a.MOD", "b/bad.mod", "c.modx"].map(|path| format!("{root}/{path}"));
    assert_eq!(paths, expected);
    let text = serde_json::to_string_pretty(&value).unwrap();
    insta::assert_snapshot!(text.replace(root, "(folder)"));
    assert_eq!(value, json(&[root]), "the same input gives the same output");
}

#[test]
fn exit_codes_distinguish_errors_from_unusable_input() {
    let folder = folder(&[("good.mod", GOOD), ("bad.mod", BAD), ("notes/read.me", b"")]);
    let path = |name: &str| shown(&folder.path().join(name)).to_owned();
    let code = |arguments: &[&str]| parse(arguments).status.code();
    assert_eq!(code(&[&path("good.mod")]), Some(0));
    assert_eq!(code(&[&path("good.mod"), &path("bad.mod")]), Some(1));
    assert_eq!(code(&[&path("gone.mod")]), Some(2));
    assert_eq!(code(&[&path("notes")]), Some(2));
    assert_eq!(code(&[]), Some(2));
    // One file is readable, so the missing one is only a note.
    let output = parse(&[&path("gone.mod"), &path("good.mod")]);
    assert_eq!(output.status.code(), Some(0));
    assert!(stderr(&output).contains("gone.mod"));
}

#[test]
fn text_shows_errors_and_a_summary() {
    let folder = folder(&[("bad.mod", BAD)]);
    let path = folder.path().join("bad.mod");
    let text = stdout(&parse(&[shown(&path)]));
    insta::assert_snapshot!(text.replace(shown(folder.path()), "(folder)"));
}

#[test]
fn an_empty_file_is_valid() {
    let folder = folder(&[("empty.mod", b"")]);
    let value = json(&[shown(&folder.path().join("empty.mod"))]);
    assert_eq!(value["files"][0]["lines"], 0);
    assert_eq!(value["totals"]["lossless"], 1);
    assert_eq!(value["totals"]["errors"], 0);
}

/// The command counts movements in the tree; this test counts tokens.
#[test]
fn movements_are_those_at_the_start_of_statements() {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
    let value = json(&[shown(&fixtures)]);
    let mut counted = 0;
    for file in value["files"].as_array().unwrap() {
        let path = file["path"].as_str().unwrap();
        let bytes = std::fs::read(path).unwrap();
        let expected = movements_at_statement_starts(&bytes);
        assert_eq!(file["movements"], expected, "{path}");
        counted += expected;
    }
    assert!(counted > 20, "only {counted} movements in all fixtures");
}

fn movements_at_statement_starts(bytes: &[u8]) -> usize {
    let parse = syntax::parse(bytes);
    let mut count = 0;
    let mut before = TokenKind::Semicolon;
    for token in parse.tree.root().all_tokens().filter(|token| !token.kind().is_trivia()) {
        let starts = before.is_keyword() && before != TokenKind::Proc
            || matches!(before, TokenKind::Semicolon | TokenKind::RightParen | TokenKind::Colon)
            || matches!(before, TokenKind::Identifier | TokenKind::Number | TokenKind::Placeholder);
        let name = String::from_utf8_lossy(token.text(bytes)).to_lowercase();
        let rest = |start: &str| name.strip_prefix(start).unwrap_or("?").to_owned();
        let plain = rest("move");
        let plain = ["sync", "do", "ao", "go"]
            .iter()
            .find_map(|end| plain.strip_suffix(end))
            .unwrap_or(&plain);
        let family = ["absj", "j", "l", "c", "extj", "pnp"].contains(&plain)
            || ["l", "j", "c", "absj", "lios", "jios"].contains(&rest("trigg").as_str())
            || ["l", "c", "extj"].contains(&rest("search").as_str());
        count += usize::from(token.kind() == TokenKind::Identifier && starts && family);
        before = token.kind();
    }
    count
}
