//! `optimize --emit retime` and `--emit egm`.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;

use std::fs;
use std::path::Path;

use command::{KNOWN_LIMITS, json, number, rows};
use serde_json::Value;

/// Rounding of a sum of times, s.
const TIME: f64 = 1e-6;
/// Clock of externally guided motion, s.
const TICK: f64 = 0.004;
/// Rounding of a position in text, degrees.
const ROUNDING: f64 = 1e-5;

const FAR: &str = "[9E9,9E9,9E9,9E9,9E9,9E9]";

fn program() -> String {
    format!(
        "MODULE M\n\
         CONST jointtarget jA:=[[0,-12,14,0,60,0],{FAR}];\n\
         CONST jointtarget jB:=[[60,20,0,-20,65,30],{FAR}];\n\
         PERS tooldata tGun:=[TRUE,[[0,0,80],[1,0,0,0]],[2,[0,0,40],[1,0,0,0],0,0,0]];\n\
         PERS wobjdata woTable:=[FALSE,TRUE,\"\",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n\
         CONST robtarget pC:=[[850,300,1000],[0,0,1,0],[0,0,0,0],{FAR}];\n\
         CONST robtarget pD:=[[850,-300,1000],[0,0,1,0],[-1,0,0,0],{FAR}];\n\
         PROC main()\n\
         ConfL \\Off; MoveAbsJ jA,v1000,fine,tool0;\n\
         MoveAbsJ jB,vmax,fine,tool0; ! quick\n\
         WaitDI diPart,1;\n\
         MoveJ pC,v300,fine,tool0;\n\
         MoveL Offs(pC,0,-100,0),v300,z20,tool0;\n\
         MoveL pD,v500,fine,tool0\\WObj:=wobj0;\n\
         MoveJ pC,v1000\\V:=700,fine,tool0;\n\
         MoveAbsJ jA,v1000,fine,tGun\\WObj:=woTable;\n\
         ENDPROC\n\
         ENDMODULE\n"
    )
}

fn run(folder: &Path, options: &[&str]) -> Value {
    run_text(folder, &program(), options)
}

fn run_text(folder: &Path, text: &str, options: &[&str]) -> Value {
    command::optimize(folder, text, &[&["--robot", KNOWN_LIMITS], options].concat())
}

fn simulate(path: &Path, input: &str) -> Value {
    let args = ["simulate", path.to_str().unwrap(), "--robot", KNOWN_LIMITS, "--format", "json"];
    json(&[&args[..], &["--quiet", "--input", input]].concat())
}

/// TCP speed in a statement's second argument, mm/s.
fn speed(statement: &str) -> f64 {
    let inside =
        statement.split_once(",v").map(|(_, rest)| rest.split([',', '\\']).next().unwrap());
    match inside {
        Some("max") => f64::INFINITY,
        Some(name) => name.parse().unwrap(),
        None => {
            let literal = statement.split(",[").last().unwrap();
            let first = literal.split(',').next().unwrap();
            let Some((share, name)) = first.split_once("*v") else { return first.parse().unwrap() };
            let named: f64 = name.strip_suffix(".v_tcp").unwrap().parse().unwrap();
            share.parse::<f64>().unwrap() * named
        }
    }
}

#[test]
fn retiming_changes_only_speeds_and_raises_none() {
    let folder = tempfile::tempdir().unwrap();
    let result = run(folder.path(), &["--emit", "retime", "--input", "diPart=4"]);
    let cycle = |which: &str| number(&result, &format!("/{which}/cycle_s"));
    assert!(cycle("optimized") <= cycle("original") + TIME, "{result}");
    assert!(number(&result, "/saving_percent") > 1.0, "{result}");
    let written = fs::read_to_string(folder.path().join("out/m.mod")).unwrap();
    assert!(!folder.path().join("out/Joulepath.mod").exists());
    let original = program();
    let mut changed = 0;
    for (was, now) in original.lines().zip(written.lines()) {
        if was == now {
            continue;
        }
        changed += 1;
        // Only the speed changes.
        let (head, tail) = (was.find(",v").unwrap(), was.find(",fine").or(was.find(",z")).unwrap());
        assert!(now.starts_with(&was[..=head]) && now.ends_with(&was[tail..]), "{was}\n{now}");
        // For joint movements it is an upper bound, too.
        assert!(speed(now) <= speed(was), "{was}\n{now}");
    }
    assert_eq!(original.lines().count(), written.lines().count());
    assert!(changed >= 1, "{written}");
    // The quick movement before the wait is slower now; a speed with \V stays.
    assert!(
        written.contains("MoveAbsJ jB,[") && written.contains("v1000\\V:=700,fine"),
        "{written}"
    );
    // The written program has the predicted result.
    let simulated = simulate(&folder.path().join("out"), "diPart=4");
    let promised = number(&result, "/optimized/energy_j");
    assert!((number(&simulated, "/energy_j") - promised).abs() < 1e-6 * promised);
    // A second run finds no saving.
    let folder = tempfile::tempdir().unwrap();
    let again = run_text(folder.path(), &written, &["--emit", "retime", "--input", "diPart=4"]);
    assert_eq!(fs::read_to_string(folder.path().join("out/m.mod")).unwrap(), written, "{again}");
}

