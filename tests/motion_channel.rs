//! The motion channel: runs of a program by a small planner of this test, against a baseline.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

use joulepath::gap::{Run, RunFound, diagnose_runs};

/// Targets \[rad\], whether the robot stops there, and the wait there \[s\].
const PROGRAM: [([f64; 3], bool, f64); 8] = [
    ([0.9, -0.3, 0.4], true, 0.3),
    ([1.1, 0.1, 0.3], false, 0.0),
    ([0.2, 0.8, -0.5], false, 0.0),
    ([-0.6, 0.2, 0.6], true, 0.0),
    ([-0.5, 0.3, 0.5], true, 0.1),
    ([-0.9, -0.7, -0.4], false, 0.0),
    ([0.3, -0.4, -0.9], true, 0.4),
    ([0.0, 0.0, 0.0], true, 0.2),
];

/// A robot that moves all joints together by trapezoids of speed, and cuts corners by beginning a
/// movement before the end of the last one.
#[derive(Clone)]
struct Robot {
    /// Largest speed of a joint \[rad/s\], of each movement.
    speed: [f64; 8],
    /// Largest acceleration \[rad/s²\].
    acceleration: f64,
    /// Share of a ramp by which movements overlap at a corner \[1\].
    overlap: f64,
    /// Lateness \[s\].
    lag: f64,
    /// Added waits \[s\].
    waits: [f64; 8],
}

const HEALTHY: Robot = Robot {
    speed: [1.6, 1.6, 1.2, 1.6, 1.6, 1.2, 1.6, 0.8],
    acceleration: 6.0,
    overlap: 0.6,
    lag: 0.0,
    waits: [0.0; 8],
};

/// How a log is recorded.
#[derive(Clone, Copy)]
struct Recorder {
    /// Interval of the rows \[s\].
    step: f64,
    /// Standard deviation of a position \[rad\].
    noise: f64,
    /// Seed of noise and jitter.
    seed: u64,
}

const BEFORE: Recorder = Recorder { step: 0.01, noise: 3e-5, seed: 1 };
const NOW: Recorder = Recorder { step: 0.008, noise: 3e-5, seed: 2 };
const HELD: Recorder = Recorder { step: 0.008, noise: 3e-5, seed: 3 };
const CYCLES: usize = 4;

/// Uniform numbers between −1 and 1 (Knuth's linear congruential generator).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A sum of twelve uniform numbers has twice the deviation of a standard normal one.
    fn normal(&mut self) -> f64 {
        0.5 * (0..12).map(|_| self.next()).sum::<f64>()
    }
}

/// A movement: number, beginning \[s\], from where, by how much \[rad\], speed \[rad/s\].
struct Leg {
    number: usize,
    start: f64,
    command: f64,
    by: [f64; 3],
    way: f64,
    speed: f64,
}

impl Robot {
    /// Duration of a leg and of its ramp \[s\].
    fn times(&self, leg: &Leg) -> (f64, f64) {
        let ramp = (leg.speed / self.acceleration).min((leg.way / self.acceleration).sqrt());
        (ramp + leg.way / (ramp * self.acceleration), ramp)
    }

    /// Share of a leg's way at a time after its beginning.
    fn share(&self, leg: &Leg, t: f64) -> f64 {
        let (whole, ramp) = self.times(leg);
        let t = t.clamp(0.0, whole);
        let up = |t: f64| 0.5 * self.acceleration * t * t;
        let gone = if t < ramp {
            up(t)
        } else if t > whole - ramp {
            leg.way - up(whole - t)
        } else {
            up(ramp) + ramp * self.acceleration * (t - ramp)
        };
        gone / leg.way
    }

    /// The legs of some cycles, and the end \[s\]. Every stop takes some ms more or less.
    fn legs(&self, random: &mut Random) -> (Vec<Leg>, f64) {
        let (mut legs, mut t, mut at) = (Vec::new(), 0.35, [0.0; 3]);
        for _ in 0..CYCLES {
            let mut overlap = 0.0;
            for (k, (target, stops, wait)) in PROGRAM.iter().enumerate() {
                let mut by = *target;
                by.iter_mut().zip(at).for_each(|(by, at)| *by -= at);
                let way = by.iter().fold(0.0_f64, |most, by| most.max(by.abs()));
                let start = t - overlap;
                let command = t - 0.5 * overlap;
                let leg = Leg { number: k + 1, start, command, by, way, speed: self.speed[k] };
                let (whole, ramp) = self.times(&leg);
                t = start + whole;
                overlap = if *stops { 0.0 } else { self.overlap * ramp };
                if *stops {
                    t += wait + self.waits[k] + 0.001 * random.next();
                }
                at = *target;
                legs.push(leg);
            }
        }
        (legs, t)
    }

    fn log(&self, recorder: Recorder) -> Run {
        let mut random = Random(recorder.seed);
        let (legs, end) = self.legs(&mut random);
        let mut run = Run { t: Vec::new(), q: vec![Vec::new(); 3], command: Vec::new() };
        // The log ends within a cycle.
        for row in 0..((end - 0.5) / recorder.step) as usize {
            let t = recorder.step * (row as f64 + 0.05 * random.next());
            run.t.push(t);
            let begun = legs.iter().take_while(|leg| leg.command <= t).last();
            run.command.push(begun.map_or(0, |leg| leg.number));
            for joint in 0..3 {
                let way = |leg: &Leg| leg.by[joint] * self.share(leg, t - self.lag - leg.start);
                let q = legs.iter().map(way).sum::<f64>() + recorder.noise * random.normal();
                run.q[joint].push((q * 1e5).round() / 1e5);
            }
        }
        run
    }
}

