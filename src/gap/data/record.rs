//! A log ready to be compared with the model.

use crate::arm::effects::{Motion, of_the_whole_motion};
use crate::arm::robot::Model;
use crate::learn::identify::{Block, Samples, Source};
use crate::learn::log::LowPass;

use super::spectrum::Spectrum;

/// Share of the fastest rate below which friction that does not jump changes its sense.
const ROUNDED: f64 = 0.06;
/// Rate below which a joint counts as at rest \[rad/s\]: its friction has no sense.
pub(super) const REST: f64 = 0.02;
/// Neighbours over which the power of noise is averaged.
pub(super) const SMOOTHED: usize = 8;
/// The same of the model's torque.
const OF_MODEL: usize = 4;
/// Share of the sampling rate up to which repetitions are compared.
const BAND: f64 = 0.45;
/// Part of an open log at each end that is faded in and out.
const FADED: f64 = 0.05;
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
pub struct Record<'a> {
    /// What it is of.
    pub kind: RecordKind,
    /// When repetitions began, by the clock of all logs \[s\], and their weights in the record.
    /// The motion's own time begins at 0.
    pub times: Vec<(f64, f64)>,
    /// The motion and the model's torques.
    pub motion: Motion<'a>,
    /// Measured torques by joint \[Nm\].
    pub measured: Vec<Vec<f64>>,
    /// Repetitions that were averaged.
    pub repetitions: usize,
    /// Share of each instant, by joint: 0 where it rests.
    pub(super) window: Vec<Vec<f64>>,
    /// By joint, the rows of each rest, whose mean tells nothing.
    rests: Vec<Vec<Vec<usize>>>,
    pub(super) spectrum: Spectrum,
    /// Variance of the noise of each instant, by joint \[N²m²\].
    pub variance: Vec<f64>,
    /// The same as the repetitions show it instant by instant, by joint and row \[N²m²\].
    pub(super) scatter: Vec<Vec<f64>>,
    /// Variance of the noise in the rows of each frequency, by joint \[N²m²\].
    pub(super) noise: Vec<Vec<f64>>,
    /// Power of the model's torque there.
    pub(super) power: Vec<Vec<f64>>,
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
        let (closed, period) = match samples.source {
            Source::Periodic { period, .. } => (true, period),
            Source::Filtered { .. } | Source::Logged => (false, 0.0),
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
            let series = match (closed, cutoff) {
                // All series have the same frequencies.
                (true, Some(cutoff)) => {
                    let spectrum = Spectrum::new(block.t.len(), samples.step, cutoff);
                    let all: Vec<[Vec<f64>; 3]> =
                        block.q.iter().map(|q| spectrum.derivatives(q, period)).collect();
                    [0, 1, 2].map(|order| all.iter().map(|of| of[order].clone()).collect())
                }
                _ => [block.q.clone(), block.qd.clone(), block.qdd.clone()],
            };
            let begins = block.t.first().copied().unwrap_or(0.0);
            let t = block.t.iter().map(|t| t - begins).collect();
            // Rows that are left out have a sense all the same: a filter spreads their friction.
            let slow: Vec<f64> = rest.iter().map(|rest| if cutoff.is_some() { STILL * rest } else { *rest }).collect();
            let mut motion = Motion::new(model, t, series, &slow, closed);
            // What the model lists of the whole motion is the model's.
            let of_motion = of_the_whole_motion(&motion);
            for (to, added) in motion.torque.iter_mut().zip(of_motion) {
                to.iter_mut().zip(added).for_each(|(to, x)| *to += x);
            }
            let windows = Windows::new(&motion, &rest, highest, cutoff);
            let spread = samples.repetitions.as_deref();
            records.push(windows.mean(motion.clone(), block.tau.clone(), spread, [begins, period]));
            if let Some(spread) = spread
                && spread.first().is_some_and(|of| of.len() >= TO_DRIFT)
            {
                records.push(windows.drift(motion, spread, [begins, period]));
            }
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

    /// Leaves out when motor 6 of a wrist that is coupled by so much more nearly rests, as it is or
    /// as it was taken to be: nobody knows which way it turns.
    pub(super) fn leave_out_turns(&mut self, coupling: f64) {
        let Motion { model, qd, rest, .. } = &self.motion;
        let fastest = qd[5].iter().fold(0.0, |most: f64, rate| rate.abs().max(most));
        let slow = if self.motion.closed { rest[5].max(ROUNDED * fastest) } else { rest[5] };
        let turns = |coupling: f64, row: usize| {
            (qd[5][row] + (model.wrist.coupling + coupling) * qd[4][row]).abs() <= slow
        };
        for row in 0..self.motion.rows() {
            if turns(coupling, row) || turns(0.0, row) {
                (self.window[4][row], self.window[5][row]) = (0.0, 0.0);
            }
        }
    }

    /// Whether a joint moves at an instant, so that its torque counts.
    #[must_use]
    pub fn moves(&self, joint: usize, row: usize) -> bool {
        self.window[joint][row] != 0.0
    }

    /// Rows of a series of a joint.
    pub(super) fn rows_of(&self, joint: usize, x: &[f64]) -> Vec<f64> {
        self.spectrum.masked(&levelled(x, &self.rests[joint]), &self.window[joint])
    }
}

