//! Streams with more points than one module holds, in both layouts.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod support;

use joulepath::arm::kinematics::fk;
use joulepath::rapid::syntax;
use joulepath::rapid::text::{self, FileId, SourceFile, Span};
use joulepath::retime::motion::Options;
use joulepath::retime::motion::stream::Stream;
use joulepath::retime::motion::timed::TimedMotion;
use joulepath::retime::motion::timeline::What;
use joulepath::tool::emit::{
    Emission, EmittedStream, Layout, MotionSettings, Names, Recorded, Robot, Site, emit,
};
use support::{irb1600, simulated, sources};

/// Points of each stream: two streams do not fit into one module.
const POINTS: usize = 900;
/// Interval of the points, s.
const INTERVAL: f64 = 0.05;
/// Rounding of emitted positions, rad.
const ROUNDING: f64 = 2e-8;

const PROGRAM: &str = "MODULE M\n\
    CONST jointtarget jA:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    CONST jointtarget jB:=[[50,20,10,-20,40,60],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    PROC main()\n    MoveAbsJ jA,v1000,fine,tool0;\n    MoveAbsJ jB,v100,fine,tool0;\n\
    SetDO doA,1;\n    MoveAbsJ jA,v90,fine,tool0;\n    WaitTime 1;\n    MoveAbsJ jB,v80,fine,tool0;\n\
    ENDPROC\nENDMODULE\n";
const ENDS: [[f64; 6]; 2] =
    [[0.0, 0.0, 0.0, 0.0, 30.0, 0.0], [50.0, 20.0, 10.0, -20.0, 40.0, 60.0]];

/// A smooth movement between the two ends.
fn points(from: usize) -> Vec<[f64; 6]> {
    let (a, b) = (ENDS[from], ENDS[1 - from]);
    let eased = |i: usize| {
        let x = (i + 1) as f64 / POINTS as f64;
        if i + 1 == POINTS { 1.0 } else { x * x * (3.0 - 2.0 * x) }
    };
    (0..POINTS)
        .map(|i| std::array::from_fn(|j| (a[j] + eased(i) * (b[j] - a[j])).to_radians()))
        .collect()
}

fn stream(from: usize) -> EmittedStream {
    EmittedStream {
        start: ENDS[from].map(f64::to_radians),
        points: points(from),
        intervals: vec![INTERVAL; POINTS],
        pause: None,
        external: [9e9; 6],
        values: Vec::new(),
        follows: 0,
        puts_off: None,
        origin: "m.mod".into(),
        before: "1 s 1 J".into(),
        after: "1 s 1 J".into(),
    }
}

/// The files of the emitted program.
fn emitted(layout: Layout) -> Vec<SourceFile> {
    let file = SourceFile::new(FileId(0), "m.mod".into(), PROGRAM.into());
    let places = ["MoveAbsJ jB,v100", "MoveAbsJ jA,v90", "MoveAbsJ jB,v80"];
    let sites: Vec<Site> = places
        .iter()
        .enumerate()
        .map(|(i, statement)| {
            let start = PROGRAM.find(statement).unwrap();
            let end = start + PROGRAM[start..].find(';').unwrap() + 1;
            let span = Span { file: FileId(0), start: start as u32, end: end as u32 };
            Site {
                span,
                origin: format!("m.mod {i}"),
                parameters: Vec::new(),
                settings: MotionSettings {
                    fastest: 100.0,
                    conf_joint: true,
                    conf_linear: true,
                    lines: false,
                },
                tool: "tool0".into(),
                streams: vec![stream(i % 2)],
                order: vec![Some(0)],
            }
        })
        .collect();
    let names = Names::free(std::slice::from_ref(&file));
    let model = irb1600();
    let posture = [0.1; 6];
    let place = fk(&model, &posture).translation.vector.into();
    let emission = Emission {
        files: vec![file.clone()],
        names,
        layout,
        robot: Robot { kind: "1600".into(), posture, place },
        override_percent: 100.0,
        recorded: Recorded::default(),
        program: "0".into(),
    };
    let emitted = emit(&emission, &sites, &[]).unwrap();
    let bytes = text::apply(&file.bytes, &emitted.edits).unwrap();
    let mut files = vec![SourceFile::new(FileId(0), "m.mod".into(), bytes)];
    for (name, text) in emitted.modules {
        let id = FileId(files.len() as u32);
        files.push(SourceFile::new(id, format!("{name}.mod"), text.into_bytes()));
    }
    files
}

#[test]
fn long_streams_are_split_into_modules_of_one_program() {
    let model = irb1600();
    for layout in [Layout::Plain, Layout::Array, Layout::Auto] {
        let files = emitted(layout);
        let paths: Vec<&str> = files.iter().map(|file| file.path.as_str()).collect();
        assert_eq!(paths, ["m.mod", "Joulepath.mod", "Joulepath_2.mod", "Joulepath_3.mod"]);
        for file in &files {
            let parse = syntax::parse(&file.bytes);
            assert!(parse.errors.is_empty(), "{layout:?} {}: {:?}", file.path, parse.errors);
            assert!(parse.tolerances.is_empty(), "{layout:?} {}", file.path);
            let text = String::from_utf8_lossy(&file.bytes);
            let loops = text.matches("FOR i FROM 1 TO 899 DO").count();
            let expected = usize::from(layout != Layout::Plain && file.path != "m.mod");
            assert_eq!(loops, expected, "{layout:?} {}", file.path);
            // Only one module contains the guard functions.
            let functions = text.contains("FUNC bool jpAt(");
            assert_eq!(functions, file.path == "Joulepath.mod");
        }
        let simulation = simulated(&model, &sources(files), &Options::default());
        assert!(simulation.unresolved.is_empty(), "{:?}", simulation.unresolved);
        let streams: Vec<&Stream> = simulation
            .events
            .iter()
            .filter_map(|event| match &event.what {
                What::Run(run) => run.motions.first(),
                _ => None,
            })
            .filter_map(|(_, motion)| match motion {
                TimedMotion::Stream(stream) => Some(stream),
                TimedMotion::Path(..) => None,
            })
            .collect();
        assert_eq!(streams.len(), 3, "{layout:?}");
        for (i, stream) in streams.iter().enumerate() {
            assert_eq!(stream.points().len(), POINTS);
            for (read, meant) in stream.points().iter().zip(points(i % 2)) {
                assert!((0..6).all(|j| (read[j] - meant[j]).abs() < ROUNDING), "{layout:?}");
            }
            assert!(stream.intervals().iter().all(|t| *t == INTERVAL));
        }
    }
}
