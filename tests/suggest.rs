//! `optimize --suggest` and `--apply`: each promise is what `simulate` says after that edit.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;

use std::fs;
use std::path::Path;

use command::{IRB1600 as ROBOT, number, parsed, refused, run_in};
use serde_json::Value;

/// Visits two places with small zones, high approaches and a way round. The output needs its stop.
const PROGRAM: &str = "MODULE M\n\
    PERS tooldata tGrip:=[TRUE,[[0,0,150],[1,0,0,0]],[2,[10,0,60],[1,0,0,0],0,0,0]];\n\
    CONST jointtarget jHome:=[[0,-12,14,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    CONST robtarget pA:=[[800,-300,300],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    CONST robtarget pB:=[[800,300,300],[0,0,1,0],[0,-1,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    CONST robtarget pRound:=[[600,0,800],[0,0,1,0],[0,-1,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    CONST num nHigh:=200;\n\
    PROC main()\n\
    MoveAbsJ jHome,v1000,fine,tGrip;\n\
    MoveJ Offs(pA,0,0,nHigh),v1000,z10,tGrip;\n\
    MoveL pA,v300,fine,tGrip;\n\
    SetDO doGrip,1;\n\
    WaitTime 0.3;\n\
    MoveL Offs(pA,0,0,nHigh),v500,z10,tGrip;\n\
    MoveJ pRound,v1000,z10,tGrip;\n\
    MoveJ Offs(pB,0,0,nHigh),v1000,z10,tGrip;\n\
    MoveL pB,v300,fine,tGrip;\n\
    SetDO doGrip,0;\n\
    WaitTime 0.3;\n\
    MoveL Offs(pB,0,0,nHigh),v500,z10,tGrip;\n\
    MoveAbsJ jHome,v1000,fine,tGrip;\n\
    ENDPROC\n\
    ENDMODULE\n";
/// Rounding of a result in JSON, J and s.
const ROUNDING: f64 = 1e-6;
/// Text beside which nothing may change: places of the process, waits and outputs.
const KEPT: [&str; 4] = ["MoveL pA,v", "SetDO doGrip,1;", "WaitTime 0.3;", "pA:=[[800,-300,300]"];

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("in")).unwrap();
    fs::write(folder.path().join("in/m.mod"), PROGRAM).unwrap();
    folder
}

fn json(folder: &Path, args: &[&str]) -> Value {
    let fixed = ["--robot", ROBOT, "--quiet", "--format", "json"];
    parsed(&run_in(folder, &[args, &fixed[..]].concat()))
}

fn with_edits(one: &Value) -> String {
    let mut text = PROGRAM.to_owned();
    let mut edits: Vec<&Value> = one["edits"].as_array().unwrap().iter().collect();
    edits.sort_by_key(|edit| std::cmp::Reverse(edit["start"].as_u64().unwrap()));
    for edit in edits {
        let [start, end] = ["start", "end"].map(|key| edit[key].as_u64().unwrap() as usize);
        text.replace_range(start..end, edit["text"].as_str().unwrap());
    }
    text
}

#[test]
fn each_suggestion_saves_what_it_promises() {
    let folder = folder();
    let result = json(folder.path(), &["optimize", "in", "--suggest"]);
    let all = result["suggestions"].as_array().unwrap();
    let changes: Vec<&str> = all.iter().map(|one| one["change"].as_str().unwrap()).collect();
    for kind in ["height", "in place of z10", "pRound shifted"] {
        assert!(changes.iter().any(|change| change.contains(kind)), "{kind} is not in {changes:?}");
    }
    assert!(all.windows(2).all(|w| number(&w[0], "/saving_j") >= number(&w[1], "/saving_j")));
    let [energy, cycle] = ["/energy_j", "/cycle_s"].map(|key| number(&result, key));
    for one in all {
        let text = with_edits(one);
        for kept in KEPT {
            assert!(text.contains(kept), "{} changes {kept}", one["change"]);
        }
        fs::write(folder.path().join("changed.mod"), &text).unwrap();
        let now = json(folder.path(), &["simulate", "changed.mod"]);
        let saved = energy - number(&now, "/energy_j");
        assert!((saved - number(one, "/saving_j")).abs() < ROUNDING, "{}", one["change"]);
        let spared = cycle - number(&now, "/cycle_s");
        assert!((spared - number(one, "/saving_s")).abs() < ROUNDING && spared > -ROUNDING);
        assert!(number(one, "/leaves_m") >= 0.0);
    }
}

