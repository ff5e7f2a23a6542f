//! Free paths among boxes and planes: dense checks of the motion of the emitted program with
//! independently computed distances.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;

use std::fs;
use std::path::Path;

use command::{IRB1600 as ROBOT, KNOWN_LIMITS, number, run_in};
use joulepath::arm::kinematics::{Body, Capsule};
use joulepath::arm::robot::find;
use nalgebra::{Point3, Vector3};
use serde_json::Value;

/// A movement and its return with a tool, away from the limits.
const PROGRAM: &str = "MODULE M\n\
    PERS tooldata tLong:=[TRUE,[[0,0,180],[1,0,0,0]],[2,[0,0,60],[1,0,0,0],0,0,0]];\n\
    CONST jointtarget jA:=[[0,-12,14,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    CONST jointtarget jB:=[[60,20,0,-20,65,30],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    PROC main()\n\
    MoveAbsJ jA,v1000,fine,tLong;\n\
    MoveAbsJ jB,vmax,fine,tLong;\n\
    MoveAbsJ jA,v1000,fine,tLong;\n\
    ENDPROC\n\
    ENDMODULE\n";
const TOOL: [f64; 3] = [0.0, 0.0, 0.18];
const FREE: [&str; 3] = ["--free-path", "--deviation", "80"];
/// Subdivisions between two rows of a trajectory, and of a capsule's axis.
const PARTS: usize = 4;
/// Subdivisions between two points.
const EDGE_PARTS: usize = 100;
/// Half the width of the box, m.
const WIDTH: f64 = 0.03;
/// Rounding of a value in a trajectory's text, m.
const ROUNDING: f64 = 1e-9;

struct Run {
    result: Value,
    /// Joint angles, rad.
    motion: Vec<Vec<f64>>,
    /// The same on the polygon of the points of the streams.
    polygon: Vec<Vec<f64>>,
}

impl Run {
    fn energy(&self) -> f64 {
        number(&self.result, "/optimized/motion_energy_j")
    }

    /// The lowest point of arm and tool in the direction `along`, and its position along it.
    fn deepest(&self, along: &Vector3<f64>) -> (Point3<f64>, f64) {
        let points = surface(&self.motion).map(|(point, radius)| {
            let point = point - along * radius;
            (point, point.coords.dot(along))
        });
        points.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
    }
}

fn optimized(config: &str, options: &[&str]) -> Run {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("joulepath.toml"), config).unwrap();
    let common = ["--robot", KNOWN_LIMITS, "--allow-faster-joints", "--layout", "plain"];
    let result = command::optimize(folder, PROGRAM, &[&common[..], options].concat());
    run_in(folder, &["simulate", "out", "--robot", KNOWN_LIMITS, "--trajectory", "t.csv"]);
    let text = fs::read_to_string(folder.join("out/Joulepath.mod")).unwrap();
    Run { result, motion: motion(&folder.join("t.csv")), polygon: polygon(&text) }
}

/// The polygons of all streams in a module's text.
fn polygon(text: &str) -> Vec<Vec<f64>> {
    let joints = |statement: &str| -> Option<Vec<f64>> {
        let numbers = statement.split("MoveAbsJ [[").nth(1)?.split(']').next()?;
        Some(numbers.split(',').map(|x| x.parse::<f64>().unwrap().to_radians()).collect())
    };
    let streams = text.split("PROC jpMove").skip(1).map(|rest| rest.split("ENDPROC").next());
    let mut all = Vec::new();
    for stream in streams {
        let points: Vec<Vec<f64>> = stream.unwrap().split(';').filter_map(joints).collect();
        assert!(points.len() > 2, "{stream:?}");
        for pair in points.windows(2) {
            let at = |i: usize| i as f64 / EDGE_PARTS as f64;
            all.extend((0..=EDGE_PARTS).map(|i| -> Vec<f64> {
                pair[0].iter().zip(&pair[1]).map(|(a, b)| a + at(i) * (b - a)).collect()
            }));
        }
    }
    all
}

fn motion(csv: &Path) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(csv).unwrap();
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').skip(1).take(6).map(|x| x.parse().unwrap()).collect())
        .collect();
    let between = |pair: &[Vec<f64>]| -> Vec<Vec<f64>> {
        let at = |part: usize| part as f64 / PARTS as f64;
        let mix =
            |part| pair[0].iter().zip(&pair[1]).map(|(a, b)| a + at(part) * (b - a)).collect();
        (0..PARTS).map(mix).collect()
    };
    rows.windows(2).flat_map(between).collect()
}

