//! Whether the gears of axes 5 and 6 are coupled, told by the torques.

use crate::arm::dynamics::BaseParameters;
use crate::arm::robot::Model;

use super::equations::{Equations, Known};
use super::factors::Factors;
use super::fit::without_errors;
use super::samples::{Block, Samples, Source};

/// Couplings that are tried first.
const TRIED: [f64; 8] = [1.0, -1.0, 0.5, -0.5, 1.5, -1.5, 2.0, -2.0];
/// Least change of the logarithms of both residuals that tells a coupling.
const TOLD: f64 = 0.4;
/// How far from a tried coupling it is sought.
const AROUND: f64 = 0.3;
/// Steps of the search.
const STEPS: usize = 16;
/// A coupling as near to a tried one as this is that one.
const ROUND: f64 = 0.03;
/// Instants that are enough.
const INSTANTS: usize = 6000;

/// The coupling that the samples show; `None` where they show none.
#[must_use]
pub(super) fn wrist_coupling(
    model: &Model,
    base: &BaseParameters,
    samples: &Samples,
) -> Option<f64> {
    if model.dof != 6 || samples.resting.iter().any(|joint| *joint >= 4) {
        return None;
    }
    let samples = shortened(samples);
    let miss = |coupling: f64| {
        let mut model = model.clone();
        model.wrist.coupling = coupling;
        let equations = Equations { model: &model, base, known: Known::Nothing };
        let factors = Factors::of(&equations, &samples, 1);
        let rms = without_errors(&factors, base.rank());
        rms[4].ln() + rms[5].ln()
    };
    let none = miss(0.0);
    let tried = TRIED.map(|coupling| (coupling, miss(coupling)));
    let (near, best) = tried.into_iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let gain = none - best;
    if gain.is_nan() || gain <= TOLD {
        return None;
    }
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut low, mut high) = (near - AROUND, near + AROUND);
    let mut inner = [high - golden * (high - low), low + golden * (high - low)];
    let mut values = inner.map(miss);
    for _ in 0..STEPS {
        if values[0] < values[1] {
            high = inner[1];
            inner = [high - golden * (high - low), inner[0]];
            values = [miss(inner[0]), values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + golden * (high - low)];
            values = [values[1], miss(inner[1])];
        }
    }
    let found = 0.5 * (low + high);
    Some(if (found - near).abs() < ROUND { near } else { found })
}

/// As many samples as are needed, from the middle.
fn shortened(samples: &Samples) -> Samples {
    let Some(longest) = samples.blocks.iter().max_by_key(|block| block.instants()) else {
        return samples.clone();
    };
    let count = longest.instants();
    // What was filtered has to stay in one piece; rows of their own need not.
    let kept: Vec<usize> = match samples.source {
        Source::Filtered { .. } => {
            let length = count.min(INSTANTS);
            let first = (count - length) / 2;
            (first..first + length).collect()
        }
        _ => (0..count).step_by(count.div_ceil(INSTANTS).max(1)).collect(),
    };
    let of = |series: &[Vec<f64>]| -> Vec<Vec<f64>> {
        series.iter().map(|x| kept.iter().map(|i| x[*i]).collect()).collect()
    };
    let block = Block {
        t: kept.iter().map(|i| longest.t[*i]).collect(),
        q: of(&longest.q),
        qd: of(&longest.qd),
        qdd: of(&longest.qdd),
        tau: of(&longest.tau),
        clipped: longest.clipped.clone(),
    };
    Samples { blocks: vec![block], ..samples.clone() }
}
