//! A log ready to be compared with the model.

use crate::arm::effects::{Motion, of_the_whole_motion};
use crate::arm::robot::{MAX_DOF, Model};
use crate::learn::identify::{Block, Samples, Source};
use crate::learn::log::LowPass;

use super::noise::{Noise, line};
use super::sharpness::ends_sharply;
use super::spectrum::Spectrum;
use super::used::Used;

/// Rate below which a joint counts as at rest \[rad/s\]: its friction has no sense.
pub(in crate::gap) const REST: f64 = 0.02;
/// Rate up to which a motor stands, of that below which its rows are left out.
const STILL: f64 = 0.2;
/// Neighbours over which the power of the model's torque is averaged.
const SMOOTHED: usize = 4;
/// Share of the sampling rate up to which repetitions are compared.
const BAND: f64 = 0.45;
/// Repetitions from which on their drift is looked at.
const TO_DRIFT: usize = 4;
/// Power of the model's torque that is there at all frequencies, of its mean power.
const FLOOR: f64 = 1e-4;
/// Rate to which open logs are thinned out \[Hz\], and how often the band is in it.
const THINNED: f64 = 100.0;
const BANDS: f64 = 6.0;
/// Cut-off frequency before that, relative to the rate after it.
const PASSED: f64 = 0.4;

/// What a record is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordKind {
    /// The mean of repetitions, or a log that does not repeat.
    Mean,
    /// How repetitions drift: their weighted sum, the weights a line about 0.
    Drift,
    /// A mean from when the model was believed true: nothing that is looked for is in it.
    Before,
}

/// Mean torques of a motion, how well they are known, and what the model says.
#[derive(Clone)]
pub struct Record<'a> {
    /// What it is of.
    pub kind: RecordKind,
    /// When repetitions began after the first one \[s\], and their weights in the record.
    pub times: Vec<(f64, f64)>,
    /// The motion, with the torques by which laws go.
    pub motion: Motion<'a>,
    /// Torques of the model by joint \[Nm\].
    pub modelled: Vec<Vec<f64>>,
    /// Measured torques by joint \[Nm\].
    pub measured: Vec<Vec<f64>>,
    /// Repetitions that were averaged.
    pub repetitions: usize,
    /// The instants that are used.
    used: Used,
    /// Variance of the noise instant by instant, by joint and row \[N²m²\].
    pub(in crate::gap) scatter: Vec<Vec<f64>>,
    /// Variance of the noise in the rows of each frequency, by joint \[N²m²\].
    pub(in crate::gap) noise: Vec<Vec<f64>>,
    /// Power of the model's torque there.
    pub(in crate::gap) power: Vec<Vec<f64>>,
}

impl<'a> Record<'a> {
    /// The records of a log: its mean and its drift where it repeats, else one for each piece
    /// without a gap.
    #[must_use]
    pub fn all(model: &'a Model, samples: &Samples) -> Vec<Record<'a>> {
        // Frequencies of the motion's accelerations that are known.
        let cutoff = match samples.source {
            Source::Periodic { period, harmonics, .. } if !ends_sharply(samples, harmonics) => {
                Some(harmonics as f64 / period)
            }
            Source::Filtered { cutoff } => Some(cutoff),
            Source::Periodic { .. } | Source::Logged => None,
        };
        let period = match samples.source {
            Source::Periodic { period, .. } => Some(period),
            Source::Filtered { .. } | Source::Logged => None,
        };
        let highest = cutoff.map_or(BAND / samples.step, |f| f.min(BAND / samples.step));
        let rest: Vec<f64> = samples.rest.iter().map(|rest| rest.max(REST)).collect();
        let mut records = Vec::new();
        for block in &samples.blocks {
            let thin = match samples.source {
                Source::Filtered { cutoff } => thinned(block, samples.step, cutoff),
                Source::Periodic { .. } | Source::Logged => None,
            };
            let block = thin.as_ref().unwrap_or(block);
            let series = match (period, cutoff) {
                // All series have the same frequencies.
                (Some(period), Some(cutoff)) => filtered(block, samples.step, period, cutoff),
                _ => [block.q.clone(), block.qd.clone(), block.qdd.clone()],
            };
            // Rows that are left out have a sense all the same: a filter spreads their friction.
            let still = |rest: &f64| if cutoff.is_some() { STILL * rest } else { *rest };
            let slow: Vec<f64> = rest.iter().map(still).collect();
            let motion =
                with_listed(Motion::new(model, block.t.clone(), series, &slow, period.is_some()));
            let used = Used::new(&motion, &rest, highest, cutoff);
            let spread = samples.repetitions.as_deref();
            let of_mean =
                Record::mean(motion, used, block.tau.clone(), spread, period.unwrap_or(0.0));
            let drift = spread
                .filter(|all| all.first().is_some_and(|of| of.len() >= TO_DRIFT))
                .map(|spread| of_mean.drift(spread));
            records.push(of_mean);
            records.extend(drift);
        }
        records
    }

    /// The records of a baseline: those of its means.
    #[must_use]
    pub fn before(model: &'a Model, samples: &Samples) -> Vec<Record<'a>> {
        let means = Record::all(model, samples).into_iter();
        means
            .filter(|record| record.kind == RecordKind::Mean)
            .map(|record| Record { kind: RecordKind::Before, ..record })
            .collect()
    }

    /// The same record, if it is of the baseline as one of today.
    #[must_use]
    pub(in crate::gap) fn as_now(&self) -> Record<'a> {
        let kind = if self.kind == RecordKind::Before { RecordKind::Mean } else { self.kind };
        Record { kind, ..self.clone() }
    }

    /// The same record, of the baseline if it is of today and of today if it is of the baseline.
    #[must_use]
    pub(in crate::gap) fn swapped(&self) -> Record<'a> {
        let kind = match self.kind {
            RecordKind::Before => RecordKind::Mean,
            RecordKind::Mean => RecordKind::Before,
            RecordKind::Drift => RecordKind::Drift,
        };
        Record { kind, ..self.clone() }
    }

