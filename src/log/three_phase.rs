//! Three phase currents as one vector.
//!
//! `i = i_a + i_b e^{j2π/3} + i_c e^{j4π/3}` turns with the rotor; its length is one and a half
//! times the amplitude. With the torque angle kept at ±90°, the vector seen from the rotor
//! stands still and its sign is the torque's. The electrical angle is the joint's times gear
//! ratio and pole pairs, in a sense that depends on the order of the phases.

use std::f64::consts::TAU;

/// Pole pairs that are tried, in both senses.
const POLE_PAIRS: i32 = 12;
/// How much of the vector has to stand still from the rotor.
const STANDS: f64 = 0.7;
/// Vectors from which the pole pairs are told.
const TOLD_FROM: usize = 20_000;

/// The vectors of one motor.
#[derive(Clone, Debug, PartialEq)]
pub struct Vectors {
    /// Real parts \[A\]: amplitudes of the phase currents.
    pub re: Vec<f64>,
    /// Imaginary parts \[A\].
    pub im: Vec<f64>,
}

/// Currents of one sign or the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Signed {
    /// The current that makes the torque, up to one sign for all \[A\], amplitude.
    pub current: Vec<f64>,
    /// Pole pairs, negative where the phases run backwards.
    pub pole_pairs: i32,
    /// Share of the vectors that stands still from the rotor: 1 for a perfect fit.
    pub coherence: f64,
}

/// The vectors of three phase currents \[A\], scaled to the amplitude of a phase.
#[must_use]
pub fn vectors(a: &[f64], b: &[f64], c: &[f64]) -> Vectors {
    let root = 3.0_f64.sqrt();
    Vectors {
        re: a.iter().zip(b).zip(c).map(|((a, b), c)| (2.0 * a - b - c) / 3.0).collect(),
        im: b.iter().zip(c).map(|(b, c)| (b - c) / root).collect(),
    }
}

/// The vectors seen from a rotor that turns with `angle` (motor side, rad); `None` where no
/// number of pole pairs makes them stand still.
#[must_use]
pub fn signed(vectors: &Vectors, angle: &[f64]) -> Option<Signed> {
    let n = vectors.re.len().min(angle.len());
    let every = n.div_ceil(TOLD_FROM).max(1);
    let best = (1..=POLE_PAIRS)
        .flat_map(|pairs| [pairs, -pairs])
        .map(|pairs| {
            let (x, y, length) = doubled(vectors, angle, pairs, every);
            (pairs, x.hypot(y) / length.max(f64::MIN_POSITIVE), y.atan2(x))
        })
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    let (pole_pairs, coherence, twice) = best;
    if coherence < STANDS {
        return None;
    }
    let direction = 0.5 * twice;
    let current = (0..n)
        .map(|i| {
            let (sin, cos) = (f64::from(pole_pairs) * angle[i] % TAU + direction).sin_cos();
            vectors.re[i] * cos + vectors.im[i] * sin
        })
        .collect();
    Some(Signed { current, pole_pairs, coherence })
}

/// The sum of the squared vectors, turned back: squares have no sign to lose.
fn doubled(vectors: &Vectors, angle: &[f64], pairs: i32, every: usize) -> (f64, f64, f64) {
    let (mut x, mut y, mut length) = (0.0, 0.0, 0.0);
    for i in (0..vectors.re.len().min(angle.len())).step_by(every) {
        let (re, im) = (vectors.re[i], vectors.im[i]);
        let (sin, cos) = (2.0 * f64::from(pairs) * angle[i] % TAU).sin_cos();
        let (square, cross) = (re * re - im * im, 2.0 * re * im);
        x += square * cos + cross * sin;
        y += cross * cos - square * sin;
        length += re * re + im * im;
    }
    (x, y, length)
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

    use super::*;

    /// Of a current, by rounding.
    const EXACT: f64 = 1e-9;

    #[test]
    fn the_current_comes_back_for_every_order_of_the_phases() {
        let angle: Vec<f64> = (0..4000).map(|i| 130.0 * (0.002 * f64::from(i)).sin()).collect();
        let current: Vec<f64> =
            (0..4000).map(|i| 3.0 * (0.005 * f64::from(i) + 1.0).cos()).collect();
        for pairs in [2.0, 3.0, 5.0] {
            let phase = |k: f64| -> Vec<f64> {
                let of = |(i, angle): (&f64, &f64)| i * (pairs * angle + 0.7 - k * TAU / 3.0).cos();
                current.iter().zip(&angle).map(of).collect()
            };
            let phases = [phase(0.0), phase(1.0), phase(2.0)];
            for [a, b, c] in [[0, 1, 2], [1, 2, 0], [2, 1, 0], [0, 2, 1]] {
                let found = signed(&vectors(&phases[a], &phases[b], &phases[c]), &angle).unwrap();
                assert!(found.coherence > 0.99 && f64::from(found.pole_pairs.abs()) == pairs);
                let sign = (found.current[0] * current[0]).signum();
                for (x, y) in found.current.iter().zip(&current) {
                    assert!((sign * x - y).abs() < EXACT);
                }
            }
        }
    }

    #[test]
    fn vectors_that_do_not_turn_with_the_rotor_are_refused() {
        let angle: Vec<f64> = (0..4000).map(|i| 130.0 * (0.002 * f64::from(i)).sin()).collect();
        let wave = |shift: f64| -> Vec<f64> {
            (0..4000).map(|i| (0.31 * f64::from(i) + shift).cos()).collect()
        };
        let [a, b, c] = [wave(0.0), wave(-TAU / 3.0), wave(TAU / 3.0)];
        assert_eq!(signed(&vectors(&a, &b, &c), &angle), None);
    }
}
