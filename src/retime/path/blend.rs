//! The shape of a corner zone.
//!
//! On [−1, 1] the direction turns from D₁ to D₂: dp/dx = D₁ (1 − W) + D₂ W. The curvature W′ is a
//! trapezoid. Its plateau gives a closest approach to the corner of 0.217·r·|d₂ − d₁|, as measured
//! on an IRC5 (a parabola has 0.25, a smoothstep 0.1875).

/// Half width b of the plateau of W′. The mean of |x| under W′ is (1 + b + b²) / (3 (1 + b)); half
/// of it is the closest approach: 0.217.
const PLATEAU: f64 = 0.7205;

/// Kinks of W′, which must be nodes of an interpolation.
pub const KINKS: [f64; 5] = [-1.0, -PLATEAU, 0.0, PLATEAU, 1.0];

/// The turn at x ∈ [−1, 1]: (∫W, W, W′), with ∫W from −1.
pub fn turn(x: f64) -> [f64; 3] {
    let x = x.clamp(-1.0, 1.0);
    if x > 0.0 {
        // W(x) = 1 − W(−x), so ∫W differs by x.
        let [integral, weight, slope] = turn(-x);
        return [integral + x, 1.0 - weight, slope];
    }
    let height = 1.0 / (1.0 + PLATEAU);
    let ramp = 1.0 - PLATEAU;
    let u = x + 1.0;
    if u < ramp {
        let slope = height * u / ramp;
        return [slope * u * u / 6.0, slope * u / 2.0, slope];
    }
    let v = u - ramp;
    let at_ramp = height * ramp / 2.0;
    let integral = height * ramp * ramp / 6.0 + at_ramp * v + height * v * v / 2.0;
    [integral, at_ramp + height * v, height]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Closest approach measured on an IRC5, in units of r·|d₂ − d₁|.
    const MEASURED: f64 = 0.217;

    #[test]
    fn corner_is_approached_as_measured() {
        assert!((turn(0.0)[0] - MEASURED).abs() < 5e-4, "{}", turn(0.0)[0]);
    }

    #[test]
    fn turn_is_complete_and_consistent() {
        assert_eq!(turn(-1.0), [0.0; 3]);
        let [integral, weight, slope] = turn(1.0);
        assert!((integral - 1.0).abs() < 1e-12 && (weight - 1.0).abs() < 1e-12 && slope == 0.0);
        let h = 1e-6;
        for i in 1..40 {
            let x = -1.0 + f64::from(i) / 20.0;
            let (a, b, at) = (turn(x - h), turn(x + h), turn(x));
            assert!(((b[0] - a[0]) / (2.0 * h) - at[1]).abs() < 1e-6, "∫W at {x}");
            assert!(((b[1] - a[1]) / (2.0 * h) - at[2]).abs() < 1e-5, "W at {x}");
        }
    }
}
