//! Delay and lag of a series, with correct jumps of friction between rows.

use super::motion::Motion;

/// Rows in which an open motion settles at its start; passes of a periodic one.
const ROUNDS: usize = 2;
/// Largest number of rows at rest in a reversal.
const TURNING: isize = 6;
/// Time constants after which a jump has settled.
const SETTLED: f64 = 12.0;
/// Smallest ratio of a time constant to the row interval.
const LEAST: f64 = 1e-6;

/// A delay followed by a first-order lag \[s\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Response {
    /// Delay of torques relative to positions \[s\].
    pub delay: f64,
    /// Time constant of the pole \[s\].
    pub lag: f64,
}

impl Response {
    /// The response to a torque of a joint. A jump at a reversal is at the standstill of the motor
    /// and is not spread over the neighbouring rows.
    #[must_use]
    pub fn behind(&self, motion: &Motion<'_>, joint: usize, x: &[f64]) -> Vec<f64> {
        let mut late = self.of_lines(x, motion.step(), motion.closed);
        if self.delay == 0.0 && self.lag == 0.0 {
            return late;
        }
        for motor in motion.motors_of(joint) {
            self.with_jumps(motion, motor, x, &mut late);
        }
        late
    }

    /// Change of the torques of all joints (`only` = 0) or of the joint `only` (from 1) by the
    /// response.
    pub(super) fn added(&self, motion: &Motion<'_>, only: f64) -> Vec<(usize, Vec<f64>)> {
        let difference = |joint: usize, tau: &[f64]| -> Vec<f64> {
            self.behind(motion, joint, tau).iter().zip(tau).map(|(late, x)| late - x).collect()
        };
        (0..motion.torque.len())
            .filter(|joint| only == 0.0 || *joint as f64 + 1.0 == only)
            .map(|joint| (joint, difference(joint, &motion.torque[joint])))
            .collect()
    }

    /// The response to a series that is linear between rows.
    fn of_lines(&self, x: &[f64], step: f64, closed: bool) -> Vec<f64> {
        let late = if self.delay == 0.0 { x.to_vec() } else { later(x, self.delay / step, closed) };
        if self.lag > LEAST * step { lagged(&late, self.lag / step, closed) } else { late }
    }

    /// Corrects the rows around each reversal of a motor for the jump between rows.
    fn with_jumps(&self, motion: &Motion<'_>, motor: usize, x: &[f64], late: &mut [f64]) {
        let n = x.len();
        let step = motion.step();
        let (rates, senses) = (&motion.rates[motor], &motion.senses[motor]);
        let at = |i: isize| -> Option<usize> {
            if motion.closed {
                usize::try_from(i.rem_euclid(n.cast_signed())).ok()
            } else {
                usize::try_from(i).ok().filter(|i| *i < n)
            }
        };
        let later = (self.delay.abs() + SETTLED * self.lag) / step;
        let reach = later.ceil() as usize + 2;
        for k in 0..n.cast_signed() {
            let (Some(here), Some(next)) = (at(k), at(k + 1)) else { continue };
            if rates[here] * rates[next] >= 0.0 || rates[here] == 0.0 {
                continue;
            }
            let crossing = k as f64 + rates[here] / (rates[here] - rates[next]);
            let moves = |i: isize| at(i).filter(|row| senses[*row] != 0.0);
            let before = (0..TURNING).find(|back| moves(k - back).is_some());
            let after = (1..=TURNING).find(|on| moves(k + on).is_some());
            let (Some(before), Some(after)) = (before, after) else { continue };
            let (a, b) = (k - before, k + after);
            let (Some(a0), Some(a1), Some(b0), Some(b1)) = (at(a - 1), at(a), at(b), at(b + 1))
            else {
                continue;
            };
            let slope = 0.5 * (x[a1] - x[a0] + x[b1] - x[b0]);
            let jump = x[b0] - x[a1] - slope * (b - a) as f64;
            // The jump as interpolated between rows, and the exact one.
            let from = a - reach.cast_signed();
            let length = (b - a) as usize + 2 * reach + 1;
            let rows: Vec<f64> = (0..length.cast_signed())
                .map(|i| match from + i {
                    row if row <= a => 0.0,
                    row if row >= b => 1.0,
                    _ => 0.5,
                })
                .collect();
            let rows = self.of_lines(&rows, step, false);
            for (i, row) in rows.iter().enumerate() {
                let number = from + i.cast_signed();
                let Some(to) = at(number) else { continue };
                let since = number as f64 - crossing - self.delay / step;
                let exact = match since {
                    since if since <= 0.0 => 0.0,
                    _ if self.lag <= LEAST * step => 1.0,
                    since => 1.0 - (-since * step / self.lag).exp(),
                };
                late[to] += jump * (exact - row);
            }
        }
    }
}

