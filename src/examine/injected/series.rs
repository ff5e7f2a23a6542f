//! Differential equations driven by a sampled input.

/// Values at the rows of a log, of a state that follows an input between the rows.
///
/// `advance(h, input)` moves the state by `h` \[s\] with the input at the end of the step and
/// returns the values. The input is linear between the rows; steps are at most `longest` \[s\].
pub(super) fn driven<const N: usize>(
    t: &[f64],
    input: &[f64],
    longest: f64,
    mut advance: impl FnMut(f64, f64) -> [f64; N],
) -> Vec<[f64; N]> {
    let mut values = Vec::with_capacity(t.len());
    for row in 0..t.len() {
        let Some(before) = row.checked_sub(1) else {
            values.push(advance(0.0, input[0]));
            continue;
        };
        let interval = t[row] - t[before];
        let steps = (interval / longest).ceil().max(1.0);
        let mut now = [0.0; N];
        for step in 1..=steps as usize {
            let x = step as f64 / steps;
            now = advance(interval / steps, input[before] + x * (input[row] - input[before]));
        }
        values.push(now);
    }
    values
}

/// The input at the time `at` \[s\], linear between the rows and constant beyond them.
pub(super) fn linear_at(t: &[f64], input: &[f64], at: f64) -> f64 {
    let after = t.partition_point(|t| *t < at);
    if after == 0 {
        return input[0];
    }
    if after == t.len() {
        return input[after - 1];
    }
    let x = (at - t[after - 1]) / (t[after] - t[after - 1]);
    input[after - 1] + x * (input[after] - input[after - 1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_first_order_lag_follows_a_ramp_with_its_time_constant() {
        let t: Vec<f64> = (0..400).map(|i| 0.01 * f64::from(i)).collect();
        let lag = 0.05;
        let mut state = 0.0;
        let found = driven(&t, &t, 1e-4, |h, input| {
            state += h * (input - state) / lag;
            [state]
        });
        let late = t[399] - found[399][0];
        assert!((late - lag).abs() < 1e-3, "{late}");
    }

    #[test]
    fn values_between_rows_are_linear() {
        let (t, x) = ([0.0, 1.0, 3.0], [2.0, 4.0, 0.0]);
        assert_eq!([-1.0, 0.5, 2.0, 9.0].map(|at| linear_at(&t, &x, at)), [2.0, 3.0, 2.0, 0.0]);
    }
}
