//! The events that a machine receives.

use super::*;
use crate::rapid::ir::lower;
use crate::rapid::ir::movement::{Movement, Output, Target, Unresolved, Wait};
use crate::rapid::syntax;
use crate::rapid::text::FileId;

/// One line per event.
#[derive(Default)]
struct Recorder(Vec<String>);

impl Machine for Recorder {
    fn on_movement(&mut self, movement: Result<Movement, Unresolved>) {
        self.0.push(match movement {
            Ok(movement) => {
                let place = match &movement.target {
                    Target::Joints(q) => q[0].to_degrees(),
                    Target::Pose(target) => {
                        let shift = movement.settings.displacement.unwrap_or_default();
                        (shift * target.pose).translation.x * 1e3
                    }
                };
                let other = movement.settings.other.join(" ");
                format!("{} {:.1} {other}", movement.instruction, place).trim_end().to_owned()
            }
            Err(unresolved) => format!("{} ({})", unresolved.reason, unresolved.moves),
        });
    }
    fn on_wait(&mut self, wait: Wait) -> WaitResult {
        self.0.push(format!("{} {:?}", wait.instruction, wait.duration));
        // Every wait with a limit times out.
        if wait.max_time.is_some() { WaitResult::TimedOut } else { WaitResult::Ended }
    }
    fn on_output(&mut self, output: Output) {
        self.0.push(format!("{} {}={}", output.instruction, output.signal, output.value));
    }
}

