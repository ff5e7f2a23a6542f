//! A log ready to be compared with the model.

use crate::effects::Motion;
use crate::identify::{Samples, Source};
use crate::robot::Model;

use super::spectrum::Spectrum;

/// Rate below which a joint counts as at rest \[rad/s\]: its friction has no sense.
pub(super) const REST: f64 = 0.02;
/// Neighbours over which the power of noise is averaged.
const SMOOTHED: usize = 8;
/// The same of the model's torque.
const OF_MODEL: usize = 4;
/// Share of the sampling rate up to which repetitions are compared.
const BAND: f64 = 0.45;
/// Part of an open log at each end that is faded in and out.
const FADED: f64 = 0.05;
/// Power of the model's torque that is there at all frequencies, of its mean power.
const FLOOR: f64 = 1e-4;

/// Mean torques of a motion, how well they are known, and what the model says.
pub struct Record<'a> {
    /// The motion and the model's torques.
    pub motion: Motion<'a>,
    /// Measured torques by joint \[Nm\].
    pub measured: Vec<Vec<f64>>,
    /// Repetitions that were averaged.
    pub repetitions: usize,
    /// Share of each instant, by joint: 0 where it rests.
    pub(super) window: Vec<Vec<f64>>,
    pub(super) spectrum: Spectrum,
    /// Variance of the noise in the rows of each frequency, by joint \[N²m²\].
    pub(super) noise: Vec<Vec<f64>>,
    /// Power of the model's torque there.
    pub(super) power: Vec<Vec<f64>>,
}

impl<'a> Record<'a> {
    /// The records of a log: one where it repeats, else one for each piece without a gap.
    #[must_use]
    pub fn all(model: &'a Model, samples: &Samples) -> Vec<Record<'a>> {
        let closed = matches!(samples.source, Source::Periodic { .. });
        let highest = match samples.source {
            Source::Filtered { cutoff } => cutoff,
            Source::Periodic { .. } | Source::Logged => BAND / samples.step,
        };
        let rest: Vec<f64> = samples.rest.iter().map(|rest| rest.max(REST)).collect();
        samples
            .blocks
            .iter()
            .map(|block| {
                let series = [block.q.clone(), block.qd.clone(), block.qdd.clone()];
                let motion = Motion::new(model, block.t.clone(), series, &rest, closed);
                let repeated = samples.repetitions.as_deref();
                Record::new(motion, block.tau.clone(), repeated, &rest, highest)
            })
            .collect()
    }

    fn new(
        motion: Motion<'a>,
        measured: Vec<Vec<f64>>,
        repeated: Option<&[Vec<Vec<f64>>]>,
        rest: &[f64],
        highest: f64,
    ) -> Record<'a> {
        let n = motion.model.dof;
        let spectrum = Spectrum::new(motion.len(), motion.step(), highest);
        let fade: Vec<f64> = (0..motion.len()).map(|row| faded(row, &motion)).collect();
        let window: Vec<Vec<f64>> = (0..n)
            .map(|joint| {
                let rates = motion.qd[joint].iter().zip(&fade);
                rates
                    .map(|(rate, fade)| if rate.abs() <= rest[joint] { 0.0 } else { *fade })
                    .collect()
            })
            .collect();
        let of =
            |joint: usize, x: &[f64]| spectrum.of(x.iter().zip(&window[joint]).map(|(x, w)| x * w));
        let noise = (0..n)
            .map(|joint| match repeated {
                Some(all) => {
                    let spread = &all[joint];
                    let count = spread.len() as f64;
                    let mut sum = vec![0.0; spectrum.bins];
                    for one in spread {
                        let power = spectrum.smoothed(&of(joint, one), SMOOTHED);
                        sum.iter_mut().zip(power).for_each(|(sum, power)| *sum += power);
                    }
                    // One mean was taken off; the mean's noise is smaller by their number.
                    sum.iter().map(|sum| sum / (count - 1.0) / count).collect()
                }
                None => floor_of_noise(&spectrum, &measured[joint], &window[joint]),
            })
            .collect();
        let power = (0..n)
            .map(|joint| {
                let tau = &motion.torque[joint];
                let power = spectrum.smoothed(&of(joint, tau), OF_MODEL);
                let mean = tau.iter().map(|x| x * x).sum::<f64>() / tau.len().max(1) as f64;
                power.iter().map(|power| power + FLOOR * mean).collect()
            })
            .collect();
        let repetitions = repeated.and_then(<[_]>::first).map_or(1, Vec::len);
        Record { measured, repetitions, window, noise, power, spectrum, motion }
    }

    /// Rows of a series of a joint.
    pub(super) fn rows_of(&self, joint: usize, x: &[f64]) -> Vec<f64> {
        self.spectrum.of(x.iter().zip(&self.window[joint]).map(|(x, w)| x * w))
    }
}

/// Ends of an open log fade in and out, so that they do not count as jumps.
fn faded(row: usize, motion: &Motion<'_>) -> f64 {
    if motion.closed {
        return 1.0;
    }
    let n = motion.len();
    let edge = (FADED * n as f64).max(1.0);
    let near = row.min(n - 1 - row) as f64;
    if near >= edge { 1.0 } else { 0.5 - 0.5 * (std::f64::consts::PI * near / edge).cos() }
}

/// White noise as the fastest changes show it; motion has none of them.
fn floor_of_noise(spectrum: &Spectrum, tau: &[f64], window: &[f64]) -> Vec<f64> {
    // Fourth differences have 70 times the variance of white noise.
    let differences = tau.windows(5).map(|x| x[0] - 4.0 * x[1] + 6.0 * x[2] - 4.0 * x[3] + x[4]);
    let mut squares: Vec<f64> = differences.map(|x| x * x / 70.0).collect();
    squares.sort_by(f64::total_cmp);
    // The median of the squares of a normal deviate is 0.455 of its variance.
    let variance = squares.get(squares.len() / 2).map_or(0.0, |x| x / 0.455);
    let used = window.iter().map(|w| w * w).sum::<f64>() / window.len().max(1) as f64;
    vec![variance * used; spectrum.bins]
}
