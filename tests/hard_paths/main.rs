//! Paths on which others break a limit or give up: near singularities, blended, with way points
//! given twice, with joints that rest, with little torque to spare; and as many easy ones.
//!
//! Limits are looked at densely, with torques of `dynamics::torque` at states that come from the
//! path itself, and streams are played by an evaluation of the spline that is written here anew.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

mod cases;
mod played;
#[path = "../support/mod.rs"]
mod support;

use cases::{Case, EASY, HARD, Kind, cases};
use joulepath::arm::dynamics::{Data, torque};
use joulepath::retime::energy::EnergyParts;
use joulepath::retime::motion::controller::motion_limits;
use joulepath::retime::motion::sampling::{Loaded, SpeedCap};
use joulepath::retime::motion::timing::grid::PathGrid;
use joulepath::retime::motion::timing::limits::PathLimits;
use joulepath::retime::motion::timing::profile::Profile;
use joulepath::retime::motion::timing::reachability::time_optimal;
use joulepath::retime::motion::timing::refined::{Refinement, time_optimal_between};
use joulepath::retime::optimize::cost::Cost;
use joulepath::retime::optimize::freedom::{Bound, Freedom};
use joulepath::retime::optimize::path_grid;
use joulepath::retime::optimize::reason::Reason;
use joulepath::retime::optimize::retime::{Goal, Task, retime};
use joulepath::retime::path::joint_path::{DOF, JointPath};
use rayon::prelude::*;

/// Paths of each sort.
const COUNT: usize = 160;
/// Of those, paths of each sort that get streams.
const STREAMS: usize = 160;
/// Intervals at first, and of the grid for comparison.
const COARSE: usize = 100;
const FINE: usize = 3000;
/// Time beyond that of the fine grid.
const SLOWER: f64 = 1.005;
/// Accepted excess over a limit between nodes, and between the points of a stream.
const EXCESS: f64 = 1.001;
/// Places of an interval that are looked at.
const PLACES: usize = 12;

fn limits(case: &Case) -> PathLimits {
    let limits = motion_limits(&case.model, 1.0);
    PathLimits::new(limits.acceleration, limits.torque).unwrap()
}

fn caps(case: &Case) -> Vec<SpeedCap> {
    let count = case.run().moves.len();
    let cap = |leg| SpeedCap { tcp: case.movement(leg).line_speed(), ..SpeedCap::NONE };
    (0..count).map(cap).collect()
}

fn grid(case: &Case, path: &JointPath, nodes: &[f64]) -> PathGrid {
    let loaded = Loaded { model: &case.model, load: &case.run().load };
    path_grid::grid(loaded, path, nodes, &caps(case)).unwrap()
}

/// The largest share of a limit on velocity, acceleration, torque and the programmed TCP speed
/// inside the intervals of a profile, and where.
fn worst_between(case: &Case, path: &JointPath, profile: &Profile) -> (f64, &'static str) {
    let (model, run) = (&case.model, case.run());
    let caps = caps(case);
    let limits = limits(case);
    let velocity = model.limits.velocity.as_ref().unwrap();
    let mut data = Data::new();
    let mut worst = (0.0, "");
    let mut see = |share: f64, what: &'static str| {
        if share > worst.0 {
            worst = (share, what);
        }
    };
    let s = profile.s();
    for k in 0..s.len() - 1 {
        let u = (profile.b()[k + 1] - profile.b()[k]) / (2.0 * (s[k + 1] - s[k]));
        for i in 0..PLACES {
            let share = (i as f64 + 0.5) / PLACES as f64;
            let at = s[k] + share * (s[k + 1] - s[k]);
            let b = profile.b()[k] + share * (profile.b()[k + 1] - profile.b()[k]);
            let piece = path.piece_at(at);
            let point = piece.eval(at);
            let qd = point.q1.map(|rate| rate * b.sqrt());
            let qdd: [f64; DOF] = std::array::from_fn(|j| point.q1[j] * u + point.q2[j] * b);
            let tau = torque(model, &mut data, &run.load, &point.q, &qd, &qdd);
            for j in 0..DOF {
                see(qd[j].abs() / velocity[j], "velocity");
                see(qdd[j].abs() / limits.acceleration()[j], "acceleration");
                see((tau.rigid[j] + tau.friction[j]).abs() / limits.torque()[j], "torque");
            }
            let tool = &run.legs[piece.leg].tool;
            let twist = tool.jacobian(model, &point.q) * nalgebra::Vector6::from(qd);
            if !matches!(piece.kind, joulepath::retime::path::PieceKind::JointZone) {
                see(twist.fixed_rows::<3>(0).norm() / caps[piece.leg].tcp, "TCP speed");
            }
        }
    }
    worst
}