/// Points on the axes of the capsules of arm and tool, with their radii.
fn surface(motion: &[Vec<f64>]) -> impl Iterator<Item = (Point3<f64>, f64)> {
    let model = find(ROBOT).unwrap();
    let capsules: Vec<Capsule> = motion
        .iter()
        .flat_map(|q| Body::new(&model, TOOL.into(), &[]).capsules(q).split_off(1))
        .collect();
    capsules.into_iter().flat_map(|capsule| {
        (0..=PARTS).map(move |i| (capsule.at(i as f64 / PARTS as f64), capsule.radius))
    })
}

/// Least distance of arm and tool from a box, negative inside.
fn clearance(motion: &[Vec<f64>], corners: &[Point3<f64>; 2]) -> f64 {
    let distance = |point: &Point3<f64>| {
        let outside: Vector3<f64> = (corners[0] - point).sup(&(point - corners[1]));
        let far = outside.map(|x| x.max(0.0)).norm();
        if far > 0.0 { far } else { outside.max() }
    };
    surface(motion).map(|(point, radius)| distance(&point) - radius).fold(f64::INFINITY, f64::min)
}

/// Positions of the tool tip along the motion, and its radius.
fn tool_tips(motion: &[Vec<f64>]) -> Vec<(Point3<f64>, f64)> {
    let model = find(ROBOT).unwrap();
    let body = Body::new(&model, TOOL.into(), &[]);
    let tool = motion.iter().map(|q| body.capsules(q).pop().unwrap());
    tool.map(|capsule| (capsule.to, capsule.radius)).collect()
}

/// For each position of the tip on a motion, the vector from the nearest one on the original, the
/// position, and the radius.
fn deviations(original: &[Vec<f64>], motion: &[Vec<f64>]) -> Vec<(Vector3<f64>, Point3<f64>, f64)> {
    let original = tool_tips(original);
    let away = |tip: &Point3<f64>| {
        let all = original.iter().map(|(other, _)| tip - other);
        all.min_by(|a, b| a.norm().total_cmp(&b.norm())).unwrap()
    };
    tool_tips(motion).into_iter().map(|(tip, radius)| (away(&tip), tip, radius)).collect()
}

/// The largest distance from the original along an axis: the axis, the point on the tool surface,
/// and the distance.
fn excursion(kept: &Run, free: &Run) -> (Vector3<f64>, Point3<f64>, f64) {
    let all = deviations(&kept.motion, &free.motion).into_iter().map(|(away, tip, radius)| {
        let mut axis = Vector3::zeros();
        axis[away.iamax()] = away[away.iamax()].signum();
        (axis, tip + axis * radius, away.dot(&axis))
    });
    all.max_by(|a, b| a.2.total_cmp(&b.2)).unwrap()
}

/// A small box that a motion enters and the original does not, as far from the original as
/// possible: its centre and half its width.
fn small_box(original: &[Vec<f64>], motion: &[Vec<f64>]) -> (Point3<f64>, f64) {
    let mut all = deviations(original, motion);
    all.sort_by(|a, b| b.0.norm().total_cmp(&a.0.norm()));
    let around = |(away, tip, radius): &(Vector3<f64>, Point3<f64>, f64)| {
        (tip + away.normalize() * *radius, 0.3 * away.norm())
    };
    let far = all.iter().take_while(|(away, ..)| away.norm() > 1e-4).step_by(20).map(around);
    let corner = 3.0_f64.sqrt();
    far.clone().find(|(middle, half)| distance(original, middle) > corner * half).unwrap()
}

/// Least distance of arm and tool from a point.
fn distance(motion: &[Vec<f64>], point: &Point3<f64>) -> f64 {
    let model = find(ROBOT).unwrap();
    let body = Body::new(&model, TOOL.into(), &[]);
    let all = motion.iter().flat_map(|q| body.capsules(q).split_off(1));
    all.map(|capsule| {
        let (along, from) = (capsule.to - capsule.from, point - capsule.from);
        let share = (from.dot(&along) / along.norm_squared().max(1e-12)).clamp(0.0, 1.0);
        (from - along * share).norm() - capsule.radius
    })
    .fold(f64::INFINITY, f64::min)
}

#[test]
fn free_paths_avoid_a_box() {
    let (kept, free) = (optimized("", &[]), optimized("", &FREE));
    let (axis, point, depth) = excursion(&kept, &free);
    assert!(depth > 0.02, "the free motion leaves the original by {depth} m only");

    // The face of the box cuts off half of the additional distance of the free motion.
    let face = point - axis * (0.5 * depth);
    let across = Vector3::repeat(WIDTH) - axis.abs() * WIDTH;
    let (one, other) = (face - across, face + across + axis * (2.0 * WIDTH));
    let corners = [one.inf(&other), one.sup(&other)];
    assert!(clearance(&free.motion, &corners) < -0.01 && clearance(&kept.motion, &corners) > 0.0);
    let [lo, hi] = corners.map(|corner| format!("{:?}", corner.coords.as_slice()));
    let boxed = optimized(&format!("[[keep_out]]\nbox = [{lo}, {hi}]\n"), &FREE);
    for way in [&boxed.motion, &boxed.polygon] {
        let left = clearance(way, &corners);
        assert!(left > -ROUNDING, "{left} m beside the box");
    }
    let energies = [&free, &boxed, &kept].map(Run::energy);
    assert!(energies.is_sorted() && energies[1] < energies[2], "{energies:?}");
    assert_eq!(boxed.result["segments"][1]["kind"], "path");
}

