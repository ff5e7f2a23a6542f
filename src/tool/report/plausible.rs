//! Sentences on the intervals of a result over plausible robots.

use crate::retime::energy::plausible::{Contribution, Interval, LEAST, Plausibility};
use crate::tool::retrofit::Retrofit;

/// Energies of a cycle, and the contributions to their intervals.
pub(super) fn energies(plausible: &Plausibility) -> Vec<String> {
    let range =
        |of: &Interval| format!("{:.0} to {:.0} J (median {:.0} J)", of.low, of.high, of.median);
    let energies = format!(
        "in 90 % of the plausible robots {}, of which motions take {}",
        range(&plausible.energy_j),
        range(&plausible.motion_energy_j),
    );
    std::iter::once(energies).chain(contributions(&plausible.contributions)).collect()
}

/// The saving of a retrofit, and the contributions to its interval; empty without uncertainty or
/// rewritten segments.
pub(super) fn saving(retrofit: &Retrofit) -> Vec<String> {
    let Some(uncertainty) = retrofit.uncertainty.as_ref().filter(|_| is_rewritten(retrofit)) else {
        return Vec::new();
    };
    let range =
        |of: &Interval| format!("{:.1} to {:.1} % (median {:.1} %)", of.low, of.high, of.median);
    let [all, motion] = &uncertainty.saving_percent;
    let saving = format!(
        "in 90 % of the plausible robots it saves {} of the motion energy, {} of all",
        range(motion),
        range(all),
    );
    std::iter::once(saving).chain(contributions(&uncertainty.contributions)).collect()
}

/// Whether anything was changed.
pub(super) fn is_rewritten(retrofit: &Retrofit) -> bool {
    retrofit.segments.iter().any(|segment| segment.rewritten)
}

/// The contributions to an interval, and data that would narrow it.
pub(super) fn contributions(parts: &[Contribution]) -> Option<String> {
    let first = parts.first()?;
    let rest = 1.0 - parts.iter().map(|part| part.share).sum::<f64>();
    let rest = (rest >= LEAST).then_some(("the others together", rest));
    let named = parts.iter().map(|part| (part.group.as_str(), part.share));
    let groups: Vec<String> =
        named.chain(rest).map(|(group, share)| format!("{group} {:.0} %", 100.0 * share)).collect();
    Some(format!(
        "shares of the variance: {}; the most informative measurement: {}",
        groups.join(", "),
        first.narrowed_by
    ))
}
