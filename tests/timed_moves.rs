//! Movements with `\T`, the limiting quantity of a movement, and lines near singularities.
#![expect(clippy::unwrap_used, reason = "a failed set-up fails the test")]

mod support;

use std::fmt::Write;
use std::fs;

use joulepath::arm::dynamics::{Data, torque};
use joulepath::arm::kinematics::fk;
use joulepath::retime::motion::timeline::{Run, What};
use joulepath::retime::motion::{Options, Simulation};
use support::{irb1600, program, simulated};

const NONE: &str = "[9E9,9E9,9E9,9E9,9E9,9E9]";

/// A line to a point in mm with the tool pointing down.
fn line(point: [f64; 3], speed: &str, zone: &str) -> String {
    let [x, y, z] = point;
    format!("MoveL [[{x},{y},{z}],[0,0,1,0],[0,0,0,0],{NONE}],{speed},{zone},tool0;\n")
}

/// Simulates a program that starts above the table, without configuration monitoring.
fn run(body: &str) -> Simulation {
    let text = format!(
        "MODULE M\nPROC main()\nMoveAbsJ [[0,0,0,0,60,0],{NONE}],v1000,fine,tool0;\nConfL\\Off;\n\
         ConfJ\\Off;\n{body}ENDPROC\nENDMODULE\n"
    );
    simulated(&irb1600(), &program(text), &Options::default())
}

fn runs(simulation: &Simulation) -> impl Iterator<Item = &Run> {
    simulation.events.iter().filter_map(|event| match &event.what {
        What::Run(run) => Some(&**run),
        _ => None,
    })
}

/// Duration and limiting quantity of each movement except the first.
fn moves(body: &str) -> Vec<(f64, &'static str)> {
    let simulation = run(body);
    assert!(simulation.unresolved.is_empty(), "{:?}", simulation.unresolved);
    let all = runs(&simulation).flat_map(|run| &run.moves);
    all.map(|record| (record.duration, record.pace.name())).skip(1).collect()
}

/// Relative tolerance of the search for a duration.
const IN_TIME: f64 = 1e-4;

#[test]
fn each_timed_move_of_a_fly_by_path_takes_its_time() {
    let body = line([900., -300., 700.], "v1000", "fine")
        + &line([900., 0., 700.], "v1000\\T:=3", "z10")
        + &line([900., 300., 700.], "v100", "z10")
        + &line([900., 300., 900.], "v100\\T:=2", "z10")
        + &line([900., 0., 900.], "v100\\T:=0.1", "z10")
        + &line([900., 0., 700.], "v1000\\T:=1", "fine")
        + &line([900., 0., 800.], "v1000\\T:=1", "z10")
        + &line([900., 200., 800.], "v1000\\T:=4", "z50")
        + &line([900., 200., 900.], "v1000\\T:=0.6", "fine")
        + "VelSet 50,5000;\n"
        + &line([900., 0., 900.], "v1000\\T:=1", "z10")
        + &line([900., 0., 800.], "v1000\\T:=1", "fine");
    let found = moves(&body);
    let wanted = [None, Some(3.0), None, Some(2.0), None, Some(1.0)];
    let wanted = wanted.into_iter().chain([1.0, 4.0, 0.6, 2.0, 2.0].map(Some));
    for (i, ((duration, pace), wanted)) in found.iter().zip(wanted).enumerate() {
        if let Some(wanted) = wanted {
            assert!((duration / wanted - 1.0).abs() < IN_TIME, "{i}: {duration}, not {wanted} s");
            assert_eq!(*pace, "time", "{i}");
        }
    }
    let (untimed, pace) = found[2];
    assert!((2.9..3.1).contains(&untimed), "300 mm at 100 mm/s took {untimed} s");
    assert_eq!(pace, "speed");
    let (hasty, pace) = found[4];
    assert!(hasty > 0.2, "300 mm in {hasty} s");
    assert_eq!(pace, "acceleration");
}

#[test]
fn the_limit_that_holds_for_the_longest_time_sets_the_pace() {
    let from = line([900., -300., 700.], "v1000", "fine");
    let pace = |body: String| moves(&(from.clone() + &body))[1].1;
    assert_eq!(pace(line([900., -200., 700.], "v50", "fine")), "speed");
    assert_eq!(pace(line([900., -290., 700.], "v5000", "fine")), "acceleration");
    let turn =
        format!("MoveL [[900,-300,700],[0.5,0,0.866025,0],[0,0,0,0],{NONE}],v20,fine,tool0;\n");
    assert_eq!(pace(turn.replace("v20", "[20,10,500,500]")), "reorientation");
    let gentle = "PathAccLim TRUE\\AccMax:=0.5,TRUE\\DecelMax:=0.5;\n".to_owned();
    assert_eq!(pace(gentle + &line([900., 100., 700.], "v5000", "fine")), "tcp-acceleration");
    let joint = format!("MoveAbsJ [[-18,0,0,200,60,0],{NONE}],[9999,5000,500,500],fine,tool0;\n");
    assert_eq!(pace(joint), "joint-speed");
}

