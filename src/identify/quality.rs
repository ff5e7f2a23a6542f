//! How much of the torques a model explains, and whether that is a model at all.

use std::fmt::Write;

use nalgebra::DVector;

use super::equations::Equations;
use super::factors::Factors;
use super::least_squares::solve;
use super::samples::{Block, Samples};
use super::work::Misses;

/// Mean share of the torques' variance that a good model explains, and a fair one.
const GOOD: f64 = 0.9;
const FAIR: f64 = 0.7;
/// A model that explains less is none.
const NONE: f64 = 0.25;
/// A friction below zero by so many deviations is none.
const SURE: f64 = 5.0;
/// Largest shift in time that is tried, and the steps it is tried in, first and then \[s\].
const SHIFT: f64 = 1.0;
const STEPS: [f64; 2] = [0.05, 0.01];
/// Instants that tell a shift.
const INSTANTS: usize = 3000;
/// Least variance of a torque, over its mean square.
const LEAST: f64 = 1e-3;
/// Share of the residuals' power that a shift has to take away to be told.
const GAIN: f64 = 0.5;

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
    /// Joints whose Coulomb friction in the free fit surely gives power, from 0.
    pub giving_power: Vec<usize>,
    /// By how much the torques fit the motion better if they are taken from later, \[s\].
    pub late: Option<f64>,
}

impl Quality {
    /// The mean share of the moving joints.
    #[must_use]
    pub fn mean(&self) -> f64 {
        let known = || self.explained.iter().filter(|share| share.is_finite());
        known().map(|share| share.clamp(0.0, 1.0)).sum::<f64>() / known().count().max(1) as f64
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
        let mut text = format!("{word}: explains {:.1} % of the torques", 100.0 * self.mean());
        let named = |joints: Vec<usize>| -> String {
            joints.iter().map(|joint| (joint + 1).to_string()).collect::<Vec<_>>().join(", ")
        };
        let weak = |joint: &usize| self.explained[*joint] < FAIR;
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
        if let Some(late) = self.late {
            let when = if late > 0.0 { "later" } else { "earlier" };
            let _ =
                write!(text, ", torques seem to be {:.2} s {when} than the positions", late.abs());
        }
        text
    }
}

/// What is said of a model with the residuals `misses` on `samples`; `giving_power` are the
/// joints whose friction surely does.
#[must_use]
pub(super) fn quality(
    equations: &Equations<'_>,
    samples: &Samples,
    misses: &Misses,
    giving_power: Vec<usize>,
) -> Quality {
    let explained: Vec<f64> = (0..misses.rms.len())
        .map(|joint| {
            let moves = !samples.resting.contains(&joint);
            if moves { explained(samples, misses, joint) } else { f64::NAN }
        })
        .collect();
    let moving = misses.rms.len() - samples.resting.len();
    let mut quality = Quality { grade: Grade::Good, explained, giving_power, late: None };
    let mean = quality.mean();
    let reversed = 2 * quality.giving_power.len() > moving;
    quality.grade = if mean < NONE || reversed {
        Grade::None
    } else if mean < FAIR {
        Grade::Poor
    } else if mean < GOOD {
        Grade::Fair
    } else {
        Grade::Good
    };
    if quality.grade != Grade::Good {
        quality.late = late(equations, samples);
    }
    quality
}

/// Whether a value is surely below 0.
#[must_use]
pub(super) fn surely_negative(value: f64, sd: f64) -> bool {
    value < -SURE * sd
}

/// The share of the variance of a joint's torque, as the equations have it, behind a filter.
fn explained(samples: &Samples, misses: &Misses, joint: usize) -> f64 {
    let all = || samples.blocks.iter().flat_map(|block| &block.tau[joint]);
    let mean = all().sum::<f64>() / samples.len().max(1) as f64;
    let (rms, relative) = (misses.rms[joint], misses.relative[joint]);
    if rms == 0.0 {
        return 1.0;
    }
    let square = (rms / relative).powi(2);
    1.0 - rms * rms / (square - mean * mean).max(LEAST * square)
}

/// The shift in time with which torques fit the motion best, where that is far better \[s\].
fn late(equations: &Equations<'_>, samples: &Samples) -> Option<f64> {
    let block = samples.blocks.iter().max_by_key(|block| block.len())?;
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

/// Sum over the joints of the share of the torque's power that a free fit misses, with the
/// torques taken from `shift` later \[s\].
fn missed(equations: &Equations<'_>, samples: &Samples, block: &Block, shift: f64) -> Option<f64> {
    let step = samples.step;
    let margin = (SHIFT / step).ceil() as usize + (STEPS[0] / step).ceil() as usize;
    let last = block.len().checked_sub(margin).filter(|last| *last > 2 * margin)?;
    let kept = margin..last.min(margin + INSTANTS.max(2 * margin));
    let moved = (shift / step).round() as isize;
    let of = |series: &Vec<Vec<f64>>| -> Vec<Vec<f64>> {
        series.iter().map(|x| x[kept.clone()].to_vec()).collect()
    };
    let tau = block
        .tau
        .iter()
        .map(|x| {
            kept.clone().filter_map(|i| x.get(i.checked_add_signed(moved)?).copied()).collect()
        })
        .collect();
    let part = Block {
        t: block.t[kept.clone()].to_vec(),
        q: of(&block.q),
        qd: of(&block.qd),
        qdd: of(&block.qdd),
        tau,
        clipped: block.clipped.clone(),
    };
    let samples = Samples { blocks: vec![part], noise: None, repetitions: None, ..samples.clone() };
    let factors = Factors::of(equations, &samples, 1);
    let torque: Vec<f64> = factors.squares.iter().flatten().copied().collect();
    let weights: Vec<f64> =
        torque.iter().map(|sum| if *sum > 0.0 { 1.0 / sum.sqrt() } else { 0.0 }).collect();
    let beta: DVector<f64> = solve(&factors.stacked(&weights, equations.base.rank())).beta;
    let squares = factors.residual_squares(&beta, None);
    Some(squares.iter().zip(&weights).map(|(e, w)| e * w * w).sum())
}
