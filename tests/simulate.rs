//! The virtual controller: movements, settings and control flow.

#![expect(clippy::unwrap_used, reason = "a failed set-up fails the test")]

mod support;

use std::collections::BTreeMap;
use std::sync::Arc;

use joulepath::arm::dynamics::{Data, kinetic_energy, potential_energy, torque};
use joulepath::arm::robot::{Model, find};
use joulepath::retime::energy::{Energies, account};
use joulepath::retime::motion::timed::TimedMotion;
use joulepath::retime::motion::timeline::{Run, What};
use joulepath::retime::motion::{Options, Plans, Simulation};
use joulepath::retime::path::PieceKind;
use support::{irb1600, program};

/// A home position and targets in front of an IRB1600, with the tool pointing down.
const DATA: &str = "CONST jointtarget home:=[[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget a:=[[700,-150,700],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget b:=[[700,150,700],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget c:=[[800,150,700],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget b25:=[[700,150,700],[0,0.2164396,0.9762960,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget d25:=[[1000,150,700],[0,0.2164396,0.9762960,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
VAR num n:=0;
VAR num endless:=1;
VAR bool late:=FALSE;
";

fn run_with(model: &Model, body: &str, options: &Options) -> Simulation {
    let text = format!(
        "MODULE M\n{DATA}PROC main()\nConfL\\Off;\nConfJ\\Off;\n{body}\nENDPROC\nENDMODULE"
    );
    support::simulated(model, &program(text), options)
}

fn simulated(body: &str) -> Simulation {
    run_with(&irb1600(), body, &Options::default())
}

fn runs(simulation: &Simulation) -> Vec<&Run> {
    simulation
        .events
        .iter()
        .filter_map(|event| match &event.what {
            What::Run(run) if event.duration > 0.0 => Some(&**run),
            _ => None,
        })
        .collect()
}

/// Total duration of the movements of a program including settling, s.
fn duration(body: &str) -> f64 {
    runs(&simulated(body)).iter().map(|run| run.duration()).sum()
}

/// Distance from the corner at which the first zone of the last run begins, m of TCP path.
fn zone_size(body: &str) -> f64 {
    let simulation = simulated(body);
    assert!(simulation.unresolved.is_empty(), "{:?}", simulation.unresolved);
    let all = runs(&simulation);
    let TimedMotion::Path(path, _) = &all.last().unwrap().motions[0].1 else { panic!("no path") };
    let zone = path.pieces().iter().find(|p| p.kind == PieceKind::CartesianZone).unwrap();
    path.leg_end(path.legs().start) - zone.s
}

/// Tolerance of lengths.
const LENGTH: f64 = 1e-9;

#[test]
fn the_smallest_relative_size_limits_a_zone() {
    // Example of the manual: a zone of 9 degrees in a rotation of 25 degrees covers 9/25 of the
    // path, although 130 of 300 mm are permitted.
    let zone = "[FALSE,130,130,130,9,130,9]";
    let body = format!(
        "MoveJ a,v1000,fine,tool0;\nMoveL b25,v300,{zone},tool0;\nMoveL d25,v300,fine,tool0;"
    );
    let size = zone_size(&body);
    assert!((size - 0.3 * 9.0 / 25.0).abs() < 1e-4, "{size}");
    // Without the rotation the size in mm applies.
    let body = format!(
        "MoveJ a,v1000,fine,tool0;\nMoveL b,v300,{zone},tool0;\nMoveL [[1000,150,700],[0,0,1,0],\
         [0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v300,fine,tool0;"
    );
    assert!((zone_size(&body) - 0.13).abs() < LENGTH);
}

#[test]
fn a_zone_takes_at_most_half_of_the_shorter_way() {
    let body = "MoveJ a,v1000,fine,tool0;\nMoveL b,v300,z200,tool0;\nMoveL c,v300,fine,tool0;";
    assert!((zone_size(body) - 0.05).abs() < LENGTH, "half of the 100 mm behind the corner");
    let body = "MoveJ a,v1000,fine,tool0;\nMoveL b,v300,z30,tool0;\nMoveL c,v300,fine,tool0;";
    assert!((zone_size(body) - 0.03).abs() < LENGTH);
}

/// Tolerance of the bisection of a stated duration, s.
const TIMED: f64 = 1e-6;

