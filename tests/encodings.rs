//! Files with other encodings and line ends, through the binary.
#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

mod command;

use std::fs;
use std::path::Path;

use command::{IRB1600, run};
use encoding_rs::{GBK, WINDOWS_1250, WINDOWS_1251, WINDOWS_1252};
use serde_json::Value;

const PROGRAM: &str = "MODULE M\n  ! COMMENT\n  PROC main()\n    TPWrite \"COMMENT\";\n    \
                       MoveJ p10, v100, fine, tool0;\n    a := 1 2;\n  ENDPROC\nENDMODULE\n";

fn parsed(path: &Path) -> Value {
    let args = ["parse", "--format", "json", path.to_str().unwrap()];
    command::parsed(&command::joulepath(&args))["files"][0].clone()
}

/// A text in UTF-16, little-endian, with the byte order mark.
fn utf16(text: &str) -> Vec<u8> {
    "\u{FEFF}".encode_utf16().chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect()
}

#[test]
fn every_encoding_and_end_of_line_gives_the_same_program() {
    let with = |comment: &str| PROGRAM.replace("COMMENT", comment);
    let russian = with("Возврат в исходное положение");
    let czech = with("výměna nástroje, počkej na signál, otevři chapadlo");
    let chinese = with("机器人回到原点位置");
    let german = with("Größe");
    let bom = ["\u{FEFF}", &german].concat();
    let variants: [(&str, Vec<u8>); 10] = [
        ("UTF-8", german.clone().into_bytes()),
        ("UTF-8", bom.into_bytes()),
        ("UTF-16LE", utf16(&german)),
        ("windows-1252", WINDOWS_1252.encode(&german).0.into_owned()),
        ("windows-1250", WINDOWS_1250.encode(&czech).0.into_owned()),
        ("windows-1251", WINDOWS_1251.encode(&russian).0.into_owned()),
        ("GBK", GBK.encode(&chinese).0.into_owned()),
        ("UTF-8", PROGRAM.replace('\n', "\r\n").into_bytes()),
        ("UTF-8", PROGRAM.replace('\n', "\r").into_bytes()),
        ("UTF-8", PROGRAM.replacen("  ", "\0\0", 3).trim_end().into()),
    ];
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.mod");
    for (index, (encoding, bytes)) in variants.iter().enumerate() {
        fs::write(&path, bytes).unwrap();
        let file = parsed(&path);
        assert_eq!(file["encoding"], *encoding, "{index}");
        assert_eq!(file["bytes"], bytes.len(), "{index}");
        assert_eq!(file["lossless"], true, "{index}");
        assert_eq!((&file["lines"], &file["movements"]), (&8.into(), &1.into()), "{index}");
        assert_eq!(file["errors"].as_array().unwrap().len(), 1, "{index}: {}", file["errors"]);
        assert_eq!(
            (&file["errors"][0]["line"], &file["errors"][0]["column"]),
            (&6.into(), &12.into())
        );
    }
}

#[test]
fn a_retrofit_keeps_the_encoding() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let text = fs::read_to_string("fixtures/hard/zones.mod").unwrap() + "! Größe\n";
    let path = folder.path().join("zones.mod");
    fs::write(&path, utf16(&text)).unwrap();
    let [program, to] = [&path, &out].map(|path| path.to_str().unwrap());
    run(&["optimize", program, "--robot", IRB1600, "--quiet", "--out", to]);
    let changed = fs::read(out.join("zones.mod")).unwrap();
    assert!(changed.len() > utf16(&text).len(), "a guard was added");
    let file = parsed(&out.join("zones.mod"));
    assert_eq!((&file["encoding"], &file["lossless"]), (&"UTF-16LE".into(), &true.into()));
    assert!(file["errors"].as_array().unwrap().is_empty());
}
