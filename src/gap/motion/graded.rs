//! How far held-out runs are from the baseline, and from what the logs show.

use super::changes::Movement;
use super::features::{Feature, Measured, measured};
use super::run::Run;
use crate::learn::log::median_step;

/// Features in seconds that tell where the time goes.
const TIMES: [Feature; 2] = [Feature::Duration, Feature::Shift];

/// Rms of durations and latenesses of held-out movements against the baseline: noise, before, after
/// \[s\], the noise's variance taken off. With an effect, what the logs changed is expected.
pub(super) fn graded(movements: &[Movement], held: &[Run], has_effect: bool) -> [f64; 3] {
    let step = held.iter().map(|run| median_step(&run.t)).fold(0.0, f64::max);
    let landmarks: Vec<_> = movements.iter().map(|of| of.landmarks.clone()).collect();
    let (mut noise, mut before, mut after, mut count) = (0.0, 0.0, 0.0, 0.0_f64);
    for (movement, held) in movements.iter().zip(measured(&landmarks, held, step)) {
        for feature in TIMES {
            let Some(change) = movement.change(feature) else { continue };
            let Some(late) = late(movement, &held, feature) else { continue };
            let expected = if has_effect { change.value } else { 0.0 };
            noise += change.sd.powi(2);
            before += late.powi(2);
            after += (late - expected).powi(2);
            count += 1.0;
        }
    }
    let rms = |sum: f64| (sum / count.max(1.0)).sqrt();
    [rms(noise), rms((before - noise).max(0.0)), rms((after - noise).max(0.0))]
}

fn late(movement: &Movement, held: &Measured, feature: Feature) -> Option<f64> {
    Some(held.mean(feature)? - movement.before.mean(feature)?)
}
