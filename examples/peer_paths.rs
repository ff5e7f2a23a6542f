//! Writes paths with their coefficients and the computing times of this crate as JSON for
//! `benches/peers/trajectories`: `cargo run --release --example peer_paths`.
#![expect(clippy::unwrap_used, reason = "a failed set-up stops the example")]
#![expect(clippy::print_stdout, reason = "an example prints")]

#[expect(dead_code, reason = "the tests use more of it")]
#[path = "../tests/hard_paths/cases.rs"]
mod cases;
#[path = "peer_paths/nodes.rs"]
mod nodes;
#[path = "../tests/support/mod.rs"]
mod support;

use std::hint::black_box;
use std::time::Instant;

use cases::{Case, EASY};
use joulepath::retime::motion::controller::motion_limits;
use joulepath::retime::motion::sampling::{Loaded, SpeedCap};
use joulepath::retime::motion::stream::{Joints, Stream};
use joulepath::retime::motion::timing::grid::PathGrid;
use joulepath::retime::motion::timing::limits::PathLimits;
use joulepath::retime::motion::timing::reachability::time_optimal;
use joulepath::retime::optimize::cost::Cost;
use joulepath::retime::optimize::energy_program::{energy_bound, minimize_energy};
use joulepath::retime::optimize::freedom::{Bound, Freedom};
use joulepath::retime::optimize::path_grid;
use joulepath::retime::optimize::plant::{Plant, realise};
use joulepath::retime::optimize::polish_problem::PathPenalty;
use joulepath::retime::optimize::retime::{Goal, retime};
use joulepath::retime::optimize::robot_plant::{smooth_torque, smooth_torque_derivatives};
use joulepath::retime::optimize::stream_fit::{StreamFit, fit_stream};
use joulepath::retime::optimize::stream_limits::StreamLimits;
use joulepath::retime::optimize::stream_polish::{Until, polish_stream};
use joulepath::retime::optimize::stream_reference::Reference;
use joulepath::retime::path::joint_path::DOF;
use serde_json::{Value, json};

/// Number of paths.
const COUNT: usize = 12;
/// Number of paths whose streams are compared under the same jerk limit.
const JERK_COUNT: usize = 48;
/// Numbers of grid intervals.
const SIZES: [usize; 2] = [100, 1000];
const JERK_INTERVALS: usize = 300;
/// Points of the free streams, and their duration over that of the fastest profile.
const FREE_POINTS: usize = 50;
const FREE_FACTOR: f64 = 1.3;
/// Repetitions of a time measurement, of which the least value is used.
const REPEATS: usize = 15;
/// Repetitions of slow calls.
const FEW: usize = 3;

/// The least time of the repetitions in s.
fn least_s<T>(repeats: usize, mut work: impl FnMut() -> T) -> f64 {
    let once = |_| {
        let start = Instant::now();
        black_box(work());
        start.elapsed().as_secs_f64()
    };
    (0..repeats).map(once).fold(f64::INFINITY, f64::min)
}

struct Arm<'a>(&'a Case);

impl Plant for Arm<'_> {
    fn torque(&self, q: &Joints, qd: &Joints, qdd: &Joints) -> Joints {
        smooth_torque(&self.0.model, &self.0.run().load, q, qd, qdd)
    }

    fn torque_derivatives(&self, q: &Joints, qd: &Joints, qdd: &Joints) -> [[Joints; DOF]; 3] {
        smooth_torque_derivatives(&self.0.model, &self.0.run().load, q, qd, qdd)
    }

    fn dry_friction(&self) -> Joints {
        std::array::from_fn(|j| self.0.model.friction.coulomb[j])
    }

    fn torque_limit(&self) -> Joints {
        motion_limits(&self.0.model).torque
    }
}

fn main() {
    // The kinds alternate; the first robot comes first.
    let cases = cases::cases(&EASY, 2 * JERK_COUNT);
    let first = cases[0].model.name.clone();
    let jerk: Vec<&Case> = cases.iter().filter(|case| case.model.name == first).collect();
    let cases: Vec<&Case> = jerk.iter().take(COUNT).copied().collect();
    let paths: Vec<Value> = cases.iter().map(|case| path(case)).collect();
    let jerk: Vec<Value> = jerk.into_iter().filter_map(fastest_stream).collect();
    let value = json!({ "robot": robot(cases[0]), "paths": paths, "jerk": jerk });
    println!("{value}");
}

fn robot(case: &Case) -> Value {
    let model = &case.model;
    let matrix =
        |m: &nalgebra::Matrix3<f64>| -> Vec<f64> { m.transpose().iter().copied().collect() };
    let joints = model.kinematics.joints.iter().zip(&model.links).map(|(joint, link)| {
        json!({
            "origin": joint.translation.as_slice(),
            "rotation": matrix(joint.rotation.matrix()),
            "axis": joint.axis.as_slice(),
            "mass": link.mass,
            "com": link.com.as_slice(),
            "inertia": matrix(&link.inertia),
        })
    });
    let motors = model.motors.as_ref().unwrap();
    let rotor: Vec<f64> =
        (0..DOF).map(|j| motors.ratio[j].powi(2) * motors.rotor_inertia[j]).collect();
    json!({
        "joints": joints.collect::<Vec<_>>(),
        "rotor": rotor,
        "coulomb": model.friction.coulomb[..DOF],
        "viscous": model.friction.viscous[..DOF],
        "loss": motors.loss_constant[..DOF],
        "velocity": model.limits.velocity,
        "acceleration": model.limits.acceleration,
        "jerk": model.limits.jerk,
        "torque": model.limits.torque,
    })
}