#[test]
fn a_stated_time_is_scaled_by_the_override_and_not_by_the_largest_speed() {
    let time = |settings: &str, wanted: f64| {
        let body = format!("MoveJ a,v1000,fine,tool0;\n{settings}MoveL b,v1000\\T:=5,fine,tool0;");
        let simulation = simulated(&body);
        let last = runs(&simulation).last().unwrap().duration();
        assert!((last - wanted).abs() < TIMED, "{settings}: {last}");
    };
    time("", 5.0);
    time("VelSet 50,5000;", 10.0);
    time("VelSet 100,10;", 5.0);
    time("SpeedRefresh 50;", 10.0);
}

#[test]
fn less_acceleration_takes_longer() {
    let time = |acc: u32| {
        duration(&format!(
            "MoveJ a,v1000,fine,tool0;\nAccSet {acc},100;\nMoveL b,v1000,z10,tool0;\n\
             MoveJ c,v1000,fine,tool0;"
        ))
    };
    let times: Vec<f64> = [20, 30, 40, 50, 60, 70, 80, 90, 100].map(time).to_vec();
    assert!(times.windows(2).all(|pair| pair[0] > pair[1]), "{times:?}");
    // Below 20 % the controller uses 20 %.
    assert_eq!(time(5), times[0]);
    let ramp = |settings: &str| {
        duration(&format!("MoveJ a,v1000,fine,tool0;\n{settings}\nMoveL b,v1000,fine,tool0;"))
    };
    assert!(ramp("AccSet 100,50;") > ramp("AccSet 100,100;"));
    assert!(ramp("AccSet 100,100\\FinePointRamp:=50;") > ramp("AccSet 100,100;"));
}

/// Largest acceleration of the TCP along and perpendicular to its path in the last run, m/s².
fn accelerations(model: &Model, body: &str) -> [f64; 2] {
    const STEP: f64 = 1e-3;
    let simulation = run_with(model, body, &Options::default());
    let all = runs(&simulation);
    let run = all.last().unwrap();
    let tool = run.legs[0].tool;
    let velocity = |t: f64| {
        let state = run.at(t);
        let twist = tool.jacobian(model, &state.q) * nalgebra::Vector6::from(state.qd);
        twist.fixed_rows::<3>(0).into_owned()
    };
    let mut worst = [0.0_f64; 2];
    let steps = (run.duration() / STEP) as usize;
    for i in 1..steps {
        let t = i as f64 * STEP;
        let rate = (velocity(t + STEP) - velocity(t - STEP)) / (2.0 * STEP);
        let direction = velocity(t).normalize();
        let along = rate.dot(&direction);
        worst[0] = worst[0].max(along.abs());
        worst[1] = worst[1].max(rate.norm());
    }
    worst
}

/// Accepted ratio to a limit at the ends of a motion, with the errors of finite differences.
const OVERSHOOT: f64 = 1.03;

#[test]
fn acceleration_limits_are_kept() {
    let body = |settings: &str, zone: &str| {
        format!(
            "MoveJ a,v1000,fine,tool0;\n{settings}\nMoveL b,v1000,{zone},tool0;\n\
             MoveL c,v1000,fine,tool0;"
        )
    };
    let model = irb1600();
    let [free, _] = accelerations(&model, &body("", "fine"));
    assert!(free > 4.0, "the limits below would be none: {free}");
    // On a straight path: in a corner the moving average also slows the TCP.
    let limited = "PathAccLim TRUE\\AccMax:=2,TRUE\\DecelMax:=2;";
    let [along, _] = accelerations(&model, &body(limited, "fine"));
    assert!(along < 2.0 * OVERSHOOT, "{along}");
    let [_, all] = accelerations(&model, &body("WorldAccLim\\On:=1.5;", "z30"));
    assert!(all < 1.5 * OVERSHOOT, "{all}");
    // The limit is removed again.
    let lifted = body("PathAccLim TRUE\\AccMax:=2,FALSE;\nPathAccLim FALSE,FALSE;", "z30");
    assert_eq!(duration(&lifted), duration(&body("", "z30")));
}

/// Measured on an IRC5 with an IRB6640 in a line of 500 mm at vmax: peak acceleration (m/s²), its
/// rise time (s), and the tolerance of both.
const LINE: (f64, f64, f64) = (12.5, 0.1, 0.15);