/// What is found of a robot that was healthy.
fn found(now: &Robot) -> RunFound {
    found_with(now, &|_| true)
}

fn found_with(now: &Robot, may: &dyn Fn(&str) -> bool) -> RunFound {
    diagnose_runs(&[HEALTHY.log(BEFORE)], &[now.log(NOW)], &[now.log(HELD)], may).unwrap()
}

/// The only effect: its id, class, value and movement.
fn only(found: &RunFound) -> (&'static str, Vec<&'static str>, f64, Option<usize>) {
    assert!(!found.is_unknown);
    let ids: Vec<_> = found.effects.iter().map(|of| of.effect.id).collect();
    assert_eq!(ids.len(), 1, "{ids:?}");
    let of = &found.effects[0];
    (of.effect.id, of.class.clone(), of.parameters[0].value, of.movement)
}

#[test]
fn a_robot_that_repeats_its_baseline_has_no_gap() {
    for seed in 2..8 {
        let now = HEALTHY.log(Recorder { seed, ..NOW });
        let found = diagnose_runs(&[HEALTHY.log(BEFORE)], &[now], &[], &|_| true).unwrap();
        assert!(found.effects.is_empty() && !found.is_unknown, "seed {seed}");
    }
}

#[test]
fn a_lag_is_found_with_its_size() {
    let (id, class, lag, _) = only(&found(&Robot { lag: 0.012, ..HEALTHY }));
    assert_eq!((id, class), ("tracking_lag", vec!["tracking_lag"]));
    assert!((lag - 0.012).abs() < 0.0015, "{lag}");
}

#[test]
fn a_wait_is_found_with_its_movement() {
    let mut waits = [0.0; 8];
    waits[4] = 0.07;
    let now = Robot { waits, ..HEALTHY };
    let found = found(&now);
    let (id, _, wait, movement) = only(&found);
    assert_eq!((id, movement), ("program_wait", Some(5)));
    assert!((wait - 0.07).abs() < 0.008, "{wait}");
    // What the logs show is also there in the held-out one.
    let [_, before, after] = found.gap;
    assert!(before > 0.015 && after < 0.2 * before, "{before} {after}");
}

#[test]
fn a_limit_of_the_acceleration_is_found_with_its_size() {
    for factor in [0.7, 1.3] {
        let now = Robot { acceleration: factor * HEALTHY.acceleration, ..HEALTHY };
        let (id, class, value, _) = only(&found(&now));
        assert_eq!((id, class), ("acceleration_limit", vec!["acceleration_limit"]));
        assert!((value / factor - 1.0).abs() < 0.06, "{value}");
    }
}

#[test]
fn a_limit_of_the_speed_is_found_with_its_size() {
    let now = Robot { speed: HEALTHY.speed.map(|speed| 0.8 * speed), ..HEALTHY };
    let (id, _, value, _) = only(&found(&now));
    assert_eq!(id, "speed_limit");
    assert!((value - 0.8).abs() < 0.03, "{value}");
    // A cap reaches fast movements only.
    let now = Robot { speed: HEALTHY.speed.map(|speed| speed.min(1.3)), ..HEALTHY };
    assert_eq!(only(&found(&now)).0, "speed_limit");
}

#[test]
fn corners_that_are_cut_less_or_more_are_found() {
    for overlap in [0.2, 0.9] {
        let (id, _, factor, _) = only(&found(&Robot { overlap, ..HEALTHY }));
        assert_eq!(id, "zone_blending");
        assert_eq!(factor < 1.0, overlap < HEALTHY.overlap, "{factor}");
    }
}

#[test]
fn movements_that_change_by_no_law_are_unknown() {
    let factors = [0.85, 1.2, 0.9, 1.15, 0.8, 1.25, 0.75, 1.1];
    let mut speed = HEALTHY.speed;
    speed.iter_mut().zip(factors).for_each(|(speed, factor)| *speed *= factor);
    let found = found(&Robot { speed, ..HEALTHY });
    assert!(found.is_unknown && found.effects.is_empty());
}

#[test]
fn what_may_not_be_named_is_not() {
    let now = Robot { acceleration: 0.6 * HEALTHY.acceleration, ..HEALTHY };
    let found = found_with(&now, &|id| id == "tracking_lag" || id == "program_wait");
    assert!(found.is_unknown && found.effects.is_empty());
}

#[test]
fn a_wait_beside_a_lag_is_found_with_it() {
    let mut waits = [0.0; 8];
    waits[0] = 0.3;
    let found = found(&Robot { waits, lag: 0.02, ..HEALTHY });
    let mut ids: Vec<_> = found.effects.iter().map(|of| of.effect.id).collect();
    ids.sort_unstable();
    assert_eq!(ids, ["program_wait", "tracking_lag"]);
}

/// Movements without a plateau that all take longer by the same factor are as slow by either limit.
#[test]
fn time_that_is_stretched_is_told_as_a_class() {
    let mut run = Robot { speed: [9.0; 8], overlap: 0.0, ..HEALTHY }.log(BEFORE);
    let before = run.clone();
    run.t.iter_mut().for_each(|t| *t *= 1.12);
    let found = diagnose_runs(&[before], &[run], &[], &|_| true).unwrap();
    let mut class = only(&found).1;
    class.sort_unstable();
    assert_eq!(class, ["acceleration_limit", "speed_limit"]);
    assert!(found.is_ambiguous());
}

#[test]
fn runs_of_another_program_are_not_compared() {
    let mut other = HEALTHY.log(NOW);
    other.command.iter_mut().filter(|number| **number > 0).for_each(|number| *number += 50);
    assert!(diagnose_runs(&[HEALTHY.log(BEFORE)], &[other], &[], &|_| true).is_none());
}
