//! Grids, limits, profiles and references as plain data; scaling and degenerate paths.

use joulepath::retime::motion::stream::DOF;
use joulepath::retime::motion::timing::grid::{GridError, PathGrid, PathPoint};
use joulepath::retime::motion::timing::limits::{PathLimits, worst_ratio};
use joulepath::retime::motion::timing::profile::Profile;
use joulepath::retime::motion::timing::reachability::{Reachability, time_optimal};
use joulepath::retime::optimize::path_energy::{EnergyModel, Sharing, evaluate};
use joulepath::retime::optimize::stream_reference::{Reference, ReferenceError};

use crate::analytic::single_joint;
use crate::arm;

const MODEL: EnergyModel = EnergyModel {
    work: 1.0,
    speed: 0.0,
    loss: arm::LOSS,
    base_w: 0.0,
    sharing: Sharing::PerJoint,
    regeneration: 0.0,
};

#[test]
fn wrong_grids_are_refused() {
    let point = PathPoint::kinematic([0.0; DOF], [1.0; DOF], [0.0; DOF], 1.0);
    let nodes = |s: &[f64], n: usize| PathGrid::from_nodes(s.to_vec(), &vec![point; n]);
    assert!(nodes(&[0.0, 1.0, 2.0], 3).is_ok());
    assert!(matches!(nodes(&[0.0, 1.0], 2), Err(GridError::Lengths { .. })));
    assert!(matches!(nodes(&[], 0), Err(GridError::Lengths { .. })));
    assert!(matches!(nodes(&[0.0, 1.0, 2.0], 4), Err(GridError::Lengths { .. })));
    for s in [[0.0, 1.0, 1.0], [0.0, f64::NAN, 1.0], [0.0, 1.0, f64::INFINITY]] {
        assert!(matches!(nodes(&s, 3), Err(GridError::NotRising { .. })));
    }
    for v_max in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let bad = PathPoint { v_max, ..point };
        let grid = PathGrid::from_nodes(vec![0.0, 1.0, 2.0], &[point, point, bad]);
        assert_eq!(grid, Err(GridError::Value { interval: 1 }));
    }
}

#[test]
fn wrong_limits_are_refused() {
    for bad in [0.0, -1.0, f64::NAN] {
        let mut torque = [1.0; DOF];
        torque[3] = bad;
        let error = PathLimits::new([1.0; DOF], torque).unwrap_err();
        assert_eq!((error.quantity, error.joint), ("torque", 4));
    }
}

#[test]
fn wrong_references_are_refused() {
    let q = [0.0; DOF];
    let reference = |t: &[f64]| Reference::new(t.to_vec(), vec![q; t.len()], vec![q; t.len()]);
    assert_eq!(reference(&[0.0]), Err(ReferenceError::Lengths));
    assert_eq!(reference(&[0.1, 0.2]), Err(ReferenceError::Time(0)));
    assert_eq!(reference(&[0.0, 0.2, 0.2]), Err(ReferenceError::Time(2)));
    let nan = Reference::new(vec![0.0, 1.0], vec![q, [f64::NAN; DOF]], vec![q; 2]);
    assert_eq!(nan, Err(ReferenceError::Value(1)));
}

#[test]
fn a_profile_agrees_with_its_integration() {
    const STEPS: usize = 100_000;
    const TOLERANCE: f64 = 1e-6;
    let s = arm::rest_to_rest_nodes(2.0, 9);
    let b = s.iter().map(|s| s * (2.0 - s)).collect();
    let profile = Profile::new(s, b).unwrap();
    let dt = profile.duration() / STEPS as f64;
    let (mut s, mut v) = (0.0, 0.0);
    for step in 0..STEPS {
        let (_, speed, u) = profile.at((step as f64 + 0.5) * dt);
        s += dt * speed;
        v += dt * u;
    }
    assert!((s - 2.0).abs() < TOLERANCE && v.abs() < 1e2 * TOLERANCE, "{s} {v}");
    assert_eq!(profile.at(profile.duration()), (2.0, 0.0, 0.0));
    assert_eq!(profile.at(-1.0), (0.0, 0.0, 0.0));
    for refused in [vec![0.0, 1.0], vec![0.0, 0.0, 0.0], vec![0.0, -1.0, 0.0], vec![f64::NAN; 3]] {
        assert_eq!(Profile::new(vec![0.0, 1.0, 2.0], refused), None);
    }
}

#[test]
fn energies_of_a_known_motion_are_exact() {
    // Constant acceleration a up to the middle and back: v = √(2 a s); m, f and k of one joint.
    let (length, a, m, f, k) = (2.0f64, 0.8f64, 3.0f64, 4.0f64, 0.05f64);
    let grid = single_joint(length, 40, 1e3, m, f);
    let b = grid.s().iter().map(|s| 2.0 * a * s.min(length - s)).collect();
    let profile = Profile::new(grid.s().to_vec(), b).unwrap();
    let mut model = EnergyModel {
        work: 1.0,
        speed: 0.0,
        loss: [0.0; DOF],
        base_w: 7.0,
        sharing: Sharing::PerJoint,
        regeneration: 0.0,
    };
    model.loss[0] = k;
    let parts = evaluate(&grid, &profile, &model);
    let half = (length / a).sqrt();
    let close = |x: f64, y: f64| assert!((x - y).abs() < 1e-9 * (1.0 + y.abs()), "{x} {y}");
    close(parts.time, 2.0 * half);
    close(parts.base, 14.0 * half);
    close(parts.mechanical, 0.0);
    // ∫ f v² = 2 f a² h³/3; ∫ k τ² with τ = ±m a + f v: the cross terms of both halves cancel.
    close(parts.friction, 2.0 * f * a * a * half.powi(3) / 3.0);
    close(parts.copper, k * (2.0 * m * m * a * a * half + f * parts.friction));
    // Braking: −m a v + f v² < 0 while v < m a/f = 0.6, the last 0.75 s: lost is its integral.
    let (still, tau) = (m * a / f, m / f);
    assert!(still < a * half);
    let lost = m * a * still * tau / 2.0 - f * a * a * tau.powi(3) / 3.0;
    assert!((parts.drive / lost - 1.0).abs() < 5e-3, "{} {lost}", parts.drive);
    let half_back = EnergyModel { regeneration: 0.5, ..model };
    close(evaluate(&grid, &profile, &half_back).drive, 0.5 * parts.drive);
}