#[test]
fn a_line_accelerates_as_measured() {
    const STEP: f64 = 1e-3;
    let model = find("IRB6640-180/2.55").unwrap();
    let tool = "[TRUE,[[75,0,493.3],[0.965925826,0,0.258819045,0]],[1,[0,0,1],[1,0,0,0],0,0,0]]";
    let none = "[9E9,9E9,9E9,9E9,9E9,9E9]";
    let body = format!(
        "MoveJ [[2200,500,1000],[0.382683432,0,0.923879533,0],[0,0,-1,1],{none}],v500,fine,{tool};\n\
         MoveL [[2200,0,1000],[0.555570233,0,0.831469612,0],[0,-1,-1,1],{none}],\
         [10000,9999999,9999999,9999999],fine,{tool};"
    );
    let simulation = run_with(&model, &body, &Options::default());
    let all = runs(&simulation);
    let run = all.last().unwrap();
    let frame = run.legs[0].tool;
    let speed = |t: f64| {
        let state = run.at(t);
        let twist = frame.jacobian(&model, &state.q) * nalgebra::Vector6::from(state.qd);
        twist.fixed_rows::<3>(0).norm()
    };
    let acceleration = |i: usize| {
        let t = i as f64 * STEP;
        (speed(t + STEP) - speed((t - STEP).max(0.0))) / (2.0 * STEP)
    };
    let values: Vec<f64> = (0..250).map(acceleration).collect();
    let peak = values.iter().copied().fold(0.0, f64::max);
    let near = |x: f64, measured: f64| (x / measured - 1.0).abs() < LINE.2;
    assert!(near(peak, LINE.0), "{peak} m/s²");
    // From the start to 90 % of the peak.
    let ramp = values.iter().position(|a| *a > 0.9 * peak).unwrap() as f64 * STEP;
    assert!(near(ramp, LINE.1), "{ramp} s");
}

/// Programs with movements of all kinds, corners, changes of speed and of load.
const MOVEMENTS: [&str; 3] = [
    "MoveJ a,v1000,fine,tool0;\nMoveL b,v500,z30,tool0;\nMoveL c,v1000,fine,tool0;\n\
     MoveAbsJ home,vmax,fine,tool0;",
    "MoveJ a,v1000,fine,tool0;\nGripLoad [8,[0,0,60],[1,0,0,0],0.1,0.1,0.05];\n\
     MoveC [[850,0,700],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],b,v300,z10,tool0;\n\
     MoveJ home2,v1500,z50,tool0;\nMoveL a,v200,fine,tool0;",
    "MoveAbsJ home,v500,fine,tool0;\nMoveJ b25,v800,z20,tool0;\nMoveJ a,v800,z20,tool0;\n\
     MoveL c,v2000,z0,tool0;\nMoveL b,v2000,fine,tool0;",
];
/// Tolerance of the energy balance, relative to the sum of absolute work.
const BALANCE: f64 = 1e-6;

#[test]
fn energy_is_balanced_in_every_move() {
    let model = irb1600();
    for body in MOVEMENTS {
        let body =
            body.replace("home2", "[[700,-150,900],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]");
        let simulation = simulated(&body);
        assert!(simulation.unresolved.is_empty(), "{:?}", simulation.unresolved);
        let account = account(&model, &simulation);
        for (event, parts) in simulation.events.iter().zip(&account.events) {
            let What::Run(run) = &event.what else { continue };
            for (i, (record, part)) in run.moves.iter().zip(parts).enumerate() {
                let rest = if i + 1 == run.moves.len() { run.settling } else { 0.0 };
                let (from, to) = (record.t_start, record.t_start + record.duration - rest);
                let energy = |t: f64| {
                    let state = run.at(t);
                    kinetic_energy(&model, &run.load, &state.q, &state.qd)
                        + potential_energy(&model, &run.load, &state.q)
                };
                let gained = energy(to) - energy(from);
                // Work of the joints by Simpson's rule on a fine grid.
                let mut data = Data::new();
                let mut power = |t: f64| {
                    let s = run.at(t);
                    let tau = torque(&model, &mut data, &run.load, &s.q, &s.qd, &s.qdd);
                    let power_of = |t: &[f64]| s.qd.iter().zip(t).map(|(v, t)| v * t).sum::<f64>();
                    [power_of(&tau.rigid), power_of(&tau.friction)]
                };
                let steps = ((to - from) / 1e-4).ceil().max(1.0) as usize;
                let h = (to - from) / steps as f64;
                let (mut work, mut lost, mut scale) = (0.0, 0.0, f64::MIN_POSITIVE);
                for k in 0..steps {
                    let t = from + h * k as f64;
                    let weights = [(0.0, 1.0), (0.5, 4.0), (1.0, 1.0)];
                    for (share, weight) in weights {
                        let [rigid, friction] = power(t + share * h);
                        work += h / 6.0 * weight * (rigid + friction);
                        lost += h / 6.0 * weight * friction;
                        scale += h / 6.0 * weight * (rigid.abs() + friction.abs());
                    }
                }
                let close = |a: f64, b: f64| (a - b).abs() < BALANCE * scale;
                let name = &record.movement.instruction;
                assert!(close(part.mechanical_j, gained), "{name}: {part:?}, gained {gained}");
                assert!(close(part.friction_j, lost), "{name}: {part:?}, lost {lost}");
                let sum = part.mechanical_j + part.friction_j;
                assert!(close(work, sum), "{name}: {work} J of the joints, {sum} J");
            }
        }
    }
}

