//! Cross-validation over the repetitions of a motion: the others predict each of them.

use nalgebra::DVector;

use super::equations::Equations;
use super::factors::Factors;
use super::samples::{Block, Samples};

/// Largest number of groups of repetitions.
const GROUPS: usize = 5;

/// A fold: held-out repetitions and the others.
#[derive(Clone, Debug)]
pub(super) struct Fold {
    /// The equations with the mean torque of the others.
    pub(super) trained: Factors,
    /// The equations of each held-out repetition.
    pub(super) tested: Vec<Factors>,
}

/// Groups of repetitions, each with the others for training; `None` for fewer than two.
#[must_use]
pub(super) fn folds(equations: &Equations<'_>, samples: &Samples) -> Option<Vec<Fold>> {
    let spread = samples.repetitions.as_ref()?;
    let [block] = samples.blocks.as_slice() else { return None };
    let count = spread.first()?.len();
    if count < 2 {
        return None;
    }
    let groups = count.min(GROUPS);
    let factors = |moved: Block| Factors::new(equations, &with(samples, moved), 1);
    let fold = |group: usize| {
        let members: Vec<usize> = (group..count).step_by(groups).collect();
        // The mean of the others, relative to the mean of all.
        let others = |r: usize| !members.contains(&r);
        let tested = |member: &usize| factors(moved(block, spread, &|r: usize| r == *member));
        Fold {
            trained: factors(moved(block, spread, &others)),
            tested: members.iter().map(tested).collect(),
        }
    };
    Some((0..groups).map(fold).collect())
}

/// Sums of each joint's squared residuals \[N²m²\], for one instant of a single repetition, and the
/// number of residuals.
#[must_use]
pub(super) fn cross_squares(
    folds: &[Fold],
    joints: usize,
    found: &dyn Fn(&Factors) -> DVector<f64>,
) -> (Vec<f64>, Vec<usize>) {
    let (mut sums, mut rows) = (vec![0.0; joints], vec![0; joints]);
    for fold in folds {
        let beta = found(&fold.trained);
        for factors in &fold.tested {
            let squares = factors.residual_squares(&beta, None);
            let counted = factors.rows_without(None);
            for joint in 0..joints {
                sums[joint] += squares[joint];
                rows[joint] += counted[joint];
            }
        }
    }
    (sums, rows)
}

fn with(samples: &Samples, block: Block) -> Samples {
    Samples {
        blocks: vec![block],
        source: samples.source.clone(),
        step: samples.step,
        rest: samples.rest.clone(),
        resting: samples.resting.clone(),
        noise: None,
        repetitions: None,
    }
}

/// The motion with the mean torque of the repetitions that `of` selects.
fn moved(block: &Block, spread: &[Vec<Vec<f64>>], of: &dyn Fn(usize) -> bool) -> Block {
    let mut block = block.clone();
    for (tau, repetitions) in block.tau.iter_mut().zip(spread) {
        let used = || repetitions.iter().enumerate().filter(|(r, _)| of(*r)).map(|(_, e)| e);
        let count = used().count().max(1) as f64;
        for (k, tau) in tau.iter_mut().enumerate() {
            *tau += used().map(|e| e[k]).sum::<f64>() / count;
        }
    }
    block
}
