//! The saving of two sets of cycles, adjusted, with the influence of each cycle.
//!
//! With means Ē over the cycles of a stratum, and sums over strata:
//! `S = 1 − (Σ w Ē_after − A) / Σ w Ē_before`, `A = P₀ ΔT + γ Δθ`, P₀ and γ from the scatter within strata and
//! sides (Frisch–Waugh), and `w = n_before n_after / (n_before + n_after)`: the weights with the least
//! variance, shared by both sides.

use nalgebra::{Matrix2, Vector2};

/// A cycle as numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub(super) stratum: usize,
    /// J.
    pub(super) energy: f64,
    /// s.
    pub(super) duration: f64,
    /// Duration without waits, s.
    pub(super) motion: f64,
    /// °C, 0 if it is not known.
    pub(super) temperature: f64,
}

/// Mean and standard deviation of what waiting costs, before the scatter of the cycles is seen, W.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Prior {
    pub(super) mean: f64,
    pub(super) sd: f64,
}

/// An estimate.
#[derive(Clone, Debug)]
pub(super) struct Estimate {
    /// Share.
    pub(super) saving: f64,
    /// The saving without adjustments.
    pub(super) raw: f64,
    /// Mean energies of a cycle, after adjustment, J.
    pub(super) energy: [f64; 2],
    /// Mean durations, s.
    pub(super) duration: [f64; 2],
    /// Change of the duration that is not the program's own, s.
    pub(super) foreign: f64,
    /// Change of the temperature, K.
    pub(super) warmer: f64,
    /// J/s and J/K.
    pub(super) slopes: [f64; 2],
    pub(super) slopes_sd: [f64; 2],
    /// Variance of the saving that comes from the slopes.
    pub(super) slope_variance: f64,
    /// Influence of each cycle on the saving: its mean is 0, the variance of its mean is that of the saving.
    pub(super) influence: [Vec<f64>; 2],
    /// The same for the difference of the durations, s.
    pub(super) influence_s: [Vec<f64>; 2],
    /// What each cycle differs from its stratum by at equal time and temperature, as a share of the energy
    /// before.
    pub(super) residual: [Vec<f64>; 2],
    /// Weight of each stratum; their sum is 1.
    pub(super) weights: Vec<f64>,
}

#[derive(Clone, Copy, Default)]
struct Sums {
    n: f64,
    energy: f64,
    duration: f64,
    motion: f64,
    temperature: f64,
}

impl Sums {
    fn means(self) -> Sums {
        let n = self.n.max(1.0);
        Sums {
            n: self.n,
            energy: self.energy / n,
            duration: self.duration / n,
            motion: self.motion / n,
            temperature: self.temperature / n,
        }
    }
}

/// The estimate; `None` without a common stratum.
pub(super) fn estimate(sides: [&[Point]; 2], strata: usize, prior: Prior) -> Option<Estimate> {
    let means = sides.map(|points| {
        let mut sums = vec![Sums::default(); strata];
        for point in points {
            let sum = &mut sums[point.stratum];
            sum.n += 1.0;
            sum.energy += point.energy;
            sum.duration += point.duration;
            sum.motion += point.motion;
            sum.temperature += point.temperature;
        }
        sums.into_iter().map(Sums::means).collect::<Vec<Sums>>()
    });
    let harmonic =
        |(a, b): (&Sums, &Sums)| if a.n > 0.0 && b.n > 0.0 { a.n * b.n / (a.n + b.n) } else { 0.0 };
    let weights: Vec<f64> = means[0].iter().zip(&means[1]).map(harmonic).collect();
    let total: f64 = weights.iter().sum();
    if total <= 0.0 {
        return None;
    }
    let weights: Vec<f64> = weights.into_iter().map(|w| w / total).collect();
    let mean = |side: usize, of: fn(&Sums) -> f64| -> f64 {
        weights.iter().zip(&means[side]).map(|(w, sums)| w * of(sums)).sum()
    };
    let [before, after] = [0, 1].map(|side| mean(side, |sums| sums.energy));
    let duration = [0, 1].map(|side| mean(side, |sums| sums.duration));
    let longer = duration[1] - duration[0];
    let moves_longer = mean(1, |sums| sums.motion) - mean(0, |sums| sums.motion);
    let warmer = mean(1, |sums| sums.temperature) - mean(0, |sums| sums.temperature);
    let (of_duration, of_motion) = derivative(longer, moves_longer);
    let foreign = of_duration * longer + of_motion * moves_longer;
    let slopes = slopes(sides, &means, prior);
    let [standing, thermal] = slopes.values;
    let adjusted = after - standing * foreign - thermal * warmer;
    if before.is_nan() || before <= 0.0 {
        return None;
    }
    let saving = 1.0 - adjusted / before;
    let gradient = Vector2::new(foreign, warmer) / before;
    let slope_variance = (gradient.transpose() * slopes.covariance * gradient).x.max(0.0);
    let influences = [0, 1].map(|side: usize| {
        let own = &means[side];
        let size = sides[side].len() as f64;
        let of = |point: &Point| {
            let mean = own[point.stratum];
            let share = weights[point.stratum] * size / mean.n.max(1.0);
            let late = point.duration - mean.duration;
            let foreign = of_duration * late + of_motion * (point.motion - mean.motion);
            let warm = thermal * (point.temperature - mean.temperature);
            let circumstances = standing * foreign + warm;
            let energy = point.energy - mean.energy;
            let residual = (energy - standing * late - warm) / before;
            match side {
                0 => {
                    let influence = share * ((1.0 - saving) * energy - circumstances) / before;
                    [influence, -share * late, residual]
                }
                _ => [-share * (energy - circumstances) / before, share * late, residual],
            }
        };
        let mut all = [Vec::new(), Vec::new(), Vec::new()];
        for point in sides[side] {
            for (values, value) in all.iter_mut().zip(of(point)) {
                values.push(value);
            }
        }
        all
    });
    let [[energy_0, time_0, left_0], [energy_1, time_1, left_1]] = influences;
    Some(Estimate {
        saving,
        raw: 1.0 - after / before,
        energy: [before, adjusted],
        duration,
        foreign,
        warmer,
        slopes: slopes.values,
        slopes_sd: [0, 1].map(|i| slopes.covariance[(i, i)].max(0.0).sqrt()),
        slope_variance,
        influence: [energy_0, energy_1],
        influence_s: [time_0, time_1],
        residual: [left_0, left_1],
        weights,
    })
}

