//! Plays back the emitted streams with an independent reader, spline and arm model. It uses neither
//! the front end nor the virtual controller: the text is parsed line by line, the points are
//! interpolated as in `docs/controller.md`, and the tool position follows from trigonometry with
//! the dimensions of the data sheet. `tests/dynamics.rs` and `tests/pinocchio.rs` verify the
//! torques.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use command::{IRB1600 as ROBOT, KNOWN_LIMITS};
use joulepath::arm::dynamics::{Data, Load, torque};
use joulepath::arm::robot::{Model, Sharing, find};
use serde_json::Value;

/// Axis speeds of the data sheet, degrees/s.
const SPEEDS: [f64; 6] = [180.0, 180.0, 185.0, 385.0, 400.0, 460.0];
/// a1, c1, c2, c3, c4 of the data sheet, mm.
const ARM: [f64; 5] = [150.0, 486.5, 700.0, 600.0, 65.0];
/// Largest ratio to a limit, with the tolerance of controller and rounding.
const LIMIT: f64 = 1.001;
/// Documented largest distances from the path, mm.
const OFF_LINE: f64 = 1.0;
const OFF_JOINT_PATH: f64 = 5.0;
/// The same for the polygon of the points near a stop, mm.
const OFF_NEAR_STOP: f64 = 0.5;
const NEAR_STOP: f64 = 50.0;
/// Tolerance of an end point, mm and degrees.
const END: f64 = 0.02;
/// Tolerance of the tool direction on a line, rad.
const TURNED: f64 = 0.02;
/// Relative tolerance of energies.
const ENERGY: f64 = 0.005;
/// Tolerance of times: the text has four decimals, s.
const TIME: f64 = 1e-6;
/// Step of the samples, s.
const STEP: f64 = 0.001;

const START: &str = "[0,-12,14,0,60,0]";

/// The motion of each line of the program, by line number.
fn program() -> String {
    let far = "[9E9,9E9,9E9,9E9,9E9,9E9]";
    format!(
        "MODULE M\n\
         CONST jointtarget jA:=[{START},{far}];\n\
         CONST jointtarget jB:=[[60,20,0,-20,65,30],{far}];\n\
         CONST robtarget pC:=[[850,300,1000],[0,0,1,0],[0,0,0,0],{far}];\n\
         CONST robtarget pD:=[[850,-300,1000],[0,0,1,0],[-1,0,0,0],{far}];\n\
         PROC main()\n\
         ConfL \\Off; MoveAbsJ jA,v1000,fine,tool0;\n\
         MoveAbsJ jB,vmax,fine,tool0;\n\
         MoveJ pC,v1000,fine,tool0;\n\
         MoveL pD,v500,fine,tool0;\n\
         WaitTime 0.5;\n\
         MoveL pC,vmax,fine,tool0;\n\
         MoveAbsJ jA,v300,fine,tool0;\n\
         ENDPROC\n\
         ENDMODULE\n"
    )
}

/// Target of a movement: joints in degrees, or a position in mm with the tool pointing down.
enum Way {
    Joints([f64; 6]),
    JointsTo([f64; 3]),
    Line([f64; 3], [f64; 3]),
}

const C: [f64; 3] = [850.0, 300.0, 1000.0];
const D: [f64; 3] = [850.0, -300.0, 1000.0];

fn ways() -> BTreeMap<u64, (Way, f64)> {
    let free = f64::INFINITY;
    BTreeMap::from([
        (8, (Way::Joints([60.0, 20.0, 0.0, -20.0, 65.0, 30.0]), free)),
        (9, (Way::JointsTo(C), free)),
        (10, (Way::Line(C, D), 500.0)),
        (12, (Way::Line(D, C), free)),
        (13, (Way::Joints([0.0, -12.0, 14.0, 0.0, 60.0, 0.0]), free)),
    ])
}

/// A stream as in the text: degrees and seconds.
#[derive(Debug, Default)]
struct Stream {
    line: u64,
    start: [f64; 6],
    points: Vec<[f64; 6]>,
    times: Vec<f64>,
}

