//! The profile of least energy.

use joulepath::retime::motion::stream::{DOF, Joints};
use joulepath::retime::motion::timing::grid::PathGrid;
use joulepath::retime::motion::timing::limits::{PathLimits, worst_ratio};
use joulepath::retime::motion::timing::profile::Profile;
use joulepath::retime::motion::timing::reachability::{speed_range, time_optimal};
use joulepath::retime::optimize::energy_program::{EnergyOptimum, EnergyOutcome};
use joulepath::retime::optimize::path_energy::{EnergyModel, Sharing, evaluate};

use crate::analytic::single_joint;
use crate::arm;

const FREE: Joints = [f64::INFINITY; DOF];
/// Discretisation error of the analytic cases with 200 intervals.
const DISCRETISATION: f64 = 2e-3;

fn first_joint(loss: f64) -> EnergyModel {
    let mut model = EnergyModel {
        work: 1.0,
        speed: 0.0,
        loss: [0.0; DOF],
        base_w: 0.0,
        sharing: Sharing::Bus,
        regeneration: 1.0,
    };
    model.loss[0] = loss;
    model
}

fn converged(
    grid: &PathGrid,
    limits: &PathLimits,
    model: &EnergyModel,
    time: impl Fn(f64) -> f64,
) -> EnergyOptimum {
    let fastest = time_optimal(grid, limits).into_profile().unwrap();
    let outcome = arm::least_energy(grid, limits, model, &fastest, time(fastest.duration()));
    match outcome {
        EnergyOutcome::Converged(optimum) => optimum,
        other => panic!("{other:?}"),
    }
}

fn free() -> PathLimits {
    let mut acceleration = FREE;
    acceleration[0] = 1e3;
    PathLimits::new(acceleration, FREE).unwrap()
}

#[test]
fn copper_losses_alone_give_a_parabolic_speed() {
    let (length, time, m, k) = (1.7, 1.3, 3.0, 0.02);
    let grid = single_joint(length, 200, 1e3, m, 0.0);
    let best = converged(&grid, &free(), &first_joint(k), |_| time);
    // v = 6 L/T² t (1 − t/T), ∫ k m² v̇² dt = 12 k m² L²/T³.
    let energy = 12.0 * k * m * m * length * length / time.powi(3);
    assert!((best.energy.copper / energy - 1.0).abs() < DISCRETISATION, "{:?}", best.energy);
    assert!((best.lower_bound / energy - 1.0).abs() < DISCRETISATION);
    // dE/dT = −3 E/T.
    assert!((best.marginal / (3.0 * energy / time) - 1.0).abs() < 5.0 * DISCRETISATION);
    for step in 1..10 {
        let t = time * f64::from(step) / 10.0;
        let (_, v, _) = best.profile.at(t);
        let exact = 6.0 * length / (time * time) * t * (1.0 - t / time);
        assert!((v / exact - 1.0).abs() < 0.02, "{t}: {v} {exact}");
    }
}

#[test]
fn copper_losses_with_viscous_friction_are_a_linear_quadratic_problem() {
    let (length, time, m, k, f) = (1.7f64, 1.3f64, 3.0f64, 0.02f64, 4.0f64);
    let grid = single_joint(length, 200, 1e3, m, f);
    let best = converged(&grid, &free(), &first_joint(k), |_| time);
    // min ∫ α v̇² + β v²: v = C (1 − cosh ω(t − T/2)/cosh ωT/2), E = β C L.
    let (alpha, beta) = (k * m * m, k * f * f + f);
    let omega = (beta / alpha).sqrt();
    let c = length / (time - 2.0 / omega * (0.5 * omega * time).tanh());
    let energy = beta * c * length;
    assert!((best.energy.total() / energy - 1.0).abs() < DISCRETISATION, "{:?}", best.energy);
    assert!(best.lower_bound < energy * (1.0 + DISCRETISATION));
    assert!(best.lower_bound > 0.97 * energy, "{} {energy}", best.lower_bound);
}

#[test]
fn viscous_friction_alone_gives_constant_speed() {
    let (length, time, f) = (1.7, 1.3, 4.0);
    let grid = single_joint(length, 200, 1e3, 0.0, f);
    let best = converged(&grid, &free(), &first_joint(0.0), |_| time);
    let energy = f * length * length / time;
    assert!((best.energy.friction / energy - 1.0).abs() < 0.01, "{:?}", best.energy);
    assert!(best.lower_bound <= best.energy.total() * (1.0 + 1e-6));
}

