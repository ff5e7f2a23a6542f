//! `optimize` through the binary: contract of its JSON, output files, messages.
#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

mod command;

use std::fmt::Write;
use std::fs;
use std::path::Path;

use command::{KNOWN_LIMITS, files, joulepath, json, module, number, refused, run, stderr, stdout};
use serde_json::Value;

/// Tolerance of end points, rad.
const ENDPOINT_TOLERANCE: f64 = 1e-4;
/// Least share of the eligible moving time that is rewritten.
const REWRITTEN_SHARE: f64 = 0.8;

/// Settings that remove platform-dependent last digits from snapshots.
fn snapshots() -> insta::Settings {
    let mut settings = insta::Settings::clone_current();
    settings.add_filter(r"(\d+\.\d)\d+", "$1…");
    settings.add_filter(r"[\d.]+…?e-\d+", "[tiny]");
    settings.add_filter(r" +", " ");
    settings.add_filter(r"-{20,}", "---");
    settings
}

#[test]
fn the_result_of_pick_place_agrees_with_the_contract() {
    let result = json(&["optimize", "fixtures/pick_place", "--format", "json"]);
    assert_eq!(result["verification"]["passed"], true);
    for limit in ["velocity", "acceleration", "torque", "tcp_speed"] {
        let ratio = number(&result, &format!("/verification/max_ratio/{limit}"));
        assert!(ratio > 0.0 && ratio <= 1.0, "{limit}: {ratio}");
    }
    assert!(number(&result, "/verification/endpoint_error_rad") <= ENDPOINT_TOLERANCE);
    assert!(number(&result, "/motion_saving_percent") > 0.0);
    assert!(number(&result, "/optimized/cycle_s") <= number(&result, "/original/cycle_s"));
    // In the mill's 12 s, closed brakes save the 60 W of their coils and the holding power.
    assert!(number(&result, "/potential_j") > 60.0 * 11.0, "{}", result["potential_j"]);

    let (mut eligible, mut rewritten) = (0.0, 0.0);
    for segment in result["segments"].as_array().unwrap() {
        let time = number(segment, "/time_before_s");
        if segment["kind"] != "timing" {
            assert_eq!(segment["rewritten"], false, "a dwell needs a setting of the controller");
            continue;
        }
        if segment["rewritten"] == true {
            eligible += time;
            rewritten += time;
            assert!(number(segment, "/points") > 0.0);
            // A run that gives time to the others may need more energy itself.
            let quicker = number(segment, "/time_after_s") < time;
            let saves = number(segment, "/energy_after_j") < number(segment, "/energy_before_j");
            assert!(quicker || saves, "{segment}");
            let bound = number(segment, "/lower_bound_j");
            assert!(bound <= number(segment, "/energy_after_j"), "{segment}");
        } else {
            let reason = segment["reason"].as_str().unwrap();
            if reason.starts_with("no-s") {
                eligible += time;
            }
        }
    }
    assert!(rewritten >= REWRITTEN_SHARE * eligible, "{rewritten} s of {eligible} s");
}

#[test]
fn the_written_program_simulates_as_predicted() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let out = out.to_str().unwrap();
    let result = json(&["optimize", "fixtures/pick_place", "--format", "json", "--out", out]);
    let robot = "IRB1600-10/1.45";
    let simulated = json(&["simulate", out, "--robot", robot, "--format", "json"]);
    for key in ["/cycle_s", "/energy_j", "/motion_energy_j"] {
        let promised = number(&result, &format!("/optimized{key}"));
        assert!((number(&simulated, key) - promised).abs() < 1e-6 * promised, "{key}");
    }
    let moves = simulated["moves"].as_array().unwrap();
    let waits = simulated["waits"].as_array().unwrap();
    let sum: f64 = moves.iter().chain(waits).map(|entry| number(entry, "/duration_s")).sum();
    assert!((sum - number(&simulated, "/cycle_s")).abs() < 1e-9, "moves and waits tile the cycle");
    // Other files are unchanged.
    for name in ["CellData.mod", "Pallet.sys"] {
        let original = fs::read(Path::new("fixtures/pick_place").join(name)).unwrap();
        assert_eq!(fs::read(Path::new(out).join(name)).unwrap(), original, "{name}");
    }
    // A second run finds no saving.
    let again = json(&["optimize", out, "--robot", robot, "--format", "json"]);
    assert_eq!(number(&again, "/saving_percent"), 0.0);
}

#[test]
fn output_is_the_same_bytes_each_time() {
    let args = ["optimize", "fixtures/hard/waits.mod", "--format", "json"];
    assert_eq!(joulepath(&args).stdout, joulepath(&args).stdout);
}

