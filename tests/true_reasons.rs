//! Difficult programs: each movement becomes a stream or has a true reason.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;

use std::fs;
use std::path::Path;

use command::{KNOWN_LIMITS, json, module};
use serde_json::Value;

const FAR: &str = "[9E9,9E9,9E9,9E9,9E9,9E9]";
/// Tolerance between two computations of the same energy, J.
const ENERGY: f64 = 1e-6;

fn optimize(input: &Path, out: &Path) -> Value {
    optimize_with(input, out, &[])
}

fn optimize_with(input: &Path, out: &Path, args: &[&str]) -> Value {
    let (input, out) = (input.to_str().unwrap(), out.to_str().unwrap());
    let robot = ["--robot", KNOWN_LIMITS, "--allow-faster-joints", "--inline-targets"];
    let form = ["optimize", input, "--out", out, "--format", "json", "--quiet"];
    let result = json(&[&form[..], &robot, args].concat());
    assert_eq!(result["verification"]["passed"], true, "{result}");
    result
}

/// The segments of a program with module-level text and movements.
fn segments(declarations: &str, movements: &[String]) -> Vec<Value> {
    segments_with(declarations, movements, &[])
}

fn segments_with(declarations: &str, movements: &[String], args: &[&str]) -> Vec<Value> {
    let movements = movements.join("\n");
    let text = format!("MODULE M\n{declarations}PROC main()\n{movements}\nENDPROC\nENDMODULE\n");
    let (folder, path) = module(text);
    let result = optimize_with(Path::new(&path), &folder.path().join("out"), args);
    result["segments"].as_array().unwrap().clone()
}

fn joints(q: [f64; 6], rest: &str) -> String {
    let [a, b, c, d, e, f] = q;
    format!("MoveAbsJ [[{a},{b},{c},{d},{e},{f}],{FAR}],{rest},tool0;")
}

fn pose(form: &str, [x, y, z]: [f64; 3], rest: &str) -> String {
    let conf = if y < 0.0 { "[-1,0,-1,0]" } else { "[0,0,0,0]" };
    format!("{form} [[{x},{y},{z}],[0,0,1,0],{conf},{FAR}],{rest},tool0;")
}

fn there_and_back() -> Vec<String> {
    let (a, b) = ([0.0, 0.0, 0.0, 0.0, 30.0, 0.0], [40.0, 10.0, 10.0, 0.0, 60.0, 20.0]);
    vec![joints(a, "v1000,fine"), joints(b, "v1000,fine"), joints(a, "v1000,fine")]
}

fn reasons(segments: &[Value]) -> Vec<String> {
    let all = segments.iter().filter_map(|s| s["reason"].as_str());
    all.map(|reason| reason.split(':').next().unwrap().to_owned()).collect()
}

#[test]
fn redefined_names_of_rapid_prevent_streams() {
    // The guard would be true at any position of the robot.
    let abs = "FUNC num Abs(num x)\nRETURN 0;\nENDFUNC\n";
    let zone = "CONST zonedata z200:=[FALSE,1,1,1,1,1,1];\n";
    for own in [abs, zone] {
        let found = reasons(&segments(own, &there_and_back()));
        assert_eq!(found, ["first-movement", "own-name", "own-name"], "{own}");
    }
    // Local data of another module have no effect.
    let local = segments(&format!("LOCAL {zone}"), &there_and_back());
    assert_eq!(reasons(&local), ["first-movement"], "{local:?}");
}

/// RAPID names are case-insensitive.
#[test]
fn tool_names_are_case_insensitive() {
    let tool = "PERS tooldata tGun:=[TRUE,[[0,0,80],[1,0,0,0]],[2,[0,0,40],[1,0,0,0],0,0,0]];\n";
    let other = tool.replace("tGun", "tOther");
    let through = |last: &str| {
        let q = |angle: f64| [angle, angle / 4.0, 10.0, 0.0, 60.0, 20.0];
        let tools = ["tGun", "tGun", "TGUN", last];
        let movements = [(0.0, "v1000,fine"), (20.0, "v1000,z50"), (40.0, "v1000,z50")];
        let mut all: Vec<String> = movements.map(|(angle, rest)| joints(q(angle), rest)).to_vec();
        all.push(joints(q(60.0), "v1000,fine"));
        let all = all.iter().zip(tools).map(|(movement, tool)| movement.replace("tool0", tool));
        segments(&format!("{tool}{other}"), &all.collect::<Vec<String>>())
    };
    let same = through("tgun");
    assert_eq!(reasons(&same), ["first-movement"], "{same:?}");
    let changed = through("tOther");
    assert_eq!(reasons(&changed), ["first-movement", "setting"], "{changed:?}");
}

