//! Populations of lengths.

use super::recorder::Chance;
use crate::tool::cell::waits::populations::populations;

#[test]
fn a_door_that_is_open_already_has_its_share() {
    let mut chance = Chance::new(1);
    let lengths: Vec<f64> =
        (0..300).map(|i| if i % 3 == 0 { 0.01 } else { 3.0 * chance.normal(0.1).exp() }).collect();
    let [ready, waited] = populations(&lengths)[..] else { panic!("two") };
    assert!((ready.share - 1.0 / 3.0).abs() < 1e-9 && ready.median_s == 0.0);
    assert!((waited.median_s - 3.0).abs() < 0.1);
}

#[test]
fn two_kinds_of_parts_are_two_populations_and_one_is_one() {
    let mut two = 0;
    let mut one = 0;
    for seed in 0..20 {
        let mut chance = Chance::new(seed);
        let mut drawn = |share: f64| -> Vec<f64> {
            let of = |chance: &mut Chance| {
                let middle = if chance.is(share) { 9.0 } else { 4.0 };
                middle * chance.normal(0.15).exp()
            };
            (0..200).map(|_| of(&mut chance)).collect()
        };
        two += usize::from(populations(&drawn(0.4)).len() == 2);
        one += usize::from(populations(&drawn(0.0)).len() == 1);
    }
    assert!(two == 20 && one >= 19, "{two} {one}");
}
