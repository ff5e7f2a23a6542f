//! Streams that follow an intended motion.

use std::f64::consts::{FRAC_PI_2, TAU};

use joulepath::retime::motion::stream::{DOF, Joints, Piece, Stream};
use joulepath::retime::motion::timing::profile::Profile;
use joulepath::retime::motion::timing::reachability::time_optimal;
use joulepath::retime::optimize::path_energy::{EnergyModel, Sharing, evaluate};
use joulepath::retime::optimize::plant::{PathDerivatives, PathShares, Plant, realise};
use joulepath::retime::optimize::polish_problem::PathPenalty;
use joulepath::retime::optimize::stream_fit::{FittedStream, StreamFit, fit_stream};
use joulepath::retime::optimize::stream_limits::StreamLimits;
use joulepath::retime::optimize::stream_polish::{PolishStatus, Until, polish_stream};
use joulepath::retime::optimize::stream_reference::Reference;
use joulepath::retime::optimize::stream_spacing::{Spacing, adaptive_intervals};

use crate::arm;

const LEVER: Joints = [1.0; DOF];
const FREE: StreamLimits = StreamLimits {
    velocity: [f64::INFINITY; DOF],
    acceleration: [f64::INFINITY; DOF],
    jerk: [f64::INFINITY; DOF],
};

fn fitted(fit: StreamFit) -> FittedStream {
    match fit {
        StreamFit::Fitted(fitted) => fitted,
        other => panic!("{other:?}"),
    }
}

/// The motion along a path with a profile.
fn motion(path: &arm::Path, profile: &Profile) -> Reference {
    Reference::sample(profile.duration(), 2000, |t| {
        let (s, speed, _) = profile.at(t);
        let (q, q1, _) = path.at(s);
        (q, q1.map(|x| x * speed))
    })
    .unwrap()
}

/// A smooth motion from rest to rest of joints 0…2; joint 3 rests.
fn smooth(duration: f64) -> Reference {
    Reference::sample(duration, 4000, |t| {
        // q = A (x³ (10 − 15 x + 6 x²)), x = t/T.
        let x = t / duration;
        let (shape, slope) =
            (x * x * x * (10.0 - 15.0 * x + 6.0 * x * x), 30.0 * (x * (1.0 - x)).powi(2));
        let size = [1.0, -0.7, 0.4, 0.0, 0.0, 0.0];
        (
            std::array::from_fn(|j| 0.1 * j as f64 + size[j] * shape),
            size.map(|a| a * slope / duration),
        )
    })
    .unwrap()
}

#[test]
fn fitting_the_motion_of_a_stream_recovers_its_points() {
    const EXACT: f64 = 1e-7;
    let intervals = vec![0.08, 0.05, 0.06, 0.09, 0.07, 0.05, 0.1];
    let point = |i: usize| std::array::from_fn(|j| (0.5 * i as f64 + j as f64).sin());
    let own = Stream::new(point(0), (1..=intervals.len()).map(point).collect(), intervals.clone())
        .unwrap();
    let reference = Reference::sample(own.duration(), 20_000, |t| {
        let (q, qd, _) = own.eval(t);
        (q, qd)
    })
    .unwrap();
    let fit = fitted(fit_stream(&reference, intervals, &FREE, &LEVER).unwrap());
    for (got, wanted) in fit.stream.points().iter().zip(own.points()) {
        for j in 0..DOF {
            assert!((got[j] - wanted[j]).abs() < EXACT, "{got:?} {wanted:?}");
        }
    }
    assert!(fit.deviation < EXACT && fit.lag < EXACT);
}

#[test]
fn ends_and_resting_joints_are_exact() {
    let reference = smooth(1.0);
    for n in [1, 2, 3, 20] {
        let fit = fitted(fit_stream(&reference, vec![1.0 / n as f64; n], &FREE, &LEVER).unwrap());
        assert_eq!(fit.stream.start(), reference.start());
        assert_eq!(fit.stream.end(), reference.end());
        assert!(fit.stream.points().iter().all(|p| p[3..] == reference.start()[3..]));
    }
}

#[test]
fn the_error_falls_with_the_third_power_of_the_spacing() {
    let errors = [10, 20, 40].map(|n| {
        let intervals = vec![1.0 / f64::from(n); n as usize];
        let fit = fitted(fit_stream(&smooth(1.0), intervals, &FREE, &LEVER).unwrap());
        fit.lag.max(fit.deviation)
    });
    for pair in errors.windows(2) {
        assert!(pair[0] / pair[1] > 5.0, "{errors:?}");
    }
    assert!(errors[2] < 1e-4);
}

