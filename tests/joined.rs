//! Runs that go on in another routine, loop or branch: they become streams, the robot makes the same
//! stops whichever way the program takes, and what may not stand between is named.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod support;

use std::collections::{BTreeMap, BTreeSet};

use joulepath::rapid::text::{FileId, SourceFile};
use joulepath::retime::motion::timed::TimedMotion;
use joulepath::retime::motion::timeline::{Run, What};
use joulepath::retime::motion::{Options, Simulation};
use joulepath::tool::retrofit::{Retrofit, Segment, Settings, Source, retrofit};
use support::{irb1600, module_paths, program, read, simulated, sources};

/// Ends of runs that are equal, rad.
const SAME: f64 = 1e-6;

fn retrofitted(files: &[Source]) -> Retrofit {
    retrofitted_with(files, None)
}

/// `read_elsewhere`: the data that other tasks may read, if known.
fn retrofitted_with(files: &[Source], read_elsewhere: Option<BTreeSet<String>>) -> Retrofit {
    let settings = Settings { point_estimate: true, read_elsewhere, ..Settings::default() };
    let result = retrofit(files, &irb1600(), &settings, &|_, _| ()).unwrap();
    assert!(result.verification.passed);
    result
}

/// A program of `fixtures/changes`.
fn fixture(name: &str) -> Vec<Source> {
    let mut paths = module_paths("changes");
    paths.retain(|path| path.ends_with(name));
    read(&paths)
}

/// The emitted program.
fn emitted(result: &Retrofit) -> Vec<Source> {
    let files = result.outputs.iter().enumerate().map(|(i, output)| {
        SourceFile::new(FileId(i as u32), output.path.clone(), output.bytes.clone())
    });
    sources(files.collect())
}

fn joined(result: &Retrofit) -> Vec<&Segment> {
    result.segments.iter().filter(|segment| segment.pieces.len() > 1).collect()
}

fn is_stream(run: &Run) -> bool {
    matches!(run.motions.as_slice(), [(_, TimedMotion::Stream(_))])
}

/// What a program does: stops of the robot, waits and outputs.
fn conduct(simulation: &Simulation) -> Vec<(String, Option<[f64; 6]>)> {
    let events = simulation.events.iter();
    let what = |what: &What| match what {
        What::Run(run) => ("stop".to_owned(), Some(run.end)),
        What::Wait(record) => (record.wait.instruction.to_string(), None),
        What::Output(output, _) => (format!("{} {}", output.signal, output.value), None),
        What::Left(left) => (left.reason.clone(), None),
    };
    events.map(|event| what(&event.what)).collect()
}

#[test]
fn the_pieces_of_a_run_become_one_stream() {
    let result = retrofitted(&fixture("joined_mode_routes.mod"));
    let joined = joined(&result);
    assert_eq!(joined.len(), 2);
    for segment in joined {
        assert!(segment.rewritten && segment.rewritten_executions == segment.executions);
        assert_eq!(segment.pieces.len(), 2);
        assert!(segment.energy_after_j < segment.energy_before_j);
    }
    let runs = result.after.0.events.iter().filter(|event| matches!(&event.what, What::Run(_)));
    assert_eq!(runs.count(), 6);
}

/// The program decides between the pieces: nothing, an output, a wait, another movement, or another
/// first piece.
#[test]
fn every_way_through_the_program_makes_the_same_stops() {
    let original = fixture("joined_mode_routes.mod");
    let retrofit = emitted(&retrofitted(&original));
    let mut conducts = Vec::new();
    for mode in 0..5 {
        for low in 0..2 {
            let levels = [("gimode", f64::from(mode)), ("dilow", f64::from(low))];
            let levels: BTreeMap<String, f64> =
                levels.map(|(signal, level)| (signal.to_owned(), level)).into();
            let options = Options { levels, ..Options::default() };
            let [before, after] =
                [&original, &retrofit].map(|files| simulated(&irb1600(), files, &options));
            let [expected, found] = [&before, &after].map(conduct);
            assert_eq!(expected.len(), found.len(), "{mode} {low}");
            for ((what, at), (found, here)) in expected.iter().zip(&found) {
                assert_eq!(what, found, "{mode} {low}");
                for (a, b) in at.iter().flatten().zip(here.iter().flatten()) {
                    assert!((a - b).abs() < SAME, "{mode} {low} {what}: {a} {b}");
                }
            }
            let is_run = |what: &What| matches!(what, What::Run(run) if is_stream(run));
            assert!(after.events.iter().any(|event| is_run(&event.what)), "{mode} {low}");
            conducts.push(found.into_iter().map(|(what, _)| what).collect::<Vec<_>>());
        }
    }
    conducts.sort();
    conducts.dedup();
    assert!(conducts.len() >= 3, "the modes do not differ: {conducts:?}");
}

