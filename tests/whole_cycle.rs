//! `joulepath optimize` with redistribution of time between runs, use of waits, and free paths.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;

use command::{KNOWN_LIMITS, number};
use serde_json::Value;

/// Rounding of a sum of times, s.
const TIME: f64 = 1e-6;

/// A quick and a slow movement, with a wait between.
fn program(line: &str) -> String {
    format!(
        "MODULE M\n\
         CONST jointtarget jA:=[[0,-12,14,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
         CONST jointtarget jB:=[[60,20,0,-20,65,30],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
         CONST robtarget pC:=[[850,300,1000],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
         CONST robtarget pD:=[[850,-300,1000],[0,0,1,0],[-1,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
         PROC main()\n\
         ConfL \\Off; MoveAbsJ jA,v1000,fine,tool0;\n\
         MoveAbsJ jB,vmax,fine,tool0;\n\
         WaitDI diPart,1;\n\
         MoveJ pC,v1000,fine,tool0;\n\
         {line}\n\
         MoveAbsJ jA,v1000,fine,tool0;\n\
         ENDPROC\n\
         ENDMODULE\n"
    )
}

fn optimize(text: &str, options: &[&str]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let robot = ["--robot", KNOWN_LIMITS, "--allow-faster-joints"];
    let result = command::optimize(folder.path(), text, &[&robot[..], options].concat());
    assert!(number(&result, "/optimized/cycle_s") <= number(&result, "/original/cycle_s") + TIME);
    result
}

/// Time of the run that starts at a line, in the original and in the retrofit.
fn times(result: &Value, line: u64) -> [f64; 2] {
    let segments = result["segments"].as_array().unwrap();
    let run = segments.iter().find(|s| s["line_first"] == line && s["kind"] == "timing").unwrap();
    ["time_before_s", "time_after_s"].map(|key| run[key].as_f64().unwrap())
}

#[test]
fn a_run_uses_a_wait_of_known_length() {
    let text = program("MoveL pD,v500,fine,tool0;");
    let unknown = optimize(&text, &[]);
    let known = optimize(&text, &["--input", "diPart=3"]);
    let [before, after] = times(&known, 8);
    assert!(after > 1.5 * before, "{before} s, {after} s");
    // A wait of unknown duration provides no time: the run uses the time saved by the others.
    assert!(after > 1.2 * times(&unknown, 8)[1], "{after} s, {} s", times(&unknown, 8)[1]);
    let saving = |result| number(result, "/motion_saving_percent");
    assert!(saving(&known) > saving(&unknown) + 5.0);
}

/// After a change of the cell a slow stream may run while a quick one does not.
#[test]
fn no_run_is_slowed_to_make_another_one_faster() {
    let result = optimize(&program("MoveL pD,v500,fine,tool0;"), &[]);
    let changes = [8, 10, 11, 12].map(|line| times(&result, line)).map(|[a, b]| b / a - 1.0);
    assert!(changes.iter().all(|change| *change < 1e-6), "{changes:?}");
}

#[test]
fn a_free_path_deviates_and_needs_less_energy() {
    let line = "MoveL pD,v500,fine,tool0; ! joulepath: free";
    let text = program(line);
    let kept = optimize(&text, &[]);
    let free = optimize(&text, &["--free-path", "--deviation", "40"]);
    let line = "MoveL pD,v500,fine,tool0;";
    let strict = optimize(&program(line), &["--free-path", "--deviation", "40"]);
    let energy = |result| number(result, "/optimized/motion_energy_j");
    let deviation = |result| number(result, "/verification/max_path_deviation_m");
    assert!(deviation(&kept) <= 0.005);
    assert!(deviation(&free) > 0.005 && deviation(&free) <= 0.04, "{}", deviation(&free));
    assert!(energy(&free) < energy(&kept), "{} J, {} J", energy(&free), energy(&kept));
    // Without the comment the line remains a line.
    assert!(energy(&free) < energy(&strict));
    for segment in free["segments"].as_array().unwrap() {
        if segment["rewritten"] == true {
            assert!(number(segment, "/lower_bound_j") <= number(segment, "/energy_after_j"));
        }
    }
}
