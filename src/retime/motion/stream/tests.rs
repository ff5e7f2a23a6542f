#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

use super::*;

/// Rounding tolerance of sums of a few dozen terms of order one.
const ROUNDING: f64 = 1e-12;

/// A stream with irregular intervals; joint 2 is at rest.
fn irregular(n: usize) -> Stream {
    let wave = |i: usize, j: usize| {
        let x = i as f64;
        if j == 2 { 0.3 } else { (0.37 * x + 0.9 * j as f64).sin() + 0.05 * x }
    };
    let point = |i: usize| std::array::from_fn(|j| wave(i, j));
    let intervals = (0..n).map(|i| 0.05 + 0.03 * (i as f64 * 1.7).sin().abs()).collect();
    Stream::new(point(0), (1..=n).map(point).collect(), intervals).unwrap()
}

#[test]
fn starts_and_ends_at_rest_on_the_first_and_the_last_point() {
    for n in [1, 2, 3, 17] {
        let stream = irregular(n);
        let total = stream.duration();
        assert_eq!(stream.eval(0.0).0, *stream.start());
        assert_eq!(stream.eval(0.0).1, [0.0; DOF]);
        assert_eq!(stream.eval(total).0, stream.points()[n - 1]);
        let last = stream.pieces().next_back().unwrap();
        let (q, qd, _) = last.at(last.length);
        for j in 0..DOF {
            assert!((q[j] - stream.points()[n - 1][j]).abs() < ROUNDING);
            assert!(qd[j].abs() < ROUNDING);
        }
    }
}

#[test]
fn knots_follow_the_rule() {
    let close = |a: &[f64], b: &[f64]| {
        assert_eq!(a.len(), b.len());
        for (x, y) in a.iter().zip(b) {
            assert!((x - y).abs() < ROUNDING, "{a:?} {b:?}");
        }
    };
    let knots = |d: &[f64]| Knots::new(d).unwrap().times().to_vec();
    close(&knots(&[0.4]), &[0.0, 0.2, 0.4]);
    close(&knots(&[0.3, 0.6]), &[0.0, 0.2, 0.5, 0.9]);
    close(&knots(&[0.3, 0.2, 0.4, 0.6]), &[0.0, 0.2, 0.4, 0.7, 1.1, 1.5]);
}

#[test]
fn displacement_is_the_sum_of_velocity_times_mean_length() {
    for n in [1, 2, 9] {
        let stream = irregular(n);
        let t = stream.knots().times();
        for j in 0..DOF {
            let moved: f64 =
                (1..=n).map(|i| stream.velocities[i][j] * 0.5 * (t[i + 1] - t[i - 1])).sum();
            let wanted = stream.points()[n - 1][j] - stream.start()[j];
            assert!((moved - wanted).abs() < ROUNDING);
        }
    }
}

#[test]
fn evaluation_agrees_with_integration() {
    const STEPS: u32 = 50;
    let stream = irregular(11);
    let (mut q, mut qd) = (*stream.start(), [0.0; DOF]);
    for ends in stream.knots().times().windows(2) {
        // The midpoint rule is exact within a piece.
        let dt = (ends[1] - ends[0]) / f64::from(STEPS);
        for step in 0..STEPS {
            let middle = ends[0] + (f64::from(step) + 0.5) * dt;
            let (_, middle_qd, a) = stream.eval(middle);
            for j in 0..DOF {
                q[j] += dt * middle_qd[j];
                qd[j] += dt * a[j];
            }
            let (exact, exact_qd, _) = stream.eval(middle + 0.5 * dt);
            for j in 0..DOF {
                assert!((q[j] - exact[j]).abs() < 1e2 * ROUNDING);
                assert!((qd[j] - exact_qd[j]).abs() < 1e3 * ROUNDING);
            }
        }
    }
}

#[test]
fn weights_reproduce_the_motion() {
    for n in [1, 2, 3, 8] {
        let stream = irregular(n);
        let control: Vec<Joints> =
            std::iter::once(*stream.start()).chain(stream.points().to_vec()).collect();
        for step in 0..200 {
            let t = stream.duration() * f64::from(step) / 200.0;
            let p = stream.knots().piece_at(t);
            let w = stream.knots().weights(p, t - stream.knots().times()[p]);
            let (q, qd, qdd) = stream.eval(t);
            for j in 0..DOF {
                let sum = |weights: &[f64; 3]| -> f64 {
                    w.support.clone().zip(weights).map(|(i, x)| x * control[i][j]).sum()
                };
                assert!((sum(&w.position) - q[j]).abs() < ROUNDING);
                assert!((sum(&w.velocity) - qd[j]).abs() < 1e2 * ROUNDING);
                assert!((sum(&w.acceleration) - qdd[j]).abs() < 1e4 * ROUNDING);
            }
        }
    }
}

#[test]
fn maxima_bound_what_dense_sampling_sees() {
    const STEPS: usize = 20_000;
    let stream = irregular(13);
    let (mut v, mut a) = ([0.0f64; DOF], [0.0f64; DOF]);
    for step in 0..STEPS {
        let (_, qd, qdd) = stream.eval(stream.duration() * step as f64 / STEPS as f64);
        for j in 0..DOF {
            v[j] = v[j].max(qd[j].abs());
            a[j] = a[j].max(qdd[j].abs());
        }
    }
    let (exact_v, exact_a) = (stream.max_velocity(), stream.max_acceleration());
    for j in 0..DOF {
        assert!(v[j] <= exact_v[j] + ROUNDING && v[j] >= exact_v[j] - 0.05);
        assert!((a[j] - exact_a[j]).abs() <= 1e3 * ROUNDING);
    }
    assert_eq!(exact_v[2], 0.0);
}

#[test]
fn jerk_of_one_point_is_known() {
    // Up for d/2, down for d/2: a = 4/d², jumps 4/d² at the ends and 8/d² in the middle.
    let d = 0.5;
    let mut point = [0.0; DOF];
    point[0] = 1.0;
    let stream = Stream::new([0.0; DOF], vec![point], vec![d]).unwrap();
    assert!((stream.max_velocity()[0] - 2.0 / d).abs() < ROUNDING);
    assert!((stream.max_acceleration()[0] - 4.0 / (d * d)).abs() < ROUNDING);
    assert!((stream.max_jerk()[0] - 16.0 / (d * d * d)).abs() < 1e2 * ROUNDING);
}

#[test]
fn resting_joints_stay_exactly() {
    let stream = irregular(9);
    for step in 0..=1000 {
        let (q, qd, qdd) = stream.eval(stream.duration() * f64::from(step) / 1000.0);
        assert_eq!((q[2], qd[2], qdd[2]), (0.3, 0.0, 0.0));
    }
}

#[test]
fn wrong_input_is_refused() {
    let p = [0.0; DOF];
    let lengths = StreamError::Lengths { points: 1, intervals: 0 };
    assert_eq!(Stream::new(p, vec![], vec![]), Err(StreamError::Empty));
    assert_eq!(Stream::new(p, vec![p], vec![]), Err(lengths));
    for bad in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            Stream::new(p, vec![p, p], vec![0.1, bad]),
            Err(StreamError::Interval { index: 1, .. })
        ));
    }
    let mut nan = p;
    nan[3] = f64::NAN;
    assert_eq!(Stream::new(p, vec![p, nan], vec![0.1, 0.1]), Err(StreamError::Point { index: 2 }));
}
