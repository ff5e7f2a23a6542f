//! What runs of a program show.

use crate::arm::effects::{ALL, Effect, Form, Timing};
use crate::gap::decision::Estimated;

use super::changes::movements;
use super::graded::graded;
use super::run::Run;
use super::search::{Explained, search};

/// What the laws have to bring beyond the motion as it was: 20 to 1 \[nats\].
const SURE: f64 = 3.0;
/// Odds below which two laws cannot be told apart: 1 to 100 \[nats\].
const CLASS: f64 = 4.6;
/// Movements that logs and baseline have to share.
const FEWEST: usize = 2;

/// What was found of the motion.
#[derive(Clone)]
pub struct RunFound {
    /// Effects.
    pub effects: Vec<RunEffect>,
    /// Whether movements differ in a way that no effect explains.
    pub is_unknown: bool,
    /// Rms by which held-out times differ from the baseline: noise, before, after \[s\].
    pub gap: [f64; 3],
}

impl RunFound {
    /// Whether several laws explain the same.
    #[must_use]
    pub fn is_ambiguous(&self) -> bool {
        self.effects.iter().any(|of| of.class.len() > 1)
    }
}

/// An effect of the motion.
#[derive(Clone)]
pub struct RunEffect {
    /// The effect.
    pub effect: &'static Effect,
    /// Ids that cannot be told apart.
    pub class: Vec<&'static str>,
    /// Its parameter.
    pub parameters: Vec<Estimated>,
    /// The movement behind which it is, from 1; `None` everywhere.
    pub movement: Option<usize>,
    /// Logarithm of the odds.
    pub nats: f64,
}

/// What separates runs from those of the baseline, graded by held-out ones; `None` where they share
/// too few movements. `may` says which effects may be named, by their ids.
#[must_use]
pub fn diagnose_runs(
    baseline: &[Run],
    train: &[Run],
    held: &[Run],
    may: &dyn Fn(&str) -> bool,
) -> Option<RunFound> {
    let movements = movements(baseline, train);
    if movements.iter().filter(|of| of.is_compared()).count() < FEWEST {
        return None;
    }
    let timings: Vec<Timing> = timed().filter(|(of, _)| may(of.id)).map(|(_, of)| of).collect();
    let searched = search(&movements, &timings);
    let best = searched.sets.first().filter(|best| best.evidence > searched.none + SURE);
    let best = best.filter(|best| best.evidence > searched.anything);
    let number = |at: usize| movements[at].landmarks.number;
    let effects = best.map_or_else(Vec::new, |best| {
        let others = &searched.sets[1..];
        (0..best.laws.len())
            .filter_map(|k| effect(best, others, k, searched.none, &number))
            .collect()
    });
    Some(RunFound {
        is_unknown: effects.is_empty() && searched.anything > searched.none,
        gap: graded(&movements, held, !effects.is_empty()),
        effects,
    })
}

/// Effects of the motion with what they act on.
fn timed() -> impl Iterator<Item = (&'static Effect, Timing)> {
    ALL.iter().filter_map(|effect| match effect.form {
        Form::Timing(timing) => Some((effect, timing)),
        _ => None,
    })
}

fn named(timing: Timing) -> Option<&'static Effect> {
    timed().find(|(_, of)| *of == timing).map(|(effect, _)| effect)
}

/// Law `k` of the best ones as an effect.
fn effect(
    best: &Explained,
    others: &[Explained],
    k: usize,
    none: f64,
    number: &dyn Fn(usize) -> usize,
) -> Option<RunEffect> {
    let (law, effect) = (&best.laws[k], named(best.laws[k].timing)?);
    let is_rival = |of: &&Explained| {
        let mut pairs = best.laws.iter().zip(&of.laws).enumerate();
        of.laws.len() == best.laws.len()
            && best.evidence - of.evidence < CLASS
            && pairs.all(|(place, (a, b))| (place == k) != (a.timing == b.timing))
    };
    let rivals = others.iter().filter(is_rival);
    let rivals = rivals.filter_map(|of| Some(named(of.laws[k].timing)?.id));
    let class = [effect.id].into_iter().chain(rivals).collect();
    let (value, slope) = law.published();
    let parameters = effect.parameters.iter().map(|parameter| Estimated {
        name: parameter.name.to_owned(),
        value,
        sd: best.deviations[k] * slope,
        unit: parameter.unit,
    });
    Some(RunEffect {
        effect,
        class,
        parameters: parameters.collect(),
        movement: law.at.map(number),
        nats: (best.evidence - none) / best.laws.len() as f64,
    })
}
