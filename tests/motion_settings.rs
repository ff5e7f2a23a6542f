//! Streams under `AccSet`, `VelSet` and `SingArea`: within the lowered limits, and only under that setting.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod support;

use joulepath::rapid::text::{FileId, SourceFile};
use joulepath::retime::motion::timed::TimedMotion;
use joulepath::retime::motion::timeline::{Run, What};
use joulepath::retime::motion::{Options, Simulation};
use joulepath::tool::retrofit::{Retrofit, Settings, Source, retrofit};
use support::{irb1600, program, simulated, sources};

/// Excess of a limit by rounding.
const ROUNDING: f64 = 1e-3;
/// Sample step, s.
const STEP: f64 = 0.002;

/// A cell in which the robot carries a part there and comes back without it.
fn cell(carrying: &str) -> Vec<Source> {
    program(format!(
        "MODULE M
CONST jointtarget jA:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST jointtarget jB:=[[60,20,10,30,60,20],[9E9,9E9,9E9,9E9,9E9,9E9]];
PROC main()
MoveAbsJ jA,v1000,fine,tool0;
{carrying}
rMove jB;
AccSet 100,100;
VelSet 100,5000;
rMove jA;
ENDPROC
PROC rMove(jointtarget j)
MoveAbsJ j,v1000,fine,tool0;
ENDPROC
ENDMODULE
"
    ))
}

fn retrofitted(carrying: &str) -> Retrofit {
    let settings = Settings { point_estimate: true, ..Settings::default() };
    let result = retrofit(&cell(carrying), &irb1600(), &settings, &|_, _| ()).unwrap();
    assert!(result.verification.passed, "{carrying}");
    result
}

/// The emitted program with another text.
fn emitted(result: &Retrofit, from: &str, to: &str) -> Simulation {
    let files = result.outputs.iter().enumerate().map(|(i, output)| {
        let text = String::from_utf8_lossy(&output.bytes).replace(from, to);
        let id = FileId(i as u32);
        SourceFile::new(id, output.path.clone(), text.into_bytes())
    });
    simulated(&irb1600(), &sources(files.collect()), &Options::default())
}

fn runs(simulation: &Simulation) -> Vec<&Run> {
    let events = simulation.events.iter();
    events
        .filter_map(|event| if let What::Run(run) = &event.what { Some(&**run) } else { None })
        .collect()
}

/// Which runs are streams.
fn streams(simulation: &Simulation) -> Vec<bool> {
    let is_stream = |run: &&Run| matches!(run.motions.as_slice(), [(_, TimedMotion::Stream(_))]);
    runs(simulation).iter().map(is_stream).collect()
}

/// The largest share of the acceleration limits in a run.
fn acceleration(run: &Run) -> f64 {
    let limits = irb1600().limits.acceleration.unwrap();
    let count = (run.duration() / STEP) as usize;
    let states = (0..=count).map(|i| run.at(i as f64 * STEP).qdd);
    states
        .flat_map(|qdd| (0..6).map(|j| qdd[j].abs() / limits[j]).collect::<Vec<_>>())
        .fold(0.0, f64::max)
}

#[test]
fn streams_keep_the_accelerations_of_accset() {
    let result = retrofitted("AccSet 60,70;");
    assert_eq!(streams(&result.after.0), [false, true, true]);
    let [gentle, usual] = [1, 2].map(|i| acceleration(runs(&result.after.0)[i]));
    assert!(gentle <= 0.6 * (1.0 + ROUNDING), "{gentle}");
    assert!(usual > 0.6, "{usual}");
    let [before, after] = [&result.before.0, &result.after.0].map(|it| runs(it)[1].duration());
    assert!(after <= before * (1.0 + ROUNDING), "{after} {before}");
}

#[test]
fn velset_does_not_stretch_streams() {
    let result = retrofitted("VelSet 40,5000;");
    assert_eq!(streams(&result.after.0), [false, true, true]);
    let [before, after] = [&result.before.0, &result.after.0].map(|it| runs(it)[1].duration());
    assert!((after / before - 1.0).abs() < ROUNDING, "{after} {before}");
}

#[test]
fn streams_need_the_setting_that_they_were_made_for() {
    for (setting, others) in [
        ("AccSet 60,70;", ["AccSet 70,70;", "AccSet 60,100;", "AccSet 50,70;"]),
        ("VelSet 40,5000;", ["VelSet 50,5000;", "VelSet 30,5000;", "VelSet 40,50;"]),
        ("VelSet 100,800;", ["VelSet 100,900;", "VelSet 100,700;", "VelSet 100,5000;"]),
    ] {
        let result = retrofitted(setting);
        assert_eq!(streams(&result.after.0), [false, true, true], "{setting}");
        for other in others {
            assert_eq!(streams(&emitted(&result, setting, other)), [false, false, true], "{other}");
        }
    }
}

/// A line whose tool turns with the wrist axes.
#[test]
fn streams_need_the_interpolation_that_they_were_made_for() {
    let files = program(
        "MODULE M
PERS tooldata tG:=[TRUE,[[118.4,0,151.7],[0.707106781,0,0.707106781,0]],[5.5,[40,0,90],[1,0,0,0],0.05,0.06,0.04]];
CONST jointtarget jRest:=[[0,-25,10,0,15,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget pA:=[[710,-230,470],[0,0,1,0],[-1,-1,0,1],[9E9,9E9,9E9,9E9,9E9,9E9]];
PROC main()
MoveAbsJ jRest,v1000,fine,tG;
ConfL\\Off;
SingArea\\Wrist;
MoveJ pA,v1000,fine,tG;
MoveL RelTool(Offs(pA,100,150,60),0,0,0\\Rx:=20),v800,fine,tG;
SingArea\\Off;
MoveAbsJ jRest,v1000,fine,tG;
ENDPROC
ENDMODULE
"
        .to_owned(),
    );
    let settings = Settings { point_estimate: true, ..Settings::default() };
    let result = retrofit(&files, &irb1600(), &settings, &|_, _| ()).unwrap();
    assert!(result.verification.passed);
    assert_eq!(streams(&result.after.0), [false, true, true, true]);
    let other = emitted(&result, "SingArea\\Wrist;", "SingArea\\Off;");
    assert_eq!(streams(&other), [false, false, false, true]);
}