#[test]
fn limits_are_kept_or_the_time_is_refused() {
    let reference = smooth(0.6);
    let intervals = || vec![0.05; 12];
    let free = fitted(fit_stream(&reference, intervals(), &FREE, &LEVER).unwrap()).stream;
    let scaled = |share: f64| StreamLimits {
        velocity: free.max_velocity().map(|v| v.max(1e-3) * share),
        acceleration: free.max_acceleration().map(|a| a.max(1e-3) * share),
        jerk: free.max_jerk().map(|j| j.max(1e-3) * share),
    };
    // Slightly lower limits are possible with another timing.
    let tight = scaled(0.97);
    assert!(tight.worst_ratio(&free) > 1.02);
    let fit = fitted(fit_stream(&reference, intervals(), &tight, &LEVER).unwrap());
    assert!(tight.worst_ratio(&fit.stream) <= 1.0);
    assert!(fit.lag > 1e-3 && fit.deviation < 0.3 * fit.lag, "{} {}", fit.lag, fit.deviation);
    // Half of the limits is possible only with the computed stretch.
    let impossible = scaled(0.5);
    let refused = fit_stream(&reference, intervals(), &impossible, &LEVER).unwrap();
    let StreamFit::TooFast { stretch } = refused else { panic!("{refused:?}") };
    let slower = intervals().iter().map(|d| d * stretch * 1.0001).collect();
    fitted(fit_stream(&reference, slower, &impossible, &LEVER).unwrap());
    let faster = intervals().iter().map(|d| d * 0.5 * (1.0 + stretch)).collect();
    let refused = fit_stream(&reference, faster, &scaled(0.4), &LEVER).unwrap();
    assert!(matches!(refused, StreamFit::TooFast { .. }));
}

#[test]
fn a_single_point_that_breaks_a_limit_is_refused() {
    let limits = StreamLimits { velocity: [0.1; DOF], ..FREE };
    let refused = fit_stream(&smooth(1.0), vec![1.0], &limits, &LEVER).unwrap();
    let StreamFit::TooFast { stretch } = refused else { panic!("{refused:?}") };
    // Equal acceleration and deceleration: twice the mean speed of 1 rad/s.
    assert!((stretch - 20.0).abs() < 1e-9);
}

#[test]
fn intervals_follow_the_third_derivative() {
    let spacing = Spacing { shortest: 0.02, tolerance: 1e-4, ..Spacing::default() };
    // At rest except for a quick move in the middle third.
    let quick = smooth(1.0);
    let still = |q: &Joints| (*q, [0.0; DOF]);
    let reference = Reference::sample(3.0, 6000, |t| match t {
        t if t < 1.0 => still(quick.start()),
        t if t > 2.0 => still(quick.end()),
        t => quick.at(t - 1.0),
    })
    .unwrap();
    for duration in [3.0, 1.7, 0.3, 0.05, 0.02, 0.01] {
        let intervals = adaptive_intervals(&reference, duration, &spacing);
        let sum: f64 = intervals.iter().sum();
        assert!((sum - duration).abs() < 1e-12);
        let least = intervals.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(least >= spacing.shortest.min(duration) * (1.0 - 1e-9), "{duration}: {least}");
        for pair in intervals.windows(2) {
            assert!(pair[0] / pair[1] < 2.0 && pair[1] / pair[0] < 2.0, "{intervals:?}");
        }
    }
    let unbounded = Spacing { shortest: 0.0, ..spacing };
    assert!(adaptive_intervals(&reference, 3.0, &unbounded).len() < 200);
    let adaptive = adaptive_intervals(&reference, 3.0, &spacing);
    let n = adaptive.len();
    let uniform = vec![3.0 / n as f64; n];
    let [adaptive, uniform] = [adaptive, uniform].map(|intervals| {
        let fit = fitted(fit_stream(&reference, intervals, &FREE, &LEVER).unwrap());
        fit.lag.max(fit.deviation)
    });
    assert!(adaptive < 0.5 * uniform, "{n}: {adaptive} {uniform}");
    assert!(adaptive < 6.0 * spacing.tolerance, "{adaptive}");
}

#[test]
fn the_adaptive_spacing_meets_its_tolerance() {
    let reference = smooth(1.0);
    for tolerance in [1e-3, 1e-4, 1e-5] {
        let spacing = Spacing { shortest: 0.02, tolerance, ..Spacing::default() };
        let intervals = adaptive_intervals(&reference, 1.0, &spacing);
        let fit = fitted(fit_stream(&reference, intervals, &FREE, &LEVER).unwrap());
        let error = fit.lag.max(fit.deviation);
        assert!(error < 2.0 * tolerance && error > 0.5 * tolerance, "{tolerance}: {error}");
    }
}

