//! The generalised Maxwell-slip model: parallel elements that stick or slip (F. Al-Bender,
//! V. Lampaert, J. Swevers, The generalized Maxwell-slip model, IEEE T-AC 50, 2005). Forces are over
//! Coulomb friction, so that the sum is near −1 or 1 while a joint moves.

use crate::examine::worlds::random::Rng;

/// Elements: four draw a smooth virgin curve.
pub(super) const ELEMENTS: usize = 4;
/// Shares of the force.
const SHARES: [f64; ELEMENTS] = [0.22, 0.28, 0.28, 0.22];
/// Breakaway distances of the elements over the mean one.
const DISTANCES: [f64; ELEMENTS] = [0.3, 0.7, 1.2, 2.2];

/// A bank of Maxwell elements.
#[derive(Clone, Debug)]
pub(super) struct Bank {
    /// Mean breakaway distance \[rad\].
    pub(super) distance: f64,
    /// Rate at which slip forces follow the Stribeck curve \[1/s\].
    pub(super) attraction: f64,
    /// Static friction over Coulomb friction, less 1.
    pub(super) rise: f64,
    /// Stribeck speed \[rad/s\].
    pub(super) speed: f64,
    pub(super) power: f64,
}

/// Forces and modes of the elements.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Elements {
    force: [f64; ELEMENTS],
    slips: [bool; ELEMENTS],
    forward: bool,
}

impl Bank {
    /// An everyday bank: it breaks away within a few tenths of a milliradian, and is slightly
    /// Stribeck-like. `top` is the largest speed \[rad/s\].
    pub(super) fn everyday(top: f64, rng: &mut Rng) -> Self {
        Self {
            distance: rng.log((0.000_03, 0.000_5)),
            attraction: rng.log((15.0, 150.0)),
            rise: 0.03 * rng.spread(1.0).abs(),
            speed: top * rng.log((0.01, 0.06)),
            power: rng.uniform((0.6, 1.6)),
        }
    }

    /// Friction of steady motion over Coulomb friction at a speed \[rad/s\].
    pub(super) fn steady(&self, v: f64) -> f64 {
        if self.rise == 0.0 {
            return 1.0;
        }
        let x = v.abs() / self.speed;
        // Beyond some ten Stribeck speeds nothing is left that a double would show in a log.
        if x > 12.0 { 1.0 } else { 1.0 + self.rise * (-x.powf(self.power)).exp() }
    }

    /// One step with the speeds at its ends; the sum of the forces.
    pub(super) fn step(&self, state: &mut Elements, v: (f64, f64), dt: f64) -> f64 {
        let mean = 0.5 * (v.0 + v.1);
        let steady = self.steady(mean);
        let forward = mean > 0.0;
        let turned = forward != state.forward || mean == 0.0;
        state.forward = forward;
        let side = if forward { 1.0 } else { -1.0 };
        let mut sum = 0.0;
        for i in 0..ELEMENTS {
            let limit = SHARES[i] * steady;
            if turned {
                state.slips[i] = false;
            }
            if state.slips[i] {
                // The linear rate of slip, integrated with the polynomial of the Runge-Kutta method.
                let x = -self.attraction * dt / steady;
                let left = 1.0 + x * (1.0 + x * (0.5 + x * (1.0 / 6.0 + x / 24.0)));
                state.force[i] = side * limit + (state.force[i] - side * limit) * left;
            } else {
                let stiffness = SHARES[i] / (DISTANCES[i] * self.distance);
                state.force[i] += stiffness * mean * dt;
                if state.force[i] * side >= limit {
                    state.force[i] = side * limit;
                    state.slips[i] = true;
                }
            }
            sum += state.force[i];
        }
        sum
    }
}
