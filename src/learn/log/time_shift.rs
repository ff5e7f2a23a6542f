//! Time shift between two signals that minimises a misfit.
//!
//! The caller defines the misfit: torques with the motion of a refitted model, phase currents with
//! the rotor, torques with a model with effects, a motion with itself a period later.

/// Ratio of the golden section.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// A shift and its misfit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shift {
    /// Shift, in the unit of the grid.
    pub shift: f64,
    /// Misfit at the shift.
    pub misfit: f64,
}

/// The shift with the least misfit among `middle` + `step` k, |k| ≤ `count`. Shifts without a
/// misfit are skipped; the result is `None` if `middle` has no misfit.
pub fn on_grid(
    middle: f64,
    step: f64,
    count: i32,
    mut misfit: impl FnMut(f64) -> Option<f64>,
) -> Option<Shift> {
    let mut best = Shift { shift: middle, misfit: misfit(middle)? };
    for k in (-count..=count).filter(|k| *k != 0) {
        let shift = middle + step * f64::from(k);
        if let Some(misfit) = misfit(shift).filter(|misfit| *misfit < best.misfit) {
            best = Shift { shift, misfit };
        }
    }
    Some(best)
}

/// The minimum between the points of the same grid, by a parabola; `None` if the least misfit
/// inside the grid is not a minimum.
pub fn between_grid(
    middle: f64,
    step: f64,
    count: i32,
    misfit: impl Fn(f64) -> f64,
) -> Option<Shift> {
    let misfits: Vec<f64> =
        (-count..=count).map(|k| misfit(middle + step * f64::from(k))).collect();
    let best = (1..misfits.len() - 1).min_by(|a, b| misfits[*a].total_cmp(&misfits[*b]))?;
    let around = [misfits[best - 1], misfits[best], misfits[best + 1]];
    let [before, here, after] = around;
    if here > before || here > after {
        return None;
    }
    let place = best as f64 - f64::from(count) + vertex(around)?;
    Some(Shift { shift: middle + step * place, misfit: here })
}

/// The local minimum of a descent from shift 0 in whole steps, with the misfits one step before,
/// there and one step after. `None` beyond `most` steps or if a misfit is missing.
pub fn downhill(most: isize, misfit: impl Fn(isize) -> Option<f64>) -> Option<(isize, [f64; 3])> {
    let mut middle: isize = 0;
    let mut around = [misfit(-1)?, misfit(0)?, misfit(1)?];
    while around[0] < around[1] || around[2] < around[1] {
        let sense = if around[0] < around[2] { -1 } else { 1 };
        middle += sense;
        if middle.abs() > most {
            return None;
        }
        let beyond = misfit(middle + sense)?;
        around =
            if sense < 0 { [beyond, around[0], around[1]] } else { [around[1], around[2], beyond] };
    }
    Some((middle, around))
}

/// The minimum of the parabola through three equally spaced values, in steps from the middle one;
/// `None` without a minimum.
#[must_use]
pub fn vertex([before, here, after]: [f64; 3]) -> Option<f64> {
    let curvature = before + after - 2.0 * here;
    (curvature > 0.0).then(|| 0.5 * (before - after) / curvature)
}

/// The minimum of a unimodal function between two points; each step shrinks the interval by 0.618.
pub fn golden_section(
    [mut low, mut high]: [f64; 2],
    steps: usize,
    misfit: impl Fn(f64) -> f64,
) -> f64 {
    let inner = |low: f64, high: f64| [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
    let [mut a, mut b] = inner(low, high);
    let [mut at_a, mut at_b] = [misfit(a), misfit(b)];
    for _ in 0..steps {
        if at_a < at_b {
            (high, b, at_b) = (b, a, at_a);
            a = inner(low, high)[0];
            at_a = misfit(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = inner(low, high)[1];
            at_b = misfit(b);
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

    use super::*;

    const STEP: f64 = 0.01;
    const LATE: f64 = 0.037;

    fn signal(t: f64) -> f64 {
        (2.0 * t).sin() + 0.3 * (5.0 * t).cos()
    }

    fn misfit(shift: f64) -> f64 {
        let times = (0..300).map(|i| STEP * f64::from(i));
        times.map(|t| (signal(t - LATE) - signal(t - shift)).powi(2)).sum()
    }

    #[test]
    fn all_searches_find_the_same_shift() {
        let coarse = on_grid(0.0, 0.1, 5, |shift| Some(misfit(shift))).unwrap();
        let fine = between_grid(coarse.shift, STEP, 10, misfit).unwrap();
        assert!((fine.shift - LATE).abs() < 1e-4, "{fine:?}");
        let (steps, around) = downhill(20, |k| Some(misfit(STEP * k as f64))).unwrap();
        let found = STEP * (steps as f64 + vertex(around).unwrap());
        assert!((found - fine.shift).abs() < 1e-9, "{found}");
        assert_eq!(downhill(3, |k| Some(misfit(STEP * k as f64))), None);
        let near = [coarse.shift - 0.1, coarse.shift + 0.1];
        assert!((golden_section(near, 24, misfit) - LATE).abs() < 1e-5);
    }
}