/// A kept path has a tolerance of millimetres, and these must not enter a box either.
#[test]
fn kept_paths_and_their_polygons_avoid_a_box() {
    let kept = optimized("", &[]);
    let programmed: Vec<Vec<f64>> = (0..=2000)
        .map(|i| f64::from(i) / 2000.0)
        .map(|s| {
            let ends = [0.0, -12.0, 14.0, 0.0, 60.0, 0.0]
                .into_iter()
                .zip([60.0, 20.0, 0.0, -20.0, 65.0, 30.0]);
            ends.map(|(a, b): (f64, f64)| (a + s * (b - a)).to_radians()).collect()
        })
        .collect();
    for way in [&kept.motion, &kept.polygon] {
        let (middle, half) = small_box(&programmed, way);
        assert!(distance(way, &middle) < half);
        let corners = [-half, half].map(|half| middle.coords.add_scalar(half));
        let [lo, hi] = corners.map(|corner| format!("{:?}", corner.as_slice()));
        let boxed = optimized(&format!("[[keep_out]]\nbox = [{lo}, {hi}]\n"), &[]);
        for way in [&boxed.motion, &boxed.polygon] {
            let left = distance(way, &middle) - half;
            assert!(left > -ROUNDING, "{left} m beside the box");
        }
    }
}

#[test]
fn free_paths_without_keep_out_zones_cause_a_warning() {
    let warning = |run: &Run| {
        let notes = run.result["notes"].as_array().unwrap().iter();
        let mut reported =
            notes.filter_map(Value::as_str).filter(|note| note.starts_with("warning: "));
        reported.next().map(str::to_owned)
    };
    let free = optimized("", &FREE);
    let reported = warning(&free).unwrap();
    let farthest = free.result["verification"]["max_path_deviation_m"].as_f64().unwrap();
    assert!(farthest > 0.02, "{farthest}");
    assert!(reported.contains(&format!("by up to {:.1} mm", 1e3 * farthest)), "{reported}");
    assert!(reported.contains("no keep-out is configured"), "{reported}");
    assert_eq!(warning(&optimized("", &[])), None);
    let known = "[[keep_out]]\nplane = [0, 0, 1, -1]\n";
    assert_eq!(warning(&optimized(known, &FREE)), None);
}

#[test]
fn free_paths_stay_on_one_side_of_a_plane() {
    let (kept, free) = (optimized("", &[]), optimized("", &FREE));
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let sides = axes.into_iter().flat_map(|axis| [axis, -axis]).map(|side| {
        let (lowest, original) = (free.deepest(&side).1, kept.deepest(&side).1);
        (side, 0.5 * (lowest + original), original - lowest)
    });
    let (side, level, depth) = sides.max_by(|a, b| a.2.total_cmp(&b.2)).unwrap();
    assert!(depth > 1e-3, "the free motion goes {depth} m farther only");

    // A normal vector of any length.
    let [x, y, z]: [f64; 3] = (2.0 * side).into();
    let config = format!("[[keep_out]]\nplane = [{x:?}, {y:?}, {z:?}, {:?}]\n", 2.0 * level);
    let planar = optimized(&config, &FREE);
    let beyond = level - planar.deepest(&side).1;
    assert!(beyond < ROUNDING, "{beyond} m beyond the plane");
    assert!(free.energy() < planar.energy() && planar.energy() <= kept.energy());
}

#[test]
fn a_path_through_a_keep_out_zone_is_kept_with_a_reason() {
    let kept = optimized("", &[]);
    let down = Vector3::z();
    let level = kept.deepest(&down).1 + 0.01;
    let config = format!("[[keep_out]]\nplane = [0, 0, 1, {level:?}]\n");
    let blocked = optimized(&config, &FREE);
    assert_eq!(blocked.energy(), kept.energy());
    let segments = blocked.result["segments"].as_array().unwrap();
    let is_kept = |segment: &&Value| {
        segment["reason"].as_str().is_some_and(|reason| reason.starts_with("keep-out"))
    };
    let found: Vec<_> = segments.iter().filter(is_kept).collect();
    assert!(!found.is_empty(), "{segments:?}");
    assert!(found.iter().all(|segment| segment["rewritten"] == true));
    assert!(found.iter().all(|segment| segment["kind"] == "timing"));
}
