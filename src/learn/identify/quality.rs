//! Share of the measured torques that a model explains, and its grade.

use std::fmt::Write;

use nalgebra::DVector;

use crate::learn::log::{downhill, on_grid, vertex};

use super::equations::Equations;
use super::factors::Factors;
use super::least_squares::solve;
use super::misses::Misses;
use super::samples::{Block, Samples};
use super::whiteness::Whiteness;

/// Least mean explained share of the torques' variance for a good and for a fair model.
const GOOD: f64 = 0.9;
const FAIR: f64 = 0.7;
/// Least explained share of the worst joint for a good model.
const GOOD_WORST: f64 = 0.87;
/// Ratio of the residuals of the physically consistent model to those of the unconstrained fit
/// above which a model is at most fair, and above which it is poor.
const ASTRAY: [f64; 2] = [1.5, 3.0];
/// Least mean explained share of a usable model.
const NONE: f64 = 0.25;
/// Explained share above which the residuals of a joint may be rounding errors.
const EXACT: f64 = 0.999;
/// Standard deviations below 0 at which a friction is significantly negative.
const SURE: f64 = 5.0;
/// Largest time shift, and its coarse and fine step \[s\].
const SHIFT: f64 = 1.0;
const STEPS: [f64; 2] = [0.05, 0.01];
/// Number of instants for the estimate of a shift.
const INSTANTS: usize = 3000;
/// Least variance of a torque over its mean square.
const LEAST: f64 = 1e-3;
/// Least share of the residuals' power that a long and a short shift have to remove.
const GAIN: f64 = 0.5;
const LITTLE: f64 = 0.05;
/// Step of the search for a short shift, its largest and its least value \[s\].
const SHORT: f64 = 0.01;
const LONGEST: f64 = 0.4;
const TOLD: f64 = 0.003;
/// Largest relative increase of a joint's residual power by a shift.
const SPOILED: f64 = 0.1;
/// p-value of the whiteness test below which the residuals count as not white.
const WHITE: f64 = 1e-3;

/// Grade of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grade {
    /// It explains the torques.
    Good,
    /// It explains most of the torques.
    Fair,
    /// It explains only a part of the torques.
    Poor,
    /// No physically possible robot explains the torques.
    None,
}

/// Quality of a model on measured torques.
#[derive(Clone, Debug, PartialEq)]
pub struct Quality {
    /// The grade.
    pub grade: Grade,
    /// Explained share of the variance of each joint's torque; NaN for a resting joint, negative if
    /// worse than a constant.
    pub explained: Vec<f64>,
    /// The same for held-out torques: validation logs, else cross-validation over fifths of the
    /// time. `None` for a repeated motion: a single repetition is mostly noise.
    pub predicted: Option<Vec<f64>>,
    /// Joints, from 0, with significantly negative Coulomb friction in the unconstrained fit.
    pub giving_power: Vec<usize>,
    /// The joint, from 0, with the largest ratio of model residuals to those of the unconstrained
    /// fit, and that ratio, if it is suspicious.
    pub astray: Option<(usize, f64)>,
    /// Delay of the torques relative to the motion, if it explains much of the residuals \[s\].
    pub late: Option<f64>,
    /// Measured weight over that of the robot file's masses, if it is suspicious.
    pub weight: Option<f64>,
}

impl Quality {
    /// Records that the torques carry `factor` times the weight of the robot file's masses. Far
    /// below 1 they are motor torques or in another unit; far above 1 the masses may be wrong.
    pub fn doubt_weight(&mut self, factor: f64) {
        self.weight = Some(factor);
        self.grade = match self.grade {
            Grade::None => Grade::None,
            _ if factor < 1.0 => Grade::Poor,
            Grade::Good => Grade::Fair,
            grade => grade,
        };
    }