/// A series without its mean in each rest: stiction may be anything.
fn levelled(x: &[f64], rests: &[Vec<usize>]) -> Vec<f64> {
    let mut level = x.to_vec();
    for rest in rests {
        let mean = rest.iter().map(|row| x[*row]).sum::<f64>() / rest.len().max(1) as f64;
        for row in rest {
            level[*row] -= mean;
        }
    }
    level
}

/// Rows of each rest.
fn rests(senses: &[f64], closed: bool) -> Vec<Vec<usize>> {
    let mut all: Vec<Vec<usize>> = Vec::new();
    let mut run = Vec::new();
    for (row, sense) in senses.iter().enumerate() {
        if *sense == 0.0 {
            run.push(row);
        } else if !run.is_empty() {
            all.push(std::mem::take(&mut run));
        }
    }
    if !run.is_empty() {
        // The rest at the end of a period goes on at its start.
        match all.first_mut().filter(|first| closed && first.first() == Some(&0)) {
            Some(first) => first.extend(run),
            None => all.push(run),
        }
    }
    all
}

/// What is used of a motion.
struct Windows {
    window: Vec<Vec<f64>>,
    rests: Vec<Vec<Vec<usize>>>,
    spectrum: Spectrum,
}

impl Windows {
    fn new(motion: &Motion<'_>, rest: &[f64], highest: f64, cutoff: Option<f64>) -> Windows {
        let fade: Vec<f64> = (0..motion.rows()).map(|row| faded(row, motion)).collect();
        let of = |joint: usize| -> Vec<f64> {
            let moves = |row: usize| {
                motion.qd[joint][row].abs() > rest[joint] && senses_known(motion, joint, row)
            };
            (0..motion.rows()).map(|row| if moves(row) { fade[row] } else { 0.0 }).collect()
        };
        // A filter spreads what is unknown over the rows beside it: when a motor begins to move.
        let reach = cutoff.map_or(0, |cutoff| (SPREAD / (cutoff * motion.step())).ceil() as usize);
        let left_out = |joint: usize| {
            let known = of(joint);
            let narrow = narrowed(&known, reach, motion.closed);
            // A motion of short moves alone is used as it is.
            if narrow.iter().any(|w| *w > 0.0) { narrow } else { known }
        };
        let window = (0..motion.model.dof).map(left_out).collect();
        let rests = (0..motion.model.dof)
            .map(|joint| if cutoff.is_some() { rests(&motion.senses[joint], motion.closed) } else { Vec::new() })
            .collect();
        Windows {
            window,
            rests,
            spectrum: Spectrum::new(motion.rows(), motion.step(), highest).filtered(cutoff.is_some()),
        }
    }

    fn rows(&self, joint: usize, x: &[f64]) -> Vec<f64> {
        self.spectrum.masked(&levelled(x, &self.rests[joint]), &self.window[joint])
    }

