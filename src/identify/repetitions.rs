//! Cross-validation over the repetitions of a motion: each is predicted by what the others
//! say.

use super::equations::Equations;
use super::factors::Factors;
use super::fit::{Weighting, reweighted};
use super::samples::{Block, Samples};

/// Groups of repetitions at most.
const GROUPS: usize = 5;

/// Sums of each joint's squared residuals \[N²m²\] for one instant of a repetition each, and
/// their number; `None` where fewer than two repetitions are known.
#[must_use]
pub(super) fn cross_squares(
    equations: &Equations<'_>,
    samples: &Samples,
    weighting: Weighting,
) -> Option<(Vec<f64>, Vec<usize>)> {
    let spread = samples.repetitions.as_ref()?;
    let [block] = samples.blocks.as_slice() else { return None };
    let count = spread.first()?.len();
    if count < 2 {
        return None;
    }
    let groups = count.min(GROUPS);
    let joints = spread.len();
    let (mut sums, mut rows) = (vec![0.0; joints], vec![0; joints]);
    for group in 0..groups {
        let members: Vec<usize> = (group..count).step_by(groups).collect();
        // The mean of the others, as it differs from that of all.
        let others = |r: usize| !members.contains(&r);
        let trained = moved(block, spread, &others);
        let factors = Factors::of(equations, &with(samples, trained), 1);
        let (solution, _) = reweighted(&factors, weighting, equations.base.rank());
        for member in &members {
            let tested = moved(block, spread, &|r: usize| r == *member);
            let factors = Factors::of(equations, &with(samples, tested), 1);
            let squares = factors.residual_squares(&solution.beta, None);
            let counted = factors.rows_without(None);
            for joint in 0..joints {
                sums[joint] += squares[joint];
                rows[joint] += counted[joint];
            }
        }
    }
    Some((sums, rows))
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

/// The motion with the mean torque of some repetitions.
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
