//! Programs in which other statements than movements determine the effect of a stream. The comment
//! `! =>` of each movement contains the expected result: `stream`, or the code of the reason for
//! keeping the movement.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;

use std::fs;
use std::path::Path;

use command::KNOWN_LIMITS;
use serde_json::Value;

const EXPECTED: &str = "! => ";

const DATA: &str = "\
CONST jointtarget jA:=[[0,-12,14,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST jointtarget jB:=[[60,20,0,-20,65,30],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget pC:=[[850,300,1000],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget pD:=[[850,-300,1000],[0,0,1,0],[-1,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
PERS tooldata tP:=[TRUE,[[0,0,90],[1,0,0,0]],[1,[0,0,40],[1,0,0,0],0,0,0]];
";

/// A program with these statements in `main`, followed by `handlers` in the routine.
fn program(declarations: &str, statements: &str, handlers: &str) -> String {
    format!(
        "MODULE M\n{DATA}{declarations}\nPROC main()\nConfL \\Off; ConfJ \\Off;\n\
         MoveAbsJ jA,v1000,fine,tP; ! => first-movement\n{statements}\n{handlers}\nENDPROC\n\
         ENDMODULE\n"
    )
}

/// Two movements with the same expected result.
fn both(what: &str) -> String {
    format!("MoveAbsJ jB,v1000,fine,tP; ! => {what}\nMoveAbsJ jA,v1000,fine,tP; ! => {what}")
}

fn optimize(folder: &Path, text: impl AsRef<[u8]>, options: &[&str]) -> Value {
    let robot = ["--robot", KNOWN_LIMITS, "--allow-faster-joints"];
    command::optimize(folder, text, &[&robot[..], options].concat())
}

/// Compares the result of each movement with its comment; the returned folder contains the output.
fn check(text: &str, options: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let result = optimize(folder.path(), text, options);
    let segments = result["segments"].as_array().unwrap();
    for (index, line) in text.lines().enumerate() {
        let Some((_, expected)) = line.split_once(EXPECTED) else { continue };
        let number = index as u64 + 1;
        let holds = |s: &&Value| {
            s["kind"] == "timing"
                && s["line_first"].as_u64().unwrap() <= number
                && number <= s["line_last"].as_u64().unwrap()
        };
        let segment = segments.iter().find(holds);
        let segment = segment.unwrap_or_else(|| panic!("{text}\nline {number} is not listed"));
        let found = if segment["rewritten"] == true {
            "stream"
        } else {
            segment["reason"].as_str().unwrap().split(':').next().unwrap()
        };
        assert_eq!(found, expected, "{text}\nline {number}: {segment}");
    }
    folder
}

#[test]
fn movements_with_resuming_error_handlers_are_kept() {
    let stay = [
        "ERROR\nRETRY;",
        "ERROR\nTRYNEXT;",
        "ERROR\nIF ERRNO=ERR_WAIT_MAXTIME THEN\nRETURN;\nELSE\nRETRY;\nENDIF",
        "ERROR\nIF ERRNO=ERR_COLL_STOP OR ERRNO=ERR_WAIT_MAXTIME THEN\nStorePath;\nRestoPath;\n\
         StartMoveRetry;\nENDIF",
        "ERROR\nTEST ERRNO\nCASE ERR_WAIT_MAXTIME:\nRETRY;\nCASE ERR_PATH_STOP:\nRETRY;\nENDTEST",
        "ERROR (ERR_PATH_STOP)\nStartMoveRetry;",
        "ERROR (LONG_JMP_ALL_ERR)\nRETRY;",
        "BACKWARD\nMoveAbsJ jA,v1000,fine,tP;",
    ];
    for handlers in stay {
        check(&program("", &both("handler"), handlers), &[]);
    }
    let go = [
        "ERROR\nRAISE;",
        "ERROR\nTPWrite \"stopped\";\nRETURN;",
        "ERROR\nIF ERRNO=ERR_WAIT_MAXTIME THEN\nRETRY;\nENDIF\nRAISE;",
        "ERROR\nIF ERRNO=ERR_WAIT_MAXTIME AND bAgain RETRY;\nRAISE;",
        "ERROR\nTEST ERRNO\nCASE ERR_WAIT_MAXTIME,ERR_SOCK_TIMEOUT:\nTRYNEXT;\nDEFAULT:\nRAISE;\nENDTEST",
        "ERROR (ERR_SOCK_TIMEOUT, ERR_SOCK_CLOSED)\nRETRY;",
        "UNDO\nReset doA;",
    ];
    for handlers in go {
        check(&program("VAR bool bAgain:=TRUE;", &both("stream"), handlers), &[]);
    }
    // The handler of a caller covers the whole call, with and without streams.
    let called = format!("PROC rGo()\n{}\nENDPROC", both("stream"));
    check(&program(&called, "rGo;", "ERROR\nRETRY;"), &[]);
    // A movement in a handler.
    let late = "WaitDI diX,1\\MaxTime:=1;\nMoveAbsJ jA,v1000,fine,tP; ! => not-reached";
    let handlers = "ERROR\nMoveAbsJ jB,v1000,fine,tP; ! => handler\nRETURN;";
    check(&program("", late, handlers), &["--input", "diX=30"]);
}