    /// Variances of one repetition's noise in the rows of each frequency, and at each instant:
    /// of what is neither the mean nor a drift of the repetitions.
    fn noise(&self, joint: usize, spread: &[Vec<f64>]) -> [Vec<f64>; 2] {
        let count = spread.len();
        let line = line(count);
        let rows = spread.first().map_or(0, Vec::len);
        let drift: Vec<f64> = (0..rows)
            .map(|k| spread.iter().zip(&line).map(|(of, w)| w * of[k]).sum::<f64>())
            .collect();
        let left = (count - if count > 2 { 2 } else { 1 }).max(1) as f64;
        let mut sum = vec![0.0; self.spectrum.bins];
        let mut scatter = vec![0.0; rows];
        for (of, weight) in spread.iter().zip(&line) {
            let weight = if count > 2 { *weight } else { 0.0 };
            let rest: Vec<f64> = of.iter().zip(&drift).map(|(x, d)| x - weight * d).collect();
            scatter.iter_mut().zip(&rest).for_each(|(sum, x)| *sum += x * x / left);
            let power = self.spectrum.smoothed(&self.rows(joint, &rest), SMOOTHED);
            sum.iter_mut().zip(power).for_each(|(sum, power)| *sum += power);
        }
        [sum.iter().map(|sum| sum / left).collect(), scatter]
    }

    fn mean<'a>(
        &self,
        motion: Motion<'a>,
        measured: Vec<Vec<f64>>,
        spread: Option<&[Vec<Vec<f64>>]>,
        [begins, period]: [f64; 2],
    ) -> Record<'a> {
        let repetitions = spread.and_then(<[_]>::first).map_or(1, Vec::len).max(1);
        let share = 1.0 / repetitions as f64;
        let [mut noise, mut scatter]: [Vec<Vec<f64>>; 2] = Default::default();
        for joint in 0..motion.model.dof {
            let of = match spread {
                Some(all) if repetitions > 1 => self.noise(joint, &all[joint]),
                _ => floor_of_noise(&self.spectrum, &measured[joint], &self.window[joint]),
            };
            let [of, at] = of.map(|of| of.iter().map(|noise| noise * share).collect());
            noise.push(of);
            scatter.push(at);
        }
        let power = (0..motion.model.dof)
            .map(|joint| {
                let tau = &motion.torque[joint];
                let power = self.spectrum.smoothed(&self.rows(joint, tau), OF_MODEL);
                let mean = tau.iter().map(|x| x * x).sum::<f64>() / tau.len().max(1) as f64;
                power.iter().map(|power| power + FLOOR * mean).collect()
            })
            .collect();
        Record {
            kind: RecordKind::Mean,
            times: (0..repetitions).map(|k| (begins + period * k as f64, share)).collect(),
            motion,
            measured,
            repetitions,
            window: self.window.clone(),
            rests: self.rests.clone(),
            spectrum: self.spectrum.clone(),
            variance: scatter.iter().map(|of| mean(of)).collect(),
            scatter,
            noise,
            power,
        }
    }

    fn drift<'a>(
        &self,
        motion: Motion<'a>,
        spread: &[Vec<Vec<f64>>],
        [begins, period]: [f64; 2],
    ) -> Record<'a> {
        let repetitions = spread.first().map_or(0, Vec::len);
        let line = line(repetitions);
        let measured = spread
            .iter()
            .map(|of| {
                let rows = of.first().map_or(0, Vec::len);
                let at = |k: usize| of.iter().zip(&line).map(|(of, w)| w * of[k]).sum();
                (0..rows).map(at).collect()
            })
            .collect();
        let all = spread.iter().enumerate().map(|(joint, of)| self.noise(joint, of));
        let (noise, scatter): (Vec<Vec<f64>>, Vec<Vec<f64>>) = all.map(Into::into).unzip();
        Record {
            kind: RecordKind::Drift,
            times: line.iter().enumerate().map(|(k, w)| (begins + period * k as f64, *w)).collect(),
            motion,
            measured,
            repetitions,
            window: self.window.clone(),
            rests: self.rests.clone(),
            spectrum: self.spectrum.clone(),
            power: noise.iter().map(|of| vec![0.0; of.len()]).collect(),
            variance: scatter.iter().map(|of| mean(of)).collect(),
            scatter,
            noise,
        }
    }
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

