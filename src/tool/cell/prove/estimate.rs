//! The saving of two sets of cycles, adjusted, with the influence of each cycle.
//!
//! With means Ē over the cycles of a stratum, and sums over strata:
//! `S = 1 − (Σ w Ē_after − A) / Σ w Ē_before`, `A = P₀ ΔT_f + γ Δθ`, P₀ and γ from the scatter within strata and
//! sides (Frisch–Waugh), beside a slope over the time of the motion, and `w = n_before n_after / (n_before + n_after)`: the weights with the least
//! variance, shared by both sides.

use nalgebra::{Matrix3, Vector3};

/// Mean square below which a circumstance is the same in all cycles, s² or K².
const CONSTANT: f64 = 1e-9;

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
    /// The waits as time at the mean power of waiting, s.
    pub(super) waiting: f64,
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
    /// Change of the duration that is not the program's own, s, as time at the mean power of waiting.
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
    waiting: f64,
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
            waiting: self.waiting / n,
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
            sum.waiting += point.waiting;
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
    let change = |of: fn(&Sums) -> f64| mean(1, of) - mean(0, of);
    let warmer = change(|sums| sums.temperature);
    let foreign = Foreign::of(
        change(|sums| sums.duration),
        change(|sums| sums.motion),
        change(|sums| sums.waiting),
    );
    let slopes = slopes(sides, &means, prior);
    let [standing, moving, thermal] = slopes.values;
    let adjusted = after - standing * foreign.seconds - thermal * warmer;
    if before.is_nan() || before <= 0.0 {
        return None;
    }
    let saving = 1.0 - adjusted / before;
    let gradient = Vector3::new(foreign.seconds, 0.0, warmer) / before;
    let slope_variance = (gradient.transpose() * slopes.covariance * gradient).x.max(0.0);
    let influences = [0, 1].map(|side: usize| {
        let own = &means[side];
        let size = sides[side].len() as f64;
        let of = |point: &Point| {
            let mean = own[point.stratum];
            let share = weights[point.stratum] * size / mean.n.max(1.0);
            let late = point.duration - mean.duration;
            let slower = point.motion - mean.motion;
            let waits = point.waiting - mean.waiting;
            let warm = thermal * (point.temperature - mean.temperature);
            let foreign = foreign.gradient.dot(&Vector3::new(late, slower, waits));
            let circumstances = standing * foreign + warm;
            let energy = point.energy - mean.energy;
            let residual = (energy - standing * waits - moving * slower - warm) / before;
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
        foreign: foreign.seconds,
        warmer,
        slopes: [standing, thermal],
        slopes_sd: [0, 2].map(|i| slopes.covariance[(i, i)].max(0.0).sqrt()),
        slope_variance,
        influence: [energy_0, energy_1],
        influence_s: [time_0, time_1],
        residual: [left_0, left_1],
        weights,
    })
}

/// The part of a longer cycle that is not the program's own: a program that moves for longer is not to blame
/// its cell, and one that uses up its waits has the same cycle.
struct Foreign {
    /// As time at the mean power of waiting, s.
    seconds: f64,
    /// Its derivative by the changes of the duration, of the motion and of the waits.
    gradient: Vector3<f64>,
}

impl Foreign {
    /// From the changes of the duration, of the time of the motion, and of the waits at the mean power of waiting, s.
    fn of(longer: f64, moves_longer: f64, waits: f64) -> Foreign {
        let (of_duration, of_motion) = if longer <= 0.0 || moves_longer <= 0.0 {
            (1.0, 0.0)
        } else if moves_longer < longer {
            (1.0, -1.0)
        } else {
            (0.0, 0.0)
        };
        let foreign = of_duration * longer + of_motion * moves_longer;
        let waits_longer = longer - moves_longer;
        // The share of the longer waits that is foreign costs what they cost; a wait that would fill up a
        // shorter cycle is none of these.
        let share = foreign / waits_longer;
        let is_inside = share > 0.0 && share < 1.0;
        let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
        let excess = waits - waits_longer;
        let by_share = if is_inside { excess / waits_longer } else { 0.0 };
        let gradient = Vector3::new(
            of_duration * (1.0 + by_share) - share * (1.0 + by_share),
            of_motion * (1.0 + by_share) + share * (1.0 + by_share),
            share,
        );
        Foreign { seconds: foreign + share * excess, gradient }
    }
}

struct Slopes {
    /// J/s of waiting, J/s of motion, J/K.
    values: [f64; 3],
    covariance: Matrix3<f64>,
}

/// The slopes of the energy over waits, motion and temperature within strata and sides.
fn slopes(sides: [&[Point]; 2], means: &[Vec<Sums>; 2], prior: Prior) -> Slopes {
    let (mut normal, mut right, mut squares) = (Matrix3::zeros(), Vector3::zeros(), 0.0);
    let (mut rows, mut groups) = (0.0, 0.0);
    for (points, means) in sides.iter().zip(means) {
        for point in *points {
            let mean = means[point.stratum];
            let x = Vector3::new(
                point.waiting - mean.waiting,
                point.motion - mean.motion,
                point.temperature - mean.temperature,
            );
            let y = point.energy - mean.energy;
            normal += x * x.transpose();
            right += x * y;
            squares += y * y;
            rows += 1.0;
        }
        groups += means.iter().filter(|mean| mean.n > 0.0).count() as f64;
    }
    let varies = [1, 2].map(|i| normal[(i, i)] > CONSTANT * rows);
    for i in (1..3).filter(|i| !varies[i - 1]) {
        normal.row_mut(i).fill(0.0);
        normal.column_mut(i).fill(0.0);
        normal[(i, i)] = 1.0;
        right[i] = 0.0;
    }
    let count = varies.iter().filter(|varies| **varies).count() as f64;
    let freedom = (rows - groups - 1.0 - count).max(1.0);
    let mut variance = (squares / freedom).max(f64::MIN_POSITIVE);
    let mut values = Vector3::new(prior.mean, 0.0, 0.0);
    let mut covariance = Matrix3::zeros();
    // The prior's weight depends on the scatter that the slopes leave.
    for _ in 0..3 {
        let weight = if prior.sd > 0.0 {
            variance / prior.sd.powi(2)
        } else {
            1e12 * (1.0 + normal[(0, 0)])
        };
        let mut informed = normal;
        informed[(0, 0)] += weight;
        let target = right + Vector3::new(weight * prior.mean, 0.0, 0.0);
        let Some(inverse) = informed.try_inverse() else { break };
        values = inverse * target;
        covariance = inverse * variance;
        let left = squares - 2.0 * values.dot(&right) + values.dot(&(normal * values));
        variance = (left / freedom).max(f64::MIN_POSITIVE);
    }
    for i in (1..3).filter(|i| !varies[i - 1]) {
        covariance[(i, i)] = 0.0;
        values[i] = 0.0;
    }
    Slopes { values: values.into(), covariance }
}