const HEAD: &str = "MODULE M
CONST jointtarget jA:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST jointtarget jB:=[[40,10,10,20,50,20],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST jointtarget jC:=[[80,-10,20,30,60,40],[9E9,9E9,9E9,9E9,9E9,9E9]];
VAR num n:=0;
VAR intnum nTrap:=0;
PERS num nShared:=0;
LOCAL PERS num nLocal:=0;
";

/// The reason of the run from `jA` over `jB` to `jC`, with statements behind `jB`.
fn reason(between: &str, rest: &str) -> Option<String> {
    reason_with(between, rest, None)
}

fn reason_with(
    between: &str,
    rest: &str,
    read_elsewhere: Option<BTreeSet<String>>,
) -> Option<String> {
    let text = format!(
        "{HEAD}PROC main()
MoveAbsJ jA,v1000,fine,tool0;
rFirst;
{between}
rSecond;
MoveAbsJ jA,v1000,fine,tool0;
ENDPROC
PROC rFirst()
MoveAbsJ jB,v1000,z100,tool0;
ENDPROC
PROC rSecond()
MoveAbsJ jC,v1000,fine,tool0;
ENDPROC
{rest}
ENDMODULE
"
    );
    let result = retrofitted_with(&program(text), read_elsewhere);
    let joined = joined(&result);
    let [segment] = joined.as_slice() else { return Some("no such run".to_owned()) };
    segment.reason.as_ref().map(ToString::to_string)
}

#[test]
fn statements_that_only_compute_may_stand_between() {
    for between in [
        "",
        "n:=n+1;",
        "Incr n;",
        "nLocal:=3;",
        "IF n=1 SetDO doA,1;",
        "IF n=7 THEN\nWaitTime 1;\nELSE\nn:=2;\nENDIF",
        "FOR i FROM 1 TO 3 DO\nn:=n+i;\nENDFOR",
        "WHILE n<3 DO\nn:=n+1;\nENDWHILE",
        "rCount;",
    ] {
        assert_eq!(reason(between, "PROC rCount()\nAdd n,2;\nENDPROC"), None, "{between}");
    }
}

#[test]
fn what_prevents_a_stream_is_named() {
    let trap = "TRAP tStep\nIF n=1 SetDO doA,1;\nENDTRAP
        PROC rConnect()\nCONNECT nTrap WITH tStep;\nENDPROC";
    for (between, rest, words) in [
        ("SetDO doA,1;", "", "SetDO doA runs between"),
        ("IF n=0 SetDO doA,1;", "", "SetDO doA runs between"),
        ("TPWrite \"b\";", "", "logic-between: TPWrite in M.mod:12 runs between"),
        ("MotionSup\\Off;", "", "logic-between: MotionSup in M.mod:12 runs between"),
        ("ConfL\\Off;", "", "logic-between: ConfL in M.mod:12 runs between"),
        ("GripLoad load0;", "", "logic-between: GripLoad in M.mod:12 runs between"),
        ("nShared:=3;", "", "logic-between: M.mod:12 (writes nShared; --only-task: "),
        ("n:=1;", trap, "logic-between: M.mod:12 runs between"),
        ("IF diA=1 n:=3;", "", "M.mod:12 decides by what may change"),
    ] {
        let reason = reason(between, rest).unwrap_or_default();
        assert!(reason.contains(words), "{between}: {reason}");
    }
}

/// Whether another task may read the data decides if they may be written early.
#[test]
fn data_that_no_other_task_reads_may_be_written_between() {
    let read = |names: &[&str]| Some(names.iter().map(|name| (*name).to_owned()).collect());
    for between in ["nShared:=3;", "Incr nShared;"] {
        assert_eq!(reason_with(between, "", read(&[])), None, "{between}");
        assert_eq!(reason_with(between, "", read(&["nother"])), None, "{between}");
        let reason = reason_with(between, "", read(&["nshared"])).unwrap_or_default();
        assert!(reason.contains("M.mod:12 (writes nShared; --only-task"), "{reason}");
    }
    let trap = "TRAP tStep\nIF nShared=1 SetDO doA,1;\nENDTRAP
        PROC rConnect()\nCONNECT nTrap WITH tStep;\nENDPROC";
    let reason = reason_with("nShared:=3;", trap, read(&[])).unwrap_or_default();
    assert!(reason.contains("M.mod:12 runs between"), "{reason}");
}

/// The message runs in the simulated cycle, but need not: the stream would never run.
#[test]
fn a_stream_that_the_cycle_does_not_reach_is_left_out() {
    let reason = reason("IF n=0 TPWrite \"b\";", "").unwrap_or_default();
    assert!(reason.starts_with("verification: "), "{reason}");
}

/// A chain of nested calls makes up for the pieces, so their number is limited.
#[test]
fn a_run_has_a_limited_number_of_pieces() {
    // Two pieces in each pass, one before and one behind.
    let passes = "FOR i FROM 1 TO 25 DO\nrFirst;\nrBack;\nENDFOR";
    let rest = "PROC rBack()\nMoveAbsJ jA,v1000,z100,tool0;\nENDPROC";
    let reason = reason(passes, rest).unwrap_or_default();
    assert!(reason.contains("in 52 pieces; 50 are possible"), "{reason}");
}
