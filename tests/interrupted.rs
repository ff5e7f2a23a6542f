//! Output is written completely or not at all, and a second retrofit changes nothing.
#![expect(clippy::unwrap_used, reason = "a failed set-up fails the test")]

mod command;

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use command::{files, parsed};

/// Number of kill times within the duration of a run.
const KILLS: u32 = 12;

fn optimize(program: &str, out: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_joulepath"));
    let robot = ["--robot", "IRB1600-10/1.45", "--quiet"];
    command.args(["optimize", program]).args(robot).arg("--out").arg(out);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command
}

#[test]
fn killing_a_run_leaves_complete_output_or_none() {
    let folder = tempfile::tempdir().unwrap();
    let program = "fixtures/hard/encoding.mod";
    let whole = folder.path().join("whole");
    let begin = Instant::now();
    assert!(optimize(program, &whole).status().unwrap().success());
    let took = begin.elapsed();
    let wanted = files(&whole);
    let mut finished = 0;
    for kill in 0..=KILLS {
        let out = folder.path().join(format!("out{kill}"));
        let mut child = optimize(program, &out).spawn().unwrap();
        // The last kills are near the moment of writing.
        std::thread::sleep(took * kill / (KILLS - 3));
        child.kill().unwrap();
        child.wait().unwrap();
        if out.exists() {
            assert_eq!(files(&out), wanted, "half-written after {kill}/{KILLS} of the time");
            finished += 1;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(finished < KILLS, "no run was interrupted");
}

#[test]
fn a_second_retrofit_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let (once, twice) = (folder.path().join("once"), folder.path().join("twice"));
    assert!(optimize("fixtures/paper", &once).status().unwrap().success());
    let mut again = optimize(once.to_str().unwrap(), &twice);
    again.args(["--format", "json"]).stdout(Stdio::piped());
    let output = again.output().unwrap();
    assert!(output.status.success());
    assert_eq!(files(&once), files(&twice));
    let result = parsed(&output);
    let notes = result["notes"].to_string();
    assert!(notes.contains("every file stays as it was"), "{notes}");
    assert!(result["segments"].as_array().unwrap().iter().all(|s| s["rewritten"] == false));
}
