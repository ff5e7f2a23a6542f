//! With a baseline, what differs from it is a finding, and what it has is none.

use joulepath::arm::effects::{ALL, Effect, find as effect};
use joulepath::arm::robot::Model;
use joulepath::gap::{Diagnosis, Logs, Settings, Trust, Tunables, Verdict, diagnose_logs};

use super::excited::irb1600;
use super::named;
use super::simulated::{Robot, perturbed};

/// Effects with their joints, from 0, and their coordinates.
type Effects<'a> = &'a [(&'static Effect, usize, &'a [f64])];

/// A robot whose baseline was another one; both have little noise.
fn since(before: (&Model, Effects<'_>), now: (&Model, Effects<'_>)) -> Diagnosis {
    let nominal = irb1600();
    let logged = |(model, effects): (&Model, Effects<'_>), seed| {
        Robot { model, effects, noise: 0.003 }.samples(seed)
    };
    let old = logged(before, 4);
    let new = [1, 2, 3].map(|seed| logged(now, seed));
    let settings = Settings {
        trust: Trust::Commissioned,
        effects: ALL.iter().collect(),
        tunables: Tunables::DEFAULT,
    };
    let [train, held, before] = [&[&new[0], &new[1]][..], &[&new[2]], &[&old]];
    diagnose_logs(&nominal, Logs { train, held, before }, &settings, &|_| {})
}

#[test]
fn twice_the_friction_of_the_baseline_is_a_finding() {
    let truth = perturbed(&irb1600(), 3);
    for change in [
        |model: &mut Model| model.friction.coulomb[2] *= 2.0,
        |model: &mut Model| {
            model.friction.viscous[2] *= 2.0;
        },
    ] {
        let mut other = truth.clone();
        change(&mut other);
        let found = since((&truth, &[]), (&other, &[]));
        let [asserted] = &found.effects[..] else { panic!("{:?}", named(&found)) };
        assert_eq!(asserted.joints, [2]);
        let class = &asserted.class;
        assert!(asserted.effect.id == "friction_level" || class.contains(&"friction_level"));
    }
}

#[test]
fn a_ripple_of_the_baseline_is_no_finding() {
    let truth = perturbed(&irb1600(), 3);
    let ripple = effect("ripple").unwrap();
    let effects: Effects<'_> = &[(ripple, 2, &[2.0, 0.0, 20.0]), (ripple, 1, &[3.0, 1.0, 20.0])];
    let found = since((&truth, effects), (&truth, effects));
    assert!(found.before.iter().any(|of| of.effect.id == "ripple"), "the robot has it");
    assert!(named(&found).is_empty(), "{:?}", named(&found));
    let found = since((&truth, &[]), (&truth, effects));
    let [asserted] = &found.effects[..] else { panic!("{:?}", named(&found)) };
    assert_eq!(asserted.effect.id, "ripple", "it is seen where the baseline lacks it");
}

#[test]
fn a_link_that_became_heavier_is_another_parameter() {
    let truth = perturbed(&irb1600(), 3);
    let mut other = truth.clone();
    other.links[2].mass *= 1.3;
    let found = since((&truth, &[]), (&other, &[]));
    assert!(named(&found).is_empty(), "{:?}", named(&found));
    assert_eq!(found.verdict, Verdict::ParametersOnly);
    let same = since((&truth, &[]), (&truth, &[]));
    assert_eq!(same.verdict, Verdict::NoGap);
}