#[test]
fn streams_save_more_than_retimed_speeds() {
    for input in [&[][..], &["--input", "diPart=4"]] {
        let folder = tempfile::tempdir().unwrap();
        let speeds = run(folder.path(), &[&["--emit", "retime"], input].concat());
        let folder = tempfile::tempdir().unwrap();
        let streams = run(folder.path(), input);
        let saved = |result: &Value| number(result, "/saving_percent");
        assert!(saved(&streams) > saved(&speeds), "{} {}", saved(&streams), saved(&speeds));
        // The wait for an input is used, and the cycle keeps its duration.
        let cycle = |which: &str| number(&streams, &format!("/{which}/cycle_s"));
        assert!(cycle("optimized") <= cycle("original") + TIME, "{streams}");
        assert!(cycle("optimized") > 0.995 * cycle("original"), "{streams}");
    }
}

#[test]
fn egm_writes_positions_beside_an_unchanged_program() {
    let folder = tempfile::tempdir().unwrap();
    let streams = run(folder.path(), &[]);
    let folder = tempfile::tempdir().unwrap();
    let result = run(folder.path(), &["--emit", "egm"]);
    let out = folder.path().join("out");
    assert_eq!(fs::read_to_string(out.join("m.mod")).unwrap(), program());
    assert_eq!(number(&result, "/saving_percent"), 0.0);
    let segments = result["segments"].as_array().unwrap();
    let guided = segments
        .iter()
        .filter(|s| s["reason"].as_str().is_some_and(|reason| reason.starts_with("guided: ")));
    let rewritten =
        streams["segments"].as_array().unwrap().iter().filter(|s| s["rewritten"] == true);
    let times: Vec<f64> = rewritten.map(|s| number(s, "/time_after_s")).collect();
    assert_eq!(guided.count(), times.len());
    let mut files: Vec<_> =
        fs::read_dir(out.join("egm")).unwrap().map(|f| f.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "csv"));
    assert_eq!(files.len(), times.len());
    files.sort();
    let mut tools = std::collections::BTreeSet::new();
    for path in &files {
        let rows = rows(&fs::read_to_string(path).unwrap());
        // Speed limits of the data sheet, and rest at both ends.
        let limit = [180.0, 180.0, 185.0, 385.0, 400.0, 460.0];
        for pair in rows.windows(2) {
            assert!((pair[1][0] - pair[0][0] - TICK).abs() < TIME);
            for j in 0..6 {
                assert!((pair[1][j + 1] - pair[0][j + 1]).abs() <= 1.001 * limit[j] * TICK);
            }
        }
        let module = fs::read_to_string(path.with_extension("mod")).unwrap();
        let start = module.split("MoveAbsJ [[").nth(1).unwrap().split(']').next().unwrap();
        for (a, b) in start.split(',').zip(&rows[0][1..]) {
            assert!((a.parse::<f64>().unwrap() - b).abs() < ROUNDING, "{module}");
        }
        assert!(module.contains("EGMRunJoint"), "{module}");
        // Without it the controller accepts a joint motion of a degree per second.
        let steps =
            rows.windows(2).flat_map(|pair| (1..7).map(|j| (pair[1][j] - pair[0][j]).abs()));
        let fastest = steps.fold(0.0, f64::max) / TICK;
        let stated = module.split(r"\MaxSpeedDeviation:=").nth(1).unwrap();
        let stated: f64 = stated.split(';').next().unwrap().parse().unwrap();
        assert!(stated >= 1.2 * fastest && stated <= 1.3 * fastest + 1.0, "{stated}, {fastest}");
        // The run with the gun and the other runs.
        let named = if module.contains(",tGun") { ("tGun", "woTable") } else { ("tool0", "wobj0") };
        let (tool, work_object) = named;
        assert!(module.contains(&format!(",fine,{tool}\\WObj:={work_object};")), "{module}");
        let active = format!("EGMActJoint egmId\\Tool:={tool}\\WObj:={work_object}\\J1:=");
        assert!(module.contains(&active), "{module}");
        tools.insert(tool);
    }
    assert_eq!(tools.len(), 2, "{tools:?}");
}

