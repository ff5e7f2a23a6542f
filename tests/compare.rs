//! `diff`: what changed in meaning is found, and nothing else is.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod layouts;

use std::path::PathBuf;

use joulepath::rapid::syntax;
use joulepath::rapid::text::{SourceFile, is_encoded_module};
use joulepath::tool::compare::{
    Change, Comparison, DifferenceKind, Group, Robot, Side, compare, meaning,
};
use layouts::resaved::{replaced, resaved};
use layouts::single_edits::edits;
use layouts::{Continued, Random, file, modules, read, relaid};
use proptest::prelude::*;

fn side(files: Vec<SourceFile>) -> Side {
    let groups = vec![Group {
        files: (0..files.len()).collect(),
        entry: "main".to_owned(),
        ..Group::default()
    }];
    let relative = files.iter().map(|file| file.path.clone()).collect();
    Side { files, relative, groups }
}

fn compared(old: impl Into<Vec<u8>>, new: impl Into<Vec<u8>>) -> Comparison {
    let [old, new] = [file(old), file(new)].map(|file| side(vec![file]));
    compare(&old, &new, Robot::Unknown("no robot"))
}

fn line(change: &Change) -> String {
    let place = change.routine.as_deref().unwrap_or("-");
    let (action, subject) = (change.action.name(), change.subject.name());
    format!("{place} {action} {subject}: {}", change.message)
}

fn lines(old: &str, new: &str) -> Vec<String> {
    compared(old, new).changes.iter().map(line).collect()
}

const CELL: &str = r#"%%%
  VERSION:1
  LANGUAGE:ENGLISH