#[test]
fn the_fastest_profile_keeps_all_limits_between_the_nodes() {
    let all: Vec<Case> = cases(&HARD, COUNT).into_iter().chain(cases(&EASY, COUNT)).collect();
    let faults: Vec<String> = all
        .par_iter()
        .filter_map(|case| {
            let path = case.path().unwrap();
            let nodes = path_grid::nodes_with_edges(&case.model, path, &caps(case), COARSE);
            let plain = time_optimal(&grid(case, path, &nodes), &limits(case)).into_profile();
            let refined = time_optimal_between(nodes.clone(), &limits(case), |nodes| {
                Ok(grid(case, path, nodes))
            });
            let refined = match refined.unwrap() {
                Refinement::Held(refined) => refined,
                Refinement::Exceeded(refined) => {
                    return Some(format!(
                        "{}: {} after {} of {}",
                        case.name,
                        refined.between,
                        refined.grid.intervals(),
                        nodes.len()
                    ));
                }
                Refinement::Infeasible { s } => {
                    return Some(format!("{}: infeasible at {s} of {}", case.name, path.length()));
                }
            };
            let fine = grid(case, path, &path_grid::nodes_with_edges(&case.model, path, &caps(case), FINE));
            let Some(fine) = time_optimal(&fine, &limits(case)).into_profile() else {
                return Some(format!("{}: the fine grid is infeasible", case.name));
            };
            let slower = refined.profile.duration() / fine.duration();
            let (worst, what) = worst_between(case, path, &refined.profile);
            let plain = plain.map_or(0.0, |plain| worst_between(case, path, &plain).0);
            let bad = slower > SLOWER || worst > EXCESS;
            bad.then(|| {
                format!(
                    "{}: {slower:.5} of the time, {worst:.5} of {what} ({plain:.4} before), {} of {} intervals",
                    case.name,
                    refined.grid.intervals(),
                    nodes.len()
                )
            })
        })
        .collect();
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}

fn is_true(case: &Case, reason: &Reason) -> bool {
    match reason {
        Reason::NoSaving | Reason::TooShort(_) => true,
        Reason::NoStream(why) => !why.is_empty() && HARD.contains(&case.kind),
        _ => false,
    }
}

#[test]
fn streams_keep_all_limits_between_their_points_or_say_why_there_is_none() {
    let all: Vec<Case> = cases(&HARD, STREAMS).into_iter().chain(cases(&EASY, STREAMS)).collect();
    let freedom = Freedom { joints: Bound::Robot, ..Freedom::none() };
    let results: Vec<(String, bool)> = all
        .par_iter()
        .flat_map(|case| {
            let task = Task {
                model: &case.model,
                run: case.run(),
                energy_before: EnergyParts::default(),
                spacing_s: 0.05,
                closest_s: 0.04,
                freedom: &freedom,
                cost: Cost::Electrical,
            };
            let fastest = retime(&task, Goal::Fastest);
            let least = fastest.as_ref().map_or(case.run().duration(), |found| found.duration_s);
            let thrifty = retime(&task, Goal::Exactly(1.1 * least));
            [("fastest", fastest), ("thrifty", thrifty)].map(|(what, outcome)| match outcome {
                Ok(retiming) => {
                    let (worst, which) = played::worst(case, &retiming.stream);
                    (format!("{what} {}: {worst:.5} of {which}", case.name), worst <= EXCESS)
                }
                Err(reason) => {
                    (format!("{what} {}: {reason:?}", case.name), is_true(case, &reason))
                }
            })
        })
        .collect();
    let wrong: Vec<&str> = results.iter().filter(|r| !r.1).map(|r| r.0.as_str()).collect();
    let left: Vec<&str> =
        results.iter().map(|r| r.0.as_str()).filter(|r| !r.contains(" of ")).collect();
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
    assert!(left.len() * 20 <= results.len(), "{} left:\n{}", left.len(), left.join("\n"));
    assert!(!all.is_empty() && all.iter().any(|case| case.kind == Kind::TightTorque));
}