/// Whether all motors whose friction a joint feels turn.
fn senses_known(motion: &Motion<'_>, joint: usize, row: usize) -> bool {
    let coupled = joint == 4 && motion.model.wrist.coupling != 0.0;
    motion.senses[joint][row] != 0.0 && !(coupled && motion.senses[5][row] == 0.0)
}

/// Weights of a line about 0, squares of the sum 1.
fn line(count: usize) -> Vec<f64> {
    let middle = 0.5 * (count as f64 - 1.0);
    let weights: Vec<f64> = (0..count).map(|k| k as f64 - middle).collect();
    let norm = weights.iter().map(|w| w * w).sum::<f64>().sqrt().max(1e-12);
    weights.iter().map(|w| w / norm).collect()
}

/// Ends of an open log fade in and out, so that they do not count as jumps.
fn faded(row: usize, motion: &Motion<'_>) -> f64 {
    if motion.closed {
        return 1.0;
    }
    let n = motion.rows();
    let edge = (FADED * n as f64).max(1.0);
    let near = row.min(n - 1 - row) as f64;
    if near >= edge { 1.0 } else { 0.5 - 0.5 * (std::f64::consts::PI * near / edge).cos() }
}

/// White noise as the fastest changes show it; motion has none of them.
fn floor_of_noise(spectrum: &Spectrum, tau: &[f64], window: &[f64]) -> [Vec<f64>; 2] {
    // Fourth differences have 70 times the variance of white noise.
    let differences = tau.windows(5).map(|x| x[0] - 4.0 * x[1] + 6.0 * x[2] - 4.0 * x[3] + x[4]);
    let mut squares: Vec<f64> = differences.map(|x| x * x / 70.0).collect();
    squares.sort_by(f64::total_cmp);
    // The median of the squares of a normal deviate is 0.455 of its variance.
    let variance = squares.get(squares.len() / 2).map_or(0.0, |x| x / 0.455);
    let used = window.iter().map(|w| w * w).sum::<f64>() / window.len().max(1) as f64;
    [vec![variance * used; spectrum.bins], vec![variance; tau.len()]]
}

fn mean(of: &[f64]) -> f64 {
    of.iter().sum::<f64>() / of.len().max(1) as f64
}

/// Amplitude of the last harmonic, of the largest one, above which a motion has no higher ones.
const SHARP: f64 = 1e-3;

/// Number of the last harmonics: one may be small by chance.
const LAST: usize = 3;

/// Whether the spectrum of a periodic motion ends with its last harmonic: that of a motion that is
/// made of harmonics does; that of moves with jumps of the jerk is cut off where noise begins.
fn ends_sharply(samples: &Samples, harmonics: usize) -> bool {
    let Some(block) = samples.blocks.first() else { return false };
    let amplitude = |q: &[f64], k: usize| {
        let (mut c, mut s) = (0.0, 0.0);
        for (row, q) in q.iter().enumerate() {
            let angle = std::f64::consts::TAU * (k * row) as f64 / q_len(block) as f64;
            c += q * angle.cos();
            s += q * angle.sin();
        }
        c.hypot(s)
    };
    block.q.iter().any(|q| {
        let largest = (1..=harmonics).map(|k| amplitude(q, k)).fold(0.0, f64::max);
        let last = harmonics.saturating_sub(LAST - 1).max(1);
        let at_end = (last..=harmonics).map(|k| amplitude(q, k)).fold(0.0, f64::max);
        at_end > SHARP * largest
    })
}

/// Rate up to which a motor stands, of that below which its rows are left out.
const STILL: f64 = 0.2;

/// Rows over which a filter spreads, in parts of the period of its cut-off frequency.
const SPREAD: f64 = 0.8;

/// A window without the rows beside those that are left out.
fn narrowed(window: &[f64], reach: usize, closed: bool) -> Vec<f64> {
    let n = window.len();
    let mut narrow = window.to_vec();
    for row in (0..n).filter(|row| window[*row] == 0.0) {
        for k in 1..=reach.min(n) {
            for other in [(row + n - k % n) % n, (row + k) % n] {
                if closed || other.abs_diff(row) <= reach {
                    narrow[other] = 0.0;
                }
            }
        }
    }
    narrow
}

fn q_len(block: &Block) -> usize {
    block.t.len()
}