#[test]
fn base_power_alone_gives_the_fastest_profile() {
    // Without inertia a greedy step is not optimal on a finite grid.
    const ZIGZAG: f64 = 5e-4;
    for seed in 0..5 {
        let grid = arm::grid(&arm::Path::random(seed), 60, 0.0);
        let model = EnergyModel { base_w: 300.0, ..first_joint(0.0) };
        let fastest = time_optimal(&grid, &arm::limits()).into_profile().unwrap();
        let best = converged(&grid, &arm::limits(), &model, |fastest| 2.0 * fastest);
        let ratio = best.profile.duration() / fastest.duration();
        assert!((ratio - 1.0).abs() < ZIGZAG, "seed {seed}: {ratio}");
    }
}

/// The electrical models of robots.
fn models() -> [EnergyModel; 3] {
    let loss = arm::LOSS;
    [
        EnergyModel {
            work: 1.0,
            speed: 0.0,
            loss,
            base_w: 0.0,
            sharing: Sharing::PerJoint,
            regeneration: 0.0,
        },
        EnergyModel {
            work: 1.0,
            speed: 0.0,
            loss,
            base_w: 0.0,
            sharing: Sharing::Bus,
            regeneration: 0.0,
        },
        EnergyModel {
            work: 1.0,
            speed: 0.0,
            loss,
            base_w: 150.0,
            sharing: Sharing::Bus,
            regeneration: 0.6,
        },
    ]
}

#[test]
fn random_paths_save_more_than_uniform_slowing_within_all_limits() {
    const BETWEEN: f64 = 5e-3;
    const GAP: f64 = 0.03;
    let limits = arm::limits();
    for seed in 0..12 {
        let path = arm::Path::random(seed);
        let grid = arm::grid(&path, 60, 1.0);
        let fine = arm::grid(&path, 1200, 1.0);
        for (model, factor) in models().iter().flat_map(|m| [(m, 1.1), (m, 1.5)]) {
            let fastest = time_optimal(&grid, &limits).into_profile().unwrap();
            let time = factor * fastest.duration();
            let best = converged(&grid, &limits, model, |_| time);
            let energy = best.energy.total();
            let uniform = evaluate(&grid, &fastest.scaled_to(time).unwrap(), model).total();
            assert!(energy < uniform, "seed {seed}: {energy} {uniform}");
            assert!(best.lower_bound <= energy);
            assert!(best.lower_bound >= (1.0 - GAP) * energy, "seed {seed}: {best:?}");
            assert!(best.profile.duration() <= time * (1.0 + 1e-9));
            assert!(worst_ratio(&grid, &limits, best.profile.b()) <= 1.0 + 1e-9);
            let b = arm::resample(grid.s(), best.profile.b(), fine.s());
            let between = worst_ratio(&fine, &limits, &b);
            assert!(between <= 1.0 + BETWEEN, "seed {seed}: {between}");
        }
    }
}

#[test]
fn random_changes_of_the_profile_are_not_better() {
    // Comparison with blind search: perturbations of b within limits and duration.
    const QUADRATURE: f64 = 3e-3;
    let limits = arm::limits();
    let mut tried = 0;
    for seed in 0..4 {
        let grid = arm::grid(&arm::Path::random(seed), 60, 1.0);
        let model = models()[1];
        let best = converged(&grid, &limits, &model, |fastest| 1.3 * fastest);
        let mut random = arm::Random::new(seed + 7);
        for _ in 0..2000 {
            let (centre, width) = (random.uniform(0.0, 60.0), random.uniform(3.0, 20.0));
            let size = random.uniform(-0.1, 0.1);
            let bump = |k: usize| size * (-((k as f64 - centre) / width).powi(2)).exp();
            let b = best.profile.b().iter().enumerate().map(|(k, b)| b * (1.0 + bump(k))).collect();
            let changed = Profile::new(grid.s().to_vec(), b).unwrap();
            let changed = changed.scaled_to(best.profile.duration()).unwrap();
            if worst_ratio(&grid, &limits, changed.b()) <= 1.0 {
                tried += 1;
                let energy = evaluate(&grid, &changed, &model).total();
                assert!(energy > (1.0 - QUADRATURE) * best.energy.total(), "seed {seed}");
            }
        }
    }
    assert!(tried > 1000);
}

