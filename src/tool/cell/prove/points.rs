//! Cycles as numbers of the estimate, with what waiting costs before the scatter is seen.

use super::estimate::{Point, Prior};
use super::series::Measure;
use super::unit::Unit;

/// How well the power at rest is known to be what a longer wait costs, share.
const STANDING: f64 = 0.2;

/// The cycles as numbers. A temperature counts if all cycles of both sides have it.
pub(super) fn points(sides: &[Vec<(usize, Unit)>; 2]) -> ([Vec<Point>; 2], Option<String>) {
    let units = || sides.iter().flatten().map(|(_, unit)| unit);
    let has = units().all(|unit| unit.temperature.is_some());
    let some = units().any(|unit| unit.temperature.is_some());
    let point = |(stratum, unit): &(usize, Unit)| Point {
        stratum: *stratum,
        energy: unit.energy_j,
        duration: unit.duration_s,
        motion: unit.duration_s - unit.rest_s,
        waiting: unit.waiting_s,
        temperature: unit.temperature.filter(|_| has).unwrap_or(0.0),
    };
    let note = (some && !has).then(|| {
        "the temperature is not used: not every log of both sides has a column temp1".to_owned()
    });
    ([0, 1].map(|side| sides[side].iter().map(point).collect()), note)
}

/// What is known of the cost of waiting: the power while the robot waits, or anything up to the mean power.
pub(super) fn prior(measure: Measure, standing_w: Option<f64>, points: &[Vec<Point>; 2]) -> Prior {
    if measure == Measure::Joints {
        return Prior { mean: 0.0, sd: 0.0 };
    }
    if let Some(mean) = standing_w {
        return Prior { mean, sd: STANDING * mean };
    }
    let all = points.iter().flatten();
    let [energy, time] = all.fold([0.0; 2], |[e, t], p| [e + p.energy, t + p.duration]);
    let half = 0.5 * energy / time.max(f64::MIN_POSITIVE);
    Prior { mean: half, sd: half }
}