#[test]
fn energies_and_durations_of_events_add_up_to_the_cycle() {
    let model = irb1600();
    let simulation = simulated(
        "MoveJ a,v1000,fine,tool0;\nWaitTime 0.5;\nMoveL b,v500,z30,tool0;\nMoveL c,v1000,fine,tool0;",
    );
    let account = account(&model, &simulation);
    let energy: f64 =
        account.events.iter().flatten().map(joulepath::retime::energy::EnergyParts::energy_j).sum();
    assert!((energy - account.total.energy_j()).abs() < 1e-9 * energy);
    let time: f64 = simulation.events.iter().map(|event| event.duration).sum();
    assert!((time - simulation.cycle_s).abs() < 1e-12);
}

#[test]
fn a_wait_takes_the_settling_of_the_stop_before_it() {
    let direct = duration("MoveJ a,v1000,fine,tool0;\nMoveL b,v500,fine,tool0;");
    let waiting = duration("MoveJ a,v1000,fine,tool0;\nWaitTime 0;\nMoveL b,v500,fine,tool0;");
    assert!(direct > waiting + 0.02, "{direct} {waiting}");
}

#[test]
fn branches_that_depend_on_inputs_are_reported() {
    let body = "MoveJ a,v1000,fine,tool0;\nIF diPart=1 THEN\nMoveL b,v500,fine,tool0;\n\
                ELSE\nMoveL c,v500,fine,tool0;\nMoveL b,v500,fine,tool0;\nENDIF";
    let low = simulated(body);
    assert_eq!(runs(&low).len(), 3);
    let note = &low.unresolved[0].reason;
    assert!(note.contains("FALSE") && note.contains("1 instruction"), "{note}");
    assert!(note.contains("--assume diPart"), "{note}");
    let levels = BTreeMap::from([("dipart".to_owned(), 1.0)]);
    let high = run_with(&irb1600(), body, &Options { levels, ..Options::default() });
    assert_eq!(runs(&high).len(), 2);
    assert!(high.unresolved[0].reason.contains("2 instructions"), "{:?}", high.unresolved);
    assert!(high.assumed.iter().any(|text| text.contains("diPart is 1")), "{:?}", high.assumed);
}

#[test]
fn the_passes_of_an_endless_loop_can_be_chosen() {
    let body = "MoveJ a,v1000,fine,tool0;\nWHILE TRUE DO\nMoveL b,v500,fine,tool0;\n\
                MoveL a,v500,fine,tool0;\nENDWHILE";
    let moves = |passes: Option<u32>| {
        let simulation = run_with(&irb1600(), body, &Options { passes, ..Options::default() });
        runs(&simulation).len() - 1
    };
    assert_eq!([moves(None), moves(Some(1)), moves(Some(3))], [2, 2, 6]);
}

#[test]
fn an_endless_program_is_stopped_and_reported() {
    let body = "MoveJ a,v1000,fine,tool0;\nWHILE endless=1 DO\nMoveL b,v500,fine,tool0;\n\
                MoveL a,v500,fine,tool0;\nENDWHILE";
    let options = Options { max_time: Some(20.0), ..Options::default() };
    let simulation = run_with(&irb1600(), body, &options);
    assert!((20.0..25.0).contains(&simulation.cycle_s), "{}", simulation.cycle_s);
    let reasons: Vec<&str> = simulation.unresolved.iter().map(|n| n.reason.as_str()).collect();
    assert!(reasons.iter().any(|r| r.contains("--max-time")), "{reasons:?}");
}

#[test]
fn the_speed_override_prolongs_movements() {
    let time = |speed_override: Option<f64>| {
        let options = Options { speed_override, ..Options::default() };
        let body = "MoveJ a,v1000,fine,tool0;\nMoveL b,v100,fine,tool0;";
        let simulation = run_with(&irb1600(), body, &options);
        runs(&simulation).last().unwrap().duration()
    };
    let way = 0.3 / 0.1;
    assert!((time(Some(0.5)) - time(None) - way).abs() < 0.02 * way);
}

