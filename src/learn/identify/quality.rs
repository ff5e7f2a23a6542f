//! How much of the torques a model explains, and whether that is a model at all.

use std::fmt::Write;

use nalgebra::DVector;

use super::equations::Equations;
use super::factors::Factors;
use super::least_squares::solve;
use super::misses::Misses;
use super::samples::{Block, Samples};
use super::whiteness::Whiteness;

/// Mean share of the torques' variance that a good model explains, and a fair one.
const GOOD: f64 = 0.9;
const FAIR: f64 = 0.7;
/// The same of the joint that is explained least.
const GOOD_WORST: f64 = 0.87;
/// How many times the residuals of the free fit those of a model that can be have where signs or
/// columns may be wrong, and where they are.
const ASTRAY: [f64; 2] = [1.5, 3.0];
/// A model that explains less is none.
const NONE: f64 = 0.25;
/// Of a joint that is explained so well nothing is missed.
const EXACT: f64 = 0.999;
/// A friction below zero by so many deviations is none.
const SURE: f64 = 5.0;
/// Largest shift in time that is tried, and the steps it is tried in, first and then \[s\].
const SHIFT: f64 = 1.0;
const STEPS: [f64; 2] = [0.05, 0.01];
/// Instants that tell a shift.
const INSTANTS: usize = 3000;
/// Least variance of a torque, over its mean square.
const LEAST: f64 = 1e-3;
/// Share of the residuals' power that a shift has to take away to be told, a long and a short
/// one.
const GAIN: f64 = 0.5;
const LITTLE: f64 = 0.05;
/// First step of the search for a short shift, the longest one found so, and the shortest that
/// is told \[s\].
const SHORT: f64 = 0.01;
const LONGEST: f64 = 0.4;
const TOLD: f64 = 0.003;
/// Share by which the residuals' power of a joint may grow with a shift of the clocks.
const SPOILED: f64 = 0.1;
/// Residuals that noise has with less than this probability have more in them.
const WHITE: f64 = 1e-3;

/// How good a model is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grade {
    /// It explains the torques.
    Good,
    /// Mostly.
    Fair,
    /// Something else is in them.
    Poor,
    /// No robot that can be has such torques.
    None,
}

/// A statement of how good a model is.
#[derive(Clone, Debug, PartialEq)]
pub struct Quality {
    /// In a word.
    pub grade: Grade,
    /// Share of the variance of each joint's torque that the model explains; not a number
    /// where a joint rests. Less than 0: worse than a constant.
    pub explained: Vec<f64>,
    /// The same of torques that took no part: of other logs, else of fifths of the time from the
    /// other four. None where the motion repeats: a single repetition is mostly noise.
    pub predicted: Option<Vec<f64>>,
    /// Joints whose Coulomb friction in the free fit surely gives power, from 0.
    pub giving_power: Vec<usize>,
    /// The joint, from 0, at which the model misses the most times what the free fit does, where
    /// that is strange.
    pub astray: Option<(usize, f64)>,
    /// By how much the torques fit the motion better if they are taken from later, \[s\].
    pub late: Option<f64>,
    /// How many times the weight of the robot file's masses the torques carry, where that is
    /// strange.
    pub weight: Option<f64>,
}

impl Quality {
    /// Takes note that the torques carry `factor` times the weight of the robot file's masses: far
    /// less are those of motors or of another unit, far more may be a file without true masses.
    pub fn doubt_weight(&mut self, factor: f64) {
        self.weight = Some(factor);
        self.grade = match self.grade {
            Grade::None => Grade::None,
            _ if factor < 1.0 => Grade::Poor,
            Grade::Good => Grade::Fair,
            grade => grade,
        };
    }

