//! Runs the binary, and reads what it writes.

#![allow(
    dead_code,
    clippy::allow_attributes,
    reason = "each test uses its part of this module; an expectation would fail in the others"
)]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

/// A robot of the catalogue with published dynamics.
pub(crate) const IRB1600: &str = "IRB1600-10/1.45";
/// The same robot with known limits.
pub(crate) const KNOWN_LIMITS: &str =
    concat!(env!("CARGO_MANIFEST_DIR"), "/tests/support/known_limits.toml");

const CRATE: &str = env!("CARGO_MANIFEST_DIR");

/// Runs `joulepath` in the folder of the crate.
pub(crate) fn joulepath(args: &[&str]) -> Output {
    joulepath_in(Path::new(CRATE), args)
}

/// Runs `joulepath` in a folder.
pub(crate) fn joulepath_in(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_joulepath")).args(args).current_dir(folder).output().unwrap()
}

/// Runs `joulepath`, which has to succeed.
pub(crate) fn run(args: &[&str]) -> Output {
    run_in(Path::new(CRATE), args)
}

/// Runs `joulepath` in a folder; it has to succeed.
pub(crate) fn run_in(folder: &Path, args: &[&str]) -> Output {
    let output = joulepath_in(folder, args);
    assert!(output.status.success(), "{args:?}: {}", stderr(&output));
    output
}

/// Runs `joulepath`, which has to refuse the input with exit code 2 a message that contains
/// `way_out`, and nothing on standard output. Returns the message.
pub(crate) fn refused(args: &[&str], way_out: &str) -> String {
    let output = joulepath(args);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{args:?}: {message}");
    assert!(message.contains(way_out), "{args:?}: {message}\nlacks {way_out}");
    assert!(output.stdout.is_empty(), "{args:?}");
    message
}

/// The JSON of a command that succeeds.
pub(crate) fn json(args: &[&str]) -> Value {
    parsed(&run(args))
}

/// The JSON on standard output.
pub(crate) fn parsed(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {output:?}"))
}

/// Standard output.
pub(crate) fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// Standard error.
pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Retrofits a program of one module in a folder. The module is `m.mod`, the output is in `out`.
pub(crate) fn optimize(folder: &Path, text: impl AsRef<[u8]>, options: &[&str]) -> Value {
    fs::write(folder.join("m.mod"), &text).unwrap();
    let args = ["optimize", "m.mod", "--out", "out", "--format", "json", "--quiet"];
    let result = parsed(&run_in(folder, &[&args[..], options].concat()));
    let text = String::from_utf8_lossy(text.as_ref());
    assert_eq!(result["verification"]["passed"], true, "{text}\n{result}");
    result
}

/// A folder with the module `m.mod`, and the path of the module.
pub(crate) fn module(text: impl AsRef<[u8]>) -> (TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = written(&folder, "m.mod", text);
    (folder, path)
}

/// Writes a file into a folder; returns its path.
pub(crate) fn written(folder: &TempDir, name: &str, text: impl AsRef<[u8]>) -> String {
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

/// A number in a JSON value.
pub(crate) fn number(value: &Value, pointer: &str) -> f64 {
    let found = value.pointer(pointer).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("no number at {pointer}"))
}

/// The rows of a CSV below its header.
pub(crate) fn rows(csv: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split(',').map(|cell| cell.parse().unwrap()).collect();
    csv.lines().skip(1).map(row).collect()
}

/// Everything below a folder: the relative paths with the bytes of the files.
pub(crate) fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let name = entry.file_name().into_string().unwrap();
        if entry.file_type().unwrap().is_dir() {
            let below = files(&entry.path()).into_iter();
            found.extend(below.map(|(path, bytes)| (format!("{name}/{path}"), bytes)));
            found.insert(name + "/", Vec::new());
        } else {
            found.insert(name, fs::read(entry.path()).unwrap());
        }
    }
    found
}