/// The six numbers after the first `[[`.
fn joints(text: &str) -> [f64; 6] {
    let inside = text.split("[[").nth(1).unwrap().split(']').next().unwrap();
    let numbers: Vec<f64> = inside.split(',').map(|x| x.trim().parse().unwrap()).collect();
    numbers.try_into().unwrap()
}

/// The number in the first pair of braces.
fn index(text: &str) -> usize {
    text.split('{').nth(1).unwrap().split('}').next().unwrap().parse().unwrap()
}

fn between<'a>(text: &'a str, from: &str, to: &str) -> &'a str {
    let rest = &text[text.find(from).unwrap_or_else(|| panic!("no {from}")) + from.len()..];
    &rest[..rest.find(to).unwrap()]
}

/// All streams of a module's text.
fn read(text: &str) -> Vec<Stream> {
    let mut streams = Vec::new();
    for number in 1.. {
        let Some(at) = text.find(&format!("CONST jointtarget jpFrom{number}{{")) else { break };
        let origin = text[..at].trim_end().rsplit('\n').next().unwrap();
        let line = between(origin, ".mod ", ":").parse().unwrap();
        let mut stream = Stream { line, start: joints(&text[at..]), ..Stream::default() };
        let body = between(text, &format!("PROC jpMove{number}_1("), "ENDPROC");
        let mut moves: Vec<&str> = body.split(';').map(str::trim).collect();
        moves.retain(|statement| !statement.is_empty());
        if body.contains("FOR ") {
            let count = index(moves[moves.len() - 1]);
            let to: usize = between(body, " TO ", " DO").parse().unwrap();
            assert_eq!(to + 1, count, "the loop ends before the last point");
            let declared = |name: &str| {
                let from = format!("{name}{number}_1{{{count}}}:=[");
                between(text, &from, "];").to_owned()
            };
            for point in declared("jpPoints").lines().filter(|l| l.contains("[[")) {
                stream.points.push(joints(point));
            }
            for time in declared("jpTimes").split(',') {
                stream.times.push(time.trim().parse().unwrap());
            }
        } else {
            for statement in &moves {
                let at = statement.find("MoveAbsJ").unwrap();
                stream.points.push(joints(&statement[at..]));
                stream.times.push(between(statement, "\\T:=", ",").parse().unwrap());
            }
        }
        let fine = moves.iter().filter(|statement| statement.contains(",fine,")).count();
        assert!(fine == 1 && moves[moves.len() - 1].contains(",fine,"), "fine at the end only");
        assert_eq!(stream.points.len(), stream.times.len());
        streams.push(stream);
    }
    streams
}

/// Time, and position, velocity and acceleration of the joints; degrees and seconds.
type Sample = (f64, [f64; 6], [f64; 6], [f64; 6]);

/// The quadratic spline of the points, as in the documentation.
fn play(stream: &Stream) -> Vec<Sample> {
    let n = stream.points.len();
    let end = |i: usize| stream.times[..i].iter().sum::<f64>();
    let mut t = vec![0.0];
    for i in 1..=n {
        let (from, to) = (end(i - 1), end(i));
        t.push(match i {
            _ if n == 1 => to / 2.0,
            1 => 2.0 / 3.0 * to,
            i if i == n => to - 2.0 / 3.0 * (to - from),
            _ => f64::midpoint(from, to),
        });
    }
    t.push(end(n));
    let point = |i: usize| if i == 0 { stream.start } else { stream.points[i - 1] };
    let speed = |i: usize| -> [f64; 6] {
        if i == 0 || i == n + 1 {
            return [0.0; 6];
        }
        std::array::from_fn(|j| 2.0 * (point(i)[j] - point(i - 1)[j]) / (t[i + 1] - t[i - 1]))
    };
    let mut samples = Vec::new();
    let mut q = stream.start;
    for i in 0..=n {
        let (h, from, to) = (t[i + 1] - t[i], speed(i), speed(i + 1));
        let a: [f64; 6] = std::array::from_fn(|j| (to[j] - from[j]) / h);
        let steps = (h / STEP).ceil() as usize;
        for k in 0..=steps {
            let s = h * k as f64 / steps as f64;
            let here = std::array::from_fn(|j| q[j] + s * from[j] + 0.5 * s * s * a[j]);
            let qd = std::array::from_fn(|j| from[j] + s * a[j]);
            samples.push((t[i] + s, here, qd, a));
        }
        q = std::array::from_fn(|j| q[j] + h * f64::midpoint(from[j], to[j]));
    }
    samples
}