#[test]
fn a_long_turn_of_one_joint_becomes_a_stream() {
    let turned = |angle: f64| joints([0.0, 0.0, 0.0, 0.0, 30.0, angle], "vmax,fine");
    let movements = [turned(300.0), turned(-300.0), turned(300.0)];
    // This tests the path, not whether it saves energy in nearly every plausible robot.
    let segments = segments_with("", &movements, &["--point-estimate"]);
    assert_eq!(reasons(&segments), ["first-movement"], "{segments:?}");
}

#[test]
fn simultaneous_reversals_of_joints_do_not_prevent_streams() {
    let movements = [
        joints([0.0, 0.0, 0.0, 0.0, 30.0, 0.0], "v1000,fine"),
        pose("MoveJ", [879.8, 72.6, 453.7], "v1000,fine"),
        pose("MoveL", [933.3, 293.8, 739.3], "v2000,z1"),
        pose("MoveL", [732.8, 43.3, 847.3], "v200,z10"),
        pose("MoveJ", [760.8, 195.5, 719.4], "v500,z50"),
        pose("MoveL", [747.8, 303.5, 633.8], "v1000,fine"),
        pose("MoveL", [812.0, 212.7, 661.8], "v2000,z1"),
    ];
    let segments = segments("", &movements);
    assert_eq!(reasons(&segments), ["first-movement", "flies-on"], "{segments:?}");
}

#[test]
fn streams_of_short_movements_stay_above_their_bound() {
    let bent = |angle: f64, last: f64| joints([0.0, 0.0, 0.0, 0.0, angle, last], "vmax,fine");
    let movements =
        [bent(30.0, 0.0), bent(30.02, 0.0), bent(30.5, 0.0), bent(31.5, 0.0), bent(31.5, 1.0)];
    for segment in segments("", &movements) {
        if segment["rewritten"] == true {
            let figure = |key: &str| segment[key].as_f64().unwrap();
            assert!(figure("points") > 1.0, "{segment}");
            assert!(figure("lower_bound_j") <= figure("energy_after_j") + ENERGY, "{segment}");
        }
    }
}

#[test]
fn a_second_retrofit_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let movements = [
        joints([0.0, 0.0, 0.0, 0.0, 30.0, 0.0], "v1000,fine"),
        pose("MoveL", [933.3, 293.8, 739.3], "v2000,z1"),
        pose("MoveL", [732.8, 43.3, 847.3], "v200,fine"),
        pose("MoveL", [747.8, 303.5, 633.8], "v50,fine"),
        pose("MoveJ", [812.0, 212.7, 661.8], "v2000,fine"),
    ];
    let path = folder.path().join("m.mod");
    let text = format!("MODULE M\nPROC main()\n{}\nENDPROC\nENDMODULE\n", movements.join("\n"));
    fs::write(&path, text).unwrap();
    let (once, twice) = (folder.path().join("once"), folder.path().join("twice"));
    optimize(&path, &once);
    let again = optimize(&once, &twice);
    for name in ["m.mod", "Joulepath.mod"] {
        let read = |out: &Path| fs::read_to_string(out.join(name)).unwrap();
        assert_eq!(read(&once), read(&twice), "{again}");
    }
    assert!(!twice.join("Joulepath2.mod").exists());
}

/// A target with an offset in y from an expression.
fn shifted(offset: &str, rest: &str) -> String {
    format!("MoveL Offs(pHere,0,{offset},0),{rest},tool0;")
}