#[test]
fn movements_of_external_axes_take_time() {
    let simulation = simulated(
        "MoveJ a,v1000,fine,tool0;\nMoveExtJ [[9E9,9E9,9E9,9E9,9E9,9E9],[0,9E9,9E9,9E9,9E9,9E9]],\
         vrot10,fine;\nMoveExtJ [[9E9,9E9,9E9,9E9,9E9,9E9],[30,9E9,9E9,9E9,9E9,9E9]],\
         [0,0,0,10],fine;\nMoveExtJ [[9E9,9E9,9E9,9E9,9E9,9E9],[0,9E9,9E9,9E9,9E9,9E9]],\
         [0,0,0,10]\\T:=7,fine;",
    );
    let waits: Vec<f64> = simulation
        .events
        .iter()
        .filter(|event| matches!(event.what, What::Wait(_)))
        .map(|event| event.duration)
        .collect();
    assert_eq!(waits, [0.0, 3.0, 7.0]);
}

fn reasons(simulation: &Simulation) -> Vec<&str> {
    simulation.unresolved.iter().map(|note| note.reason.as_str()).collect()
}

fn waits(simulation: &Simulation) -> Vec<f64> {
    let waits = simulation.events.iter().filter(|e| matches!(e.what, What::Wait(_)));
    waits.map(|event| event.duration).collect()
}

fn with_input(body: &str, seconds: f64) -> Simulation {
    let inputs = BTreeMap::from([("dipart".to_owned(), seconds)]);
    run_with(&irb1600(), body, &Options { inputs, ..Options::default() })
}

/// Rounding of times, s.
const TIME: f64 = 1e-9;
/// More than the duration of any movement between a, b and c below, s.
const ONE_MOVE: f64 = 2.0;

#[test]
fn endless_fly_by_motion_is_stopped_at_the_time_limit() {
    let loops = [
        "WHILE endless=1 DO\nMoveL b,v500,z10,tool0;\nMoveL a,v500,z10,tool0;\nENDWHILE",
        "FOR i FROM 1 TO 90000 DO\nMoveL b,v500,z10,tool0;\nMoveL a,v500,z10,tool0;\nENDFOR",
    ];
    for body in loops {
        let body = format!("MoveJ a,v1000,fine,tool0;\n{body}");
        let options = Options { max_time: Some(20.0), ..Options::default() };
        let simulation = run_with(&irb1600(), &body, &options);
        let cycle = simulation.cycle_s;
        assert!((20.0..20.0 + ONE_MOVE).contains(&cycle), "{cycle}");
        let reported: Vec<&str> = reasons(&simulation);
        assert!(reported.iter().any(|r| r.contains("--max-time")), "{reported:?}");
        let moves: usize = runs(&simulation).iter().map(|run| run.moves.len()).sum();
        assert!((20..60).contains(&moves), "{moves}");
        let last = runs(&simulation).last().unwrap().at(cycle);
        assert!(last.qd.iter().all(|qd| *qd == 0.0), "{last:?}");
    }
}

#[test]
fn exceeding_the_time_limit_in_the_last_instruction_is_reported() {
    let options = Options { max_time: Some(20.0), ..Options::default() };
    let simulation = run_with(&irb1600(), "MoveJ a,v1000,fine,tool0;\nWaitTime 60;", &options);
    assert!(reasons(&simulation).iter().any(|r| r.contains("--max-time")));
    let simulation = run_with(&irb1600(), "MoveJ a,v1000,fine,tool0;\nWaitTime 6;", &options);
    assert!(reasons(&simulation).is_empty());
}

#[test]
fn waits_end_at_their_max_time() {
    let start = "MoveAbsJ home,v1000,fine,tool0;\n";
    let wait = |options: &str| format!("{start}WaitDI diPart,1{options};\nIF late WaitTime 9;");
    assert_eq!(waits(&with_input(&wait("\\MaxTime:=2\\TimeFlag:=late"), 5.0)), [2.0, 9.0]);
    assert_eq!(waits(&with_input(&wait("\\MaxTime:=7\\TimeFlag:=late"), 5.0)), [5.0]);
    let until = format!("{start}WaitUntil diPart=1\\MaxTime:=2;\nWaitTime 9;");
    let ended = with_input(&until, 5.0);
    assert_eq!(waits(&ended), [2.0]);
    assert!(reasons(&ended).iter().any(|r| r.contains("ERR_WAIT_MAXTIME")), "{ended:?}");
}