/// How the foreign part of a longer cycle depends on it and on the longer motion: a program that moves
/// for longer is not to blame its cell, and one that uses up its waits has the same cycle.
fn derivative(longer: f64, moves_longer: f64) -> (f64, f64) {
    if longer <= 0.0 || moves_longer <= 0.0 {
        (1.0, 0.0)
    } else if moves_longer < longer {
        (1.0, -1.0)
    } else {
        (0.0, 0.0)
    }
}

struct Slopes {
    values: [f64; 2],
    covariance: Matrix2<f64>,
}

/// The slopes of the energy over duration and temperature within strata and sides.
fn slopes(sides: [&[Point]; 2], means: &[Vec<Sums>; 2], prior: Prior) -> Slopes {
    let (mut normal, mut right, mut squares) = (Matrix2::zeros(), Vector2::zeros(), 0.0);
    let (mut rows, mut groups) = (0.0, 0.0);
    for (points, means) in sides.iter().zip(means) {
        for point in *points {
            let mean = means[point.stratum];
            let x =
                Vector2::new(point.duration - mean.duration, point.temperature - mean.temperature);
            let y = point.energy - mean.energy;
            normal += x * x.transpose();
            right += x * y;
            squares += y * y;
            rows += 1.0;
        }
        groups += means.iter().filter(|mean| mean.n > 0.0).count() as f64;
    }
    let has_temperature = normal[(1, 1)] > 1e-9 * rows;
    if !has_temperature {
        normal[(1, 0)] = 0.0;
        normal[(0, 1)] = 0.0;
        normal[(1, 1)] = 1.0;
        right.y = 0.0;
    }
    let freedom = (rows - groups - 1.0 - f64::from(u8::from(has_temperature))).max(1.0);
    let mut variance = (squares / freedom).max(f64::MIN_POSITIVE);
    let mut values = Vector2::new(prior.mean, 0.0);
    let mut covariance = Matrix2::zeros();
    // The prior's weight depends on the scatter that the slopes leave.
    for _ in 0..3 {
        let weight = if prior.sd > 0.0 {
            variance / prior.sd.powi(2)
        } else {
            1e12 * (1.0 + normal[(0, 0)])
        };
        let mut informed = normal;
        informed[(0, 0)] += weight;
        let target = right + Vector2::new(weight * prior.mean, 0.0);
        let Some(inverse) = informed.try_inverse() else { break };
        values = inverse * target;
        covariance = inverse * variance;
        let left = squares - 2.0 * values.dot(&right) + values.dot(&(normal * values));
        variance = (left / freedom).max(f64::MIN_POSITIVE);
    }
    if !has_temperature {
        covariance[(1, 1)] = 0.0;
        values.y = 0.0;
    }
    Slopes { values: [values.x, values.y], covariance }
}