#[test]
fn the_polygon_of_the_points_keeps_the_requested_distance() {
    // Two joints on a quarter circle: the polygon lies outside it.
    let circle = |t: f64| {
        let (angle, speed) = (t - (TAU * t).sin() / TAU, 1.0 - (TAU * t).cos());
        let (q, qd) = (angle * FRAC_PI_2, speed * FRAC_PI_2);
        let joints = |a: f64, b: f64| std::array::from_fn(|j| [a, b, 0.0, 0.0, 0.0, 0.0][j]);
        (joints(q.cos(), q.sin()), joints(-q.sin() * qd, q.cos() * qd))
    };
    let reference = Reference::sample(1.0, 2000, circle).unwrap();
    let farthest = |polygon: f64| {
        let spacing = Spacing { polygon, tolerance: 1.0, ..Spacing::default() };
        let intervals = adaptive_intervals(&reference, 1.0, &spacing);
        let fit = fitted(fit_stream(&reference, intervals, &FREE, &LEVER).unwrap());
        let off = |edge: Piece| {
            (0..=10)
                .map(|k| edge.at(f64::from(k) / 10.0).0)
                .map(|q| (q[0].hypot(q[1]) - 1.0).abs())
                .fold(0.0, f64::max)
        };
        (fit.stream.intervals().len(), fit.stream.polygon().map(off).fold(0.0, f64::max))
    };
    let (loose, unasked) = farthest(f64::INFINITY);
    for polygon in [1e-2, 5e-3, 2e-3] {
        let (points, found) = farthest(polygon);
        assert!(points > loose && found < unasked, "{polygon}: {points} {found} {unasked}");
        assert!(found < 1.5 * polygon, "{polygon}: {points} points, {found}");
    }
}

/// Limits of the arm's streams; the jerk limit permits full acceleration after 50 ms.
fn arm_limits() -> StreamLimits {
    StreamLimits {
        velocity: arm::VELOCITY,
        acceleration: *arm::limits().acceleration(),
        jerk: arm::limits().acceleration().map(|a| 20.0 * a),
    }
}

/// The whole chain for a random path: the energies of the fastest and the best profile, the
/// reference and the fitted stream.
fn pipeline(seed: u64, factor: f64, model: &EnergyModel) -> (f64, f64, Reference, Stream) {
    let limits = arm::limits();
    let path = arm::Path::random(seed);
    let grid = arm::grid(&path, 60, 1.0);
    let fastest = time_optimal(&grid, &limits).into_profile().unwrap();
    let time = factor * fastest.duration();
    let best = arm::least_energy(&grid, &limits, model, &fastest, time).into_optimum().unwrap();
    let reference = motion(&path, &best.profile);
    let spacing = Spacing { tolerance: 5e-4, ..Spacing::default() };
    let intervals = adaptive_intervals(&reference, time, &spacing);
    let fit = fit_stream(&reference, intervals, &arm_limits(), &LEVER).unwrap();
    let spent = evaluate(&grid, &fastest, model).total();
    (spent, best.energy.total(), reference, fitted(fit).stream)
}

const BUS: EnergyModel = EnergyModel {
    work: 1.0,
    speed: 0.0,
    loss: arm::LOSS,
    base_w: 0.0,
    sharing: Sharing::Bus,
    regeneration: 0.0,
};

#[test]
fn polished_streams_realise_most_of_the_predicted_saving() {
    const CORRIDOR: PathPenalty = PathPenalty { tolerance: 1e-3, lever: LEVER };
    let mut shares = Vec::new();
    for seed in 0..10 {
        let (spent, promised, reference, fit) = pipeline(seed, 1.1, &BUS);
        let arm = arm::SyntheticArm;
        let polished =
            polish_stream(&fit, &reference, &arm, &arm_limits(), &BUS, &CORRIDOR, Until::Least)
                .unwrap();
        let stream = &polished.stream;
        assert_eq!((stream.start(), stream.end()), (fit.start(), fit.end()));
        assert_eq!(stream.intervals(), fit.intervals());
        assert!(arm_limits().worst_ratio(stream) <= 1.0);
        assert!(polished.deviation < 5.0 * CORRIDOR.tolerance, "{seed}: {}", polished.deviation);
        for step in 0..3000 {
            let (q, qd, qdd) = stream.eval(stream.duration() * f64::from(step) / 3000.0);
            let torque = arm.full_torque(&q, &qd, &qdd);
            for j in 0..DOF {
                assert!(torque[j].abs() <= 1.001 * arm.torque_limit()[j], "{seed} joint {j}");
            }
        }
        let share = |energy: f64| (spent - energy) / (spent - promised);
        let before = share(realise(&fit, &arm, &BUS).energy.total());
        assert!(share(polished.realised.energy.total()) > before, "{seed}: {before}");
        shares.push(share(polished.realised.energy.total()));
    }
    shares.sort_by(f64::total_cmp);
    assert!(shares[0] > 0.85 && shares[5] > 0.92, "{shares:?}");
}