#[test]
fn guards_compare_values_that_may_change() {
    let here = format!("CONST robtarget pHere:=[[900,50,900],[0,0,1,0],[0,0,0,0],{FAR}];\n");
    let start = "MoveJ pHere,v1000,fine,tool0;".to_owned();
    let ways = |offset: &str| vec![shifted(offset, "v500,fine"), start.clone()];
    let none: [&str; 1] = ["first-movement"];
    for (declared, first, offset) in [
        // Local data: never assigned, or computed from constants.
        ("", "VAR num h:=60;", "h"),
        ("", "VAR num h;\nh:=3*20;", "h"),
        ("", "VAR num h{2}:=[60,0];\nh{2}:=h{1};", "h{2}"),
        // Data of the module that the program writes.
        ("VAR num h:=10;\n", "h:=h+50;", "h"),
        ("VAR num h{2,2};\n", "h{1,2}:=60;", "h{1,2}"),
    ] {
        let all = [vec![first.to_owned(), start.clone()], ways(offset)].concat();
        let found = segments(&format!("{here}{declared}"), &all);
        assert_eq!(reasons(&found), none, "{declared}{first}: {found:?}");
    }
    let targets = format!(
        "{here}VAR robtarget p1;\nPROC go(robtarget p{{*}})\nFOR i FROM 1 TO 2 DO\n\
         MoveL p{{i}},v500,fine,tool0;\nENDFOR\nENDPROC\n\
         CONST robtarget both{{2}}:=[{0},{1}];\n",
        target(190.0),
        target(320.0)
    );
    let all = ["p1:=Offs(pHere,0,20,0);", &start, "MoveL p1,v500,fine,tool0;", "go both;"];
    let found = segments(&targets, &all.map(str::to_owned));
    assert_eq!(reasons(&found), none, "{found:?}");
    // Values of inputs, stored data and functions are compared, too.
    for (declared, first) in [
        ("PERS num h:=60;\n", ""),
        ("PERS num g:=60;\n", "VAR num h;\nVAR num k;\nk:=g;\nh:=k;"),
        ("VAR num h;\n", "h:=60*diPart;"),
    ] {
        let all = [vec![first.to_owned(), start.clone()], ways("h")].concat();
        let found = segments(&format!("{here}{declared}"), &all);
        let refused = reasons(&found).contains(&"not-constant".to_owned());
        assert!(!refused, "{declared}{first}: {found:?}");
    }
    let function = |statement: &str| {
        format!("{here}VAR num g:=60;\nFUNC num f()\nVAR num x;\n{statement}\nRETURN x;\nENDFUNC\n")
    };
    let all = [vec!["g:=g+1;".into(), start.clone()], ways("f()")].concat();
    let found = segments(&function("x:=g;"), &all);
    assert_eq!(reasons(&found), none, "{found:?}");
    // A function with side effects would run twice.
    let found = segments(&function("g:=g+1;\nx:=g;"), &all);
    assert_eq!(reasons(&found)[..2], ["first-movement", "not-constant"], "{found:?}");
}

fn target(y: f64) -> String {
    format!("[[900,{y},900],[0,0,1,0],[0,0,0,0],{FAR}]")
}

#[test]
fn the_original_runs_where_a_variable_has_another_value() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.mod");
    let program = |shift: &str| {
        let here = target(50.0);
        format!(
            "MODULE M\nCONST robtarget pHere:={here};\nVAR num h:={shift};\nPROC main()\n\
             h:=h+0;\n             MoveJ pHere,v1000,fine,tool0;\n{}\nMoveJ pHere,v1000,fine,tool0;\nENDPROC\n\
             ENDMODULE\n",
            shifted("h", "v500,fine")
        )
    };
    fs::write(&path, program("60")).unwrap();
    let out = folder.path().join("out");
    let result = optimize(&path, &out);
    assert_eq!(reasons(result["segments"].as_array().unwrap()), ["first-movement"], "{result}");
    // On the controller the variable has another value.
    let written = fs::read_to_string(out.join("m.mod")).unwrap();
    fs::write(out.join("m.mod"), written.replace("h:=60;", "h:=200;")).unwrap();
    fs::write(&path, program("200")).unwrap();
    let [was, now] = [&path, &out].map(|input| {
        let input = input.to_str().unwrap();
        json(&["simulate", input, "--robot", KNOWN_LIMITS, "--format", "json", "--quiet"])
    });
    let lines = |result: &Value| -> Vec<f64> {
        let moves = result["moves"].as_array().unwrap();
        moves.iter().map(|m| m["duration_s"].as_f64().unwrap()).collect()
    };
    let (was, now) = (lines(&was), lines(&now));
    assert_eq!(was[..2], now[..2], "{was:?} {now:?}");
}

#[test]
fn an_early_output_prevents_only_its_own_stream() {
    let (a, b) = (pose("MoveL", [900.0, 50.0, 900.0], "v500,z50"), there_and_back());
    let all = [
        vec![pose("MoveJ", [900.0, 150.0, 900.0], "v1000,fine"), a],
        vec!["Set doGrip;".into(), "WaitTime 0.5;".into()],
        vec![pose("MoveL", [900.0, 150.0, 900.0], "v500,fine")],
        b,
    ]
    .concat();
    let found = segments("", &all);
    let timing: Vec<Value> = found.into_iter().filter(|s| s["kind"] == "timing").collect();
    assert_eq!(reasons(&timing), ["first-movement", "early-output"], "{timing:?}");
}