#[test]
fn the_bound_of_a_coarse_grid_holds_for_a_fine_one() {
    let limits = arm::limits();
    for seed in 0..5 {
        for model in models() {
            let path = arm::Path::random(seed);
            let coarse = arm::grid(&path, 60, 1.0);
            let fastest = time_optimal(&coarse, &limits).into_profile().unwrap();
            let time = 1.1 * fastest.duration();
            let bound = converged(&coarse, &limits, &model, |_| time).lower_bound;
            let fine = converged(&arm::grid(&path, 240, 1.0), &limits, &model, |_| time);
            assert!(bound < fine.energy.total(), "seed {seed}: {bound} {:?}", fine.energy);
            // The coarse profile is nearly as good.
            let own = converged(&coarse, &limits, &model, |_| time).energy.total();
            assert!(own < 1.025 * fine.energy.total(), "seed {seed}: {own}");
        }
    }
}

#[test]
fn the_marginal_value_is_the_slope_of_energy_over_time() {
    const STEP: f64 = 0.01;
    let limits = arm::limits();
    for seed in 0..5 {
        let grid = arm::grid(&arm::Path::random(seed), 60, 1.0);
        let model = models()[0];
        let [before, here, after] = [1.2 - STEP, 1.2, 1.2 + STEP]
            .map(|factor| converged(&grid, &limits, &model, |fastest| factor * fastest));
        let slope = (before.energy.total() - after.energy.total())
            / (after.profile.duration() - before.profile.duration());
        assert!((here.marginal / slope - 1.0).abs() < 0.05, "{} {slope}", here.marginal);
    }
}

#[test]
fn a_time_below_the_fastest_is_refused() {
    let grid = arm::grid(&arm::Path::random(1), 40, 1.0);
    let fastest = time_optimal(&grid, &arm::limits()).into_profile().unwrap();
    for time in [0.9 * fastest.duration(), 0.0, -1.0, f64::NAN] {
        let outcome = arm::least_energy(&grid, &arm::limits(), &models()[0], &fastest, time);
        assert_eq!(outcome, EnergyOutcome::TooShort { fastest: fastest.duration() });
    }
}

#[test]
fn at_the_fastest_time_the_fastest_profile_is_kept() {
    let grid = arm::grid(&arm::Path::random(1), 40, 1.0);
    let fastest = time_optimal(&grid, &arm::limits()).into_profile().unwrap();
    let time = fastest.duration();
    let outcome = arm::least_energy(&grid, &arm::limits(), &models()[0], &fastest, time);
    let EnergyOutcome::Kept(best) = outcome else { panic!("{outcome:?}") };
    assert_eq!(best.profile, fastest);
}

#[test]
fn a_time_just_above_the_fastest_gives_a_verified_profile() {
    for seed in 0..10 {
        for factor in [1.0001, 1.001, 1.01] {
            let grid = arm::grid(&arm::Path::random(seed), 60, 1.0);
            let fastest = time_optimal(&grid, &arm::limits()).into_profile().unwrap();
            let time = factor * fastest.duration();
            let outcome = arm::least_energy(&grid, &arm::limits(), &models()[1], &fastest, time);
            let best = outcome.into_optimum().unwrap();
            assert!(worst_ratio(&grid, &arm::limits(), best.profile.b()) <= 1.0 + 2e-6);
            assert!(best.profile.duration() <= time * (1.0 + 1e-9));
        }
    }
}

#[test]
fn profiles_of_a_duration_lie_in_its_speed_range() {
    const ROUNDING: f64 = 1e-9;
    let limits = arm::limits();
    let mut narrow = Vec::new();
    for seed in 0..8 {
        let grid = arm::grid(&arm::Path::random(seed), 60, 1.0);
        let fastest = time_optimal(&grid, &limits).into_profile().unwrap();
        for factor in [1.05, 1.1, 1.5] {
            let time = factor * fastest.duration();
            let range = speed_range(&grid, &limits, time);
            let uniform = fastest.scaled_to(time).unwrap();
            let others = models().map(|model| converged(&grid, &limits, &model, |_| time).profile);
            for profile in others.iter().chain([&fastest, &uniform]) {
                for (b, (lo, hi)) in profile.b().iter().zip(&range) {
                    assert!((lo - ROUNDING..=hi + ROUNDING).contains(b), "{seed}: {lo} {b} {hi}");
                }
            }
            // A profile that is slow at one place and otherwise as fast as possible.
            let middle = grid.intervals() / 2;
            let slow = range[middle].0.sqrt();
            let dip = grid.capped(|k| if k == middle { 0.98 * slow.max(1e-6) } else { f64::MAX });
            let dipped = time_optimal(&dip, &limits).into_profile().unwrap();
            assert!(dipped.duration() > time, "{seed}: {} {time}", dipped.duration());
            narrow.push(range[middle].0 / range[middle].1);
        }
    }
    assert!(narrow.iter().any(|share| *share > 0.2), "{narrow:?}");
}