#[test]
fn a_free_path_costs_less() {
    for seed in 0..4 {
        let (_, _, reference, fit) = pipeline(seed, 1.2, &BUS);
        let [bound, free] = [1e-3, f64::INFINITY].map(|tolerance| {
            let corridor = PathPenalty { tolerance, lever: LEVER };
            let arm = arm::SyntheticArm;
            polish_stream(&fit, &reference, &arm, &arm_limits(), &BUS, &corridor, Until::Least)
                .unwrap()
        });
        assert!(
            free.realised.energy.total() < 0.99 * bound.realised.energy.total(),
            "{} {}",
            free.realised.energy.total(),
            bound.realised.energy.total()
        );
        assert!(free.deviation > 10.0 * bound.deviation);
        assert!(free.realised.worst_share <= 1.0 && arm_limits().worst_ratio(&free.stream) <= 1.0);
    }
}

/// One joint with inertia only, and an upper speed limit.
struct Flywheel {
    inertia: f64,
    ceiling: f64,
}

impl Plant for Flywheel {
    fn torque(&self, _q: &Joints, _qd: &Joints, qdd: &Joints) -> Joints {
        qdd.map(|a| self.inertia * a)
    }

    fn dry_friction(&self) -> Joints {
        [0.0; DOF]
    }

    fn torque_limit(&self) -> Joints {
        [1e3; DOF]
    }

    fn path_shares(&self, _q: &Joints, qd: &Joints, _place: &mut usize) -> PathShares {
        [qd[0].abs() / self.ceiling, 0.0, 0.0, 0.0]
    }

    fn path_derivatives(&self, _q: &Joints, qd: &Joints, _place: usize) -> PathDerivatives {
        let mut slopes = PathDerivatives::default();
        slopes[0][1][0] = qd[0].signum() / self.ceiling;
        slopes
    }
}

#[test]
fn copper_losses_alone_give_a_stream_with_parabolic_speed() {
    // The spline has n free speeds: its error of 12 k m² L²/T³ is O(1/n²).
    const SPLINE: f64 = 0.01;
    let (length, time, m, k) = (1.7, 1.3, 3.0, 0.02);
    // A poor start: a third of acceleration, of constant speed and of deceleration.
    let reference = Reference::sample(time, 3000, |t| {
        let x = 3.0 * t / time;
        let ramp = |x: f64| 0.5 * x * x;
        let share = match x {
            x if x < 1.0 => ramp(x),
            x if x < 2.0 => x - 0.5,
            x => 2.0 - ramp(3.0 - x),
        };
        let slope = x.min(1.0).min(3.0 - x);
        let along = |a: f64| {
            let mut q = [0.0; DOF];
            q[0] = a;
            q
        };
        (along(0.5 * length * share), along(1.5 * length / time * slope))
    })
    .unwrap();
    let fit = fitted(fit_stream(&reference, vec![time / 20.0; 20], &FREE, &LEVER).unwrap()).stream;
    let model = EnergyModel {
        work: 1.0,
        speed: 0.0,
        loss: [k; DOF],
        base_w: 0.0,
        sharing: Sharing::Bus,
        regeneration: 1.0,
    };
    let corridor = PathPenalty { tolerance: 1e-3, lever: LEVER };
    let polish = |ceiling: f64| {
        let plant = Flywheel { inertia: m, ceiling };
        polish_stream(&fit, &reference, &plant, &FREE, &model, &corridor, Until::Least).unwrap()
    };
    let energy = 12.0 * k * m * m * length * length / time.powi(3);
    let first = realise(&fit, &Flywheel { inertia: m, ceiling: 1e3 }, &model).energy.total();
    assert!(first > 1.1 * energy);
    let free = polish(1e3);
    assert!(
        (free.realised.energy.total() / energy - 1.0).abs() < SPLINE,
        "{} {energy}",
        free.realised.energy.total()
    );
    assert!(free.stream.max_velocity()[0] > 1.4 * length / time);
    // An upper speed limit is kept and costs energy.
    let ceiling = 1.35 * length / time;
    let slow = polish(ceiling);
    assert!(slow.stream.max_velocity()[0] <= ceiling);
    assert!(
        slow.realised.energy.total() > free.realised.energy.total()
            && slow.realised.energy.total() < first
    );
    // One below the mean speed cannot be kept in this time, and polishing gives up.
    let hopeless = polish(0.8 * length / time);
    assert_eq!(hopeless.status, PolishStatus::Stopped);
    assert!(hopeless.realised.worst_share > 1.0);
}