const DATA: &str = "
    CONST robtarget p10:=[[100,0,300],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST robtarget p20:=[[150,0,300],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST robtarget pTurned:=[[150,0,300],[0,0,0,1],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST jointtarget j10:=[[30,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    VAR robtarget pVar;
    VAR robtarget pFound;
    VAR jointtarget jVar;
    VAR bool bFlag;
    VAR num nKey;";

/// The events of these statements.
fn events(statements: &str) -> Vec<String> {
    executed(statements, 0).0
}

/// The events of statements with this number of syntax errors, and the unresolved reasons.
fn executed(statements: &str, errors: usize) -> (Vec<String>, Vec<String>) {
    executed_with("", statements, errors)
}

/// The same with more data and routines in the module.
fn executed_with(
    declarations: &str,
    statements: &str,
    errors: usize,
) -> (Vec<String>, Vec<String>) {
    let text =
        format!("MODULE M{DATA}\nPROC main()\n{statements}\nENDPROC\n{declarations}\nENDMODULE");
    let parse = syntax::parse(text.as_bytes());
    assert!(parse.errors.len() == errors, "{statements}: {:?}", parse.errors);
    let program = Program::new(lower(FileId(0), &parse, text.as_bytes()));
    let mut recorder = Recorder::default();
    let execution = execute(&program, program.entry("main").expect("main"), &mut recorder);
    (recorder.0, execution.unresolved.into_iter().map(|note| note.reason).collect())
}

#[test]
fn movements_of_every_family_are_resolved() {
    let target = "p10, v100, z10, tool0";
    for statement in [
        format!("MoveJ {target};"),
        format!("MoveL \\Conc, {target} \\WObj:=wobj0 \\Corr;"),
        "MoveC p20, p10, v100, z10, tool0;".to_owned(),
        "MoveLDO p10, v100, z10, tool0, doGlue, 1;".to_owned(),
        "TriggL p10, v100, trGlue \\T2:=trGlue, z10, tool0;".to_owned(),
        "TriggC p20, p10, v100, trGlue, z10, tool0;".to_owned(),
        "TriggJ p10, v100, trGlue, z10, tool0;".to_owned(),
        "TriggLIOs p10, v100 \\TriggData1:=trGlue, z10, tool0;".to_owned(),
        "MoveLSync p10, v100, z10, tool0, \"rGlue\";".to_owned(),
        "SearchL \\Stop, diTouch, pFound, p10, v100, tool0;".to_owned(),
        "SearchC diTouch, pFound, p20, p10, v100, tool0;".to_owned(),
        "ArcLStart p10 \\ID:=3, v100, sm1, wd1 \\Weave:=wv1, fine, tool0 \\WObj:=wobj0;".to_owned(),
        "ArcC2 p20, p10, v100, sm1, wd1, z10, tool0;".to_owned(),
        "ArcMoveJ p10, v100, z10, tool0;".to_owned(),
        "SpotL p10, v100, gun1, sp1, tool0;".to_owned(),
        "DispC \\On, p20, p10, v100, bd1, z10, tool0;".to_owned(),
        "CapL p10, v100, cd1, ws1, we1, fine, tool0;".to_owned(),
        "MoveL Tool:=tool0, ToPoint:=p10, Speed:=v100, Zone:=z10;".to_owned(),
    ] {
        let events = events(&statement);
        assert!(events.len() == 1 && events[0].ends_with(" 100.0"), "{statement}: {events:?}");
    }
    assert_eq!(events("MoveAbsJ j10 \\NoEOffs, v100 \\T:=2, fine, tool0;"), ["MoveAbsJ 30.0"]);
}

/// Of all movements only a search writes a target, and only the point that it finds.
#[test]
fn only_searches_write_a_target() {
    let behind = |statement: &str| {
        events(&format!(
            "pVar:=p20; pFound:=p20; {statement}; MoveL pVar, v100, fine, tool0; \
             MoveL pFound, v100, fine, tool0;"
        ))
        .split_off(1)
    };
    for statement in [
        "MoveLDO pVar, v100, z10, tool0, doGlue, 1",
        "MoveLSync pVar, v100, z10, tool0, \"rGlue\"",
        "TriggL pVar, v100, trGlue, z10, tool0",
        "ArcL pVar, v100, sm1, wd1, z10, tool0",
    ] {
        assert_eq!(behind(statement), ["MoveL 150.0", "MoveL 150.0"], "{statement}");
    }
    for statement in [
        "SearchL \\Stop, diTouch, pFound, pVar, v100, tool0",
        "SearchC diTouch, pFound, p10, pVar, v100, tool0",
    ] {
        let found = behind(statement);
        assert_eq!(found, ["MoveL 150.0", "'pFound' is found by a search (true)"], "{statement}");
    }
}

/// World zones cause no movement and write only the zone or the shape.
#[test]
fn world_zones_write_only_their_zone_shape_and_signal() {
    let statements = "pVar:=p20; jVar:=j10; SetDO doHome, 1;
        WZHomeJointDef \\Inside, shHome, jVar, jVar; WZLimJointDef \\Outside, shHome, jVar, jVar;
        WZBoxDef \\Inside, shBox, pVar.trans, pVar.trans; WZCylDef \\Inside, shBox, pVar.trans, 9, 9;
        WZSphDef \\Inside, shBox, pVar.trans, 9; WZLimSup \\Stat, wzBox, shBox;
        WZDisable wzTemp; WZEnable wzTemp; WZFree wzTemp;
        MoveL pVar, v100, fine, tool0; MoveAbsJ jVar, v100, fine, tool0;";
    assert_eq!(events(statements), ["SetDO doHome=1", "MoveL 150.0", "MoveAbsJ 30.0"]);
    // From then on the output depends on the position of the robot.
    let inverted = |zone: &str| events(&format!("SetDO doHome, 1; {zone} InvertDO doHome;"));
    assert_eq!(inverted("")[1], "InvertDO doHome=0");
    assert_eq!(
        inverted("WZDOSet \\Stat, wzHome \\Inside, shHome, doHome, 1;")[1],
        "InvertDO doHome=unknown"
    );
}

#[test]
fn a_statement_with_an_error_may_move_the_robot() {
    let (events, _) = executed("MoveJ p10, v100 fine, tool0;\nMoveJ p20, v100, fine, tool0;", 1);
    assert_eq!(events, ["the statement has a syntax error (true)", "MoveJ 150.0"]);
}

#[test]
fn movements_of_external_axes_are_waits() {
    // A wait of unknown length until the position of the axes is known.
    assert_eq!(events("MoveExtJ j10, vrot10, fine;"), ["MoveExtJ None"]);
    assert_eq!(events("SearchExtJ diTouch, j10, j10, vrot10;"), ["SearchExtJ None"]);
    assert_eq!(events("MoveExtJ j10, vrot10 \\T:=2, fine;"), ["MoveExtJ Some(2.0)"]);
}

#[test]
fn displacements_follow_from_two_points() {
    let moved = |on: &str| events(&format!("{on}; MoveJ p10, v100, fine, tool0; PDispOff;"));
    assert_eq!(moved("PDispOn \\ExeP:=p20, p10, tool0"), ["MoveJ 150.0"]);
    assert_eq!(moved("PDispOn \\Rot \\ExeP:=pTurned, p20, tool0"), ["MoveJ 200.0"]);
    assert_eq!(moved("PDispOn p10, tool0"), ["MoveJ 100.0 PDispOn"]);
    assert_eq!(moved("PDispSet [[7,0,0],[1,0,0,0]]"), ["MoveJ 107.0"]);
}

#[test]
fn waits_for_operators_and_tasks_have_no_stated_time() {
    for wait in [
        "WaitSyncTask sync1, taskList",
        "TPReadFK nKey, \"x\", \"\", \"\", \"\", \"\", \"a\"",
        "WaitLoad load1",
        "SyncMoveOn sync1, taskList",
        "SyncMoveOff sync1",
        "SocketConnect socket1, \"192.168.0.1\", 1025",
        "SocketReceiveFrom socket1 \\Str:=text, sender, port",
    ] {
        let name = wait.split(' ').next().expect("a name");
        assert_eq!(events(&format!("{wait};")), [format!("{name} None")]);
    }
    assert_eq!(events("WaitRob \\InPos;"), ["WaitRob Some(0.0)"]);
    let (events_of_raise, _) = executed("RaiseToUser \\Continue;", 0);
    assert!(events_of_raise[0].ends_with("(true)"), "{events_of_raise:?}");
    assert_eq!(events("WaitTime \\InPos, 0.5;"), ["WaitTime Some(0.5)"]);
    assert_eq!(
        events("nKey:=1; TPReadFK nKey, \"\", \"\", \"\", \"\", \"\", \"\"; WaitTime nKey;").len(),
        2
    );
}

/// Data assigned in a branch on an input, taken or not, depend on the input.
#[test]
fn skipped_branches_on_inputs_are_reported() {
    let later = "IF nKey=1 THEN\nMoveJ p10, v100, fine, tool0;\nENDIF";
    for first in [
        "IF diX=1 THEN\nnKey:=1;\nENDIF",
        "IF diX=1 nKey:=1;",
        "IF diX=0 THEN\nnKey:=2;\nENDIF",
        "IF diX=1 THEN\npVar:=p10;\nELSEIF nKey=0 THEN\nnKey:=2;\nENDIF",
        "TEST giX\nCASE 1:\nnKey:=1;\nENDTEST",
        "TEST giX\nCASE 0:\nnKey:=2;\nENDTEST",
    ] {
        let (events, notes) = executed(&format!("{first}\n{later}"), 0);
        assert!(events.is_empty(), "{first}: {events:?}");
        let is_reported =
            notes.iter().any(|note| note.contains("taken as FALSE") && note.contains("X=LEVEL"));
        assert!(is_reported, "{first}: {notes:?}");
    }
    let (_, notes) = executed(&format!("IF diX=1 THEN\nnKey:=1;\nENDIF\nnKey:=2;\n{later}"), 0);
    assert!(notes.is_empty(), "{notes:?}");
}

/// Data that a function or an instruction writes decide no branch unnoticed.
#[test]
fn written_arguments_are_not_known() {
    let data = "PERS bool sem:=FALSE; VAR num list{3}:=[1,2,3]; VAR errnum e; VAR bool ok;";
    for statements in [
        "WaitTestAndSet sem; IF sem Set doA;",
        "ok:=TestAndSet(sem); IF sem Set doA;",
        "ok:=StrToVal(\"5\", nKey); IF nKey=5 Set doA;",
        "ok:=StrToVal(\"5\", list{2}); IF list{2}=5 Set doA;",
        "jVar:=CalcJointT(p10, tool0 \\ErrorNumber:=e); IF e=1 Set doA;",
        "TPReadNum list{2}, \"?\"; IF list{2}=5 Set doA;",
        "foreign list{2}; IF list{2}=5 Set doA;",
        "ok:=foreign(nKey); IF nKey=5 Set doA;",
    ] {
        let (_, reasons) = executed_with(data, statements, 0);
        let of_condition = |reason: &String| reason.contains("condition is not known");
        assert!(reasons.iter().any(of_condition), "{statements}: {reasons:?}");
    }
    let (events, reasons) =
        executed_with(data, "ok:=StrToVal(\"5\", list{2}); IF list{1}=1 Set doA;", 0);
    assert_eq!((&*events, &*reasons), (&["Set doA=1".to_owned()][..], &[][..]));
}

/// A part of data that a routine has by reference has what the routine wrote.
#[test]
fn parts_are_passed_by_reference() {
    let declarations = "VAR num list{3}:=[1,2,3];
        PROC add(INOUT num x) x:=x+10; ENDPROC
        PROC shift(VAR robtarget p \\num own) own:=own+1; p.trans.x:=p.trans.x+own; ENDPROC
        PROC outer(\\num dx) shift pVar \\own?dx; SetGO goX, dx; ENDPROC";
    let events = |statements: &str| executed_with(declarations, statements, 0).0;
    assert_eq!(events("nKey:=2; add list{nKey}; SetGO goX, list{2};"), ["SetGO goX=12"]);
    assert_eq!(
        events("pVar:=p10; add pVar.trans.x; MoveL pVar, v100, fine, tool0;"),
        ["MoveL 110.0"]
    );
    // Indices are evaluated once.
    let next = "FUNC num next(INOUT num n) n:=n+1; RETURN n; ENDFUNC";
    let (events_of_next, _) = executed_with(
        &format!("{declarations} {next}"),
        "nKey:=1; add list{next(nKey)}; SetGO goX, list{2}; SetGO goY, nKey;",
        0,
    );
    assert_eq!(events_of_next, ["SetGO goX=12", "SetGO goY=2"]);
    let (events_of_next, _) = executed_with(
        &format!("{declarations} {next}"),
        "nKey:=1; bFlag:=StrToVal(\"5\", list{next(nKey)}); SetGO goY, nKey;",
        0,
    );
    assert_eq!(events_of_next, ["SetGO goY=2"]);
    // An input that chooses the part decides what is done with it.
    let one = "PROC one(INOUT num x) IF x=2 MoveJ p10, v100, fine, tool0; ENDPROC";
    let (_, reasons) = executed_with(&format!("{declarations} {one}"), "one list{diPart+1};", 0);
    assert!(reasons.iter().any(|reason| reason.contains("depends on inputs")), "{reasons:?}");
    // What may be the same data by another name is not known, and neither is a part that is not known.
    for (routine, call) in [
        ("PROC both(INOUT num x) x:=5; IF list{2}=5 Set doA; ENDPROC", "both list{2};"),
        ("PROC both(INOUT num x) list{2}:=7; IF x=7 Set doA; ENDPROC", "both list{2};"),
        ("PROC both(INOUT num x) list:=[7,7,7]; IF x=7 Set doA; ENDPROC", "both list{2};"),
        ("PROC both(INOUT num x) list{1}:=7; x:=5; ENDPROC", "both list{2}; IF list{1}=7 Set doA;"),
        (
            "PROC both(INOUT num x) list:=[7,7,7]; x:=5; ENDPROC",
            "both list{2}; IF list{2}=5 Set doA;",
        ),
        (
            "PROC two(INOUT num x, INOUT num y) x:=5; IF y=5 Set doA; ENDPROC",
            "two list{2}, list{2};",
        ),
        (
            "PROC inner(INOUT num x) x:=5; ENDPROC PROC both(INOUT num x) inner list{2}; ENDPROC",
            "both list{1}; IF list{2}=5 Set doA;",
        ),
        (
            "PROC inner(INOUT num x) list{2}:=7; IF x=7 Set doA; ENDPROC
            PROC both(INOUT num x) inner x; ENDPROC",
            "both list{2};",
        ),
        ("PROC both(INOUT num x) x:=5; ENDPROC", "both list{foreign()}; IF list{1}=1 Set doA;"),
    ] {
        let (_, reasons) = executed_with(&format!("{declarations} {routine}"), call, 0);
        let of_condition = |reason: &String| reason.contains("condition is not known");
        assert!(reasons.iter().any(of_condition), "{routine}: {reasons:?}");
    }
    // Two parts that do not overlap, and a part of a part.
    let more = "PROC swap(INOUT num x, INOUT num y) VAR num z; z:=x; x:=y; y:=z; ENDPROC
        PROC outer2(INOUT pos p) add p.x; ENDPROC";
    let events_of_more =
        |statements: &str| executed_with(&format!("{declarations} {more}"), statements, 0).0;
    assert_eq!(
        events_of_more("swap list{1}, list{3}; SetGO goX, list{1}; SetGO goY, list{3};"),
        ["SetGO goX=3", "SetGO goY=1"]
    );
    assert_eq!(
        events_of_more("pVar:=p10; outer2 pVar.trans; MoveL pVar, v100, fine, tool0;"),
        ["MoveL 110.0"]
    );
    // A loop on a part that an input chooses waits for the input.
    let get = "FUNC num get(INOUT num x) RETURN x; ENDFUNC";
    let (_, reasons) =
        executed_with(&format!("{declarations} {get}"), "WHILE get(list{giX+1})=1 DO ENDWHILE", 0);
    assert!(!reasons.iter().any(|reason| reason.contains("does not end")), "{reasons:?}");
    // An argument by value stays.
    assert_eq!(
        events("pVar:=p10; outer \\dx:=5; MoveL pVar, v100, fine, tool0;"),
        ["SetGO goX=5", "MoveL 106.0"]
    );
}

#[test]
fn the_load_of_the_system_is_the_load_of_the_robot() {
    let data = "PERS loaddata load8:=[8,[0,0,100],[1,0,0,0],0,0,0];";
    let others = |statements: &str| executed_with(data, statements, 0).0;
    let masses = |statements: &str| {
        struct Masses(Vec<Option<f64>>);
        impl Machine for Masses {
            fn on_movement(&mut self, movement: Result<Movement, Unresolved>) {
                let load = movement.ok().and_then(|movement| movement.settings.grip_load);
                self.0.push(load.map(|load| load.mass));
            }
            fn on_wait(&mut self, _: Wait) -> WaitResult {
                WaitResult::Ended
            }
            fn on_output(&mut self, _: Output) {}
        }
        let text = format!("MODULE M{DATA}{data}\nPROC main() {statements} ENDPROC\nENDMODULE");
        let parse = syntax::parse(text.as_bytes());
        let program = Program::new(lower(FileId(0), &parse, text.as_bytes()));
        let mut masses = Masses(Vec::new());
        execute(&program, program.entry("main").expect("main"), &mut masses);
        masses.0
    };
    let movement = "MoveJ p10, v100, fine, tool0;";
    assert_eq!(masses(&format!("SetSysData load8; {movement}")), [Some(8.0)]);
    assert_eq!(masses(&format!("SetSysData tool0; {movement}")), [None]);
    // The name of the object is computed: the load is not known until it is stated.
    let by_name = format!("SetSysData load8 \\ObjectName:=\"heavy\"; {movement}");
    assert_eq!(others(&by_name), ["MoveJ 100.0 SetSysData"]);
    assert_eq!(others(&format!("GripLoad loadX; SetSysData load8; {movement}")), ["MoveJ 100.0"]);
}