type Vector = [f64; 3];

fn about_x(v: Vector, degrees: f64) -> Vector {
    let (s, c) = degrees.to_radians().sin_cos();
    [v[0], c * v[1] - s * v[2], s * v[1] + c * v[2]]
}

fn about_y(v: Vector, degrees: f64) -> Vector {
    let (s, c) = degrees.to_radians().sin_cos();
    [c * v[0] + s * v[2], v[1], -s * v[0] + c * v[2]]
}

fn about_z(v: Vector, degrees: f64) -> Vector {
    let (s, c) = degrees.to_radians().sin_cos();
    [c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]]
}

fn plus(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn apart(a: Vector, b: Vector) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

/// Position of the flange, mm, and its direction.
fn flange(q: &[f64; 6]) -> (Vector, Vector) {
    let [a1, c1, c2, c3, c4] = ARM;
    let hand = |v: Vector| about_y(about_x(about_y(v, q[4]), q[3]), q[1] + q[2]);
    let along = hand([1.0, 0.0, 0.0]);
    let mut at = plus([a1, 0.0, c1], about_y([0.0, 0.0, c2], q[1]));
    at = plus(at, about_y([c3, 0.0, 0.0], q[1] + q[2]));
    at = plus(at, along.map(|x| c4 * x));
    (about_z(at, q[0]), about_z(along, q[0]))
}

/// Distance of a point from a line, mm.
fn off_line(place: Vector, [from, to]: [Vector; 2]) -> f64 {
    let length = apart(from, to).powi(2);
    let along: f64 = (0..3).map(|k| (place[k] - from[k]) * (to[k] - from[k])).sum::<f64>() / length;
    let along = along.clamp(0.0, 1.0);
    apart(place, std::array::from_fn(|k| from[k] + along * (to[k] - from[k])))
}

/// Points of the original path of a joint movement: all axes move in proportion.
fn joint_path(from: &[f64; 6], to: &[f64; 6]) -> Vec<Vector> {
    const POINTS: usize = 4000;
    (0..=POINTS)
        .map(|i| {
            let s = i as f64 / POINTS as f64;
            flange(&std::array::from_fn(|j| from[j] + s * (to[j] - from[j]))).0
        })
        .collect()
}

/// Grid power of a state without base power, W.
fn power(model: &Model, tau: &[f64], rigid: &[f64], friction: &[f64], qd: &[f64; 6]) -> f64 {
    let motors = model.motors.as_ref().unwrap();
    let copper: f64 = (0..6).map(|j| motors.loss_constant[j] * tau[j] * tau[j]).sum();
    let work: Vec<f64> = (0..6).map(|j| (rigid[j] + friction[j]) * qd[j]).collect();
    let total: f64 = work.iter().sum();
    let lost: f64 = match model.drive.sharing {
        Sharing::None => work.iter().map(|w| (-w).max(0.0)).sum(),
        Sharing::Bus => (-total).max(0.0),
    };
    total + copper + lost * (1.0 - model.drive.regeneration)
}

/// Without corner zones the robot stops at every point, with straight joint lines between.
fn check_polygon(stream: &Stream, way: &Way, original: &[Vector]) {
    const STEPS: usize = 40;
    let stops = [stream.start, *stream.points.last().unwrap()].map(|q| flange(&q).0);
    let from = std::iter::once(&stream.start).chain(&stream.points);
    for (i, (from, to)) in from.zip(&stream.points).enumerate() {
        for k in 0..=STEPS {
            let share = k as f64 / STEPS as f64;
            let place = flange(&std::array::from_fn(|j| from[j] + share * (to[j] - from[j]))).0;
            let (off, allowed) = if let Way::Line(from, to) = way {
                (off_line(place, [*from, *to]), OFF_LINE)
            } else {
                let nearest = original.iter().map(|p| apart(*p, place)).fold(f64::MAX, f64::min);
                (nearest, OFF_JOINT_PATH)
            };
            let near = stops.iter().any(|stop| apart(*stop, place) < NEAR_STOP);
            let allowed = if near { OFF_NEAR_STOP } else { allowed };
            assert!(off <= allowed, "line {}: edge {i}: {off} mm off at {share}", stream.line);
        }
    }
}

/// Checks a stream against the limits, its path and its predicted values.
fn check_stream(model: &Model, stream: &Stream, segment: &Value, (way, ceiling): &(Way, f64)) {
    let name = format!("line {}", stream.line);
    let samples = play(stream);
    let limits = &model.limits;
    let list = |limit: &Option<Vec<f64>>, j: usize| limit.as_ref().unwrap()[j];
    let end = *stream.points.last().unwrap();
    let original = joint_path(&stream.start, &end);
    let mut data = Data::new();
    let mut joules = 0.0;
    let mut before: Option<(f64, f64, Vector)> = None;
    let first = flange(&stream.start).1;
    for (t, q, qd, qdd) in &samples {
        let rad = |x: &[f64; 6]| x.map(f64::to_radians);
        let (q_rad, qd_rad, qdd_rad) = (rad(q), rad(qd), rad(qdd));
        let load = torque(model, &mut data, &Load::none(), &q_rad, &qd_rad, &qdd_rad);
        let tau: [f64; 6] = std::array::from_fn(|j| load.rigid[j] + load.friction[j]);
        for j in 0..6 {
            assert!(qd[j].abs() <= LIMIT * SPEEDS[j], "{name}: axis {} at {t} s: {qd:?}", j + 1);
            let most = LIMIT * list(&limits.acceleration, j);
            assert!(qdd_rad[j].abs() <= most, "{name}: acceleration of axis {} at {t} s", j + 1);
            let most = LIMIT * list(&limits.torque, j);
            assert!(tau[j].abs() <= most, "{name}: torque of axis {} at {t} s", j + 1);
        }
        let watts = power(model, &tau, &load.rigid, &load.friction, &qd_rad);
        let (place, direction) = flange(q);
        let off = if let Way::Line(from, to) = way {
            let turned = apart(direction, first);
            assert!(turned <= TURNED, "{name}: the tool turns by {turned} rad at {t} s");
            off_line(place, [*from, *to]) / OFF_LINE
        } else {
            let nearest = original.iter().map(|p| apart(*p, place)).fold(f64::MAX, f64::min);
            nearest / OFF_JOINT_PATH
        };
        assert!(off <= 1.0, "{name}: {off} of the allowed distance from the path at {t} s");
        if let Some((then, power, from)) = before
            && *t - then > STEP * 1e-6
        {
            let speed = apart(place, from) / (t - then);
            assert!(speed <= LIMIT * ceiling, "{name}: {speed} mm/s at {t} s");
            joules += f64::midpoint(power, watts) * (t - then);
        }
        before = Some((*t, watts, place));
    }
    check_polygon(stream, way, &original);
    let (_, reached, ..) = samples[samples.len() - 1];
    match way {
        Way::Joints(to) => {
            let far = (0..6).map(|j| (reached[j] - to[j]).abs()).fold(0.0, f64::max);
            assert!(far <= END, "{name}: ends {far} degrees away");
        }
        Way::JointsTo(to) | Way::Line(_, to) => {
            let far = apart(flange(&reached).0, *to);
            assert!(far <= END, "{name}: ends {far} mm away");
        }
    }
    let number = |key: &str| segment[key].as_f64().unwrap();
    let total: f64 = stream.times.iter().sum();
    // The remaining time is settling at the stop point, as in the original.
    let settling = number("time_after_s") - total;
    assert!((-TIME..0.2).contains(&settling), "{name}: {total} s of {segment}");
    let still = [0.0; 6];
    let held =
        torque(model, &mut data, &Load::none(), &reached.map(f64::to_radians), &still, &still);
    let holding = power(model, &held.rigid, &held.rigid, &still, &still);
    let standing: f64 = model.standstill.holding_w.iter().sum();
    let brakes = model.brakes.as_ref().map_or(0.0, |brakes| brakes.power_released_w);
    joules += (holding + standing) * settling;
    joules += (model.drive.base_w + brakes) * number("time_after_s");
    let promised = number("energy_after_j");
    assert!((joules - promised).abs() <= ENERGY * promised, "{name}: {joules} J, not {promised} J");
    assert!(joules < number("energy_before_j") * (1.0 + ENERGY), "{name}: {joules} J {segment}");
}

fn optimize(folder: &Path, options: &[&str]) -> (Value, String) {
    let robot = ["--robot", KNOWN_LIMITS, "--allow-faster-joints"];
    let result = command::optimize(folder, program(), &[&robot[..], options].concat());
    (result, fs::read_to_string(folder.join("out/Joulepath.mod")).unwrap())
}

#[test]
fn emitted_streams_keep_limits_paths_and_predicted_energies() {
    let model = find(ROBOT).unwrap();
    let ways = ways();
    for options in [
        &["--layout", "plain"][..],
        &["--layout", "array"],
        &["--layout", "array", "--spacing", "0.02"],
        &["--objective", "time"],
    ] {
        let folder = tempfile::tempdir().unwrap();
        let (result, text) = optimize(folder.path(), options);
        let streams = read(&text);
        let lines: Vec<u64> = streams.iter().map(|stream| stream.line).collect();
        assert_eq!(lines, ways.keys().copied().collect::<Vec<_>>(), "{options:?}\n{result}");
        let segments = result["segments"].as_array().unwrap();
        let mut stands: Option<[f64; 6]> = None;
        for stream in &streams {
            let is_timing = |s: &&Value| s["line_first"] == stream.line && s["kind"] == "timing";
            let segment = segments.iter().find(is_timing).unwrap();
            assert_eq!(segment["points"].as_u64().unwrap() as usize, stream.points.len());
            // Each stream starts at the end of the previous one.
            if let Some(stands) = stands {
                let jump = (0..6).map(|j| (stands[j] - stream.start[j]).abs()).fold(0.0, f64::max);
                assert!(jump <= END, "line {}: {jump} degrees from there", stream.line);
            }
            if options[1] == "time" {
                let time = segment["time_after_s"].as_f64().unwrap();
                assert!(time <= segment["time_before_s"].as_f64().unwrap() + TIME);
                let end = stream.points.last().unwrap();
                check_polygon(stream, &ways[&stream.line].0, &joint_path(&stream.start, end));
            } else {
                check_stream(&model, stream, segment, &ways[&stream.line]);
            }
            stands = stream.points.last().copied();
        }
    }
}

#[test]
fn both_layouts_give_the_same_motion() {
    let folder = tempfile::tempdir().unwrap();
    let (_, plain) = optimize(folder.path(), &["--layout", "plain"]);
    let (_, array) = optimize(folder.path(), &["--layout", "array"]);
    assert!(array.contains("MoveAbsJ jpPoints") && !plain.contains("MoveAbsJ jpPoints"));
    for (plain, array) in read(&plain).iter().zip(&read(&array)) {
        assert_eq!((&plain.points, &plain.times), (&array.points, &array.times));
    }
    // Short streams become plain instructions automatically.
    let (_, auto) = optimize(folder.path(), &[]);
    assert_eq!(auto, plain);
}
