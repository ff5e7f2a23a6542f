//! Energy savings by timing on reference paths, and the share that streams realise: `cargo run
//! --release --example savings`. `docs/trajectories.md` contains the table.
#![expect(clippy::unwrap_used, reason = "a failed set-up stops the example")]
#![expect(clippy::print_stdout, reason = "an example prints")]

#[expect(dead_code, reason = "the tests use more of it")]
#[path = "../tests/hard_paths/cases.rs"]
mod cases;
#[path = "../tests/support/mod.rs"]
mod support;

use cases::{Case, EASY, Kind};
use joulepath::retime::energy::power::motion_energy;
use joulepath::retime::motion::controller::motion_limits;
use joulepath::retime::motion::sampling::{Loaded, SpeedCap};
use joulepath::retime::motion::timed::TimedMotion;
use joulepath::retime::motion::timing::grid::PathGrid;
use joulepath::retime::motion::timing::limits::PathLimits;
use joulepath::retime::motion::timing::profile::Profile;
use joulepath::retime::motion::timing::reachability::time_optimal;
use joulepath::retime::optimize::cost::Cost;
use joulepath::retime::optimize::energy_program::{energy_bound, minimize_energy};
use joulepath::retime::optimize::freedom::{Bound, Freedom};
use joulepath::retime::optimize::path_energy::evaluate;
use joulepath::retime::optimize::path_grid;
use joulepath::retime::optimize::retime::{Goal, retime};
use joulepath::retime::path::joint_path::DOF;
use rayon::prelude::*;

/// Number of paths on both robots.
const COUNT: usize = 96;
/// Number of grid intervals.
const INTERVALS: usize = 100;
/// Durations over the least one.
const FACTORS: [f64; 3] = [1.1, 1.2, 1.3];
/// Least duration of a compared move in s.
const SHORTEST: f64 = 0.2;

/// Saved shares of the energy of the fastest profile.
struct Saving {
    uniform: f64,
    optimal: f64,
    gap: f64,
    /// `None` without a stream of this duration.
    realised: Option<f64>,
}

fn main() {
    let cases = cases::cases(&EASY, COUNT);
    for factor in FACTORS {
        let all: Vec<Saving> = cases.par_iter().filter_map(|case| saving(case, factor)).collect();
        let spread = |f: &dyn Fn(&Saving) -> f64| quartiles(all.iter().map(f).collect());
        println!("{factor} × the least time, {} paths:", all.len());
        println!("  uniform slowing   {}", spread(&|s| 100.0 * s.uniform));
        println!("  optimal profile   {}", spread(&|s| 100.0 * s.optimal));
        println!("  gap of the bound  {}", spread(&|s| 100.0 * s.gap));
        let streams: Vec<(f64, f64)> =
            all.iter().filter_map(|s| Some((s.realised?, s.optimal))).collect();
        println!("  streams           {} of {}", streams.len(), all.len());
        let realised = streams.iter().map(|s| 100.0 * s.0).collect();
        println!("  saving of streams {}", quartiles(realised));
        let share = streams.iter().map(|s| 100.0 * s.0 / s.1).collect();
        println!("  share realised    {}", quartiles(share));
    }
    let joint: Vec<&Case> = cases.iter().filter(|case| case.kind == Kind::EasyJoint).collect();
    let ratios: Vec<f64> =
        joint.par_iter().filter_map(|case| ratio_with_jerk_limit(case)).collect();
    println!("time of the fastest stream over the least with its jerk, {} moves:", ratios.len());
    println!("                    {}", quartiles(ratios));
    let others = cases.par_iter().filter(|case| case.kind != Kind::EasyJoint);
    let ratios: Vec<f64> = others.filter_map(ratio_without_jerk_limit).collect();
    println!("and over the least without a limit on jerk, {} lines and blends:", ratios.len());
    println!("                    {}", quartiles(ratios));
}

/// Minimum, lower quartile, median, upper quartile, maximum.
fn quartiles(mut values: Vec<f64>) -> String {
    values.sort_by(f64::total_cmp);
    if values.is_empty() {
        return "none".to_owned();
    }
    let at = |share: f64| values[(share * (values.len() - 1) as f64).round() as usize];
    let row: Vec<String> =
        [0.0, 0.25, 0.5, 0.75, 1.0].iter().map(|share| format!("{:8.3}", at(*share))).collect();
    row.join(" ")
}