/// Whether a change with these words is suggested for a program.
fn suggests(text: &str, words: &str) -> bool {
    let folder = folder();
    fs::write(folder.path().join("in/m.mod"), text).unwrap();
    let result = json(folder.path(), &["optimize", "in", "--suggest", "--point-estimate"]);
    let all = result["suggestions"].as_array().unwrap();
    all.iter().any(|one| one["change"].as_str().unwrap().contains(words))
}

/// The way back of a program that ends elsewhere is not simulated, so where it begins stays.
#[test]
fn the_start_stays_if_the_program_ends_elsewhere() {
    let shifts_home = |text: &str| suggests(text, "jHome shifted");
    assert!(shifts_home(PROGRAM));
    let (begin, end) = PROGRAM.split_at(PROGRAM.rfind("MoveAbsJ jHome").unwrap());
    let (_, end) = end.split_once('\n').unwrap();
    assert!(!shifts_home(&format!("{begin}{end}")));
}

/// A height that is also that of a place where an output is switched stays.
#[test]
fn places_of_outputs_stay() {
    let has_height = |text: &str| suggests(text, "height");
    assert!(has_height(PROGRAM));
    let passed = "MoveJ Offs(pB,0,0,nHigh),v1000,z10,tGrip;\n";
    let stopped = "MoveJ Offs(pB,0,0,nHigh),v1000,fine,tGrip;\nSetDO doLook,1;\n";
    assert!(!has_height(&PROGRAM.replace(passed, stopped)));
}

/// Marks that cannot be used are named, and no order is offered for them.
#[test]
fn malformed_marks_of_a_free_order_are_named() {
    let begin = "! joulepath: free order\n";
    let end = "! JOULEPATH: END OF FREE ORDER\n";
    let first = "MoveJ pRound,v1000,z10,tGrip;\n";
    let second = "MoveJ Offs(pB,0,0,nHigh),v1000,z10,tGrip;\n";
    let visits = &format!("{first}{second}");
    let marked = |with: String| {
        let text = PROGRAM.replace(visits, &with);
        assert!(text != PROGRAM);
        let folder = folder();
        fs::write(folder.path().join("in/m.mod"), text).unwrap();
        let args = ["optimize", "in", "--suggest", "--point-estimate", "--robot", ROBOT];
        let output = run_in(folder.path(), &args);
        (
            String::from_utf8_lossy(&output.stderr).into_owned(),
            String::from_utf8_lossy(&output.stdout).into_owned(),
        )
    };
    for (text, fault) in [
        (format!("{begin}{visits}"), "no end"),
        (format!("{visits}{end}"), "before this end"),
        (format!("{begin}{begin}{visits}{end}"), "has not ended"),
        (format!("{begin}{end}{visits}"), "no statement"),
        (format!("{begin}reg1:=1;\n{visits}{end}"), "only have calls"),
        (format!("{begin}{first}IF TRUE THEN\n{second}{end}ENDIF\n"), "different blocks"),
    ] {
        let (notes, list) = marked(text);
        assert!(notes.contains(fault) && notes.contains("m.mod:"), "{fault}: {notes}");
        assert!(!list.contains("order Move"), "{list}");
    }
}

/// An order is no other one if its visits would go elsewhere, or switch outputs elsewhere.
#[test]
fn a_free_order_does_the_same_work() {
    let text = |visits: &str| {
        let head = PROGRAM.split("PROC main").next().unwrap();
        format!(
            "{head}VAR num n:=0;\nPROC Visit()\nMoveL Offs(pA,0,55*n,0),v300,fine,tGrip;\nSetDO doTest,1;\nENDPROC\n\
             PROC Next(num by)\nn:=n+by;\nENDPROC\n\
             PROC main()\nMoveAbsJ jHome,v1000,fine,tGrip;\n! joulepath: free order\n{visits}\
             ! joulepath: end of free order\nMoveAbsJ jHome,v1000,fine,tGrip;\nENDPROC\nENDMODULE\n"
        )
    };
    let named = "order Visit; Next 4; Next -4; Visit; Visit;";
    assert!(!suggests(&text("Visit;\nNext 4;\nVisit;\nNext -4;\nVisit;\n"), named));
}

