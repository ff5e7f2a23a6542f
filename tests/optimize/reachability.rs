//! The fastest profile.

use joulepath::retime::motion::stream::DOF;
use joulepath::retime::motion::timing::grid::PathGrid;
use joulepath::retime::motion::timing::limits::{PathLimits, worst_ratio};
use joulepath::retime::motion::timing::profile::Profile;
use joulepath::retime::motion::timing::reachability::{Reachability, time_optimal};

use crate::analytic::single_joint;
use crate::arm;

/// Tolerance of the stages, for a hundred intervals.
const ROUNDING: f64 = 1e-7;
const FREE: [f64; DOF] = [f64::INFINITY; DOF];

fn optimal(grid: &PathGrid, limits: &PathLimits) -> Profile {
    match time_optimal(grid, limits) {
        Reachability::Optimal(profile) => profile,
        Reachability::Infeasible { interval } => panic!("infeasible at {interval}"),
    }
}

#[test]
fn the_fastest_profile_of_a_double_integrator_is_a_triangle() {
    let mut acceleration = FREE;
    acceleration[0] = 2.0;
    let limits = PathLimits::new(acceleration, FREE).unwrap();
    // T = 2 √(L/a).
    let profile = optimal(&single_joint(1.8, 100, 1e3, 0.0, 0.0), &limits);
    assert!((profile.duration() - 2.0 * (1.8f64 / 2.0).sqrt()).abs() < ROUNDING);
}

#[test]
fn the_fastest_profile_with_a_speed_limit_is_a_trapezoid() {
    let mut torque = FREE;
    torque[0] = 6.0;
    let limits = PathLimits::new(FREE, torque).unwrap();
    // a = 6/3 = 2, v = 1.2: T = v/a + L/v; both corners fall on nodes.
    let profile = optimal(&single_joint(1.8, 100, 1.2, 3.0, 0.0), &limits);
    assert!((profile.duration() - (1.2 / 2.0 + 1.8 / 1.2)).abs() < ROUNDING);
}

#[test]
fn viscous_friction_slows_according_to_the_differential_equation() {
    // m v̇ = L − f v while driving and −L − f v while braking; the speeds meet at v*. Constraints
    // at both ends cost half a step of friction on each interval.
    const TOLERANCE: f64 = 1e-3;
    let (m, f, limit, length) = (3.0f64, 2.0, 6.0, 1.8);
    let travelled = |v: f64, sign: f64| {
        // ∫ v dv m/(L − sign f v)
        let k = sign * f;
        m * (-v / k - limit / (k * k) * (1.0 - k * v / limit).ln())
    };
    let (mut lo, mut hi) = (0.0, limit / f * (1.0 - 1e-12));
    for _ in 0..200 {
        let v = 0.5 * (lo + hi);
        if travelled(v, 1.0) + travelled(v, -1.0) < length { lo = v } else { hi = v }
    }
    let time = m / f * (-(1.0 - f * lo / limit).ln() + (1.0 + f * lo / limit).ln());
    let mut torque = FREE;
    torque[0] = limit;
    let limits = PathLimits::new(FREE, torque).unwrap();
    let grid = single_joint(length, 2000, 1e3, m, f);
    let profile = optimal(&grid, &limits);
    assert!((profile.duration() / time - 1.0).abs() < TOLERANCE, "{} {time}", profile.duration());
    let without = optimal(&single_joint(length, 2000, 1e3, m, 0.0), &limits);
    assert!(without.duration() < 0.995 * time);
}

#[test]
fn impossible_holding_torque_is_infeasible() {
    let limits = PathLimits::new([10.0; DOF], [1.0; DOF]).unwrap();
    let grid = arm::grid(&arm::Path::random(3), 40, 1.0);
    assert!(matches!(time_optimal(&grid, &limits), Reachability::Infeasible { .. }));
}

#[test]
fn random_paths_keep_limits_at_nodes_and_between() {
    const BETWEEN: f64 = 0.003;
    for seed in 0..40 {
        let path = arm::Path::random(seed);
        let grid = arm::grid(&path, 100, 1.0);
        let profile = optimal(&grid, &arm::limits());
        let b = profile.b();
        assert_eq!((b[0], b[b.len() - 1]), (0.0, 0.0));
        let worst = worst_ratio(&grid, &arm::limits(), b);
        assert!(worst <= 1.0 + 2e-6 && worst > 0.999, "seed {seed}: {worst}");
        let fine = arm::grid(&path, 2000, 1.0);
        let between = worst_ratio(&fine, &arm::limits(), &arm::resample(grid.s(), b, fine.s()));
        assert!(between < 1.0 + BETWEEN, "seed {seed}: {between}");
    }
}

#[test]
fn no_small_change_is_faster() {
    // Any increase of b violates a limit: the profile is on the boundary of the reachable set.
    for seed in 0..10 {
        let grid = arm::grid(&arm::Path::random(seed), 60, 1.0);
        let limits = arm::limits();
        let profile = optimal(&grid, &limits);
        for node in 1..grid.intervals() {
            let mut b = profile.b().to_vec();
            b[node] *= 1.0 + 1e-3;
            assert!(worst_ratio(&grid, &limits, &b) > 1.0 + 1e-5, "seed {seed} node {node}");
        }
    }
}

#[test]
fn tight_torques_are_infeasible_only_where_the_arm_cannot_hold_itself() {
    let mut infeasible = 0;
    for share in [0.7, 0.55, 0.45] {
        let loose = arm::limits();
        let torque = loose.torque().map(|t| t * share);
        let limits = PathLimits::new(*loose.acceleration(), torque).unwrap();
        for (seed, n) in (0..40).zip([10, 60, 200].into_iter().cycle()) {
            let grid = arm::grid(&arm::Path::random(seed), n, 1.0);
            let still = worst_ratio(&grid, &limits, &vec![0.0; grid.s().len()]);
            match time_optimal(&grid, &limits) {
                Reachability::Optimal(_) => assert!(still < 1.0),
                Reachability::Infeasible { .. } => {
                    infeasible += 1;
                    assert!(still > 0.99, "seed {seed}, {n} intervals at {share}: {still}");
                }
            }
        }
    }
    assert!(infeasible > 0);
}

#[test]
fn dense_ends_halve_the_loss_of_a_coarse_grid() {
    let mut excess = [Vec::new(), Vec::new()];
    for seed in 0..21 {
        let path = arm::Path::random(seed);
        let fine = optimal(&arm::grid(&path, 3000, 1.0), &arm::limits()).duration();
        let equal = (0..=100).map(|k| path.length * f64::from(k) / 100.0).collect();
        let grids = [arm::with_reversals(&path, equal, 1.0), arm::grid(&path, 100, 1.0)];
        for (excess, grid) in excess.iter_mut().zip(&grids) {
            excess.push(optimal(grid, &arm::limits()).duration() / fine - 1.0);
        }
    }
    let [equal, dense] = excess.map(|mut x| {
        x.sort_by(f64::total_cmp);
        (x[10], x[20])
    });
    assert!(dense.0 < 0.65 * equal.0 && dense.1 < 0.65 * equal.1, "{equal:?} {dense:?}");
    assert!(dense.0 < 0.005 && dense.1 < 0.01, "{dense:?}");
}