    /// In a sentence.
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

/// What is said of a model that explains these `shares` of the torques, of those that it was fitted
/// to and of those that took no part, and misses `rms` \[Nm\] of `samples`, of
/// which the free fit misses `free`; `giving_power` are the
/// joints whose friction surely does, `whiteness` is that of the free fit.
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
    // A joint that is not explained is not made good by the others.
    let worst = shares().flatten().copied().fold(1.0, f64::min);
    let reversed = 2 * giving_power.len() > moving;
    // Residuals of some size: what data without noise leave is rounding.
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

/// Whether a value is surely below 0.
#[must_use]
pub(super) fn surely_negative(value: f64, sd: f64) -> bool {
    value < -SURE * sd
}

/// The mean share of the moving joints.
fn mean(shares: &[f64]) -> f64 {
    let known = || shares.iter().filter(|share| share.is_finite());
    known().map(|share| share.clamp(0.0, 1.0)).sum::<f64>() / known().count().max(1) as f64
}

/// The share of the variance of each joint's torque, as the equations have it, behind a filter;
/// not a number where a joint rests.
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

/// The shift in time with which torques fit the motion best, where that is far better \[s\].
fn late(equations: &Equations<'_>, samples: &Samples) -> Option<f64> {
    let block = samples.blocks.iter().max_by_key(|block| block.instants())?;
    let miss = |shift: f64| missed(equations, samples, block, shift);
    let mut best = (0.0, miss(0.0)?);
    let none = best.1;
    for step in STEPS {
        let middle = best.0;
        let reach = if step == STEPS[0] { SHIFT } else { STEPS[0] };
        let steps = (reach / step).round() as i32;
        for k in -steps..=steps {
            let shift = middle + step * f64::from(k);
            if let Some(found) = miss(shift).filter(|found| *found < best.1) {
                best = (shift, found);
            }
        }
    }
    (best.1 < GAIN * none).then_some(best.0)
}

/// A short shift: downhill from none, by whole samples, as noise between two is smaller than
/// theirs; then between them by a parabola. Joints count by their residuals `rms` \[Nm\].
fn slightly_late(equations: &Equations<'_>, samples: &Samples, rms: &[f64]) -> Option<f64> {
    let block = samples.blocks.iter().max_by_key(|block| block.instants())?;
    let weights: Vec<f64> =
        rms.iter().map(|rms| if *rms > 0.0 { 1.0 / rms } else { 0.0 }).collect();
    let width = (SHORT / samples.step).round().max(1.0) as isize;
    let most = (LONGEST / samples.step) as isize;
    let by_joint = |k: isize| {
        let part = shifted(samples, block, k)?;
        Some(missed_by(equations, &part, |_| weights.clone()))
    };
    let miss = |k: isize| Some(by_joint(k)?.iter().sum::<f64>());
    let none = miss(0)?;
    let (mut middle, mut here) = (0, none);
    let [mut before, mut after] = [miss(-width)?, miss(width)?];
    while before < here || after < here {
        let sense = if before < after { -1 } else { 1 };
        let next = middle + sense * width;
        if next.abs() > most {
            return None;
        }
        let beyond = miss(next + sense * width)?;
        (before, here, after) =
            if sense < 0 { (beyond, before, here) } else { (here, after, beyond) };
        middle = next;
    }
    let bend = before + after - 2.0 * here;
    let place = if bend > 0.0 { 0.5 * (before - after) / bend } else { 0.0 };
    let late = (middle as f64 + place * width as f64) * samples.step;
    let least = here - 0.25 * (before - after) * place;
    // Rows far apart tell no less than half of their distance.
    let told = if samples.step > SHORT { 0.5 * samples.step } else { TOLD };
    if late.abs() < told || least > (1.0 - LITTLE) * none {
        return None;
    }
    // Clocks are those of all joints: what spoils one of them is something else.
    let [none, before, here, after] =
        [by_joint(0)?, by_joint(middle - width)?, by_joint(middle)?, by_joint(middle + width)?];
    let spoiled = (0..none.len()).any(|j| {
        let (slope, bend) = (after[j] - before[j], before[j] + after[j] - 2.0 * here[j]);
        let there = here[j] + 0.5 * place * (slope + bend * place);
        there > (1.0 + SPOILED) * none[j]
    });
    (!spoiled).then_some(late)
}

/// Sum over the joints of the share of the torque's power that a free fit misses, with the
/// torques taken from `shift` later \[s\].
fn missed(equations: &Equations<'_>, samples: &Samples, block: &Block, shift: f64) -> Option<f64> {
    let part = shifted(samples, block, (shift / samples.step).round() as isize)?;
    let of_torque = |factors: &Factors| -> Vec<f64> {
        let torque = factors.squares.iter().flatten();
        torque.map(|sum| if *sum > 0.0 { 1.0 / sum.sqrt() } else { 0.0 }).collect()
    };
    Some(missed_by(equations, &part, of_torque).iter().sum())
}

/// The weighted power that a free fit misses, by joint.
fn missed_by(
    equations: &Equations<'_>,
    samples: &Samples,
    weights: impl Fn(&Factors) -> Vec<f64>,
) -> Vec<f64> {
    let factors = Factors::of(equations, samples, 1);
    let weights = weights(&factors);
    let beta: DVector<f64> = solve(&factors.stacked(&weights, equations.base.rank())).beta;
    let squares = factors.residual_squares(&beta, None);
    squares.iter().zip(&weights).map(|(e, w)| e * w * w).collect()
}

/// Instants from the middle of a block with the torques of so many samples later; `None` where
/// it is too short.
fn shifted(samples: &Samples, block: &Block, moved: isize) -> Option<Samples> {
    let step = samples.step;
    let margin = (SHIFT / step).ceil() as usize + (STEPS[0] / step).ceil() as usize;
    let last = block.instants().checked_sub(margin).filter(|last| *last > 2 * margin)?;
    let kept = margin..last.min(margin + INSTANTS.max(2 * margin));
    let of = |series: &Vec<Vec<f64>>| -> Vec<Vec<f64>> {
        series.iter().map(|x| x[kept.clone()].to_vec()).collect()
    };
    let later = |x: &Vec<f64>| -> Vec<f64> {
        kept.clone().filter_map(|i| x.get(i.checked_add_signed(moved)?).copied()).collect()
    };
    let part = Block {
        t: block.t[kept.clone()].to_vec(),
        q: of(&block.q),
        qd: of(&block.qd),
        qdd: of(&block.qdd),
        tau: block.tau.iter().map(later).collect(),
        clipped: block.clipped.clone(),
    };
    Some(Samples { blocks: vec![part], noise: None, repetitions: None, ..samples.clone() })
}