#[test]
fn the_unit_of_the_path_does_not_matter() {
    const SAME: f64 = 1e-6;
    let limits = arm::limits();
    let path = arm::Path::random(5);
    let grid = arm::grid(&path, 60, 1.0);
    let solve = |grid: &PathGrid| {
        let fastest = time_optimal(grid, &limits).into_profile().unwrap();
        let time = 1.2 * fastest.duration();
        let best = arm::least_energy(grid, &limits, &MODEL, &fastest, time).into_optimum().unwrap();
        (fastest.duration(), best.energy.total())
    };
    let wanted = solve(&grid);
    for unit in [1e-4, 1e4] {
        let scaled = |point: &PathPoint| PathPoint {
            q1: point.q1.map(|x| x / unit),
            q2: point.q2.map(|x| x / (unit * unit)),
            m: point.m.map(|x| x / unit),
            c: point.c.map(|x| x / (unit * unit)),
            viscous: point.viscous.map(|x| x / unit),
            v_max: point.v_max * unit,
            ..*point
        };
        let ends = grid.ends().iter().map(|pair| [scaled(&pair[0]), scaled(&pair[1])]).collect();
        let s = grid.s().iter().map(|s| s * unit).collect();
        let got = solve(&PathGrid::new(s, ends).unwrap());
        assert!((got.0 / wanted.0 - 1.0).abs() < SAME, "{unit}: {got:?} {wanted:?}");
        assert!((got.1 / wanted.1 - 1.0).abs() < 1e2 * SAME, "{unit}: {got:?} {wanted:?}");
    }
}

#[test]
fn unlimited_time_gives_a_finite_optimal_duration() {
    // Copper losses of holding give an optimal duration.
    let grid = arm::grid(&arm::Path::random(2), 40, 1.0);
    let fastest = time_optimal(&grid, &arm::limits()).into_profile().unwrap();
    let optimum = |time: f64| {
        let outcome = arm::least_energy(&grid, &arm::limits(), &MODEL, &fastest, time);
        outcome.into_optimum().unwrap()
    };
    let (enough, endless) = (optimum(20.0 * fastest.duration()), optimum(f64::INFINITY));
    assert!(enough.profile.duration() < 10.0 * fastest.duration());
    assert!(enough.energy.total() < optimum(1.2 * fastest.duration()).energy.total());
    assert!(endless.energy.total() < 1.01 * enough.energy.total());
}

#[test]
fn short_parts_of_a_path_are_solved() {
    let limits = arm::limits();
    for seed in 0..6 {
        let path = arm::Path::random(seed);
        for share in [1e-4, 1e-3, 1e-2, 0.1] {
            let s: Vec<f64> = arm::rest_to_rest_nodes(share * path.length, 40);
            let grid = arm::with_reversals(&path, s, 1.0);
            let fastest = time_optimal(&grid, &limits).into_profile().unwrap();
            let time = 1.3 * fastest.duration();
            let outcome = arm::least_energy(&grid, &limits, &MODEL, &fastest, time);
            let best = outcome.into_optimum().unwrap();
            let uniform = evaluate(&grid, &fastest.scaled_to(time).unwrap(), &MODEL).total();
            assert!(best.energy.total() < uniform, "seed {seed} {share}");
            assert!(worst_ratio(&grid, &limits, best.profile.b()) <= 1.0 + 1e-9);
        }
    }
}

#[test]
fn arbitrary_grids_are_solved_or_infeasible() {
    let mut random = arm::Random::new(11);
    let (mut solved, mut refused) = (0, 0);
    for _ in 0..200 {
        let n = random.uniform(3.0, 12.0) as usize;
        let size = 10f64.powf(random.uniform(-6.0, 6.0));
        let mut joints = || std::array::from_fn(|_| size * random.uniform(-1.0, 1.0));
        let nodes: Vec<PathPoint> = (0..n)
            .map(|_| PathPoint {
                m: joints(),
                c: joints(),
                g: joints(),
                coulomb: joints(),
                viscous: joints(),
                ..PathPoint::kinematic(joints(), joints(), joints(), 1.0)
            })
            .collect();
        let s = (0..n).map(|k| k as f64).collect();
        let grid = PathGrid::from_nodes(s, &nodes).unwrap();
        let limits = PathLimits::new([1.0; DOF], [1.0; DOF]).unwrap();
        match time_optimal(&grid, &limits) {
            Reachability::Optimal(fastest) => {
                solved += 1;
                let time = 1.5 * fastest.duration();
                let outcome = arm::least_energy(&grid, &limits, &MODEL, &fastest, time);
                let best = outcome.into_optimum().unwrap();
                assert!(worst_ratio(&grid, &limits, best.profile.b()) <= 1.0 + 2e-6);
            }
            Reachability::Infeasible { .. } => refused += 1,
        }
    }
    assert!(solved > 20 && refused > 20, "{solved} {refused}");
}