    /// The quality as a sentence.
    #[must_use]
    pub fn sentence(&self) -> String {
        let word = match self.grade {
            Grade::Good => "good",
            Grade::Fair => "fair",
            Grade::Poor => "poor",
            Grade::None => "none",
        };
        let mut text =
            format!("{word}: explains {:.1} % of the torques", 100.0 * mean(&self.explained));
        if let Some(predicted) = &self.predicted {
            let share = 100.0 * mean(predicted);
            let _ = write!(text, ", {share:.1} % of those that it was not fitted to");
        }
        let named = |joints: Vec<usize>| -> String {
            joints.iter().map(|joint| (joint + 1).to_string()).collect::<Vec<_>>().join(", ")
        };
        let weak = |joint: &usize| self.explained[*joint] < GOOD_WORST;
        let weak: Vec<usize> = (0..self.explained.len()).filter(weak).collect();
        if !weak.is_empty() {
            let shares: Vec<String> =
                weak.iter().map(|j| format!("{:.0} %", 100.0 * self.explained[*j])).collect();
            let _ = write!(text, ", of joints {} only {}", named(weak), shares.join(", "));
        }
        if !self.giving_power.is_empty() {
            let joints = named(self.giving_power.clone());
            let _ = write!(text, ", friction of joints {joints} would give power");
        }
        if let Some((joint, times)) = self.astray {
            let _ = write!(
                text,
                ", joint {} misses {times:.1} times what a fit with any masses does: has a column \
                 the wrong sign or place?",
                joint + 1
            );
        }
        if let Some(factor) = self.weight {
            let _ = write!(
                text,
                ", which carry {} times the weight of the robot file's masses",
                if factor < 1.0 { format!("{factor:.3}") } else { format!("{factor:.0}") }
            );
        }
        if let Some(late) = self.late {
            let when = if late > 0.0 { "later" } else { "earlier" };
            let late = late.abs();
            let by =
                if late < 0.1 { format!("{:.0} ms", 1e3 * late) } else { format!("{late:.2} s") };
            let _ = write!(text, ", torques seem to be {by} {when} than the positions");
        }
        text
    }
}

/// The quality of a model with the residuals `rms` \[Nm\] on `samples`; the unconstrained fit has
/// the residuals `free` and `whiteness`. `explained` and `predicted` are shares of the training and
/// held-out torques.
#[must_use]
pub(super) fn quality(
    equations: &Equations<'_>,
    samples: &Samples,
    [rms, free]: [&[f64]; 2],
    (explained, predicted): (Vec<f64>, Option<Vec<f64>>),
    giving_power: Vec<usize>,
    whiteness: &[Option<Whiteness>],
) -> Quality {
    let moving = rms.len() - samples.resting.len();
    let shares = || [Some(&explained), predicted.as_ref()].into_iter().flatten();
    let mean_of_fitted = mean(&explained);
    let mean = shares().map(|of| mean(of)).fold(1.0, f64::min);
    // A poor joint is not compensated by the others.
    let worst = shares().flatten().copied().fold(1.0, f64::min);
    let reversed = 2 * giving_power.len() > moving;
    // The ratio of rounding errors is meaningless.
    let times =
        |joint: usize| (explained[joint] < EXACT).then(|| (joint, rms[joint] / free[joint]));
    let astray = (0..rms.len()).filter_map(times).max_by(|a, b| a.1.total_cmp(&b.1));
    let times = astray.map_or(1.0, |(_, times)| times);
    let grade = if mean_of_fitted < NONE || reversed {
        Grade::None
    } else if mean < FAIR || worst < NONE || times > ASTRAY[1] {
        Grade::Poor
    } else if mean < GOOD || worst < GOOD_WORST || times > ASTRAY[0] {
        Grade::Fair
    } else {
        Grade::Good
    };
    let astray = astray.filter(|(_, times)| *times > ASTRAY[0]);
    let mut quality =
        Quality { grade, explained, predicted, giving_power, astray, late: None, weight: None };
    if quality.grade != Grade::Good {
        quality.late = late(equations, samples);
    }
    let white = whiteness.iter().flatten().all(|of| of.p_value > WHITE);
    if quality.late.is_none() && !white {
        quality.late = slightly_late(equations, samples, rms);
    }
    if quality.late.is_some() && quality.grade == Grade::Good {
        quality.grade = Grade::Fair;
    }
    quality
}

/// Whether a value is significantly negative.
#[must_use]
pub(super) fn surely_negative(value: f64, sd: f64) -> bool {
    value < -SURE * sd
}

/// Mean share over the moving joints.
fn mean(shares: &[f64]) -> f64 {
    let known = || shares.iter().filter(|share| share.is_finite());
    known().map(|share| share.clamp(0.0, 1.0)).sum::<f64>() / known().count().max(1) as f64
}

/// Explained share of the variance of each joint's filtered torque; NaN for a resting joint.
#[must_use]
pub(super) fn explained(samples: &[Samples], misses: &Misses) -> Vec<f64> {
    let count: usize = samples.iter().map(Samples::instants).sum();
    let share = |(joint, (rms, relative)): (usize, (&f64, &f64))| {
        if samples.iter().all(|of| of.resting.contains(&joint)) {
            return f64::NAN;
        }
        if *rms == 0.0 {
            return 1.0;
        }
        let blocks = samples.iter().flat_map(|of| &of.blocks);
        let mean = blocks.flat_map(|block| &block.tau[joint]).sum::<f64>() / count.max(1) as f64;
        let square = (rms / relative).powi(2);
        1.0 - rms * rms / (square - mean * mean).max(LEAST * square)
    };
    misses.rms.iter().zip(&misses.relative).enumerate().map(share).collect()
}