/// The fastest profile on the path of a case without a jerk limit, with grid and limits.
fn fastest(case: &Case) -> Option<(PathGrid, PathLimits, Profile)> {
    let (path, run) = (case.path()?, case.run());
    let limits = motion_limits(&case.model);
    let limits = PathLimits::new(limits.acceleration, limits.torque).ok()?;
    let moves = run.moves.iter().map(|record| record.movement.line_speed());
    let caps: Vec<SpeedCap> = moves.map(|tcp| SpeedCap { tcp, ..SpeedCap::NONE }).collect();
    let loaded = Loaded { model: &case.model, load: &run.load };
    let nodes = path_grid::nodes(&case.model, path, &caps, INTERVALS);
    let grid = path_grid::grid(loaded, path, &nodes, &caps).ok()?;
    let profile = time_optimal(&grid, &limits).into_profile()?;
    Some((grid, limits, profile))
}

/// Duration of the fastest stream over the least one on its path without a jerk limit: an upper
/// bound of the cost of the jerk limit.
fn ratio_without_jerk_limit(case: &Case) -> Option<f64> {
    let least = fastest(case)?.2.duration();
    let freedom = Freedom { joints: Bound::Robot, ..Freedom::default() };
    let stream = retime(&case.task(&freedom), Goal::Fastest).ok()?;
    (least > SHORTEST).then(|| (stream.duration_s - case.run().settling) / least)
}

fn saving(case: &Case, factor: f64) -> Option<Saving> {
    let run = case.run();
    let (grid, limits, fastest) = fastest(case)?;
    let model = Cost::Electrical.model(&case.model);
    let time = factor * fastest.duration();
    let first = evaluate(&grid, &fastest, &model).total();
    let saved = |energy: f64| (first - energy) / first;
    let uniform = evaluate(&grid, &fastest.scaled_to(time)?, &model).total();
    let bound = energy_bound(&grid, &limits, &model, &fastest, time);
    let best = minimize_energy(&grid, &limits, &model, &fastest, time, bound.as_ref());
    let best = best.into_optimum()?;
    let freedom = Freedom { joints: Bound::Robot, ..Freedom::default() };
    let stream = retime(&case.task(&freedom), Goal::Exactly(time + run.settling)).ok();
    let realised = stream.map(|retiming| {
        let duration = retiming.stream.duration();
        let motion = TimedMotion::Stream(retiming.stream);
        let parts = motion_energy(&case.model, &run.load, &motion, 0.0, duration);
        saved(parts.motion_energy_j())
    });
    Some(Saving {
        uniform: saved(uniform),
        optimal: saved(best.energy.total()),
        gap: 1.0 - best.lower_bound / best.energy.total(),
        realised,
    })
}

/// Duration of the fastest stream of a joint move over the largest least duration of its single
/// joints with limits on speed, acceleration and jerk: a lower bound of any synchronous motion.
fn ratio_with_jerk_limit(case: &Case) -> Option<f64> {
    let run = case.run();
    let limits = &case.model.limits;
    let (v, a, jerk) =
        (limits.velocity.as_ref()?, limits.acceleration.as_ref()?, limits.jerk.as_ref()?);
    let least = (0..DOF)
        .map(|j| seven_segments((run.end[j] - run.start[j]).abs(), v[j], a[j], jerk[j]))
        .fold(0.0, f64::max);
    let freedom = Freedom { joints: Bound::Robot, ..Freedom::default() };
    let fastest = retime(&case.task(&freedom), Goal::Fastest).ok()?;
    (least > SHORTEST).then(|| (fastest.duration_s - run.settling) / least)
}

/// Least duration from rest to rest over a distance, with limits on speed, acceleration and jerk.
fn seven_segments(distance: f64, v: f64, a: f64, j: f64) -> f64 {
    let ramp = |v: f64| if v * j >= a * a { v / a + a / j } else { 2.0 * (v / j).sqrt() };
    // v · ramp(v) is the distance of speeding up and slowing down.
    if v * ramp(v) <= distance {
        return distance / v + ramp(v);
    }
    let (mut lo, mut hi) = (0.0, v);
    for _ in 0..100 {
        let middle = 0.5 * (lo + hi);
        if middle * ramp(middle) < distance { lo = middle } else { hi = middle }
    }
    2.0 * ramp(lo)
}
