//! The laws under which the differences of all movements are most probable.

use crate::arm::effects::Timing;

use super::changes::Movement;
use super::expected::{Mode, log_density, log_density_of_anything};
use super::features::Feature;
use super::laws::Law;

/// Least parameters that matter: 3 ms, 10 ms, 2 % of a speed or an acceleration, 10 % of a zone.
const LEAST_LAG: f64 = 0.003;
const LEAST_WAIT: f64 = 0.01;
const LEAST_SCALE: f64 = 0.02;
const LEAST_ZONE: f64 = 0.1;
/// Widths of what parameters may be, by law: seconds, a logarithm, a factor.
const RANGE_LAG: f64 = 0.4;
const RANGE_WAIT: f64 = 4.0;
const RANGE_SCALE: f64 = 4.0;
const RANGE_ZONE: f64 = 4.0;
/// What a law costs besides its parameter \[nats\]: few logs differ from their baseline at all.
const LAW: f64 = 4.0;
/// Shares of the features that anything may change, and what it costs to try them \[nats\].
const SHARES: [f64; 3] = [0.03, 0.15, 0.5];
const ANYTHING: f64 = 12.0;
/// Shares of the movements that a law may reach: a few or most.
const REACHES: [f64; 2] = [0.2, 0.8];
/// What a second law has to bring of what the first one does: it may be the form of that.
const SECOND: f64 = 0.15;
/// Laws at once.
const MOST: usize = 2;
/// Rounds of a search for the best parameter, the first step of it and what each leaves of it.
const ROUNDS: usize = 24;
const STEP: f64 = 0.02;
const SHRINK: f64 = 0.6;
/// Steps of the parameter, of itself, at which its deviation is measured.
const CURVED: f64 = 1e-3;

/// Some laws with the logarithm of their evidence.
#[derive(Clone, Debug)]
pub(super) struct Explained {
    pub laws: Vec<Law>,
    /// Deviations of their parameters.
    pub deviations: Vec<f64>,
    /// \[nats\].
    pub evidence: f64,
}

/// What is most probable.
pub(super) struct Searched {
    /// The evidence of the same motion as in the baseline \[nats\].
    pub none: f64,
    /// That of movements that change by anything \[nats\].
    pub anything: f64,
    /// The best laws, the best first; each with other ones in their place.
    pub sets: Vec<Explained>,
}

/// Searches for the laws that explain the differences of some movements.
pub(super) fn search(movements: &[Movement], timings: &[Timing]) -> Searched {
    let none = evidence_of(movements, &[]);
    let of_share = |share: f64| -> f64 {
        movements.iter().map(|of| log_density_of_anything(share, &of.changes)).sum()
    };
    let anything = SHARES.map(of_share).into_iter().fold(f64::NEG_INFINITY, f64::max) - ANYTHING;
    let mut all: Vec<Explained> = Vec::new();
    let mut before = Explained { laws: Vec::new(), deviations: Vec::new(), evidence: none };
    for _ in 0..MOST {
        let mut sets: Vec<Explained> =
            timings.iter().filter_map(|timing| with(movements, &before, *timing)).collect();
        sets.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
        let asked = before.evidence + SECOND * (before.evidence - none);
        let Some(best) = sets.first().filter(|best| best.evidence > asked) else { break };
        before = best.clone();
        all.extend(sets);
    }
    all.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    Searched { none, anything, sets: all }
}

/// Some laws and the best one of a kind beside them.
fn with(movements: &[Movement], before: &Explained, timing: Timing) -> Option<Explained> {
    // What two limits do together one of them may do in another form.
    let is_there = |law: &Law| law.timing == timing && timing != Timing::Wait;
    let is_limit = |timing: Timing| !matches!(timing, Timing::Lag | Timing::Wait);
    let is_form = |law: &Law| is_limit(timing) && is_limit(law.timing);
    if before.laws.iter().any(|law| is_there(law) || is_form(law)) {
        return None;
    }
    let starts = candidates(movements, timing);
    let starts = starts
        .into_iter()
        .filter(|law| before.laws.iter().all(|of| of.at.is_none() || of.at != law.at));
    let joined = |law: Law| -> Vec<Law> { before.laws.iter().copied().chain([law]).collect() };
    let (start, _) = starts
        .map(|law| (law, evidence_of(movements, &joined(law))))
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    let mut laws = joined(start);
    for k in (0..laws.len()).rev().chain([laws.len() - 1]) {
        tune(movements, &mut laws, k);
    }
    let deviations: Vec<f64> = (0..laws.len()).map(|k| deviation(movements, &laws, k)).collect();
    if laws.iter().any(|law| law.value.abs() < least(law.timing)) {
        return None;
    }
    let cost = |(law, sd): (&Law, &f64)| {
        let places = law.at.map_or(1.0, |_| movements.len() as f64);
        // The integral over the parameter, of a bell.
        let tried = places * REACHES.len() as f64;
        (range(law.timing) / (sd * std::f64::consts::TAU.sqrt())).ln() + tried.ln() + LAW
    };
    let costs: f64 = laws.iter().zip(&deviations).map(cost).sum();
    let evidence = evidence_of(movements, &laws) - costs;
    Some(Explained { laws, deviations, evidence })
}

