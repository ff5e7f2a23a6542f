//! Rates of the intervals over simulated campaigns. `examples/prove_coverage.rs` has more of them, from logs.

use super::estimate::{Point, Prior, estimate};
use super::interval::uncertainty;
use super::mixture::swapped;

/// Campaigns of a rate.
const CAMPAIGNS: u64 = 200;
/// W, and the scatter of a cycle.
const STANDING: f64 = 300.0;
const SCATTER: f64 = 0.03;

fn normal(random: &mut fastrand::Rng) -> f64 {
    (0..12).map(|_| random.f64()).sum::<f64>() - 6.0
}

/// A side: two kinds of cycles in changing shares, waits, warmth and memory.
fn side(
    random: &mut fastrand::Rng,
    factor: f64,
    heavy: f64,
    wait: f64,
    degrees: f64,
) -> Vec<Point> {
    let mut last = normal(random);
    let point = |i: i32| {
        last = 0.3 * last + 0.954 * normal(random);
        let stratum = usize::from(random.f64() < heavy);
        let rest = -wait * (1.0 - random.f64()).ln();
        let temperature = degrees + 3.0 * random.f64() + 0.05 * f64::from(i);
        let work = [6000.0, 7500.0][stratum] * factor * (1.0 + SCATTER * last);
        Point {
            stratum,
            energy: work + STANDING * rest - 12.0 * (temperature - 30.0),
            duration: 8.0 + rest,
            motion: 8.0,
            waiting: rest,
            temperature,
        }
    };
    (0..30).map(point).collect()
}

/// Intervals that hold, and intervals above 0.
fn rates(saving: f64) -> (u64, u64) {
    let prior = Prior { mean: STANDING, sd: 0.2 * STANDING };
    let (mut holds, mut above) = (0, 0);
    for seed in 0..CAMPAIGNS {
        let mut random = fastrand::Rng::with_seed(seed);
        let before = side(&mut random, 1.0, 0.3, 0.5, 28.0);
        let after = side(&mut random, 1.0 - saving, 0.6, 1.0, 29.0);
        let sides = [before.as_slice(), after.as_slice()];
        let of = estimate(sides, 2, prior).expect("common strata");
        let [low, high] = uncertainty(sides, 2, prior, &of).interval;
        // The saving is of the work; the mean cycle before has waits and warmth, too.
        let work: f64 = of.weights.iter().zip([6000.0, 7500.0]).map(|(w, j)| w * j).sum();
        let truth = saving * work / of.energy[0];
        holds += u64::from(low <= truth && truth <= high);
        above += u64::from(low > 0.0);
    }
    (holds, above)
}

#[test]
fn intervals_hold_and_nothing_is_rarely_a_saving() {
    let (holds, above) = rates(0.0);
    assert!(above <= 5, "{above} of {CAMPAIGNS} without a saving say that there is one");
    assert!(holds >= 186, "{holds} of {CAMPAIGNS} hold 0");
    let (holds, above) = rates(0.05);
    assert!(holds >= 186, "{holds} of {CAMPAIGNS} hold 5 %");
    assert!(above >= 170, "{above} of {CAMPAIGNS} show 5 %");
}

#[test]
fn swapped_cycles_are_noticed() {
    let mut random = fastrand::Rng::with_seed(1);
    let prior = Prior { mean: STANDING, sd: 0.2 * STANDING };
    let mut noticed = [0, 0];
    for _ in 0..20 {
        let mut before = side(&mut random, 1.0, 0.0, 0.5, 29.0);
        let mut after = side(&mut random, 0.85, 0.0, 0.5, 29.0);
        for is_swapped in 0..2 {
            if is_swapped == 1 {
                (0..6).for_each(|i| std::mem::swap(&mut before[4 * i], &mut after[3 * i]));
            }
            let of = estimate([&before, &after], 1, prior).expect("common strata");
            let doubt = swapped(&of);
            noticed[is_swapped] += usize::from(doubt.is_some());
            // The interval is moved away from 0 only.
            assert!(doubt.is_none_or(|doubt| doubt.widens[0] == 0.0));
        }
    }
    assert!(noticed[0] <= 4 && noticed[1] == 20, "{noticed:?}");
}
