//! How well a further motion tells explanations apart.

use joulepath::arm::effects::find as effect;
use joulepath::gap::{Calibration, Record, Settings, Trust, Tunables, diagnose};
use joulepath::learn::identify::Samples;

use super::excited::{irb1600, series};
use super::simulated::{Robot, perturbed};

/// Factor within which the promised nats are those that the motion gives: sizes of everyday errors are
/// found anew.
const AS_PROMISED: f64 = 1.6;
/// Seed of the further motion, its rows, their interval \[s\] and its repetitions.
const NEXT: u64 = 5;
const ROWS: usize = 1000;
const STEP: f64 = 0.01;
const REPETITIONS: usize = 7;
/// Share of a motion's amplitude with which friction over the speed hardly shows.
const SMALL: f64 = 0.2;

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
    let [first, held, next] = [1, 3, NEXT].map(|seed| robot.samples(seed));
    let by = |log: &Samples| {
        diagnose(&nominal, Record::all(&nominal, log), &Record::all(&nominal, &held), &settings)
    };
    let known = by(&first);
    let rivals = known.rivals.as_ref().unwrap();
    let names: Vec<usize> = rivals.all.iter().map(|of| of.effects.len()).collect();
    assert_eq!(names, [1, 0]);
    let motion = series(NEXT);
    let promised = rivals.separation(&motion.sampled(ROWS), STEP, REPETITIONS);
    let given = by(&next).rivals.unwrap().all[0].score;
    let ratio = promised.between(0, 1) / given;
    assert!((1.0 / AS_PROMISED..AS_PROMISED).contains(&ratio), "{ratio} of {given}");
    assert_eq!(promised.nearest(0), Some(1));
    assert_eq!(promised.most[0][1].0, 1);
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