/// Accepted ratio to `PathAccLim`, with the errors of finite differences.
const OVERSHOOT: f64 = 1.01;

#[test]
fn path_acceleration_is_limited_in_small_zones_too() {
    const STEP: f64 = 1e-3;
    let body = line([900., 0., 800.], "v1000", "fine")
        + "PathAccLim TRUE\\AccMax:=1,TRUE\\DecelMax:=1;\n"
        + &line([900., 300., 800.], "v1000", "z1")
        + &line([900., 300., 1000.], "v1000", "z1")
        + &line([800., -100., 1000.], "v1000", "fine");
    let simulation = run(&body);
    let run = runs(&simulation).last().unwrap();
    let (model, tool) = (irb1600(), run.legs[0].tool);
    let speed = |t: f64| {
        let state = run.at(t);
        let twist = tool.jacobian(&model, &state.q) * nalgebra::Vector6::from(state.qd);
        twist.fixed_rows::<3>(0).norm()
    };
    let steps = (run.duration() / STEP) as usize;
    let rate = |i: usize| (speed((i + 1) as f64 * STEP) - speed(i as f64 * STEP)).abs() / STEP;
    let worst = (0..steps).map(rate).fold(0.0, f64::max);
    assert!(worst < OVERSHOOT, "{worst} m/s²");
    assert!(worst > 0.9, "nothing was limited: {worst} m/s²");
}

/// Accepted excess over the time with stop points: the limits are approached in rounds.
const NO_LONGER: f64 = 1.05;

/// The unlimited program turns the TCP back in small zones, with the limit from any of its statements on.
#[test]
fn path_acceleration_slows_no_zone_below_a_stop() {
    let text = fs::read_to_string("fixtures/lint/EW103_tiny_zone.mod").unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let cycle = |text: &str| simulated(&irb1600(), &program(text), &Options::default()).cycle_s;
    let moves = (0..lines.len()).filter(|at| lines[*at].trim_start().starts_with("Move"));
    let mut slowed = 0;
    for at in moves {
        let mut limited = lines.clone();
        limited.insert(at, "PathAccLim TRUE\\AccMax:=1.5,TRUE\\DecelMax:=1.5;");
        let limited = limited.join("\n");
        let stops = limited.replace(",z1,", ",fine,").replace(",z50,", ",fine,");
        let (flying, stopping) = (cycle(&limited), cycle(&stops));
        assert!(flying < NO_LONGER * stopping, "line {}: {flying} s, {stopping} s", at + 1);
        slowed += usize::from(flying > 1.02 * cycle(&text));
    }
    assert!(slowed > 3, "the limit slowed {slowed} programs");
}

/// Largest distance of the TCP from the programmed line, m: the moving average of the joints bends
/// the line slightly.
const BESIDE: f64 = 5e-5;

#[test]
fn wrist_interpolation_passes_a_singularity_on_a_line() {
    let target = |y: f64| format!("[[1000,{y},1194.5],[0.707107,0,0.707107,0],[0,0,0,0],{NONE}]");
    let from = format!("MoveL {},v200,fine,tool0;\n", target(300.0));
    let to = format!("MoveL {},v200,fine,tool0;\n", target(-300.0));
    let plain = run(&format!("SingArea\\Wrist;\n{from}SingArea\\Off;\n{to}"));
    assert!(plain.unresolved[0].reason.contains("singularity"), "{:?}", plain.unresolved);
    let simulation = run(&format!("SingArea\\Wrist;\n{from}{to}"));
    assert!(simulation.unresolved.is_empty(), "{:?}", simulation.unresolved);
    let run = runs(&simulation).last().unwrap();
    let model = irb1600();
    let mut turned: f64 = 0.0;
    let programmed = run.legs[0].target.rotation;
    for i in 0..=100 {
        let q = run.at(run.duration() * f64::from(i) / 100.0).q;
        let pose = run.legs[0].tool.pose(&fk(&model, &q));
        let at = pose.translation.vector;
        let beside = (at.x - 1.0).hypot(at.z - 1.1945);
        assert!(beside < BESIDE, "{beside} m beside the line");
        turned = turned.max(pose.rotation.angle_to(&programmed));
    }
    assert!(turned > 1e-3, "the tool keeps its orientation: nothing was interpolated");
}

#[test]
fn a_line_without_configuration_ends_where_it_arrives() {
    // The solution nearest to the start differs from that at the end of the line.
    let turn = |angle: f64| {
        let half = (0.5 * angle).to_radians();
        format!("[0,{},{},0]", half.sin(), half.cos())
    };
    let mut body = String::new();
    for (i, angle) in [0.0, 100.0, 200.0, 300.0].into_iter().enumerate() {
        let y = 100.0 * i as f64;
        let turn = turn(angle);
        writeln!(body, "MoveL [[800,{y},700],{turn},[0,0,0,0],{NONE}],v200,fine,tool0;").unwrap();
    }
    let simulation = run(&body);
    assert!(simulation.unresolved.is_empty(), "{:?}", simulation.unresolved);
    let last = runs(&simulation).last().unwrap().end;
    assert!(last[5].abs() > 4.0, "axis 6 turned to {} rad", last[5]);
}