#[test]
fn error_handlers_receive_timeouts_of_waits() {
    let program = |handler: &str| {
        format!(
            "MoveAbsJ home,v1000,fine,tool0;\nWaitDI diPart,1\\MaxTime:=2;\nWaitTime 9;\nERROR\n\
             IF ERRNO=ERR_WAIT_MAXTIME THEN\n{handler}\nENDIF"
        )
    };
    // Three tries of two seconds reach the input at five seconds.
    assert_eq!(waits(&with_input(&program("RETRY;"), 5.0)), [2.0, 2.0, 1.0, 9.0]);
    assert_eq!(waits(&with_input(&program("TRYNEXT;"), 5.0)), [2.0, 9.0]);
    assert_eq!(waits(&with_input(&program("RETURN;"), 5.0)), [2.0]);
    let never = with_input(&program("RETRY;"), 500.0);
    assert_eq!(waits(&never), [2.0; 5]);
    assert!(reasons(&never).iter().any(|r| r.contains("ERR_EXCRTYMAX")), "{:?}", reasons(&never));
}

#[test]
fn stop_points_wait_for_their_condition() {
    let time = |option: &str| {
        duration(&format!("MoveJ a,v1000,fine,tool0;\nMoveL b,v500,z10{option},tool0;"))
    };
    let fine = duration("MoveJ a,v1000,fine,tool0;\nMoveL b,v500,fine,tool0;");
    let longer = |option: &str, seconds: f64| {
        let more = time(option) - fine;
        assert!((more - seconds).abs() < TIME, "{option}: {more} s");
    };
    longer("\\Inpos:=stoptime0_5", 0.5);
    longer("\\Inpos:=stoptime1_5", 1.5);
    longer("\\Inpos:=fllwtime1_0", 1.0);
    longer("\\Inpos:=inpos100", 0.0);
    longer("\\Inpos:=[inpos,TRUE,[100,100,0.3,2],0,0,\"\",0,0]", 0.3);
    longer("\\Inpos:=[inpos,TRUE,[1,1,0,0.1],0,0,\"\",0,0]", 0.1);
    assert!(time("\\Inpos:=inpos20") > time("\\Inpos:=inpos50"));
    assert!(time("\\Inpos:=inpos50") > fine + 0.01);
}

#[test]
fn other_branches_of_a_test_on_an_input_are_reported() {
    let body = "MoveJ a,v1000,fine,tool0;\nTEST giPart\nCASE 1:\nMoveL b,v500,fine,tool0;\n\
                CASE 3,4:\nMoveL c,v500,fine,tool0;\nMoveL b,v500,fine,tool0;\nENDTEST";
    let zero = simulated(body);
    assert_eq!(runs(&zero).len(), 1);
    let reported = reasons(&zero).join("\n");
    assert!(reported.contains("2 other branches (3 instructions)"), "{reported}");
    assert!(reported.contains("--assume giPart"), "{reported}");
    // Also through a variable.
    let body_of = |value: &str| body.replace("TEST giPart", &format!("n:={value};\nTEST n"));
    let reported = reasons(&simulated(&body_of("giPart+0"))).join("\n");
    assert!(
        reported.contains("2 other branches") && reported.contains("--assume giPart"),
        "{reported}"
    );
    assert!(reasons(&simulated(&body_of("0"))).is_empty());
    let levels = BTreeMap::from([("gipart".to_owned(), 3.0)]);
    let three = run_with(&irb1600(), body, &Options { levels, ..Options::default() });
    assert_eq!(runs(&three).len(), 3);
    assert!(reasons(&three).join("\n").contains("1 other branch (1 instruction)"));
}

/// Loops that poll an input; all of them end when it is set.
const POLLING: [&str; 8] = [
    "again:\nIF diPart=0 THEN\nWaitTime 0.1;\nGOTO again;\nENDIF",
    "again:\nIF diPart=0 GOTO again;",
    "again:\nWaitTime 0.1;\nIF diPart=1 GOTO done;\nGOTO again;\ndone:",
    "again:\nn:=n+1;\nIF diPart=0 THEN\nGOTO again;\nELSE\nENDIF",
    "WHILE diPart=0 DO\nWaitTime 0.1;\nENDWHILE",
    "WHILE TRUE DO\nIF diPart=1 GOTO done;\nWaitTime 0.1;\nENDWHILE\ndone:",
    "WHILE late=FALSE DO\nWaitTime 0.1;\nIF diPart=1 THEN\nlate:=TRUE;\nENDIF\nENDWHILE",
    "FOR i FROM 1 TO 90000 DO\nIF diPart=1 GOTO done;\nWaitTime 0.1;\nENDFOR\ndone:",
];

