//! What plausible robots say of a result, in sentences.

use crate::energy::plausible::{Contribution, Interval, Plausibility};
use crate::retrofit::Retrofit;

/// Energies of a cycle, and what their intervals come from.
pub(super) fn energies(plausible: &Plausibility) -> Vec<String> {
    let Interval { low, high, .. } = plausible.energy_j;
    let motion = plausible.motion_energy_j;
    let energies = format!(
        "in 90 % of the plausible robots {low:.0} to {high:.0} J, of which motions take {:.0} to {:.0} J",
        motion.low, motion.high,
    );
    std::iter::once(energies).chain(contributions(&plausible.contributions)).collect()
}

/// What a retrofit saves, and what that interval comes from; nothing of a known robot, or where
/// nothing was rewritten.
pub(super) fn saving(retrofit: &Retrofit) -> Vec<String> {
    let is_rewritten = retrofit.segments.iter().any(|segment| segment.rewritten);
    let Some(uncertainty) = retrofit.uncertainty.as_ref().filter(|_| is_rewritten) else {
        return Vec::new();
    };
    let [all, motion] = uncertainty.saving_percent;
    let saving = format!(
        "in 90 % of the plausible robots it saves {:.1} to {:.1} % of the motion energy, {:.1} to {:.1} % of all",
        motion.low, motion.high, all.low, all.high,
    );
    std::iter::once(saving).chain(contributions(&uncertainty.contributions)).collect()
}

/// What an interval comes from, and what would narrow it.
fn contributions(parts: &[Contribution]) -> Option<String> {
    let first = parts.first()?;
    let groups: Vec<String> =
        parts.iter().map(|it| format!("{} {:.0} %", it.group, 100.0 * it.share)).collect();
    Some(format!("of the variance: {}; most would tell {}", groups.join(", "), first.narrowed_by))
}