#[test]
fn predefined_registers_may_be_part_of_a_target() {
    let here = format!("CONST robtarget pHere:=[[900,50,900],[0,0,1,0],[0,0,0,0],{FAR}];\n");
    let all = [
        "reg1:=1;",
        "WHILE reg1<4 DO",
        "MoveJ pHere,v1000,fine,tool0;",
        &shifted("20*reg1", "v500,fine"),
        "reg1:=reg1+1;",
        "ENDWHILE",
    ];
    let found = segments(&here, &all.map(str::to_owned));
    let executions: Vec<i64> = found.iter().map(|s| s["executions"].as_i64().unwrap()).collect();
    assert_eq!(executions, [3, 3], "{found:?}");
    assert_eq!(found[1]["rewritten"], true, "{found:?}");
}

#[test]
fn a_first_line_from_an_unknown_position_ends_at_its_target() {
    let lines = [[900.0, 50.0, 900.0], [900.0, 150.0, 900.0], [900.0, 50.0, 900.0]];
    let found = segments("", &lines.map(|place| pose("MoveL", place, "v500,fine")));
    assert_eq!(reasons(&found), ["first-movement"], "{found:?}");
}

/// A guard cannot compare the value of an optional argument that a caller may omit.
#[test]
fn movements_with_optional_parameters_as_arguments_are_kept() {
    for (option, kind) in
        [("WObj?W", "PERS wobjdata"), ("V?W", "num"), ("T?W", "num"), ("Z?W", "num")]
    {
        let routine = format!(
            "PROC rGo(\\{kind} W)\nMoveL Offs(pHere,0,90,0),v500,fine,tool0\\{option};\nENDPROC\n\
             CONST robtarget pHere:={};\nPERS wobjdata wCell:=[FALSE,TRUE,\"\",[[10,20,-30],[1,0,0,0]],\
             [[0,0,0],[1,0,0,0]]];\n",
            target(50.0)
        );
        let given = if option.starts_with('W') { "wCell" } else { "20" };
        for call in ["rGo;".to_owned(), format!("rGo\\W:={given};")] {
            let start = "MoveJ pHere,v1000,fine,tool0;".to_owned();
            let found = segments(&routine, &[start, call.clone()]);
            let reported = reasons(&found);
            let own = if option == "T?W" && call != "rGo;" { "timed" } else { "argument" };
            assert!(reported.contains(&own.to_owned()), "{option} {call}: {found:?}");
        }
    }
}

/// Interrupt routines also write through functions and late-bound names.
#[test]
fn functions_that_interrupt_routines_call_are_considered() {
    let cases = [
        ("nQ:=fWrites();", "meanwhile"),
        ("IF fWrites()=1 THEN\nnQ:=2;\nENDIF", "meanwhile"),
        ("WaitTime fWrites();", "meanwhile"),
        ("rCalled;", "meanwhile"),
        ("bQ:=StrToVal(\"5\",nS);", "meanwhile"),
        ("nQ:=fSettings();", "interrupt"),
        ("ConfJ\\On;", "interrupt"),
        ("SingArea\\Wrist;", "interrupt"),
        ("PathResol 50;", "interrupt"),
        ("rElsewhere;", "interrupt"),
        ("nQ:=fElsewhere();", "interrupt"),
        ("TPWrite \"trap\"\\Num:=ClkRead(ckX);", ""),
        ("CallByVar \"rCalled\",1;", "interrupt"),
        ("SetDataVal \"nS\",nQ;", "interrupt"),
        ("nQ:=Abs(nS);", ""),
        ("nQ:=3;", ""),
    ];
    let here = target(50.0);
    for (statement, expected) in cases {
        let declared = format!(
            "CONST robtarget pHere:={here};\nVAR num nS:=0;\nVAR num nQ;\nVAR bool bQ;\nVAR intnum iX;\n\
             VAR clock ckX;\n\
             FUNC num fWrites()\nnS:=5;\nRETURN 1;\nENDFUNC\n\
             FUNC num fSettings()\nVelSet 50,500;\nRETURN 1;\nENDFUNC\n\
             PROC rCalled()\nnQ:=fWrites();\nENDPROC\n\
             TRAP tX\n{statement}\nENDTRAP\n"
        );
        let movements = [
            "MoveJ pHere,v1000,fine,tool0;",
            "CONNECT iX WITH tX;",
            "MoveL Offs(pHere,0,60,-50),v500,z20,tool0;",
            "MoveL Offs(pHere,0,90,-90+nS),v500,fine,tool0;",
        ];
        let found = segments(&declared, &movements.map(str::to_owned));
        let reported = reasons(&found);
        assert_eq!(reported.get(1).map_or("", String::as_str), expected, "{statement}: {found:?}");
    }
}

