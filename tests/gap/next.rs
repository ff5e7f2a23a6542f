//! How well a further motion tells explanations apart.

use joulepath::arm::effects::find as effect;
use joulepath::gap::{Calibration, Record, Settings, Trust, Tunables, diagnose};
use joulepath::learn::identify::Samples;

use super::excited::{irb1600, series};
use super::simulated::{Robot, perturbed};

/// Standard deviations within which motions give what is promised. The logarithm of the ratio of two
/// Gaussian densities whose mean is m nats varies by 2m.
const SPREAD: f64 = 2.0;
/// Seeds of the further motions, their rows, the interval of these \[s\] and their repetitions.
const NEXT: [u64; 4] = [5, 6, 7, 8];
const ROWS: usize = 1000;
const STEP: f64 = 0.01;
const REPETITIONS: usize = 7;
/// Share of a motion's amplitude with which all speeds are far below that of the Stribeck curve, which is
/// dry friction there.
const SMALL: f64 = 0.01;

/// What is promised of a motion is what its log gives.
#[test]
fn motions_tell_as_much_as_is_promised() {
    let nominal = irb1600();
    let truth = perturbed(&nominal, 3);
    let stribeck = effect("stribeck").unwrap();
    let robot = Robot { model: &truth, effects: &[(stribeck, 1, &[12.0, 0.1])], noise: 0.005 };
    let settings = Settings {
        trust: Trust::Commissioned,
        effects: vec![stribeck],
        tunables: Tunables::DEFAULT,
    };
    let [first, held] = [1, 3].map(|seed| robot.samples(seed));
    let by = |log: &Samples| {
        diagnose(&nominal, Record::all(&nominal, log), &Record::all(&nominal, &held), &settings)
    };
    let known = by(&first);
    let rivals = known.rivals.as_ref().unwrap();
    let names: Vec<usize> = rivals.all.iter().map(|of| of.effects.len()).collect();
    assert_eq!(names, [1, 0]);
    let of = |seed: u64| {
        let promised = rivals.separation(&series(seed).sampled(ROWS), STEP, REPETITIONS);
        assert_eq!(promised.nearest(0), Some(1));
        assert_eq!(promised.most[0][1].0, 1);
        let given = by(&robot.samples(seed)).rivals.unwrap();
        let with = given.all.iter().find(|of| of.effects.len() == 1);
        // What is no better than no effect is no rival.
        [promised.between(0, 1), with.map_or(0.0, |of| of.score)]
    };
    let all = NEXT.map(of);
    let [promised, given] = [0, 1].map(|k| all.iter().map(|of| of[k]).sum::<f64>());
    assert!((given - promised).abs() < SPREAD * (2.0 * promised).sqrt(), "{all:?}");
    let motion = series(NEXT[0]);
    let promised = rivals.separation(&motion.sampled(ROWS), STEP, REPETITIONS);
    let small = rivals.separation(&motion.scaled(SMALL).sampled(ROWS), STEP, REPETITIONS);
    assert!(small.worth() < promised.worth());
}

/// The counts of `blind calibrate` are those of the present settings.
#[test]
fn the_calibration_is_fresh() {
    assert!(
        Calibration::used().is_fresh(),
        "src/gap/tunables.rs has changed: run joulepath blind calibrate on development cases"
    );
}