#[test]
fn loops_that_poll_an_input_are_waits_for_it() {
    for poll in POLLING {
        let body = format!("MoveAbsJ home,v1000,fine,tool0;\n{poll}\nMoveJ a,v1000,fine,tool0;");
        let unknown = simulated(&body);
        assert_eq!(runs(&unknown).len(), 1, "{poll}: {:?}", reasons(&unknown));
        assert!(waits(&unknown).len() <= 3, "{poll}: {:?}", waits(&unknown));
        let reported = reasons(&unknown);
        assert!(
            reported.iter().any(|r| r.contains("--input diPart=SECONDS")),
            "{poll}: {reported:?}"
        );
        let known = with_input(&body, 5.0);
        let sum: f64 = waits(&known).iter().sum();
        // The pass that detects the input may add its duration.
        assert!((5.0 - TIME..5.1 + TIME).contains(&sum), "{poll}: {:?}", waits(&known));
        assert_eq!(runs(&known).len(), 1, "{poll}");
        assert!(known.repeats_from.is_none(), "{poll}");
    }
}

#[test]
fn a_counted_loop_gives_up_before_the_input_comes() {
    let body = "MoveAbsJ home,v1000,fine,tool0;\nFOR i FROM 1 TO 20 DO\nIF diPart=1 GOTO done;\n\
                WaitTime 0.1;\nENDFOR\nWaitTime 7;\ndone:";
    let sum: f64 = waits(&with_input(body, 5.0)).iter().sum();
    assert!((sum - 9.0).abs() < 0.11, "{sum}");
}

#[test]
fn loops_move_until_their_input_is_set() {
    for body in [
        "again:\nMoveL b,v500,z10,tool0;\nMoveL a,v500,fine,tool0;\nIF diPart=0 GOTO again;",
        "WHILE diPart=0 DO\nMoveL b,v500,z10,tool0;\nMoveL a,v500,fine,tool0;\nENDWHILE",
    ] {
        let body = format!("MoveJ a,v1000,fine,tool0;\n{body}\nWaitTime 1;");
        let unknown = simulated(&body);
        let reported = reasons(&unknown);
        assert_eq!(runs(&unknown).len(), 2, "{reported:?}");
        assert!(reported.iter().any(|r| r.contains("the first pass")), "{reported:?}");
        assert_eq!(waits(&unknown), [1.0]);
        let known = with_input(&body, 10.0);
        let cycle = known.cycle_s - 1.0;
        assert!((10.0..10.0 + ONE_MOVE).contains(&cycle), "{cycle}");
    }
}

#[test]
fn refused_or_unsimulated_settings_are_reported() {
    for (setting, what) in [
        ("VelSet 0,5000", "stops with an error"),
        ("VelSet 250,5000", "stops with an error"),
        ("VelSet 100,0", "stops with an error"),
        ("SpeedRefresh 120", "stops with an error"),
        ("PathAccLim TRUE\\AccMax:=0.01,FALSE", "0.1 m/s²"),
        ("SoftAct 1,50", "not simulated"),
        ("TuneServo ROB_1,1,80", "not simulated"),
        ("CirPathMode\\CirPointOri", "not simulated"),
        ("EOffsOn", "not simulated"),
    ] {
        let body = format!("MoveJ a,v1000,fine,tool0;\n{setting};\nMoveL b,v500,fine,tool0;");
        let simulation = simulated(&body);
        let reported = reasons(&simulation);
        assert!(reported.len() == 1 && reported[0].contains(what), "{setting}: {reported:?}");
        assert_eq!(runs(&simulation).len(), 2);
    }
    assert!(reasons(&simulated("CirPathMode\\PathFrame;\nSoftDeact;")).is_empty());
}

#[test]
fn external_axes_move_with_their_own_speeds() {
    let to = |x: f64, speed: &str| {
        format!("MoveExtJ [[9E9,9E9,9E9,9E9,9E9,9E9],[{x},9E9,9E9,9E9,9E9,9E9]],{speed},fine;\n")
    };
    let body = [to(0.0, "vrot10"), to(30.0, "vrot10"), to(130.0, "vlin50")].concat();
    let simulation = simulated(&format!("MoveJ a,v1000,fine,tool0;\n{body}"));
    assert_eq!(waits(&simulation), [0.0, 3.0, 2.0]);
}

