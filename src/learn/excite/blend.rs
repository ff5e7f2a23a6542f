//! Blends from rest into a periodic motion and back to rest.

use crate::arm::robot::{MAX_DOF, Model};

use super::series::{Series, State};

/// Shortest and longest blend \[s\].
const DURATIONS: [f64; 2] = [0.5, 15.0];
/// Factor between successive durations that are tried.
const LONGER: f64 = 1.15;
/// Times of the period whose speed is compared …
const PLACES: usize = 100;
/// … and number of the slowest ones that are tried.
const TRIED: usize = 15;

/// A motion between rest and the beginning of a period.
#[derive(Clone, Debug, PartialEq)]
pub struct Blend {
    /// Duration \[s\].
    pub duration: f64,
    /// For each joint, the coefficients of the polynomial in time, constant term first.
    coefficients: Vec<[f64; 6]>,
}

impl Blend {
    /// The state at a time from 0 to the duration \[s\].
    #[must_use]
    pub fn at(&self, t: f64) -> State {
        let mut state = [[0.0; MAX_DOF]; 3];
        for (joint, c) in self.coefficients.iter().enumerate() {
            // Horner's scheme for value, first and half the second derivative.
            let [mut value, mut rate, mut bend] = [0.0; 3];
            for coefficient in c.iter().rev() {
                bend = bend * t + rate;
                rate = rate * t + value;
                value = value * t + coefficient;
            }
            state[0][joint] = value;
            state[1][joint] = rate;
            state[2][joint] = 2.0 * bend;
        }
        state
    }

    /// The states at intervals of about `step` \[s\].
    #[must_use]
    pub fn sampled(&self, step: f64) -> Vec<State> {
        let count = (self.duration / step).round() as usize;
        (0..=count).map(|i| self.at(self.duration * i as f64 / count.max(1) as f64)).collect()
    }
}

/// The shortest blends at both ends that `fits` accepts, and the series shifted to begin where they
/// join: at a slow time of the period.
#[must_use]
pub fn blends(
    model: &Model,
    series: &Series,
    fits: &dyn Fn(&[State]) -> bool,
) -> Option<(Series, [Blend; 2])> {
    let speed = |state: &State| {
        let share = |joint: usize| {
            let limit = model.limits.velocity.as_ref().map_or(1.0, |of| of[joint]);
            state[1][joint].abs() / limit
        };
        (0..model.dof).map(share).fold(0.0, f64::max)
    };
    let mut places: Vec<(f64, f64)> = series
        .sampled(PLACES)
        .iter()
        .enumerate()
        .map(|(i, state)| (speed(state), series.period() * i as f64 / PLACES as f64))
        .collect();
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    places.truncate(TRIED);
    places.iter().find_map(|(_, shift)| {
        let series = series.later(*shift);
        let blends = at_the_edge(model, &series, fits)?;
        Some((series, blends))
    })
}

fn at_the_edge(
    model: &Model,
    series: &Series,
    fits: &dyn Fn(&[State]) -> bool,
) -> Option<[Blend; 2]> {
    let edge = series.at(0.0);
    let shortest = |sense: f64| {
        let mut duration = DURATIONS[0];
        while duration <= DURATIONS[1] {
            let blend = blend(model, &edge, duration, sense);
            if fits(&blend.sampled(0.001)) {
                return Some(blend);
            }
            duration *= LONGER;
        }
        None
    };
    Some([shortest(1.0)?, shortest(-1.0)?])
}

/// Quintic between rest and the state `edge`; `sense` 1 starts at rest, −1 ends at rest.
fn blend(model: &Model, edge: &State, duration: f64, sense: f64) -> Blend {
    // Multiples of 10 ms, so that the points of a stream include the end of the blend.
    let duration = (duration * 100.0).round() / 100.0;
    let coefficients = (0..model.dof)
        .map(|joint| {
            let [q, v, a] = [edge[0][joint], edge[1][joint], edge[2][joint]];
            // The rest position lies behind the motion, so that the joint need not reverse.
            let [low, high] = model.limits.position[joint];
            let rest = (q - sense * 0.5 * v * duration).clamp(low.min(q), high.max(q));
            let inside = 0.5 * (rest + q);
            let rest = if rest <= low || rest >= high { inside } else { rest };
            let moving = [q, v, a];
            let ends =
                if sense > 0.0 { [[rest, 0.0, 0.0], moving] } else { [moving, [rest, 0.0, 0.0]] };
            quintic(ends, duration)
        })
        .collect();
    Blend { duration, coefficients }
}

fn quintic([[q0, v0, a0], [q1, v1, a1]]: [[f64; 3]; 2], t: f64) -> [f64; 6] {
    let d = q1 - q0 - v0 * t - 0.5 * a0 * t * t;
    let e = v1 - v0 - a0 * t;
    let f = a1 - a0;
    [
        q0,
        v0,
        0.5 * a0,
        (20.0 * d - 8.0 * e * t + f * t * t) / (2.0 * t.powi(3)),
        (-30.0 * d + 14.0 * e * t - 2.0 * f * t * t) / (2.0 * t.powi(4)),
        (12.0 * d - 6.0 * e * t + f * t * t) / (2.0 * t.powi(5)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_are_met_with_rates_and_accelerations() {
        let ends = [[0.3, -0.2, 0.7], [1.1, 0.9, -2.0]];
        let blend = Blend { duration: 1.7, coefficients: vec![quintic(ends, 1.7)] };
        for (t, end) in [(0.0, ends[0]), (1.7, ends[1])] {
            let state = blend.at(t);
            assert!((0..3).all(|order| (state[order][0] - end[order]).abs() < 1e-12));
        }
    }
}