#[test]
fn movements_are_kept_where_interrupts_affect_the_motion() {
    let connected =
        |what: &str| format!("CONNECT iA WITH tStop;\nISignalDI diStop,1,iA;\n{}", both(what));
    let trap = |body: &str| {
        format!(
            "VAR intnum iA;\nPROC rSlow()\nSpeedRefresh 20;\nENDPROC\n\
             PROC rAside()\nMoveAbsJ jB,v100,fine,tP;\nENDPROC\nTRAP tStop\n{body}\nENDTRAP"
        )
    };
    let harmless = [
        "StopMove;\nWaitDI diStop,0;\nStartMove;",
        "StopMove;\nStorePath;\nrAside;\nMoveAbsJ jA,v100,fine,tP;\nRestoPath;\nStartMove;",
        "SetDO doLamp,1;",
    ];
    for body in harmless {
        check(&program(&trap(body), &connected("stream"), ""), &[]);
    }
    let touching = [
        "StopMove;\nClearPath;\nStartMove;",
        "VelSet 20,1000;",
        "IF diStop=1 THEN\nrSlow;\nENDIF",
        "rAside;",
        "%\"rSlow\"%;",
    ];
    for body in touching {
        check(&program(&trap(body), &connected("interrupt"), ""), &[]);
        // No interrupt is connected to it.
        check(&program(&trap(body), &both("stream"), ""), &[]);
    }
}

#[test]
fn movements_under_special_settings_are_kept() {
    let cases = [
        ("PDispSet [[0,0,10],[1,0,0,0]];", "PDispOff;"),
        ("EOffsSet [10,0,0,0,0,0];", "EOffsOff;"),
        ("SoftAct 1,50;", "SoftDeact;"),
        ("WorldAccLim \\On:=2;", "WorldAccLim \\Off;"),
        ("PathAccLim TRUE\\AccMax:=2,TRUE\\DecelMax:=2;", "PathAccLim FALSE,FALSE;"),
        ("SpeedRefresh 50;", "SpeedRefresh 100;"),
        ("TuneServo ROB_1,1,110;", "TuneReset;"),
        ("CorrCon cId;", "CorrDiscon cId;"),
        (
            "MotionProcessModeSet LOW_SPEED_ACCURACY_MODE;",
            "MotionProcessModeSet OPTIMAL_CYCLE_TIME_MODE;",
        ),
        ("PathRecStart pathA;", "PathRecStop;"),
        ("PathResol 50;", "PathResol 100;"),
        ("SpeedLimAxis ROB_1,1,20;", ""),
    ];
    let data = "VAR corrdescr cId;\nVAR pathrecid pathA;";
    for (on, off) in cases {
        let after = if off.is_empty() { "setting" } else { "stream" };
        let statements = format!("{on}\n{}\n{off}\n{}", both("setting"), both(after));
        check(&program(data, &statements, ""), &[]);
    }
    // Settings that do not affect streams.
    for harmless in ["ConfJ \\Off;", "ConfL \\On;", "MotionSup \\Off;", "PathResol 100;"] {
        check(&program("", &format!("{harmless}\n{}", both("stream")), ""), &[]);
    }
}