/// The time shift \[s\] with which the torques fit the motion much better, if it exists.
fn late(equations: &Equations<'_>, samples: &Samples) -> Option<f64> {
    let block = samples.blocks.iter().max_by_key(|block| block.instants())?;
    let miss = |shift: f64| missed(equations, samples, block, shift);
    let none = miss(0.0)?;
    let [coarse, fine] = STEPS;
    let near = on_grid(0.0, coarse, (SHIFT / coarse).round() as i32, miss)?;
    let best = on_grid(near.shift, fine, (coarse / fine).round() as i32, miss)?;
    (best.misfit < GAIN * none).then_some(best.shift)
}

/// A short time shift \[s\]: descent from 0 in whole samples, because interpolation would smooth
/// the noise; then a parabola. Joints are weighted by their residuals `rms` \[Nm\].
fn slightly_late(equations: &Equations<'_>, samples: &Samples, rms: &[f64]) -> Option<f64> {
    let block = samples.blocks.iter().max_by_key(|block| block.instants())?;
    let weights: Vec<f64> =
        rms.iter().map(|rms| if *rms > 0.0 { 1.0 / rms } else { 0.0 }).collect();
    let width = (SHORT / samples.step).round().max(1.0) as isize;
    let most = (LONGEST / samples.step) as isize / width;
    let by_joint = |steps: isize| {
        let part = shifted(samples, block, steps * width)?;
        Some(missed_by(equations, &part, |_| weights.clone()))
    };
    let miss = |steps: isize| Some(by_joint(steps)?.iter().sum::<f64>());
    let none = miss(0)?;
    let (middle, around) = downhill(most, miss)?;
    let place = vertex(around).unwrap_or(0.0);
    let [before, here, after] = around;
    let late = ((middle * width) as f64 + place * width as f64) * samples.step;
    let least = here - 0.25 * (before - after) * place;
    // Shifts below half a sample interval are not resolved.
    let told = if samples.step > SHORT { 0.5 * samples.step } else { TOLD };
    if late.abs() < told || least > (1.0 - LITTLE) * none {
        return None;
    }
    // All joints share the clocks: if a joint becomes worse, the cause is not a delay.
    let [none, before, here, after] =
        [by_joint(0)?, by_joint(middle - 1)?, by_joint(middle)?, by_joint(middle + 1)?];
    let spoiled = (0..none.len()).any(|j| {
        let (slope, bend) = (after[j] - before[j], before[j] + after[j] - 2.0 * here[j]);
        let there = here[j] + 0.5 * place * (slope + bend * place);
        there > (1.0 + SPOILED) * none[j]
    });
    (!spoiled).then_some(late)
}

/// Unexplained share of the torque's power in an unconstrained fit, summed over the joints, with
/// the torques taken `shift` \[s\] later.
fn missed(equations: &Equations<'_>, samples: &Samples, block: &Block, shift: f64) -> Option<f64> {
    let part = shifted(samples, block, (shift / samples.step).round() as isize)?;
    let of_torque = |factors: &Factors| -> Vec<f64> {
        let torque = factors.squares.iter().flatten();
        torque.map(|sum| if *sum > 0.0 { 1.0 / sum.sqrt() } else { 0.0 }).collect()
    };
    Some(missed_by(equations, &part, of_torque).iter().sum())
}

/// Weighted residual power of an unconstrained fit, by joint.
fn missed_by(
    equations: &Equations<'_>,
    samples: &Samples,
    weights: impl Fn(&Factors) -> Vec<f64>,
) -> Vec<f64> {
    let factors = Factors::new(equations, samples, 1);
    let weights = weights(&factors);
    let beta: DVector<f64> = solve(&factors.stacked(&weights, equations.base.rank())).beta;
    let squares = factors.residual_squares(&beta, None);
    squares.iter().zip(&weights).map(|(e, w)| e * w * w).collect()
}

/// Instants from the middle of a block with the torques taken `moved` samples later; `None` if the
/// block is too short.
fn shifted(samples: &Samples, block: &Block, moved: isize) -> Option<Samples> {
    let step = samples.step;
    let margin = (SHIFT / step).ceil() as usize + (STEPS[0] / step).ceil() as usize;
    let last = block.instants().checked_sub(margin).filter(|last| *last > 2 * margin)?;
    let kept: Vec<usize> = (margin..last.min(margin + INSTANTS.max(2 * margin))).collect();
    let later: Vec<usize> = kept.iter().filter_map(|i| i.checked_add_signed(moved)).collect();
    let mut part = block.select(&kept);
    part.tau = block.select(&later).tau;
    Some(Samples { blocks: vec![part], noise: None, repetitions: None, ..samples.clone() })
}