    /// A periodic motion that nobody has logged, whose torques are the model's. `states` are position,
    /// rate and acceleration \[rad, s\] every `step` \[s\], `noise` the variance of a row of one
    /// repetition by joint \[N²m²\].
    pub(in crate::gap) fn planned(
        model: &'a Model,
        states: &[[[f64; MAX_DOF]; 3]],
        step: f64,
        noise: &[f64],
        repetitions: usize,
    ) -> Record<'a> {
        let of = |order: usize, joint: usize| states.iter().map(|of| of[order][joint]).collect();
        let series = [0, 1, 2].map(|order| (0..model.dof).map(|j| of(order, j)).collect());
        let t: Vec<f64> = (0..states.len()).map(|row| step * row as f64).collect();
        let rest = vec![REST; model.dof];
        let motion = with_listed(Motion::new(model, t, series, &rest, true));
        let used = Used::new(&motion, &rest, BAND / step, None);
        let period = step * states.len() as f64;
        let measured = motion.torque.clone();
        let mut record = Record::mean(motion, used, measured, None, period);
        let share = 1.0 / repetitions as f64;
        record.repetitions = repetitions;
        record.times = (0..repetitions).map(|k| (period * k as f64, share)).collect();
        for (all, variance) in record.noise.iter_mut().zip(noise) {
            all.fill(share * variance);
        }
        record
    }

    /// Variance of the noise in a row of one repetition, by joint \[N²m²\].
    pub(in crate::gap) fn noise_of_one(&self) -> Vec<f64> {
        let mean = |of: &Vec<f64>| of.iter().sum::<f64>() / of.len().max(1) as f64;
        self.noise.iter().map(|of| self.repetitions as f64 * mean(of)).collect()
    }

    /// Whether a joint moves at an instant, so that its torque counts.
    #[must_use]
    pub fn moves(&self, joint: usize, row: usize) -> bool {
        self.used.window[joint][row] != 0.0
    }

    /// Share of the instants that count, at a joint.
    pub(in crate::gap) fn used_share(&self, joint: usize) -> f64 {
        let window = &self.used.window[joint];
        window.iter().sum::<f64>() / window.len().max(1) as f64
    }

    /// Duration of the motion \[s\].
    pub(in crate::gap) fn duration(&self) -> f64 {
        self.motion.step() * self.motion.rows() as f64
    }

    /// Number of frequencies.
    pub(in crate::gap) fn bins(&self) -> usize {
        self.used.spectrum.bins
    }

    /// Rows of a series of a joint.
    pub(in crate::gap) fn rows_of(&self, joint: usize, x: &[f64]) -> Vec<f64> {
        self.used.rows(joint, x)
    }

    /// The series of a joint whose product with another one is that of rows with the other one's, but
    /// for what is done to series before.
    pub(in crate::gap) fn back(&self, joint: usize, rows: &[f64]) -> Vec<f64> {
        let all = self.used.spectrum.back(rows);
        all.iter().zip(&self.used.window[joint]).map(|(x, w)| x * w).collect()
    }

    fn mean(
        motion: Motion<'a>,
        used: Used,
        measured: Vec<Vec<f64>>,
        spread: Option<&[Vec<Vec<f64>>]>,
        period: f64,
    ) -> Record<'a> {
        let repetitions = spread.and_then(<[_]>::first).map_or(1, Vec::len).max(1);
        let share = 1.0 / repetitions as f64;
        let joints = 0..motion.model.dof;
        let noise = joints.clone().map(|joint| {
            let of_one = match spread {
                Some(all) if repetitions > 1 => Noise::of_repetitions(&used, joint, &all[joint]),
                _ => Noise::of_differences(&used, joint, &measured[joint]),
            };
            of_one.of_mean(repetitions)
        });
        let noise: Vec<Noise> = noise.collect();
        let power = joints.map(|joint| {
            let tau = &motion.torque[joint];
            let power = used.spectrum.smoothed(&used.rows(joint, tau), SMOOTHED);
            let mean = tau.iter().map(|x| x * x).sum::<f64>() / tau.len().max(1) as f64;
            power.iter().map(|power| power + FLOOR * mean).collect()
        });
        Record {
            kind: RecordKind::Mean,
            times: (0..repetitions).map(|k| (period * k as f64, share)).collect(),
            power: power.collect(),
            modelled: motion.torque.clone(),
            motion,
            measured,
            repetitions,
            used,
            scatter: noise.iter().map(|of| of.scatter.clone()).collect(),
            noise: noise.into_iter().map(|of| of.spectrum).collect(),
        }
    }

    /// How the repetitions of a mean drift.
    fn drift(&self, spread: &[Vec<Vec<f64>>]) -> Record<'a> {
        let line = line(self.repetitions);
        let drift = |of: &Vec<Vec<f64>>| -> Vec<f64> {
            let rows = of.first().map_or(0, Vec::len);
            (0..rows).map(|k| of.iter().zip(&line).map(|(of, w)| w * of[k]).sum()).collect()
        };
        let noise = spread.iter().enumerate();
        let noise: Vec<Noise> =
            noise.map(|(joint, of)| Noise::of_repetitions(&self.used, joint, of)).collect();
        Record {
            kind: RecordKind::Drift,
            times: self.times.iter().zip(&line).map(|((t, _), w)| (*t, *w)).collect(),
            measured: spread.iter().map(drift).collect(),
            power: noise.iter().map(|of| vec![0.0; of.spectrum.len()]).collect(),
            scatter: noise.iter().map(|of| of.scatter.clone()).collect(),
            noise: noise.into_iter().map(|of| of.spectrum).collect(),
            ..self.clone()
        }
    }
}