/// A series delayed by `shift` rows with linear interpolation. Before its start: its end if it is
/// periodic, otherwise its first value.
fn later(x: &[f64], shift: f64, closed: bool) -> Vec<f64> {
    let n = x.len();
    (0..n)
        .map(|i| {
            let place = i as f64 - shift;
            let place =
                if closed { place.rem_euclid(n as f64) } else { place.clamp(0.0, (n - 1) as f64) };
            let before = (place.floor() as usize).min(n - 1);
            let share = place - before as f64;
            let after = if closed { (before + 1) % n } else { (before + 1).min(n - 1) };
            x[before] * (1.0 - share) + x[after] * share
        })
        .collect()
}

/// A series after a first-order lag with a time constant in rows.
fn lagged(x: &[f64], lag: f64, closed: bool) -> Vec<f64> {
    // Exact for a piecewise linear series.
    let ratio = 1.0 / lag;
    let kept = (-ratio).exp();
    let mean = (1.0 - kept) / ratio;
    let mut state = x.first().copied().unwrap_or(0.0);
    let mut last = state;
    let mut out = vec![0.0; x.len()];
    for _ in 0..if closed { ROUNDS } else { 1 } {
        for (to, x) in out.iter_mut().zip(x) {
            state = kept * state + (mean - kept) * last + (1.0 - mean) * x;
            last = *x;
            *to = state;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

    use super::*;
    use crate::arm::robot::{Model, find};

    const STEP: f64 = 0.01;
    const ROWS: usize = 400;
    const FINE: usize = 500;
    const FRICTION: f64 = 20.0;
    const CLOSE: f64 = 0.02;

    fn rate(t: f64) -> f64 {
        (std::f64::consts::TAU * t / (STEP * ROWS as f64) + 0.123).cos()
    }

    fn torque(t: f64) -> f64 {
        FRICTION * rate(t).signum() + 3.0 * rate(t)
    }

    fn motion(model: &Model) -> Motion<'_> {
        let series = |of: &dyn Fn(f64) -> f64| -> Vec<Vec<f64>> {
            vec![(0..ROWS).map(|i| of(STEP * i as f64)).collect(); model.dof]
        };
        let t = (0..ROWS).map(|i| STEP * i as f64).collect();
        let still = series(&|_| 0.0);
        Motion::new(model, t, [still.clone(), series(&rate), still], &vec![0.0; model.dof], true)
    }

    /// Compares Coulomb friction after a lag with small filter steps, and a delay with the torque
    /// at an earlier time.
    #[test]
    fn jumps_are_where_the_motor_turns_back() {
        let model = find("IRB1600-6/1.45").unwrap();
        let motion = motion(&model);
        let x: Vec<f64> = motion.t.iter().map(|t| torque(*t)).collect();
        let lag = 0.004;
        let fine = STEP / FINE as f64;
        let mut state = torque(0.0);
        let mut expected = vec![0.0; ROWS];
        for i in 0..2 * ROWS * FINE {
            if i % FINE == 0 {
                expected[(i / FINE) % ROWS] = state;
            }
            state += fine / lag * (torque(fine * i as f64) - state);
        }
        let got = Response { delay: 0.0, lag }.behind(&motion, 0, &x);
        for (row, (a, b)) in got.iter().zip(&expected).enumerate() {
            assert!((a - b).abs() < CLOSE * FRICTION, "{row}: {a} {b}");
        }
        let delay = 0.0137;
        let got = Response { delay, lag: 0.0 }.behind(&motion, 0, &x);
        for (t, a) in motion.t.iter().zip(&got) {
            let b = torque(t - delay);
            assert!((a - b).abs() < CLOSE * FRICTION, "{t}: {a} {b}");
        }
    }
}
