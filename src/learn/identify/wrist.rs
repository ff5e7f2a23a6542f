//! Identification of the gear coupling of axes 5 and 6: the coupling that gives a fit of all
//! parameters the least residuals.
//!
//! `gap::coupled` identifies a change of a known coupling, together with other effects.

use crate::arm::dynamics::BaseParameters;
use crate::arm::robot::Model;
use crate::learn::log::golden_section;

use super::equations::{Equations, Known};
use super::factors::Factors;
use super::fit::without_errors;
use super::samples::{Samples, Source};

/// Couplings of the coarse search.
const TRIED: [f64; 8] = [1.0, -1.0, 0.5, -0.5, 1.5, -1.5, 2.0, -2.0];
/// Least decrease of the sum of the logarithms of both joints' residuals.
const TOLD: f64 = 0.4;
/// Half width of the fine search around the best of them.
const AROUND: f64 = 0.3;
/// Steps of the golden section search.
const STEPS: usize = 16;
/// A result this near to a coarse value is replaced by it.
const ROUND: f64 = 0.03;
/// Largest number of instants.
const INSTANTS: usize = 6000;

/// The coupling \[1\], if it explains the torques of axes 5 and 6 much better than none.
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
        let factors = Factors::new(&equations, &samples, 1);
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
    let found = golden_section([near - AROUND, near + AROUND], STEPS, miss);
    Some(if (found - near).abs() < ROUND { near } else { found })
}

/// At most [`INSTANTS`] instants of the longest block.
fn shortened(samples: &Samples) -> Samples {
    let Some(longest) = samples.blocks.iter().max_by_key(|block| block.instants()) else {
        return samples.clone();
    };
    let count = longest.instants();
    // Filtered samples have to be consecutive.
    let kept: Vec<usize> = match samples.source {
        Source::Filtered { .. } => {
            let length = count.min(INSTANTS);
            let first = (count - length) / 2;
            (first..first + length).collect()
        }
        _ => (0..count).step_by(count.div_ceil(INSTANTS).max(1)).collect(),
    };
    Samples { blocks: vec![longest.select(&kept)], ..samples.clone() }
}
