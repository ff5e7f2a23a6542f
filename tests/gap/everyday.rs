//! What any robot has takes no place of a finding; waves may have any order.

use joulepath::arm::effects::find as effect;

use super::excited::irb1600;
use super::simulated::{Robot, perturbed};
use super::{diagnosed, named};

/// An order that is no multiple of a motor's turn, and how well it is told \[1/rad\].
const ORDER: f64 = 17.3;
const TOLD: f64 = 0.05;
/// Stated deviations within which the order lies.
const WITHIN: f64 = 3.0;
/// Amplitude of the wave \[Nm\], and its relative tolerance.
const AMPLITUDE: f64 = 6.0;
const TOLERANCE: f64 = 0.05;
/// Angle in which friction builds up after a reversal \[rad\].
const BUILD_UP: f64 = 5e-4;

#[test]
fn waves_of_any_order_are_found() {
    let nominal = irb1600();
    let truth = perturbed(&nominal, 3);
    let ripple = effect("ripple").unwrap();
    let effects: [(_, usize, &[f64]); 1] = [(ripple, 2, &[AMPLITUDE, 0.0, ORDER])];
    let found = diagnosed(&nominal, &Robot { model: &truth, effects: &effects, noise: 0.005 });
    assert_eq!(named(&found), [("ripple", vec![3])]);
    let [amplitude, _, order] = &found.effects[0].parameters[..] else { unreachable!() };
    assert!((order.value - ORDER).abs() < TOLD, "{order:?}");
    assert!((order.value - ORDER).abs() < WITHIN * order.sd && order.sd < TOLD, "{order:?}");
    assert!((amplitude.value / AMPLITUDE - 1.0).abs() < TOLERANCE, "{amplitude:?}");
}

#[test]
fn everyday_friction_hides_no_effect() {
    let nominal = irb1600();
    let truth = perturbed(&nominal, 3);
    let [spring, build_up] = ["gravity_spring", "presliding"].map(|id| effect(id).unwrap());
    let slides: &[f64] = &[BUILD_UP];
    let effects: [(_, usize, &[f64]); 4] = [
        (build_up, 0, slides),
        (build_up, 1, slides),
        (build_up, 2, slides),
        (spring, 1, &[600.0, 100.0]),
    ];
    let found = diagnosed(&nominal, &Robot { model: &truth, effects: &effects, noise: 0.0005 });
    assert_eq!(named(&found), [("gravity_spring", vec![2])]);
}