#[test]
fn times_and_energies_are_ordered_as_in_the_paper() {
    let energy = json(&["optimize", "fixtures/paper", "--format", "json"]);
    let time = json(&["optimize", "fixtures/paper", "--format", "json", "--objective", "time"]);
    let segment = |result: &Value, line: u64, key: &str| -> f64 {
        let segments = result["segments"].as_array().unwrap();
        let found = segments.iter().find(|s| s["line_first"] == line).unwrap();
        found[key].as_f64().unwrap()
    };
    // Lines: B at vmax 78, D at vmax 94, B at v300 68.
    let (straight, joint, slow) = (78, 94, 68);
    let fastest = segment(&time, joint, "time_after_s");
    assert!(fastest < segment(&time, straight, "time_before_s"), "time-optimal beats the line");
    for line in [straight, joint] {
        assert!(
            segment(&energy, line, "energy_after_j") < segment(&energy, line, "energy_before_j"),
            "energy-optimal is below the controller's move at equal time"
        );
    }
    // The same line at v1000 instead of vmax needs less motion energy.
    let half = 72;
    let idle_w = 210.0;
    let motion = |line| {
        segment(&energy, line, "energy_before_j") - idle_w * segment(&energy, line, "time_before_s")
    };
    assert!(motion(half) < 0.8 * motion(straight), "{} {}", motion(half), motion(straight));
    assert!(segment(&energy, slow, "time_before_s") > segment(&energy, half, "time_before_s"));
}

#[test]
fn undo_restores_every_byte() {
    let folder = tempfile::tempdir().unwrap();
    let cell = folder.path().join("cell");
    fs::create_dir(&cell).unwrap();
    let program = cell.join("waits.mod");
    fs::copy("fixtures/hard/waits.mod", &program).unwrap();
    let before = files(folder.path());
    let path = program.to_str().unwrap();
    let args = ["optimize", path, "--robot", "IRB1600-10/1.45", "--in-place", "--quiet"];
    refused(&["optimize", path, "--undo"], "nothing to undo");
    for named in [&program, &cell] {
        run(&args);
        assert_ne!(fs::read(&program).unwrap(), before["cell/waits.mod"]);
        assert!(cell.join("Joulepath.mod").is_file());
        // The originals are outside the loaded folder.
        let kept = folder.path().join("cell.joulepath-undo");
        assert_eq!(fs::read(kept.join("files/waits.mod")).unwrap(), before["cell/waits.mod"]);
        let names: Vec<String> = files(&cell).into_keys().collect();
        assert_eq!(names, ["Joulepath.mod", "joulepath_brakes.txt", "waits.mod"]);
        run(&["optimize", named.to_str().unwrap(), "--undo"]);
        assert_eq!(files(folder.path()), before);
    }
    refused(&["optimize", cell.to_str().unwrap(), "--undo"], "nothing to undo");
}

/// A second change in place replaces the undo folder, and no folder that the user has.
#[test]
fn a_new_undo_folder_replaces_the_old_one_alone() {
    let folder = tempfile::tempdir().unwrap();
    let cell = folder.path().join("cell");
    fs::create_dir(&cell).unwrap();
    fs::copy("fixtures/hard/waits.mod", cell.join("waits.mod")).unwrap();
    let before = files(&cell);
    let own = folder.path().join("cell.older/notes.txt");
    fs::create_dir(own.parent().unwrap()).unwrap();
    fs::write(&own, "mine").unwrap();
    let path = cell.to_str().unwrap();
    for command in ["optimize", "refresh"] {
        run(&[command, path, "--robot", "IRB1600-10/1.45", "--in-place", "--quiet"]);
    }
    assert_eq!(fs::read_to_string(&own).unwrap(), "mine");
    let left = files(folder.path()).into_keys().filter(|name| name.contains("undo.older"));
    assert_eq!(left.count(), 0);
    run(&["optimize", path, "--undo"]);
    assert_eq!(files(&cell), before);
}

#[test]
fn undo_is_refused_after_an_edit() {
    let folder = tempfile::tempdir().unwrap();
    let cell = folder.path().join("cell");
    fs::create_dir(&cell).unwrap();
    let program = cell.join("waits.mod");
    fs::copy("fixtures/hard/waits.mod", &program).unwrap();
    let original = fs::read(&program).unwrap();
    let path = cell.to_str().unwrap();
    let args = ["optimize", path, "--robot", "IRB1600-10/1.45", "--in-place", "--quiet"];
    run(&args);
    let written = fs::read(&program).unwrap();
    // A second run would overwrite the originals.
    fs::write(&program, &original).unwrap();
    refused(&args, "--undo");
    // An edited file remains, and so do all others.
    for changed in ["waits.mod", "Joulepath.mod"] {
        fs::write(&program, &written).unwrap();
        fs::write(cell.join(changed), "MODULE M\nENDMODULE\n").unwrap();
        let now = files(folder.path());
        refused(&["optimize", path, "--undo"], &format!("{changed}' was changed since"));
        assert_eq!(files(folder.path()), now);
    }
    // Already restored or removed files are no obstacle.
    fs::remove_file(cell.join("Joulepath.mod")).unwrap();
    fs::write(&program, &original).unwrap();
    run(&["optimize", path, "--undo"]);
    assert_eq!(fs::read(&program).unwrap(), original);
    assert!(!folder.path().join("cell.joulepath-undo").exists());
}