/// A motion whose torques have what the model lists of the whole motion.
fn with_listed(mut motion: Motion<'_>) -> Motion<'_> {
    let listed = of_the_whole_motion(&motion);
    for (to, added) in motion.torque.iter_mut().zip(listed) {
        to.iter_mut().zip(added).for_each(|(to, x)| *to += x);
    }
    motion
}

/// Positions of a period up to a frequency \[Hz\], with two derivatives.
fn filtered(block: &Block, step: f64, period: f64, cutoff: f64) -> [Vec<Vec<f64>>; 3] {
    let spectrum = Spectrum::new(block.t.len(), step, cutoff);
    let all: Vec<[Vec<f64>; 3]> = block.q.iter().map(|q| spectrum.derivatives(q, period)).collect();
    [0, 1, 2].map(|order| all.iter().map(|of| of[order].clone()).collect())
}

/// A block at a rate that is enough for its band; `None` where it has that.
fn thinned(block: &Block, step: f64, cutoff: f64) -> Option<Block> {
    let every = (1.0 / (step * THINNED.max(BANDS * cutoff))) as usize;
    let filter = LowPass::new(PASSED / (step * every as f64), step);
    if every < 2 || block.instants() < 2 * filter.width() {
        return None;
    }
    let tau: Vec<Vec<f64>> = block.tau.iter().map(|x| filter.filtered(x, 0)).collect();
    let count = tau.first().map_or(0, Vec::len);
    let of =
        |x: &[f64]| x[filter.half..filter.half + count].iter().copied().step_by(every).collect();
    let all = |series: &[Vec<f64>]| series.iter().map(|x| of(x)).collect();
    Some(Block {
        t: of(&block.t),
        q: all(&block.q),
        qd: all(&block.qd),
        qdd: all(&block.qdd),
        tau: tau.iter().map(|x| x.iter().copied().step_by(every).collect()).collect(),
        clipped: block.clipped.clone(),
    })
}