%%%
MODULE Cell
  CONST robtarget p10:=[[500,0,600],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget p20:=[[600,100,600],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jHome:=[[0,-12,14,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST speeddata vFast:=[1500,500,5000,1000];
  PERS tooldata tGrip:=[TRUE,[[0,0,150],[1,0,0,0]],[2,[0,0,60],[1,0,0,0],0,0,0]];
  PERS wobjdata wTable:=[FALSE,TRUE,"",[[400,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  PERS num nParts:=17;
  VAR num nRow:=0;
  PROC main()
    ! home
    MoveAbsJ jHome,v1000,fine,tool0;
    rPick;
    FOR i FROM 1 TO 3 DO
      MoveL Offs(p20,0,0,10*i),vFast,z10,tGrip\WObj:=wTable;
      nRow:=nRow+1;
    ENDFOR
    MoveAbsJ jHome,v1000,fine,tool0;
  ENDPROC
  PROC rPick()
    MoveJ p10,v1000,z50,tGrip\WObj:=wTable;
    MoveL p20,v200,fine,tGrip\WObj:=wTable;
    Set doGrip;
    WaitTime 0.5;
    WaitDI diPart,1;
    AccSet 50,100;
    MoveL p10,v200,z10,tGrip\WObj:=wTable;
    SetDO doLamp,1;
  ENDPROC
ENDMODULE
"#;

/// The changes after a replacement in the cell.
fn edited(from: &str, to: &str) -> Vec<String> {
    assert!(CELL.contains(from), "{from}");
    lines(CELL, &CELL.replacen(from, to, 1))
}

#[test]
fn each_kind_of_change_is_one_line() {
    let table: &[(&str, &str, &[&str])] = &[
        (
            "[600,100,600]",
            "[600,112.5,600]",
            &["- changed target: p20 moved by 12.5 mm (y +12.5), used 2 times"],
        ),
        (
            "[600,100,600],[0,0,1,0],[0,0,0,0]",
            "[603,104,600],[0,0,0.9961947,0.0871557],[0,-1,0,0]",
            &["- changed target: p20 moved by 5 mm (x +3, y +4); turned by 10°; configuration \
               [0,0,0,0] → [0,-1,0,0], used 2 times"],
        ),
        (
            "[0,-12,14,0,90,0]",
            "[0,-2,14,0,45,0]",
            &["- changed target: jHome axis 2 by +10°, axis 5 by −45°, used 2 times"],
        ),
        ("[1500,500,", "[800,500,", &["- changed speed: vFast v_tcp 1500 → 800"]),
        (
            "[2,[0,0,60]",
            "[3.5,[0,0,60]",
            &["- changed tool: tGrip tload.mass 2 → 3.5, used 4 times"],
        ),
        (
            "[[400,0,0]",
            "[[400,7,0]",
            &["- changed work_object: wTable uframe.trans moved by 7 mm (y +7), used 4 times"],
        ),
        (
            "p20,v200",
            "p20,v150",
            &["rPick changed speed: MoveL p20: speed v200 → v150 (v_tcp 200 → 150)"],
        ),
        ("v200,fine", "v200\\T:=2,fine", &["rPick changed speed: MoveL p20: \\t none → 2"]),
        (
            "fine,tGrip",
            "z5,tGrip",
            &[
                "rPick changed zone: MoveL p20: zone fine → z5 (finep TRUE → FALSE; pzone_tcp 0 → 5; pzone_ori 0 → 8; pzone_eax 0 → 8; zone_ori 0 → 0.8; zone_leax 0 → 8; zone_reax 0 → 0.8)",
            ],
        ),
        (
            "fine,tGrip",
            "fine,tool0",
            &[
                "rPick changed tool: MoveL p20: tool tGrip → tool0 (tframe.trans moved by 150 mm (z −150); tload.mass 2 → 0.001; tload.cog moved by 59.999 mm (z −59.999))",
            ],
        ),
        (
            "z50,tGrip\\WObj:=wTable",
            "z50,tGrip",
            &["rPick changed work_object: MoveJ p10: work object wTable → none"],
        ),
        ("MoveJ p10", "MoveL p10", &["rPick changed movement: MoveL p10: MoveJ → MoveL"]),
        (
            "Offs(p20,0,0,10*i)",
            "Offs(p20,0,0,12*i)",
            &[
                "main changed target: MoveL Offs(p20,0,0,12*i): target Offs(p20,0,0,10*i) → Offs(p20,0,0,12*i)",
            ],
        ),
        (
            "MoveJ p10",
            "MoveJ p20",
            &[
                "rPick changed target: MoveJ p20: target p10 → p20 (moved by 141.421 mm (x +100, y +100))",
            ],
        ),
        ("WaitTime 0.5", "WaitTime 1.5", &["rPick changed wait: WaitTime 1.5: Time 0.5 → 1.5"]),
        ("diPart,1", "diPart,0", &["rPick changed input: WaitDI diPart: Value 1 → 0"]),
        ("doLamp,1", "doLamp,0", &["rPick changed output: SetDO doLamp: Value 1 → 0"]),
        ("Set doGrip", "Reset doGrip", &["rPick changed output: Reset doGrip: Set → Reset"]),
        ("AccSet 50", "AccSet 80", &["rPick changed setting: AccSet 80: Acc 50 → 80"]),
        ("nRow:=nRow+1", "nRow:=nRow+2", &["main changed data: nRow := nRow+1 → nRow+2"]),
        ("TO 3", "TO 4", &["main changed control_flow: FOR i FROM 1 TO 3 → FOR i FROM 1 TO 4"]),
        ("    Set doGrip;\n", "", &["rPick removed output: Set doGrip"]),
        (
            "    Set doGrip;\n",
            "    Set doGrip;\n    MoveL p10,v5,fine,tGrip;\n",
            &["rPick added movement: MoveL p10,v5,fine,tGrip"],
        ),
        ("    rPick;\n", "    rPlace;\n", &["main changed call: rPick → rPlace"]),
        ("VAR num nRow:=0", "VAR num nRow:=1", &["- changed data: nRow 0 → 1, used 2 times"]),
        (
            "VAR num nRow",
            "PERS num nRow",
            &["- changed data: nRow: VAR num → PERS num, used 2 times"],
        ),
        (
            "PROC rPick()",
            "PROC rPick(\\switch s)",
            &["rPick changed routine: PROC( ) → PROC( \\ switch s )"],
        ),
        (
            "    Set doGrip;\n    WaitTime 0.5;\n",
            "    WaitTime 0.5;\n    Set doGrip;\n",
            &["rPick moved wait: WaitTime 0.5"],
        ),
    ];
    for (from, to, expected) in table {
        let found = edited(from, to);
        if *from == "PROC rPick()" {
            // The header of the routine as words.
            assert_eq!(found.len(), 1, "{found:?}");
            continue;
        }
        let moved =
            found.len() == 1 && found[0].contains(" moved ") && expected[0].contains(" moved ");
        assert!(
            found == *expected || moved && from.contains("WaitTime"),
            "{from}\n{found:#?}\n{expected:#?}"
        );
    }
}

#[test]
fn a_block_around_statements_is_one_change() {
    let movement = |i: i32| format!("MoveL Offs(p10,0,0,{i}),v100,z1,tGrip;\n");
    let movements = (1..=10).map(movement).collect::<Vec<_>>().concat();
    let program = |body: &str| {
        format!("MODULE m\nPROC main()\nSet do1;\n{body}\nReset do1;\nENDPROC\nENDMODULE\n")
    };
    let around = |head: &str, end: &str| program(&format!("{head}\n{movements}{end}"));
    let bare = program(&movements);
    assert_eq!(
        lines(&bare, &around("IF di1=1 THEN", "ENDIF")),
        ["main added control_flow: IF di1=1 around 10 movements"]
    );
    assert_eq!(
        lines(&around("WHILE TRUE DO", "ENDWHILE"), &bare),
        ["main removed control_flow: WHILE TRUE around 10 movements"]
    );
    assert_eq!(
        lines(&around("IF a THEN", "ENDIF"), &around("IF b THEN", "ENDIF")),
        ["main changed control_flow: IF a → IF b"]
    );
    assert_eq!(
        lines(&around("IF a THEN", "ENDIF"), &around("IF a THEN\nIF b THEN", "ENDIF\nENDIF")),
        ["main added control_flow: IF b around 10 movements"]
    );
    assert_eq!(
        lines(&around("IF a THEN", "ENDIF"), &around("IF a THEN", "ELSE\nStop;\nENDIF")),
        ["main added control_flow: ELSE with 1 statement"]
    );
    assert_eq!(
        lines(&program(""), &around("IF a THEN", "ENDIF")),
        ["main added control_flow: IF a with 10 movements"]
    );
}

#[test]
fn other_names_of_the_same_are_one_change() {
    let renamed = CELL.replace("rPick", "rGrasp");
    assert_eq!(lines(CELL, &renamed), ["rGrasp renamed routine: rPick → rGrasp"]);
    let renamed = CELL.replace("p20", "pPlace");
    assert_eq!(lines(CELL, &renamed), ["- renamed target: robtarget p20 → pPlace"]);
    let both = renamed.replace("rPick", "rGrasp").replace("MODULE Cell", "MODULE Line");
    assert_eq!(
        lines(CELL, &both),
        [
            "- renamed module: module Cell → Line",
            "- renamed target: robtarget p20 → pPlace",
            "rGrasp renamed routine: rPick → rGrasp"
        ]
    );
    let moved = CELL.replace("  PROC rPick()", "ENDMODULE\nMODULE Other\n  PROC rPick()");
    assert_eq!(
        lines(CELL, &moved),
        [
            "- added module: module Other with 1 routine and 0 declarations of data",
            "rPick moved routine: rPick from module Cell to Other"
        ]
    );
}

#[test]
fn values_that_a_controller_saves_are_counted_only() {
    let comparison = compared(CELL, CELL.replace("nParts:=17", "nParts:=99"));
    assert!(comparison.changes.is_empty());
    assert_eq!(comparison.state, 1);
}

#[test]
fn what_cannot_be_read_is_compared_by_its_words() {
    let broken = CELL.replace("Set doGrip;", "nRow := doGrip +;");
    assert!(lines(&broken, &broken.replace("nRow := doGrip +", "NROW:=  DoGrip+")).is_empty());
    let found = lines(&broken, &broken.replace("doGrip +", "doOther +"));
    assert_eq!(found, ["rPick changed unreadable: nRow := doGrip + → nRow := doOther +"]);
    // The rest is compared by its meaning.
    let found = lines(&broken, &broken.replace("WaitTime 0.5", "WaitTime 0.7"));
    assert_eq!(found, ["rPick changed wait: WaitTime 0.7: Time 0.5 → 0.7"]);
    let comparison = compared(broken.clone(), broken.replace("0.5", "0.50"));
    assert!(comparison.changes.is_empty());
    assert_eq!(comparison.errors.map(|files| files.len()), [1, 1]);
    let encoded = compared(b"\xFC\x01\x02".to_vec(), b"\xFC\x01\x03".to_vec());
    assert!(!encoded.changes.is_empty());
    assert!(compared(b"\xFC\x01\x02".to_vec(), b"\xFC\x01\x02".to_vec()).changes.is_empty());
}

#[test]
fn latin_1_and_utf_8_are_the_same_text() {
    let text = CELL
        .replace("nRow", "nGröße")
        .replace("doLamp,1", "doLamp,1;\nTPWrite \"Fertig für Öl: prüfen\"");
    let (latin, _, lossy) = encoding_rs::WINDOWS_1252.encode(&text);
    assert!(!lossy);
    assert!(compared(latin.into_owned(), text).changes.is_empty());
}

#[test]
fn every_fixture_is_itself() {
    for path in modules(".") {
        let source = read(&path);
        let both = [source.clone(), source.clone()].map(|file| side(vec![file]));
        let comparison = compare(&both[0], &both[1], Robot::Unknown("no robot"));
        assert!(comparison.changes.is_empty(), "{}: {:?}", path.display(), comparison.changes);
        assert_eq!(meaning(&source), meaning(&source));
    }
}

fn clean() -> Vec<PathBuf> {
    let folders = ["cells", "changes", "hard", "lint", "paper", "pick_place", "backup"];
    let all = folders.into_iter().flat_map(modules);
    let is_clean = |path: &PathBuf| {
        let bytes = read(path).bytes;
        !is_encoded_module(&bytes) && syntax::parse(&bytes).errors.is_empty()
    };
    all.filter(is_clean).collect()
}

proptest! {
    #[test]
    fn a_program_that_is_saved_again_is_the_same(seed: u64) {
        let mut random = Random::new(seed);
        let paths = clean();
        let path = random.pick::<PathBuf>(&paths);
        let source = read(path);
        let saved = resaved(&source.bytes, &mut random);
        prop_assume!(syntax::parse(&saved).errors.is_empty());
        let comparison = compared(source.bytes.clone(), saved.clone());
        prop_assert!(comparison.changes.is_empty(), "{}: {:#?}", path.display(), comparison.changes);
        let (text, other) = (meaning(&source), meaning(&file(saved)));
        prop_assert_eq!(text, other, "{}", path.display());
    }

    #[test]
    fn one_edit_is_one_change(seed: u64, kind in 0_usize..8) {
        let mut random = Random::new(seed);
        let paths = clean();
        let path = random.pick::<PathBuf>(&paths);
        let source = read(path);
        let all = edits(&source.bytes, kind);
        prop_assume!(!all.is_empty());
        let edit = random.pick(&all);
        let new = replaced(&source.bytes, vec![(edit.place.clone(), edit.text.clone())]);
        let new = relaid(&new, Continued::Further, &mut random);
        let comparison = compared(source.bytes.clone(), new);
        let found: Vec<String> = comparison.changes.iter().map(line).collect();
        let shown = String::from_utf8_lossy(&source.bytes[edit.place.clone()]).into_owned();
        prop_assert_eq!(found.len(), 1, "{}: {} → {:#?}", path.display(), shown, &found);
        let change = &comparison.changes[0];
        prop_assert_eq!(change.action.name(), edit.action, "{}: {} → {:#?}", path.display(), shown, &found);
        if let Some(subject) = edit.subject {
            prop_assert_eq!(change.subject.name(), subject, "{}: {:#?}", path.display(), &found);
        }
        if let Some(by) = edit.moved {
            let is_it = |kind: &DifferenceKind| {
                matches!(kind, DifferenceKind::Position([x, y, z])
                    if (x - by).abs() < 1e-9 && *y == 0.0 && *z == 0.0)
            };
            prop_assert!(change.differences.len() == 1 && is_it(&change.differences[0].kind), "{:?}", change);
        }
    }

    #[test]
    fn any_two_files_are_compared_without_a_panic(seed: u64) {
        let mut random = Random::new(seed);
        let paths = modules(".");
        let [old, new] = [0, 1].map(|_| read(random.pick::<PathBuf>(&paths)));
        let comparison = compared(old.bytes, new.bytes);
        for change in &comparison.changes {
            prop_assert!(change.old.is_some() || change.new.is_some());
            prop_assert!(!change.message.is_empty());
        }
    }
}