#[test]
fn undo_removes_created_folders() {
    let folder = tempfile::tempdir().unwrap();
    let cell = folder.path().join("cell");
    fs::create_dir(&cell).unwrap();
    fs::write(cell.join("m.mod"), program("", "")).unwrap();
    let before = files(folder.path());
    let path = cell.to_str().unwrap();
    let (messages, code) =
        messages_of(folder.path(), &["optimize", path, "--emit", "egm", "--in-place"]);
    assert_eq!(code, Some(0), "{messages}");
    assert!(cell.join("egm").is_dir());
    run(&["optimize", path, "--undo"]);
    assert_eq!(files(folder.path()), before);
}

#[test]
fn refusals_are_exit_code_one_only_when_strict() {
    let args = ["optimize", "fixtures/hard/unreachable.mod", "--quiet"];
    assert_eq!(joulepath(&args).status.code(), Some(0));
    let strict = ["optimize", "fixtures/hard/unreachable.mod", "--quiet", "--strict"];
    assert_eq!(joulepath(&strict).status.code(), Some(1));
}

#[test]
fn unusable_input_names_the_way_out() {
    let folder = tempfile::tempdir().unwrap();
    let broken = folder.path().join("broken.mod");
    fs::write(&broken, "MODULE m\nPROC main()\nMoveJ p1 v100,,;\nENDPROC\nENDMODULE\n").unwrap();
    let headless = folder.path().join("headless.mod");
    fs::write(&headless, "MODULE m\nPROC other()\nENDPROC\nENDMODULE\n").unwrap();
    let empty = folder.path().join("empty");
    fs::create_dir(&empty).unwrap();
    let cell = folder.path().join("cell");
    fs::create_dir(&cell).unwrap();
    fs::write(cell.join("m.mod"), program("", "")).unwrap();
    let within = cell.join("new/out");
    let robot = "IRB1600-10/1.45";
    let cases: Vec<Vec<&str>> = vec![
        vec!["optimize", "no/such/file.mod", "--robot", robot],
        vec!["optimize", empty.to_str().unwrap(), "--robot", robot],
        vec!["optimize", broken.to_str().unwrap(), "--robot", robot],
        vec!["optimize", headless.to_str().unwrap(), "--robot", robot],
        vec!["optimize", "fixtures/pick_place", "--robot", "IRB1600-99"],
        vec!["optimize", broken.to_str().unwrap()],
        vec!["optimize", "fixtures/hard/waits.mod", "--takt", "10"],
        vec!["optimize", "fixtures/hard/waits.mod", "--spacing", "0"],
        vec![
            "optimize",
            cell.to_str().unwrap(),
            "--robot",
            robot,
            "--out",
            within.to_str().unwrap(),
        ],
        vec!["simulate", "fixtures/hard/waits.mod", "--start", "1,2,3"],
        vec!["simulate", "fixtures/hard/waits.mod", "--input", "diReady"],
    ];
    let mut all = String::new();
    for args in cases {
        let output = joulepath(&args);
        assert_eq!(output.status.code(), Some(2), "{args:?}");
        assert!(output.stdout.is_empty(), "{args:?}");
        let message = stderr(&output).replace(folder.path().to_str().unwrap(), "[folder]");
        let messages = message.lines().filter(|line| !line.starts_with("note:"));
        for line in messages {
            all.push_str(line);
            all.push('\n');
        }
    }
    snapshots().bind(|| insta::assert_snapshot!("messages", all));
}