#[test]
fn a_resting_joint_has_no_friction() {
    // In the plane of the arm, axes 1, 4 and 6 are at rest except for rounding.
    let body = line([900., 0., 700.], "v500", "fine") + &line([1000., 0., 900.], "v500", "fine");
    let simulation = run(&body);
    let model = irb1600();
    let run = runs(&simulation).last().unwrap();
    let mut data = Data::new();
    let mut moved = false;
    for i in 1..100 {
        let s = run.at(run.duration() * f64::from(i) / 100.0);
        let tau = torque(&model, &mut data, &run.load, &s.q, &s.qd, &s.qdd);
        for joint in [0, 3, 5] {
            assert_eq!(tau.friction[joint], 0.0, "joint {} at {} rad/s", joint + 1, s.qd[joint]);
        }
        moved |= tau.friction[1] != 0.0;
    }
    assert!(moved);
}

#[test]
fn joint_angles_are_exactly_constant_at_rest() {
    let body = line([900., 120., 700.], "v500", "fine")
        + "WaitTime 0.1;\n"
        + &line([1000., -70., 900.], "v500", "fine")
        + &line([900., 120., 700.], "v500", "fine");
    let simulation = run(&body);
    let mut before = None;
    for run in runs(&simulation) {
        if let Some(before) = before.replace(run.end) {
            assert_eq!(run.at(0.0).q, before);
        }
        let end = run.duration();
        for t in [end - run.settling, end - 0.5 * run.settling, end, end + 1.0] {
            assert_eq!(run.at(t).q, run.end);
        }
    }
}

#[test]
fn one_sided_path_acceleration_slows_no_more_than_both() {
    let time = |settings: &str| {
        let body = line([850., 100., 700.], "v1000", "fine")
            + settings
            + &line([850., 300., 700.], "v1000", "fine");
        moves(&body)[1].0
    };
    let both = time("PathAccLim TRUE\\AccMax:=0.1,TRUE\\DecelMax:=0.1;\n");
    let up = time("PathAccLim TRUE\\AccMax:=0.1,FALSE;\n");
    let down = time("PathAccLim FALSE,TRUE\\DecelMax:=0.1;\n");
    // From rest to rest with one acceleration limit a: √(2 s / a), plus the ramp of the average.
    assert!((2.0..2.2).contains(&up), "{up} s");
    assert!((2.0..2.2).contains(&down), "{down} s");
    assert!((2.8..3.0).contains(&both), "{both} s");
}

/// Accepted ratio to a joint's speed limit.
const JOINT_SPEED: f64 = 1.01;

#[test]
fn joints_keep_their_speed_limits_near_a_singularity() {
    let model = irb1600();
    let limits = model.limits.velocity.clone().unwrap();
    let target =
        |y: f64, z: f64| format!("[[815,{y},{z}],[0.7071068,0,0.7071068,0],[0,0,0,0],{NONE}]");
    let mut fastest: f64 = 0.0;
    for z in [1150.0, 1165.0, 1175.0, 1180.0] {
        let simulation = run(&format!(
            "MoveAbsJ [[0,10,10,0,-20,0],{NONE}],v1000,fine,tool0;\nMoveJ {},v1000,fine,tool0;\n\
             MoveL {},v1000,fine,tool0;\n",
            target(-200.0, z),
            target(200.0, z),
        ));
        assert!(simulation.unresolved.is_empty(), "{:?}", simulation.unresolved);
        let run = runs(&simulation).last().unwrap();
        for i in 0..=5000 {
            let state = run.at(run.duration() * f64::from(i) / 5000.0);
            let ratios = state.qd.iter().zip(&limits).map(|(v, limit)| v.abs() / limit);
            fastest = fastest.max(ratios.fold(0.0, f64::max));
        }
    }
    assert!(fastest < JOINT_SPEED, "{fastest}");
    assert!(fastest > 0.9, "no joint was fast: {fastest}");
}

/// A time that no robot keeps lengthens its own points alone.
#[test]
fn times_that_are_far_too_short_leave_the_other_points() {
    for time in ["1E-3", "1E-6", "1E-200"] {
        let point = |(i, time): (usize, &str)| {
            format!("MoveAbsJ [[{},0,0,0,60,0],{NONE}],v1000\\T:={time},z200,tool0;\n", 5 * (i + 1))
        };
        let times = ["1", "1", time, time, time, "1", "1"].into_iter().enumerate();
        let body: String = times.map(point).collect();
        let simulation = run(&body);
        assert!(simulation.cycle_s < 5.0, "{time}: {}", simulation.cycle_s);
    }
}

/// The samples of a motion do not follow its duration.
#[test]
fn a_move_of_many_days_takes_no_more_work() {
    let body = line([850., 100., 700.], "v1000", "fine")
        + &line([850., 300., 700.], "v1000\\T:=10000000", "fine");
    let simulation = run(&body);
    let joules = joulepath::retime::energy::account(&irb1600(), &simulation).total.energy_j();
    assert!(joules > 1e8, "{joules} J");
    assert!((simulation.cycle_s / 1e7 - 1.0).abs() < 1e-3);
}
