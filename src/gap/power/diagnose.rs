//! From the power of some logs to its effects.

use super::cause::{Cause, causes};
use super::found::PowerFound;
use super::powers::Powers;
use super::reference::Reference;
use super::weighing::Weighing;
use crate::arm::robot::Model;

/// Share of the difference that the effects have to explain.
const EXPLAINS: f64 = 0.7;

/// Which effects separate the power now from that of the baseline. `None` where the baseline
/// tells no reference.
#[must_use]
pub fn diagnose_power(
    model: &Model,
    baseline: &[Powers],
    train: &[Powers],
    held: &[Powers],
    may: &dyn Fn(&str) -> bool,
) -> Option<PowerFound> {
    let reference = Reference::new(model, baseline)?;
    let causes = causes(&reference, may);
    let weighing = Weighing::new(&reference, &causes, train)?;
    let chosen = weighing.forward();
    let [none, found] = [&[][..], &chosen].map(|of| weighing.fit(of));
    let (none, found) = (none?, found?);
    let noise = weighing.variance;
    let explained = (none.left - found.left) / (none.left - noise).max(noise);
    let is_unknown = !chosen.is_empty() && explained < EXPLAINS;
    let told = if is_unknown { &[][..] } else { &chosen };
    let effects = told.iter().map(|k| weighing.effect(&chosen, *k)).collect::<Option<_>>()?;
    let best = if is_unknown { &none } else { &found };
    let added: Vec<(&Cause<'_>, f64)> =
        told.iter().zip(&best.values).map(|(k, value)| (&causes[*k], *value)).collect();
    let rms = |mean: f64| (mean - reference.variance).max(0.0).sqrt();
    let before = left(&reference, held, &[]);
    let after = left(&reference.moved(&(&reference.root * &best.moved)), held, &added);
    let gap = [reference.variance.sqrt(), rms(before), rms(after)];
    Some(PowerFound { effects, is_unknown, gap })
}

/// Mean square that is missed with causes \[W²\].
fn left(reference: &Reference, logs: &[Powers], added: &[(&Cause<'_>, f64)]) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0_f64);
    for log in logs {
        let mut missed = reference.missed(log);
        for (cause, value) in added {
            missed.iter_mut().zip(cause.of(log)).for_each(|(missed, x)| *missed -= value * x);
        }
        sum += missed.iter().map(|x| x * x).sum::<f64>();
        count += missed.len() as f64;
    }
    sum / count.max(1.0)
}