/// The module is next to the program, which does not see the module's local data.
#[test]
fn egm_refuses_a_tool_that_is_local_to_its_module() {
    let folder = tempfile::tempdir().unwrap();
    let text = program().replace("PERS tooldata", "LOCAL PERS tooldata");
    let result = run_text(folder.path(), &text, &["--emit", "egm"]);
    let segments = result["segments"].as_array().unwrap();
    let reasons: Vec<&str> = segments.iter().filter_map(|s| s["reason"].as_str()).collect();
    let refused = reasons.iter().filter(|reason| reason.contains("tGun is not known outside"));
    assert_eq!(refused.count(), 1, "{reasons:?}");
    let guided = reasons.iter().filter(|reason| reason.starts_with("guided: ")).count();
    assert!(guided > 0, "{reasons:?}");
}

/// If the operator reduces a speed, a retimed program becomes slower, too.
#[test]
fn retimed_speeds_follow_their_speed_data() {
    let folder = tempfile::tempdir().unwrap();
    let data = "VAR speeddata vWay:=[800,500,5000,1000];\n\
                CONST speeddata vAll{2}:=[[300,200,5000,1000],[600,300,5000,1000]];\n\
                FUNC speeddata fSlow()\nRETURN v200;\nENDFUNC\n\
                PROC main()";
    let text = program()
        .replace("PROC main()", data)
        .replace("MoveJ pC,v300", "MoveJ pC,vWay")
        .replace("MoveL Offs(pC,0,-100,0),v300", "MoveL Offs(pC,0,-100,0),vAll{1}")
        .replace("MoveL pD,v500", "MoveL pD,vAll{2}")
        .replace("MoveJ pC,v1000\\V:=700", "MoveJ pC,fSlow()");
    let options = ["--emit", "retime", "--time-factor", "1.6", "--input", "diPart=0"];
    run_text(folder.path(), &text, &options);
    let retimed = fs::read_to_string(folder.path().join("out/m.mod")).unwrap();
    let line = |part: &str| retimed.lines().find(|line| line.contains(part)).unwrap();
    assert!(line("MoveJ pC,[").contains("*vWay.v_ori,vWay.v_leax,vWay.v_reax]"), "{retimed}");
    assert!(line("MoveL pD,[").contains("*vAll{2}.v_tcp,"), "{retimed}");
    assert!(line("MoveJ pC,fSlow()").ends_with(",fine,tool0;"), "{retimed}");
    // Standard names: replacing v1000 by v100 has the same effect.
    assert!(line("MoveAbsJ jA,[").contains("*v1000.v_ori,v1000.v_leax,v1000.v_reax]"), "{retimed}");
    // The value of vmax depends on the controller.
    assert!(line("MoveAbsJ jB,[").contains(",5000,1000]"), "{retimed}");

    let times = |text: &str, name: &str| -> Vec<(u64, f64)> {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        let result = simulate(&path, "diPart=0");
        let moves = result["moves"].as_array().unwrap();
        moves
            .iter()
            .map(|m| (m["line"].as_u64().unwrap(), m["duration_s"].as_f64().unwrap()))
            .collect()
    };
    for (from, to) in
        [("[800,500,", "[40,500,"), ("[300,200,", "[20,200,"), ("[600,300", "[30,300")]
    {
        let [original, retimed] = [(&text, "a.mod"), (&retimed, "b.mod")]
            .map(|(text, name)| times(&text.replace(from, to), name));
        for ((line, original), (other, retimed)) in original.iter().zip(&retimed) {
            assert!(
                line == other && *retimed >= original - TIME,
                "{to}: {line}: {original} {retimed}"
            );
        }
    }
}