#[test]
fn a_displacement_acts_in_the_frame_of_the_work_object() {
    // The object is rotated by a quarter turn: its x axis is the y axis of the world.
    let object = "[FALSE,TRUE,\"\",[[700,0,700],[0.70710678,0,0,0.70710678]],[[0,0,0],[1,0,0,0]]]";
    let point = "[[0,0,0],[0,0.70710678,0.70710678,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";
    let at = |settings: &str| {
        let body = format!("{settings}MoveJ {point},v1000,fine,tool0\\WObj:={object};");
        let simulation = simulated(&body);
        assert!(reasons(&simulation).is_empty(), "{:?}", reasons(&simulation));
        runs(&simulation).last().unwrap().legs[0].target.translation.vector
    };
    let shift = at("PDispSet [[100,0,0],[1,0,0,0]];\n") - at("");
    assert!((shift - nalgebra::Vector3::new(0.0, 0.1, 0.0)).norm() < 1e-6, "{shift}");
}

#[test]
fn logic_runs_during_concurrent_movements() {
    let cycle = |conc: &str, wait: &str| {
        let body =
            format!("MoveJ a,v1000,fine,tool0;\nMoveL {conc}b,v100,fine,tool0;\nWaitTime {wait};");
        simulated(&body).cycle_s
    };
    // The movement of 0.3 m at 100 mm/s covers a wait of one second, and three of five.
    let moves = cycle("", "0");
    assert!((cycle("", "1") - moves - 1.0).abs() < TIME);
    assert!((cycle("\\Conc,", "1") - moves).abs() < TIME);
    let rest = 1.0 + cycle("\\Conc,", "5") - moves;
    assert!((2.5..3.0).contains(&rest), "{rest}");
}

#[test]
fn a_wait_for_several_inputs_ends_with_the_decisive_one() {
    let inputs = BTreeMap::from([("di3".to_owned(), 4.0), ("di4".to_owned(), 5.5)]);
    let ends = |wait: &str| {
        let options = Options { inputs: inputs.clone(), ..Options::default() };
        let simulation = run_with(&irb1600(), wait, &options);
        assert!(simulation.inputs_asked.contains("di3") && simulation.inputs_asked.contains("di4"));
        simulation.cycle_s
    };
    assert_eq!(ends("WaitUntil di3=1 AND di4=1;"), 5.5);
    assert_eq!(ends("WaitUntil di4=1 AND di3=1;"), 5.5);
    assert_eq!(ends("WaitUntil di3=1 OR di4=1;"), 4.0);
    assert_eq!(ends("WaitUntil di4=1 OR di3=1;"), 4.0);
    assert_eq!(ends("WaitUntil NOT (di3=0 OR di4=0);"), 5.5);
    assert_eq!(ends("WHILE di3=0 OR di4=0 DO\nWaitTime 0.1;\nENDWHILE"), 5.5);
    assert_eq!(ends("WHILE di3=0 AND di4=0 DO\nWaitTime 0.1;\nENDWHILE"), 4.0);
}

/// An array that exceeds any memory causes a message and is not allocated.
#[test]
fn arrays_larger_than_memory_are_not_allocated() {
    let body = "VAR num all{10000,10000,10000};\nall{1,1,1}:=1;\nMoveJ a,v1000,fine,tool0;\n\
                MoveJ b,[all{1,1,2}+100,500,5000,1000],fine,tool0;";
    let simulation = simulated(body);
    let reported = reasons(&simulation);
    assert!(reported.iter().any(|reason| reason.contains("too large")), "{reported:?}");
}

#[test]
fn known_runs_change_no_result() {
    let body = "MoveAbsJ home,v1000,fine,tool0;\nMoveJ a,v1000,z10,tool0;\nMoveL b,v300,fine,tool0;\n\
        WaitTime 0.5;\nMoveL c,v300,fine,tool0;";
    let changed = body.replace("MoveL c,v300", "MoveL c,v800");
    let model = irb1600();
    let options = Options { plans: Some(Arc::new(Plans::new(&model))), ..Options::default() };
    let energies = Energies::new(&model);
    let states = |simulation: &Simulation| -> Vec<_> {
        let of = |run: &Run| [0.1, 0.4, 0.9].map(|share| run.at(share * run.duration()).list());
        runs(simulation).into_iter().map(of).collect()
    };
    for body in [body, &changed, body] {
        let plain = simulated(body);
        let known = run_with(&model, body, &options);
        assert_eq!(plain.cycle_s, known.cycle_s);
        assert_eq!(states(&plain), states(&known));
        assert_eq!(account(&model, &plain).events, energies.account(&known).events);
    }
    // With a twentieth of the joint speeds it is another robot.
    let mut slow = model.clone();
    for speed in slow.limits.velocity.iter_mut().flatten() {
        *speed *= 0.05;
    }
    let plain = run_with(&slow, body, &Options::default());
    assert_ne!(plain.cycle_s, simulated(body).cycle_s);
    assert_eq!(plain.cycle_s, run_with(&slow, body, &options).cycle_s);
}