fn path(case: &Case) -> Value {
    let limits = motion_limits(&case.model);
    let limits = PathLimits::new(limits.acceleration, limits.torque).unwrap();
    let caps = vec![SpeedCap::NONE; case.run().moves.len()];
    let (path, loaded) =
        (case.path().unwrap(), Loaded { model: &case.model, load: &case.run().load });
    let model = Cost::Electrical.model(&case.model);
    let mut sizes = Vec::new();
    for n in SIZES {
        let nodes = |n| path_grid::nodes(&case.model, path, &caps, n);
        let set_up = || path_grid::grid(loaded, path, &nodes(n), &caps).unwrap();
        let grid = set_up();
        let seconds = least_s(REPEATS, || time_optimal(&set_up(), &limits));
        let fastest = time_optimal(&grid, &limits).into_profile().unwrap();
        let time = 1.1 * fastest.duration();
        let energy_s = (n == SIZES[0]).then(|| {
            least_s(FEW, || {
                let grid = set_up();
                let fastest = time_optimal(&grid, &limits).into_profile().unwrap();
                let bound = energy_bound(&grid, &limits, &model, &fastest, time);
                minimize_energy(&grid, &limits, &model, &fastest, time, bound.as_ref())
            })
        });
        sizes.push(json!({
            "grid": coefficients(&grid),
            "time_optimal_s": seconds,
            "duration_s": fastest.duration(),
            "energy_s": energy_s,
            "stages_s": nodes::stages(case, || nodes(n), &limits, &caps),
            "nodes": nodes::nodes(case, &grid, &limits),
        }));
    }
    json!({ "name": case.name, "sizes": sizes, "free": free_stream(case, &limits, &caps) })
}

/// Input of the peers: the nodes and the path at these.
fn coefficients(grid: &PathGrid) -> Value {
    let ends = grid.ends();
    let points = ends.iter().map(|pair| pair[0].q).chain(ends.last().map(|pair| pair[1].q));
    json!({ "s": grid.s(), "q": points.collect::<Vec<_>>() })
}

/// The duration of the fastest stream without settling, and its path; `None` without a stream.
fn fastest_stream(case: &Case) -> Option<Value> {
    let (path, run) = (case.path()?, case.run());
    let moves = run.moves.iter().map(|record| record.movement.line_speed());
    let caps: Vec<SpeedCap> = moves.map(|tcp| SpeedCap { tcp, ..SpeedCap::NONE }).collect();
    let loaded = Loaded { model: &case.model, load: &run.load };
    let nodes = path_grid::nodes(&case.model, path, &caps, JERK_INTERVALS);
    let grid = path_grid::grid(loaded, path, &nodes, &caps).ok()?;
    let freedom = Freedom { joints: Bound::Robot, ..Freedom::default() };
    let stream = retime(&case.task(&freedom), Goal::Fastest).ok()?;
    let ends = grid.ends();
    let nodes: Vec<_> = ends.iter().map(|pair| pair[0]).chain(ends.last().map(|p| p[1])).collect();
    Some(json!({
        "name": case.name,
        "s": grid.s(),
        "q": nodes.iter().map(|node| node.q).collect::<Vec<_>>(),
        "q1": nodes.iter().map(|node| node.q1).collect::<Vec<_>>(),
        "v_max": nodes.iter().map(|node| node.v_max).collect::<Vec<_>>(),
        "stream_s": stream.duration_s - run.settling,
    }))
}

/// A stream that may leave its path, from the slowed fastest profile.
fn free_stream(case: &Case, limits: &PathLimits, caps: &[SpeedCap]) -> Value {
    let path = case.path().unwrap();
    let loaded = Loaded { model: &case.model, load: &case.run().load };
    let nodes = path_grid::nodes(&case.model, path, caps, SIZES[0]);
    let grid = path_grid::grid(loaded, path, &nodes, caps).unwrap();
    let fastest = time_optimal(&grid, limits).into_profile().unwrap();
    let list = |values: &Option<Vec<f64>>| -> Joints {
        std::array::from_fn(|j| values.as_ref().map_or(f64::INFINITY, |list| list[j]))
    };
    let robot = &case.model.limits;
    let joint_limits = StreamLimits {
        velocity: list(&robot.velocity),
        acceleration: list(&robot.acceleration),
        jerk: list(&robot.jerk),
    };
    let model = Cost::Electrical.model(&case.model);
    let duration = FREE_FACTOR * fastest.duration() + 0.1;
    let slow = fastest.scaled_to(duration).unwrap();
    let reference = Reference::sample(duration, 1000, |t| {
        let (s, v, _) = slow.at(t);
        let point = path.eval(s.min(path.length()));
        (point.q, point.q1.map(|x| x * v))
    })
    .unwrap();
    let arm = Arm(case);
    let corridor = PathPenalty { tolerance: f64::INFINITY, lever: [1.0; DOF] };
    let intervals = vec![duration / FREE_POINTS as f64; FREE_POINTS];
    let work = || -> Option<[Stream; 2]> {
        let fit = fit_stream(&reference, intervals.clone(), &joint_limits, &[1.0; DOF]).ok()?;
        let StreamFit::Fitted(fit) = fit else { return None };
        let polished = polish_stream(
            &fit.stream,
            &reference,
            &arm,
            &joint_limits,
            &model,
            &corridor,
            Until::Least,
        )
        .ok()?;
        Some([fit.stream, polished.stream])
    };
    let Some([first, best]) = work() else { return Value::Null };
    json!({
        "duration_s": duration,
        "start": first.start(),
        "first": first.points(),
        "points": best.points(),
        "energy_j": realise(&best, &arm, &model).energy.total(),
        "first_energy_j": realise(&first, &arm, &model).energy.total(),
        "seconds": least_s(FEW, work),
    })
}
