//! The figures of a proof from its estimate.

use super::estimate::Estimate;
use super::interval::Uncertainty;
use super::proof::{Adjustment, CycleTime};
use super::series::Measure;
use super::strata::Stratum;
use super::unit::Unit;

/// Standard errors beyond which a difference of the durations is seen, and its least share.
const LONGER: f64 = 1.645;
const LEAST_LONGER: f64 = 1e-3;

/// The durations of both sides.
pub(super) fn cycle_time(of: &Estimate, uncertain: Option<&Uncertainty>) -> CycleTime {
    let longer = of.duration[1] - of.duration[0];
    let is_longer = uncertain.is_some_and(|uncertain| {
        longer > LONGER * uncertain.error_s && longer > LEAST_LONGER * of.duration[0]
    });
    CycleTime {
        means_s: of.duration,
        difference_high_s: uncertain.map(|of| of.longer),
        foreign_s: of.foreign,
        is_longer,
    }
}

/// The routine adjustments.
pub(super) fn adjustments(of: &Estimate, measure: Measure) -> Vec<Adjustment> {
    let mut found = Vec::new();
    if measure == Measure::Cabinet {
        found.push(Adjustment {
            name: "cycle time",
            change: of.foreign,
            unit: "s",
            slope: of.slopes[0],
            slope_sd: of.slopes_sd[0],
            energy_j: of.slopes[0] * of.foreign,
        });
    }
    if of.slopes_sd[1] > 0.0 {
        found.push(Adjustment {
            name: "temperature",
            change: of.warmer,
            unit: "K",
            slope: of.slopes[1],
            slope_sd: of.slopes_sd[1],
            energy_j: of.slopes[1] * of.warmer,
        });
    }
    found
}

/// What both sides made.
pub(super) fn strata(
    names: &[String],
    units: &[Vec<(usize, Unit)>; 2],
    of: &Estimate,
) -> Vec<Stratum> {
    let row = |(index, name): (usize, &String)| {
        let of_side = |side: usize| units[side].iter().filter(move |(own, _)| *own == index);
        let count = [0, 1].map(|side| of_side(side).count());
        let energy = |side: usize| {
            of_side(side).map(|(_, unit)| unit.energy_j).sum::<f64>() / count[side].max(1) as f64
        };
        Stratum {
            name: name.clone(),
            cycles: count,
            energy_j: [energy(0), energy(1)],
            weight: of.weights[index],
        }
    };
    names.iter().enumerate().map(row).collect()
}

/// Mean power at rest of both sides, W.
pub(super) fn rest_means(units: &[Vec<(usize, Unit)>; 2]) -> Option<[f64; 2]> {
    let mean = |side: usize| {
        let values: Vec<f64> = units[side].iter().filter_map(|(_, unit)| unit.rest_w).collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    };
    Some([mean(0)?, mean(1)?])
}