#[test]
fn movements_with_further_actions_are_kept() {
    let data = "VAR triggdata trG;\nVAR robtarget pF;\nPERS seamdata sm:=[0,0,0,0];\n\
                CONST jointtarget jE:=[[60,20,0,-20,65,30],[9E9,9E9,9E9,9E9,9E9,9E9]];";
    let cases = [
        ("TriggIO trG,10\\DOp:=doA,1;\nTriggL pD,v500,trG,fine,tP;", "instruction"),
        ("TriggJ pD,v500,trG,fine,tP;", "instruction"),
        ("SearchL diA,pF,pD,v100,tP;", "instruction"),
        ("MoveLDO pD,v500,fine,tP,doA,1;", "instruction"),
        ("MoveLSync pD,v500,fine,tP,\"rX\";", "instruction"),
        ("ArcLStart pD,v500,sm,wd,fine,tP;", "instruction"),
        ("SpotJ pD,v500,gun1,sp1,tP;", "instruction"),
        ("DispL \\On,pD,v500,bd,fine,tP;", "instruction"),
        ("MoveL \\Conc,pD,v500,fine,tP;", "argument"),
        ("MoveL pD,v500,fine,tP\\TLoad:=load0;", "argument"),
        ("MoveL pD\\ID:=10,v500,fine,tP;", "argument"),
        ("MoveL pD,v500,fine,tP\\Corr;", "argument"),
        ("MoveL pD,v500,z10\\Inpos:=[2,TRUE,[0,0,0,0],1.5,0,\"\",0,0],tP;", "argument"),
        ("MoveL pD,v500\\T:=3,fine,tP;", "timed"),
    ];
    for (statement, code) in cases {
        let statements = format!("MoveJ pC,v1000,fine,tP; ! => stream\n{statement} ! => {code}");
        check(&program(data, &statements, ""), &[]);
    }
    // A process instruction with unknown arguments may end anywhere.
    let process = "MoveJ pC,v1000,fine,tP; ! => stream\nPaintL pD,v500,sm,wd,fine,tP;\n\
                   MoveAbsJ jE,v1000,fine,tP; ! => unknown-start\n\
                   MoveAbsJ jA,v1000,fine,tP; ! => stream";
    check(&program(data, process, ""), &[]);
}

#[test]
fn movements_are_kept_where_external_axes_move() {
    let data = "CONST jointtarget jE:=[[0,-12,14,0,60,0],[1500,9E9,9E9,9E9,9E9,9E9]];\n\
                CONST jointtarget jF:=[[60,20,0,-20,65,30],[1500,9E9,9E9,9E9,9E9,9E9]];";
    let statements = "MoveAbsJ jB,v1000,fine,tP; ! => stream\n\
                      MoveAbsJ jE,v1000,fine,tP; ! => external-axes\n\
                      MoveAbsJ jF,v1000,fine,tP; ! => stream\n\
                      MoveAbsJ jE,v1000,fine,tP; ! => stream";
    let folder = check(&program(data, statements, ""), &[]);
    let streams = fs::read_to_string(folder.path().join("out/Joulepath.mod")).unwrap();
    let moves = streams.lines().filter(|line| line.trim_start().starts_with("MoveAbsJ"));
    let held: Vec<bool> =
        moves.map(|line| line.contains("],[1500,9E9,9E9,9E9,9E9,9E9]],")).collect();
    assert!(held.contains(&true) && held.contains(&false), "{streams}");
    // A separate movement changes their positions.
    let apart = "MoveAbsJ jB,v1000,fine,tP; ! => stream\nMoveExtJ jE,vlin100,fine;\n\
                 MoveAbsJ jE,v1000,fine,tP; ! => stream\nMoveExtJ jE,vlin100,fine;\n\
                 MoveAbsJ jB,v1000,fine,tP; ! => external-axes";
    check(&program(data, apart, ""), &[]);
    // The same movement twice, with different positions of the track.
    let twice = "CONST jointtarget jG:=[[0,-12,14,0,60,0],[0,9E9,9E9,9E9,9E9,9E9]];\n\
                 CONST jointtarget jH:=[[60,20,0,-20,65,30],[0,9E9,9E9,9E9,9E9,9E9]];\n\
                 PROC rGo(jointtarget jX,jointtarget jY)\n\
                 MoveAbsJ jX,v1000,fine,tP; ! => stream\n\
                 MoveAbsJ jY,v1000,fine,tP; ! => stream\nENDPROC";
    let calls = "MoveExtJ jG,vlin100,fine;\nrGo jH,jG;\nMoveExtJ jE,vlin100,fine;\nrGo jF,jE;";
    check(&program(&format!("{data}\n{twice}"), calls, ""), &[]);
    // The external axes are constant in each stream.
    let changes = held.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert_eq!(changes, 1, "{streams}");
}