/// A program with these declarations and statements of `main`, which include two movements.
fn program(declarations: &str, statements: &str) -> String {
    format!(
        "MODULE M\n\
         PERS tooldata tP:=[TRUE,[[58,0,172],[1,0,0,0]],[3,[30,0,80],[1,0,0,0],0,0,0]];\n\
         CONST jointtarget jA:=[[0,-12,14,20,95,-136],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
         CONST jointtarget jB:=[[40,10,4,-20,65,30],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
         {declarations}\n\
         PROC main()\n\
         MoveAbsJ jA,v1000,fine,tP;\n\
         {statements}\n\
         MoveAbsJ jB,v1000,fine,tP;\n\
         ENDPROC\n\
         ENDMODULE\n"
    )
}

const KNOWN: [&str; 2] = ["--robot", KNOWN_LIMITS];
const ROBOT: [&str; 2] = ["--robot", "IRB1600-10/1.45"];

/// Standard error of a command without its assumptions, and the exit code.
fn messages_of(folder: &Path, args: &[&str]) -> (String, Option<i32>) {
    let output = joulepath(&[args, &ROBOT].concat());
    let message = stderr(&output).replace(folder.to_str().unwrap(), "[folder]");
    let lines = message.lines().filter(|line| !line.starts_with("note: assumed"));
    (lines.flat_map(|line| [line, "\n"]).collect(), output.status.code())
}

/// Standard error for a program of one file.
fn messages_of_program(
    declarations: &str,
    statements: &str,
    args: &[&str],
) -> (String, Option<i32>) {
    let (folder, path) = module(program(declarations, statements));
    messages_of(folder.path(), &[&["optimize", &path], args].concat())
}

/// The JSON of a retrofit of a program.
fn optimized(statements: &str, options: &[&str]) -> Value {
    let (_folder, path) = module(program("", statements));
    let args = ["optimize", &path, "--format", "json", "--quiet"];
    json(&[&args[..], options].concat())
}

#[test]
fn requested_cycle_times_have_bounds() {
    let cases: [&[&str]; 6] = [
        &["--takt", "1e9"],
        &["--takt", "0.1"],
        &["--takt", "-1"],
        &["--time-factor", "1e6"],
        &["--time-factor", "0.1"],
        &["--time-factor", "1.5"],
    ];
    let mut all = String::new();
    for args in cases {
        let (messages, code) = messages_of_program("", "", args);
        writeln!(all, "{args:?}: {}\n{messages}", code.unwrap()).unwrap();
    }
    snapshots().bind(|| insta::assert_snapshot!("time", all));
}

/// A takt that the original keeps is possible.
#[test]
fn a_takt_above_the_cycle_is_possible() {
    let (_folder, path) = module(program("", ""));
    let simulated =
        json(&[&["simulate", &path, "--format", "json", "--quiet"][..], &ROBOT].concat());
    let takt = format!("{:.4}", number(&simulated, "/cycle_s") + 1e-3);
    let args = ["optimize", &path, "--takt", &takt, "--format", "json", "--quiet"];
    json(&[&args[..], &ROBOT].concat());
}

/// `ModPos` changes the text of a movement with its target inside, which no guard detects.
#[test]
fn movements_with_inline_targets_are_kept() {
    let own = "MoveAbsJ [[30,0,4,-20,65,30],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tP;";
    let named = "MoveAbsJ jB,v1000,fine,tP;";
    for (statement, args, stays) in
        [(own, &[][..], true), (own, &["--inline-targets"], false), (named, &[], false)]
    {
        let (_folder, path) = module(program("", statement));
        let reported = stdout(&joulepath(&[&["optimize", &path], args, &ROBOT[..]].concat()));
        assert_eq!(reported.contains("inline-target: "), stays, "{reported}");
    }
}

/// Guards compare values: a name may be edited or receive another value.
#[test]
fn the_original_runs_where_a_name_has_another_value() {
    let (folder, path) = module(program("", "MoveAbsJ jA,v1000,fine,tP;"));
    let out = folder.path().join("out");
    let options = ["optimize", &path, "--out", out.to_str().unwrap()];
    let (reported, code) = messages_of(folder.path(), &options);
    assert_eq!(code, Some(0), "{reported}");
    let paths = ["m.mod", "Joulepath.mod"].map(|name| out.join(name));
    let written = paths.each_ref().map(|file| fs::read_to_string(file).unwrap());
    let time = || {
        let args = ["simulate", out.to_str().unwrap(), "--format", "json", "--quiet"];
        number(&json(&[&args[..], &ROBOT].concat()), "/cycle_s")
    };
    let before = time();
    let slow = "CONST speeddata v1000:=[50,500,5000,1000];\nPROC main";
    let changes: [[String; 2]; 3] = [
        [written[0].replace("v1000", "v50"), written[1].clone()],
        written.each_ref().map(|text| text.replace("v1000", "v50")),
        [written[0].replacen("PROC main", slow, 1), written[1].clone()],
    ];
    for changed in changes {
        for (file, text) in paths.iter().zip(&changed) {
            fs::write(file, text).unwrap();
        }
        assert!(time() > 2.0 * before, "{}", changed[0]);
    }
    // Streams have their own zones.
    let small = "CONST zonedata z200:=[FALSE,1,1,1,1,1,1];\nPROC main";
    fs::write(&paths[0], written[0].replacen("PROC main", small, 1)).unwrap();
    fs::write(&paths[1], &written[1]).unwrap();
    assert!((time() - before).abs() < 1e-6);
}

/// The operator's override scales the duration of streams and movements equally.
#[test]
fn streams_for_a_speed_override_take_no_longer() {
    for percent in ["50", "99"] {
        let statements = "MoveAbsJ jB,v1000,fine,tP;\nMoveAbsJ jA,v1000,fine,tP;";
        let options = ["--point-estimate", "--speed-override", percent];
        let result = optimized(statements, &[&options[..], &ROBOT].concat());
        let segments = result["segments"].as_array().unwrap();
        let streams = segments.iter().filter(|segment| segment["rewritten"] == true).count();
        assert!(streams > 0, "{result:#}");
        let longer = number(&result, "/optimized/cycle_s") - number(&result, "/original/cycle_s");
        assert!(longer < 1e-3, "{longer}");
    }
}

/// In strings of RAPID, quotes and backslashes are doubled.
#[test]
fn arguments_in_messages_are_escaped_for_rapid() {
    let function = "FUNC jointtarget fPlace(string sName\\num nUp)\nRETURN jB;\nENDFUNC\n";
    let statement = "MoveAbsJ fPlace(\"a\\nUp:=1),v1000,fine,tP;".replace("\"a", "\"a\"");
    let text = program("", &statement).replace("PROC main", &format!("{function}PROC main"));
    let (folder, path) = module(text);
    let out = folder.path().join("out");
    let (messages, code) =
        messages_of(folder.path(), &["optimize", &path, "--out", out.to_str().unwrap()]);
    assert_eq!(code, Some(0), "{messages}");
    let module = fs::read_to_string(out.join("Joulepath.mod")).unwrap();
    assert!(module.contains("\"fPlace(\"\"a\"\"\\\\nUp:=1)\""), "{module}");
}

#[test]
fn the_value_that_an_error_message_proposes_is_accepted() {
    let (folder, path) = module(program("", "WaitTime 0.5;"));
    for flag in ["--takt", "--time-factor"] {
        let (message, _) = messages_of(folder.path(), &["optimize", &path, flag, "0.1"]);
        let (_, advice) = message.split_once(&format!("give {flag} ")).unwrap();
        let least = advice.split(' ').next().unwrap();
        let args = ["optimize", &path, flag, least, "--format", "json"];
        let result = json(&[&args[..], &ROBOT].concat());
        let cycle = number(&result, "/optimized/cycle_s");
        assert!(cycle < number(&result, "/original/cycle_s"), "{flag} {least}: {cycle} s");
        if flag == "--takt" {
            assert!(cycle <= least.parse::<f64>().unwrap() + 1e-6, "{least}: {cycle} s");
        }
    }
}

#[test]
fn a_duration_that_needs_more_energy_causes_a_note() {
    // The extended arm needs more holding power than the final pose of the cycle.
    let far = "CONST jointtarget jFar:=[[20,85,-5,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
               CONST jointtarget jOut:=[[35,85,-5,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];";
    let out = "MoveAbsJ jFar,v1000,fine,tP;\nMoveAbsJ jOut,v1000,fine,tP;";
    let (_folder, path) = module(program(far, out));
    let args = ["optimize", &path, "--time-factor", "10", "--format", "json", "--quiet"];
    let result = json(&[&args[..], &KNOWN].concat());
    let note = result["notes"][1].as_str().unwrap();
    assert!(note.contains("1 of the rewritten runs take more energy than before"), "{note}");
    assert!(note.contains("m.mod:10)"), "{note}");
}

/// With a longer takt, the original is padded with a wait.
#[test]
fn a_longer_time_is_compared_with_a_padded_original() {
    let text = program("", "WaitTime 0.5;");
    let (_folder, path) = module(&text);
    let path = path.as_str();
    let simulated =
        || json(&[&["simulate", path, "--format", "json", "--quiet"][..], &KNOWN].concat());
    let alone = simulated();
    let takt = (number(&alone, "/cycle_s") + 3.0).to_string();
    let forms = [["--takt", &takt], ["--time-factor", "1.8"]];
    for time in forms {
        for form in [&[][..], &["--emit", "retime"]] {
            let args = ["optimize", path, "--format", "json", "--quiet"];
            let result = json(&[&args[..], &time, form, &KNOWN].concat());
            let [original, optimized] =
                ["original", "optimized"].map(|side| number(&result, &format!("/{side}/cycle_s")));
            assert!(optimized > number(&alone, "/cycle_s") + 0.5, "{time:?}: {result}");
            assert!((original - optimized).abs() < 1e-9, "{original} s, {optimized} s");
            let padding = number(&result, "/original/padding_s");
            let own =
                number(&result, "/original/energy_j") - number(&result, "/original/padding_j");
            assert!((own - number(&alone, "/energy_j")).abs() < 1e-6, "{own} J");
            assert!(number(&result, "/saving_percent") > 0.0, "{time:?} {form:?}: {result}");
            let note = result["notes"][0].as_str().unwrap();
            assert!(note.starts_with("the original is padded"), "{note}");

            let waiting = text.replace("ENDPROC", &format!("WaitTime {padding};\nENDPROC"));
            fs::write(path, waiting).unwrap();
            let waiting = simulated();
            fs::write(path, &text).unwrap();
            let error = number(&waiting, "/energy_j") - number(&result, "/original/energy_j");
            assert!(error.abs() < 1e-6, "{error} J");
            let args = [&["optimize", path][..], &time, form, &KNOWN].concat();
            let table = stdout(&joulepath(&args));
            let row = table.lines().find(|line| line.starts_with("end of the cycle"));
            assert!(row.is_some_and(|row| row.contains("padding")), "{table}");
        }
    }
    // With its own takt, no wait is added.
    let result = json(&[&["optimize", path, "--format", "json", "--quiet"][..], &KNOWN].concat());
    assert_eq!(number(&result, "/original/padding_s"), 0.0);
}

/// With assumed limits a run may also use additional time. If the true limits are lower, it loses
/// no more than the original: a known wait keeps a reserve.
#[test]
fn additional_time_is_used_where_limits_are_assumed() {
    let statements = "WaitTime 0.5;\nMoveAbsJ jB,v1000,fine,tP;\nWaitDI diGo,1;";
    let optimized = |options: &[&str]| {
        optimized(statements, &[&["--robot", "IRB1600-10/1.45"], options].concat())
    };
    let plain = optimized(&[]);
    let late = (number(&plain, "/original/cycle_s") + 1.0).to_string();
    for form in [&[][..], &["--emit", "retime"]] {
        for time in [["--input", &format!("diGo={late}")], ["--time-factor", "1.4"]] {
            let result = optimized(&[&time[..], form].concat());
            let saved = number(&result, "/motion_saving_percent");
            assert!(
                saved > number(&plain, "/motion_saving_percent") + 5.0,
                "{time:?} {form:?} {saved}"
            );
            let cycles =
                ["original", "optimized"].map(|s| number(&result, &format!("/{s}/cycle_s")));
            let limits = result["lower_limits"].as_array().unwrap();
            assert_eq!(limits.len(), 3);
            for lower in limits {
                let loss =
                    |side: &str, planned: f64| number(lower, &format!("/{side}_s")) - planned;
                let own = loss("original", cycles[0] - number(&result, "/original/padding_s"));
                assert!(loss("optimized", cycles[1]) <= own + LOSS * cycles[0], "{time:?} {lower}");
            }
        }
    }
}

/// Accepted additional loss of a retrofit under lower limits, as a share of the cycle.
const LOSS: f64 = 0.005;

#[test]
fn unusual_statements_have_their_true_reason() {
    let clash = "CONST num nX:=1;\nPROC rB()\nENDPROC\nPROC rB()\nENDPROC\nVAR num nX:=2;";
    let heavy = "PERS tooldata tH:=[TRUE,[[0,0,90],[1,0,0,0]],[1E30,[0,0,9],[1,0,0,0],0,0,0]];";
    let endless = "PROC rEndless()\nrEndless;\nENDPROC";
    let cases = [
        ("", "WaitTime 1E400;", &[][..]),
        ("", "WaitTime -3;", &[]),
        ("", "WaitUntil diOn=1;", &["--input", "diNo=2"]),
        (clash, "rB;\nWaitTime nX;\nMoveAbsJ jB,[nX,5,5,5],fine,tP;", &[]),
        (heavy, "MoveAbsJ jB,v1000,fine,tH;", &[]),
        (endless, "rEndless;", &[]),
        ("", "again:\nMoveAbsJ jB,v1000,fine,tP;\nMoveAbsJ jA,v1000,fine,tP;\nGOTO again;", &[]),
        ("", "IF jpAt(jpFrom1) THEN\njpRun1 tP;\nENDIF", &[]),
    ];
    let mut all = String::new();
    for (declarations, statements, args) in cases {
        let (messages, code) = messages_of_program(declarations, statements, args);
        writeln!(all, "{statements}\n-> {}\n{messages}", code.unwrap()).unwrap();
    }
    snapshots().bind(|| insta::assert_snapshot!("odd", all));
}

#[test]
fn an_unknown_call_is_the_reason_for_what_it_may_change() {
    let target = "PERS jointtarget jP:=[[40,10,4,-20,65,30],[9E9,9E9,9E9,9E9,9E9,9E9]];";
    // A tool that is passed counts as constant: no statement of the program writes it.
    let statements = "MoveAbsJ jB,v500,fine,tP;\nrElsewhere jP,tP;\nMoveAbsJ jA,v500,fine,tP;\n\
                      MoveAbsJ jP,v500,fine,tP;";
    let (_folder, path) = module(program(target, statements));
    let args = ["optimize", &path, "--format", "json"];
    let result = json(&[&args[..], &ROBOT].concat());
    let segments = result["segments"].as_array().unwrap();
    let reasons: Vec<&str> = segments.iter().filter_map(|s| s["reason"].as_str()).collect();
    insta::assert_snapshot!("unknown_call", reasons.join("\n"));
}

/// A long movement of the extended arm: distant points need larger zones.
const FAR: &str = "CONST jointtarget jC:=[[-100,50,-30,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
                   CONST jointtarget jD:=[[100,50,-30,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];";

#[test]
fn streams_work_without_indentation_and_over_long_distances() {
    let statements = "MoveAbsJ jC,vmax,fine,tP;\nMoveAbsJ jD,vmax,fine,tP;";
    let (_folder, path) = module(program(FAR, statements));
    let args = ["optimize", &path, "--format", "json"];
    let result = json(&[&args[..], &ROBOT].concat());
    for segment in &result["segments"].as_array().unwrap()[1..] {
        assert_eq!(segment["rewritten"], true, "{segment}");
    }
}

/// First line of each timing segment, and whether it is a stream.
fn streams(declarations: &str, statements: &str) -> Vec<(u64, bool)> {
    let folder = tempfile::tempdir().unwrap();
    let options = [&["--allow-faster-joints"], &KNOWN[..]].concat();
    let result = command::optimize(folder.path(), program(declarations, statements), &options);
    let segments = result["segments"].as_array().unwrap().iter();
    let timing = segments.filter(|segment| segment["kind"] == "timing");
    timing.map(|s| (s["line_first"].as_u64().unwrap(), s["rewritten"] == true)).collect()
}

#[test]
fn statements_may_stand_close_together() {
    let close = "MoveAbsJ jB,v500,fine,tP;SetDO doA,1;MoveAbsJ jA,v500,fine,tP;";
    assert_eq!(streams("", close), [(7, false), (8, true), (8, true), (9, true)]);
}

#[test]
fn a_fly_by_movement_into_the_next_loop_pass_is_kept() {
    // From the second pass on, the last and the first movement of the loop form one path.
    let flies = |zone: &str| {
        format!(
            "MoveAbsJ jB,v500,fine,tP;\nWHILE TRUE DO\nMoveAbsJ jA,v500,fine,tP;\n\
             MoveAbsJ jB,v500,{zone},tP;\nENDWHILE"
        )
    };
    assert_eq!(
        streams("", &flies("z50")),
        [(7, false), (8, true), (10, false), (11, false), (13, false)]
    );
    assert_eq!(
        streams("", &flies("fine")),
        [(7, false), (8, true), (10, true), (11, true), (13, false)]
    );
}

#[test]
fn a_path_through_two_routines_does_not_prevent_other_streams() {
    let helper = "PROC rGo()\nMoveAbsJ jB,v500,fine,tP;\nMoveAbsJ jA,v500,z20,tP;\nENDPROC";
    let calls = "rGo;\nrGo;\nMoveAbsJ jA,v500,fine,tP;\nMoveAbsJ jB,v500,fine,tP;\n\
                 MoveAbsJ jA,v500,fine,tP;";
    let streams = streams(helper, calls);
    let is_stream = |line: u64| streams.iter().find(|(first, _)| *first == line).unwrap().1;
    assert!(is_stream(14) && is_stream(15) && is_stream(16), "{streams:?}");
}

#[test]
fn the_folder_of_the_program_is_refused_as_output() {
    let source = program("", "MoveAbsJ jB,v500,fine,tP;\nMoveAbsJ jA,v500,fine,tP;");
    let (folder, path) = module(&source);
    let out = folder.path().to_str().unwrap();
    refused(&[&["optimize", &path, "--out", out], &ROBOT[..]].concat(), "--in-place");
    assert_eq!(fs::read_to_string(&path).unwrap(), source);
}

#[test]
fn two_entry_routines_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.mod", "b.mod"] {
        fs::write(folder.path().join(name), program("", "")).unwrap();
    }
    let (message, code) =
        messages_of(folder.path(), &["optimize", folder.path().to_str().unwrap()]);
    assert_eq!(code, Some(2));
    assert!(message.contains("[folder]/a.mod:6 and in [folder]/b.mod:6"), "{message}");
    fs::write(folder.path().join("a.mod"), "\r\n").unwrap();
    let empty = folder.path().join("a.mod");
    let (message, _) = messages_of(folder.path(), &["optimize", empty.to_str().unwrap()]);
    assert!(message.contains("is empty"), "{message}");
}

#[test]
fn a_load_gripped_while_waiting_is_held() {
    let part = "PERS loaddata lPart:=[6,[0,0,60],[1,0,0,0],0,0,0];";
    let energy = |statements: &str| {
        let (_folder, path) = module(program(part, statements));
        let args = ["simulate", &path, "--format", "json"];
        number(&json(&[&args[..], &ROBOT].concat()), "/energy/idle_j")
    };
    let loaded = energy("MoveAbsJ jB,v1000,fine,tP;\nGripLoad lPart;\nWaitTime 20;");
    let empty = energy("MoveAbsJ jB,v1000,fine,tP;\nWaitTime 20;\nGripLoad lPart;");
    assert!(loaded > empty + 10.0, "{loaded} {empty}");
}

#[test]
fn the_list_of_modules_names_the_new_one() {
    let outside = tempfile::tempdir().unwrap();
    let folder = outside.path().join("cell");
    fs::create_dir(&folder).unwrap();
    let list = "<?xml version=\"1.0\"?>\r\n<Program>\r\n\t<Module>m.mod</Module>\r\n</Program>\r\n";
    fs::write(folder.join("cell.pgf"), list).unwrap();
    fs::write(folder.join("m.mod"), program("", "")).unwrap();
    let path = folder.join("cell.pgf");
    let out = folder.join("out");
    let args = ["optimize", path.to_str().unwrap(), "--out", out.to_str().unwrap()];
    assert_eq!(messages_of(&folder, &args).1, Some(0));
    let entry = "\r\n\t<Module>Joulepath.mod</Module>";
    let expected = list.replace("m.mod</Module>", &format!("m.mod</Module>{entry}"));
    assert_eq!(fs::read_to_string(out.join("cell.pgf")).unwrap(), expected);
    // The output is a complete program.
    let (message, code) =
        messages_of(&folder, &["simulate", out.join("cell.pgf").to_str().unwrap()]);
    assert_eq!((message.as_str(), code), ("", Some(0)));
    let args = ["optimize", path.to_str().unwrap(), "--in-place"];
    assert_eq!(messages_of(&folder, &args).1, Some(0));
    assert_eq!(fs::read_to_string(&path).unwrap(), expected);
    let kept = outside.path().join("cell.joulepath-undo/files/cell.pgf");
    assert_eq!(fs::read_to_string(kept).unwrap(), list);
}

#[test]
fn files_of_one_name_do_not_collide() {
    let folder = tempfile::tempdir().unwrap();
    let paths = ["x", "y"].map(|name| folder.path().join(name).join("m.mod"));
    for path in &paths {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
    }
    fs::write(&paths[0], program("", "")).unwrap();
    fs::write(&paths[1], "MODULE other\nENDMODULE\n").unwrap();
    let [x, y] = [&paths[0], &paths[1]].map(|path| path.to_str().unwrap());
    let out = folder.path().join("out");
    let args = ["optimize", x, y, "--out", out.to_str().unwrap()];
    assert_eq!(messages_of(folder.path(), &args).1, Some(0));
    assert_eq!(fs::read(out.join("y/m.mod")).unwrap(), fs::read(y).unwrap());
    assert!(out.join("x/Joulepath.mod").is_file());
}

#[test]
fn text_diff_and_module_agree_with_the_snapshots() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let args = ["optimize", "fixtures/hard/encoding.mod", "--quiet"];
    snapshots().bind(|| insta::assert_snapshot!("text", stdout(&joulepath(&args))));
    let args = ["optimize", "fixtures/hard/encoding.mod", "--quiet", "--diff"];
    snapshots().bind(|| insta::assert_snapshot!("diff", stdout(&joulepath(&args))));
    let args =
        ["optimize", "fixtures/hard/encoding.mod", "--quiet", "--out", out.to_str().unwrap()];
    run(&args);
    let module =
        String::from_utf8_lossy(&fs::read(out.join("Joulepath.mod")).unwrap()).into_owned();
    snapshots().bind(|| insta::assert_snapshot!("module", module));
}

#[test]
fn json_has_the_fields_of_the_contract() {
    let args = ["optimize", "fixtures/hard/encoding.mod", "--quiet", "--format", "json"];
    snapshots().bind(|| insta::assert_snapshot!("json", stdout(&joulepath(&args))));
    let args = ["simulate", "fixtures/hard/encoding.mod", "--quiet", "--format", "json"];
    snapshots().bind(|| insta::assert_snapshot!("simulate", stdout(&joulepath(&args))));
}