fn least(timing: Timing) -> f64 {
    match timing {
        Timing::Lag => LEAST_LAG,
        Timing::Wait => LEAST_WAIT,
        Timing::Acceleration | Timing::Speed => LEAST_SCALE,
        Timing::Blending => LEAST_ZONE,
    }
}

fn range(timing: Timing) -> f64 {
    match timing {
        Timing::Lag => RANGE_LAG,
        Timing::Wait => RANGE_WAIT,
        Timing::Acceleration | Timing::Speed => RANGE_SCALE,
        Timing::Blending => RANGE_ZONE,
    }
}

/// Laws whose parameter is what some movement differs by.
fn candidates(movements: &[Movement], timing: Timing) -> Vec<Law> {
    let mut laws = Vec::new();
    for (k, movement) in movements.iter().enumerate() {
        let of = |feature: Feature| movement.change(feature).map(|change| change.value);
        let cut = movement.before.mean(Feature::Corner);
        let (at, values) = match timing {
            Timing::Lag => (None, vec![of(Feature::Shift)]),
            Timing::Wait => {
                // A robot cannot rest less than not at all.
                let rest = movement.before.mean(Feature::Rest).unwrap_or(0.0);
                (Some(k), vec![of(Feature::Duration).filter(|wait| *wait > -rest)])
            }
            Timing::Speed => (None, vec![of(Feature::Speed)]),
            Timing::Acceleration => {
                let all = [Feature::Start, Feature::End, Feature::Speed];
                (None, all.map(|feature| of(feature).map(|value| 2.0 * value)).to_vec())
            }
            Timing::Blending => (None, vec![of(Feature::Corner).zip(cut).map(|(e, cut)| e / cut)]),
        };
        let values = values.into_iter().flatten().filter(|value| value.is_finite());
        let values = values.filter(|value| value.abs() > least(timing));
        let reaching = |value| REACHES.map(|reach| Law { timing, at, value, reach });
        laws.extend(values.flat_map(reaching));
    }
    laws
}

/// Logarithm of the density of all differences under some laws.
fn evidence_of(movements: &[Movement], laws: &[Law]) -> f64 {
    let of = |k: usize| {
        let modes = laws.iter().fold(vec![Mode::unchanged(1.0)], |modes, law| {
            let own = law.modes(movements, k);
            modes.iter().flat_map(|mode| own.iter().map(|of| mode.and(of))).collect()
        });
        log_density(&modes, &movements[k].changes)
    };
    (0..movements.len()).map(of).sum()
}

/// Brings the parameter of a law to the best value near it.
fn tune(movements: &[Movement], laws: &mut [Law], k: usize) {
    let mut step = STEP * laws[k].value.abs();
    let mut best = evidence_of(movements, laws);
    for _ in 0..ROUNDS {
        let value = laws[k].value;
        let mut moved = false;
        for other in [value - step, value + step] {
            let mut changed = laws.to_vec();
            changed[k].value = other;
            let evidence = evidence_of(movements, &changed);
            if evidence > best {
                best = evidence;
                laws[k].value = other;
                moved = true;
            }
        }
        if !moved {
            step *= SHRINK;
        }
    }
}

/// The deviation of a parameter, by the curvature of the evidence.
fn deviation(movements: &[Movement], laws: &[Law], k: usize) -> f64 {
    let step = CURVED * laws[k].value.abs();
    let at = |value: f64| {
        let mut changed = laws.to_vec();
        changed[k].value = value;
        evidence_of(movements, &changed)
    };
    let value = laws[k].value;
    let curvature = (2.0 * at(value) - at(value - step) - at(value + step)) / (step * step);
    let widest = value.abs().max(step);
    if curvature > 0.0 { curvature.sqrt().recip().min(widest) } else { widest }
}