/// A guard evaluates all arguments before the first movement, and an error in one of them would
/// occur too early for a caller that handles it.
#[test]
fn movements_with_arguments_that_may_fail_are_kept_under_an_error_handler() {
    let here = target(50.0);
    for (last, handler, expected) in [
        ("Offs(pHere,0,90,-40/nS)", "ERROR\nTRYNEXT;", true),
        ("Offs(pHere,0,90,-nH{nS})", "ERROR\nIF ERRNO=ERR_ARRAYINDEX THEN\nTRYNEXT;\nENDIF", true),
        (
            "Offs(pHere,0,90,-nH{nS})",
            "ERROR\nIF ERRNO=ERR_WAIT_MAXTIME THEN\nTRYNEXT;\nENDIF",
            false,
        ),
        ("Offs(pHere,0,90,-40/nS)", "", false),
    ] {
        let declared = format!(
            "CONST robtarget pHere:={here};\nVAR num nS:=1;\nVAR num nH{{2}}:=[40,50];\n\
             PROC rGo()\nMoveL Offs(pHere,0,60,-50),v500,z20,tool0;\n\
             MoveL {last},v500,fine,tool0;\n{handler}\nENDPROC\n"
        );
        let movements = ["MoveJ pHere,v1000,fine,tool0;", "rGo;"].map(str::to_owned);
        let reported = reasons(&segments(&declared, &movements));
        let is_reported = reported.iter().any(|reason| reason == "handler");
        assert_eq!(is_reported, expected, "{last} {handler}: {reported:?}");
    }
}

/// A guard compares what cannot be read back: the program records it after each change.
#[test]
fn changes_that_cannot_be_read_back_are_recorded() {
    let there = target(50.0);
    let [first, rest @ ..] = &there_and_back()[..] else { unreachable!("three movements") };
    let branch = "IF diX=1 THEN\nEOffsSet eOff;\nEOffsOn \\ExeP:=pHere,pHere;\nSpeedLimAxis ROB_1,1,10;\n\
        SetSysData heavy;\nSetSysData heavy \\ObjectName:=\"other\";\nSetSysData load0;\n\
        SetSysData tool0;\nENDIF\nIF diX=2 EOffsOff;";
    let text = format!(
        "MODULE M\nCONST robtarget pHere:={there};\nCONST extjoint eOff:=[0,0,0,0,0,0];\n\
         PERS loaddata heavy:=[8,[0,0,100],[1,0,0,0],0,0,0];\n\
         PROC main()\n{first}\n{branch}\n{}\nENDPROC\nENDMODULE\n",
        rest.join("\n")
    );
    let (folder, path) = module(text);
    let out = folder.path().join("out");
    let result = optimize_with(Path::new(&path), &out, &[]);
    let is_rewritten = |segment: &Value| segment["rewritten"] == true;
    assert!(result["segments"].as_array().unwrap().iter().any(is_rewritten), "{result}");
    let text = fs::read_to_string(out.join("m.mod")).unwrap();
    for recorded in [
        "EOffsSet eOff; jpEOffsSet:=TRUE;\n",
        "pHere,pHere; jpEOffsOn:=TRUE;\n",
        "SpeedLimAxis ROB_1,1,10; jpSpeedLimAxis:=TRUE;\n",
        "SetSysData heavy; jpLoad:=heavy;\n",
        "\\ObjectName:=\"other\"; jpSetSysData:=TRUE;\n",
        "SetSysData load0; jpLoad:=load0;\n",
        "SetSysData tool0;\n",
        "IF diX=2 THEN EOffsOff; jpEOffsSet:=FALSE; jpEOffsOn:=FALSE; ENDIF\n",
    ] {
        assert!(text.contains(recorded), "{text}\nlacks {recorded}");
    }
}