/// What an order, an acceleration or a configuration costs is found out, and the edit mends it.
#[test]
fn settings_configurations_and_orders_are_suggested() {
    let slow = PROGRAM.replace(
        "MoveAbsJ jHome,v1000,fine,tGrip;\nMoveJ",
        "AccSet 30,30;\nMoveAbsJ jHome,v1000,fine,tGrip;\nMoveJ",
    );
    assert!(slow != PROGRAM && suggests(&slow, "in place of 30,30"));
    assert!(!suggests(PROGRAM, "AccSet"));
    // Axis 6 goes a turn to pB and back.
    let turned = PROGRAM.replace(
        "[0,-1,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nCONST robtarget pRound",
        "[0,-1,4,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nCONST robtarget pRound",
    );
    assert!(turned != PROGRAM && suggests(&turned, "axis 6 a turn back at pB"));
    assert!(!suggests(PROGRAM, "turn back at pB"));
}

/// Four places on a circle, in a bad order. Only the comments make the order free.
#[test]
fn marked_visits_get_their_best_order() {
    let visit = |order: &[i32]| {
        let calls: Vec<String> = order.iter().map(|n| format!("Visit {n};\n")).collect();
        calls.concat()
    };
    let text = |visits: &str| {
        let head = PROGRAM.split("PROC main").next().unwrap();
        format!(
            "{head}PROC Visit(num n)\nMoveJ Offs(pA,0,55*n,100),v1000,z10,tGrip;\nMoveL Offs(pA,0,55*n,0),v300,fine,tGrip;\n\
             PulseDO doTest;\nWaitTime 0.2;\nMoveL Offs(pA,0,55*n,100),v1000,z10,tGrip;\nENDPROC\n\
             PROC main()\nMoveAbsJ jHome,v1000,fine,tGrip;\n{visits}MoveAbsJ jHome,v1000,fine,tGrip;\nENDPROC\nENDMODULE\n"
        )
    };
    let bad = [1, 3, 0, 4];
    let marked =
        format!("! joulepath: free order\n{}! joulepath: end of free order\n", visit(&bad));
    assert!(!suggests(&text(&visit(&bad)), "order Visit"));
    let folder = folder();
    fs::write(folder.path().join("in/m.mod"), text(&marked)).unwrap();
    let result = json(folder.path(), &["optimize", "in", "--suggest", "--point-estimate"]);
    let all = result["suggestions"].as_array().unwrap();
    let is_order = |one: &&Value| one["change"].as_str().unwrap().contains("order Visit");
    let found = all.iter().find(is_order).unwrap();
    let energy = |order: &[i32]| {
        fs::write(folder.path().join("one.mod"), text(&visit(order))).unwrap();
        let simulated = json(folder.path(), &["simulate", "one.mod"]);
        assert_eq!(simulated["unresolved"].to_string(), "[]");
        number(&simulated, "/energy_j")
    };
    let mut least = f64::INFINITY;
    for a in bad {
        for b in bad.into_iter().filter(|b| *b != a) {
            for c in bad.into_iter().filter(|c| *c != a && *c != b) {
                let d = bad.into_iter().find(|d| ![a, b, c].contains(d)).unwrap();
                least = least.min(energy(&[a, b, c, d]));
            }
        }
    }
    let promised = energy(&bad) - number(found, "/saving_j");
    assert!((promised - least).abs() < ROUNDING, "{promised} J, the best order takes {least} J");
}

#[test]
fn applied_suggestions_and_streams_are_one_program() {
    let folder = folder();
    let result = json(folder.path(), &["optimize", "in", "--apply", "all", "--out", "out"]);
    let applied = &result["applied"];
    assert!(applied["taken"].as_array().unwrap().len() > 1);
    let before = json(folder.path(), &["simulate", "in"]);
    assert!((number(applied, "/before/energy_j") - number(&before, "/energy_j")).abs() < ROUNDING);
    let after = json(folder.path(), &["simulate", "out"]);
    let [now, once] = [&after, &applied["after"]].map(|of| number(of, "/energy_j"));
    assert!(now <= once + ROUNDING, "streams add to it: {now} J, {once} J without");
    assert!(once < 0.95 * number(&before, "/energy_j"));
    assert!(number(&after, "/cycle_s") <= number(&before, "/cycle_s") + ROUNDING);
    let text = fs::read_to_string(folder.path().join("out/m.mod")).unwrap();
    for kept in KEPT {
        assert!(text.contains(kept), "{kept} is gone");
    }
    assert_eq!(fs::read_to_string(folder.path().join("in/m.mod")).unwrap(), PROGRAM);
}

#[test]
fn unknown_numbers_have_a_way_out() {
    let folder = folder();
    let program = folder.path().join("in");
    let program = program.to_str().unwrap();
    for asked in ["0", "999", "1,x", ""] {
        refused(&["optimize", program, "--robot", ROBOT, "--apply", asked], "--suggest lists them");
    }
}
