//! Three phase currents as a space vector.
//!
//! `i = i_a + i_b e^{j2π/3} + i_c e^{j4π/3}` turns with the rotor; its length is 1.5 times the
//! amplitude. In rotor coordinates it lies on a line along the torque-producing axis (q), offset by
//! a constant on the other axis (d), which does no work. The electrical angle is the joint angle
//! times gear ratio and pole pairs; its sign depends on the order of the phases.

use std::f64::consts::TAU;

/// Largest number of pole pairs that is tried, with both signs.
const POLE_PAIRS: i32 = 12;
/// Least coherence with the rotor.
const STANDS: f64 = 0.7;
/// Largest number of vectors that determine the pole pairs.
const TOLD_FROM: usize = 20_000;

/// The current vectors of one motor.
#[derive(Clone, Debug, PartialEq)]
pub struct Vectors {
    /// Real parts \[A\], scaled to the amplitude of a phase.
    pub re: Vec<f64>,
    /// Imaginary parts \[A\].
    pub im: Vec<f64>,
}

/// Currents of which the common sign is unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Signed {
    /// The torque-producing current \[A\] as amplitude, except for a common sign.
    pub current: Vec<f64>,
    /// Pole pairs; negative for the opposite order of the phases.
    pub pole_pairs: i32,
    /// Coherence of the vectors with the rotor: 1 for a perfect fit.
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

/// The torque-producing current for a motor that turns with `angle` \[rad\]; `None` if no number of
/// pole pairs gives a sufficient coherence.
#[must_use]
pub fn signed(vectors: &Vectors, angle: &[f64]) -> Option<Signed> {
    let n = vectors.re.len().min(angle.len());
    let every = n.div_ceil(TOLD_FROM).max(1);
    let best = all_pairs()
        .map(|pairs| (pairs, seen(vectors, angle, pairs, every)))
        .max_by(|a, b| a.1.stands.total_cmp(&b.1.stands))?;
    let (pole_pairs, Seen { stands, direction }) = best;
    if stands < STANDS {
        return None;
    }
    let current = (0..n)
        .map(|i| {
            let (sin, cos) = (f64::from(pole_pairs) * angle[i] % TAU + direction).sin_cos();
            vectors.re[i] * cos + vectors.im[i] * sin
        })
        .collect();
    Some(Signed { current, pole_pairs, coherence: stands })
}

/// Coherence of the vectors with a rotor that turns with `angle`, for the best or the given pole
/// pairs; uses one of `every` vectors.
#[must_use]
pub fn coherence(
    vectors: &Vectors,
    angle: &[f64],
    pole_pairs: Option<i32>,
    every: usize,
) -> (f64, i32) {
    let of = |pairs: i32| (seen(vectors, angle, pairs, every).stands, pairs);
    match pole_pairs {
        Some(pairs) => of(pairs),
        None => all_pairs().map(of).max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default(),
    }
}

fn all_pairs() -> impl Iterator<Item = i32> {
    (1..=POLE_PAIRS).flat_map(|pairs| [pairs, -pairs])
}

/// Vectors in rotor coordinates.
struct Seen {
    /// Share of their power that is constant or on one line.
    stands: f64,
    /// Direction of the line \[rad\].
    direction: f64,
}

/// Statistics of the vectors in rotor coordinates. The line is that of their deviations from the
/// mean, which need not lie on it; squared vectors remove the sign.
fn seen(vectors: &Vectors, angle: &[f64], pairs: i32, every: usize) -> Seen {
    let (mut x, mut y, mut squares, mut crosses) = (0.0, 0.0, 0.0, 0.0);
    let (mut length, mut count) = (0.0, 0.0);
    for i in (0..vectors.re.len().min(angle.len())).step_by(every.max(1)) {
        let (re, im) = (vectors.re[i], vectors.im[i]);
        let (sin, cos) = (f64::from(pairs) * angle[i] % TAU).sin_cos();
        let (d, q) = (re * cos + im * sin, im * cos - re * sin);
        x += d;
        y += q;
        squares += d * d - q * q;
        crosses += 2.0 * d * q;
        length += d * d + q * q;
        count += 1.0_f64;
    }
    let count = count.max(1.0);
    let (along, across) = (squares - (x * x - y * y) / count, crosses - 2.0 * x * y / count);
    let constant = (x * x + y * y) / count;
    Seen {
        stands: (constant + along.hypot(across)) / length.max(f64::MIN_POSITIVE),
        direction: 0.5 * across.atan2(along),
    }
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

    use super::*;

    /// Rounding error of a current.
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

    /// A constant current on the axis without torque, larger than the torque-producing one.
    #[test]
    fn a_constant_on_the_other_axis_changes_nothing() {
        let angle: Vec<f64> = (0..4000).map(|i| 130.0 * (0.002 * f64::from(i)).sin()).collect();
        let current: Vec<f64> =
            (0..4000).map(|i| 0.4 + 0.3 * (0.005 * f64::from(i) + 1.0).cos()).collect();
        let phase = |k: f64| -> Vec<f64> {
            let of = |(i, angle): (&f64, &f64)| {
                let electrical = 4.0 * angle + 0.7 - k * TAU / 3.0;
                i * electrical.cos() + 0.9 * electrical.sin()
            };
            current.iter().zip(&angle).map(of).collect()
        };
        let found = signed(&vectors(&phase(0.0), &phase(1.0), &phase(2.0)), &angle).unwrap();
        let sign = found.current[0].signum();
        for (x, y) in found.current.iter().zip(&current) {
            assert!((sign * x - y).abs() < 0.02, "{x} {y}");
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