#[test]
fn tools_and_work_objects_may_be_given_in_any_form() {
    let tools = "PERS tooldata tT{2}:=[[TRUE,[[0,0,90],[1,0,0,0]],[1,[0,0,40],[1,0,0,0],0,0,0]],\
                 [TRUE,[[0,0,190],[1,0,0,0]],[3,[0,0,40],[1,0,0,0],0,0,0]]];";
    let statements = "MoveAbsJ jB,v1000,fine,tT{2}; ! => stream\n\
                      MoveAbsJ jA,v1000,fine,tT{1}; ! => stream";
    check(&program(tools, statements, ""), &[]);
    let handed = "PROC rGo(PERS tooldata tX)\nMoveAbsJ jB,v1000,fine,tX; ! => stream\n\
                  MoveAbsJ jA,v1000,fine,tX; ! => stream\nENDPROC";
    check(&program(handed, "rGo tP;\nrGo tool0;", ""), &[]);
    // Another call may pass other data: the guard compares them.
    let handed = "PERS wobjdata wA:=[FALSE,TRUE,\"\",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n\
                  PROC rGo(PERS wobjdata wX,PERS tooldata tX)\n\
                  MoveJ pC,v1000,fine,tX\\WObj:=wX; ! => stream\nENDPROC";
    let folder = check(&program(handed, "rGo wA,tP;", ""), &[]);
    let written = fs::read_to_string(folder.path().join("out/m.mod")).unwrap();
    assert!(written.contains("IF jpFits1(pC,v1000,fine,tX,wX) THEN"), "{written}");
    // A name in the encoding of the file.
    let name =
        "PERS tooldata tGr\u{f6}\u{df}e:=[TRUE,[[0,0,90],[1,0,0,0]],[1,[0,0,40],[1,0,0,0],0,0,0]];";
    let statements = "MoveAbsJ jB,v1000,fine,tGr\u{f6}\u{df}e; ! => stream";
    let latin: Vec<u8> = program(name, statements, "").chars().map(|c| c as u8).collect();
    let folder = tempfile::tempdir().unwrap();
    let result = optimize(folder.path(), &latin, &[]);
    assert_eq!(result["segments"][1]["rewritten"], true, "{result}");
    let written = fs::read(folder.path().join("out/m.mod")).unwrap();
    assert_eq!(written.split(|b| *b == 0xf6).count(), 5);
    // A label before a run, and a jump to it.
    let jump = "VAR num n:=0;";
    let statements = "again:\nMoveAbsJ jB,v1000,fine,tP; ! => stream\n\
                      MoveAbsJ jA,v1000,fine,tP; ! => stream\nIncr n;\nIF n<2 GOTO again;";
    check(&program(jump, statements, ""), &[]);
    // A work object moved by another mechanism.
    let belt =
        "PERS wobjdata wBelt:=[FALSE,FALSE,\"CNV1\",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];";
    let statements = "MoveJ pC,v1000,fine,tP\\WObj:=wBelt; ! => path\n\
                      MoveAbsJ jA,v1000,fine,tP; ! => unknown-start";
    let folder = tempfile::tempdir().unwrap();
    let result = optimize(folder.path(), program(belt, statements, ""), &[]);
    for segment in result["segments"].as_array().unwrap() {
        assert_eq!(segment["rewritten"], false, "{segment}");
    }
    // Names that collide with those of the streams.
    let names = "MODULE Joulepath\nVAR num jpAt;\nPROC jpRun1()\nENDPROC\nENDMODULE\n";
    check(&format!("{}{names}", program("", &both("stream"), "")), &[]);
}
