//! Which findings come first: by the joules of a cycle and by how sure the rule is.

use std::collections::BTreeSet;

use super::rule::{Confidence, Finding};
use crate::rapid::diagnostics::Severity;

/// Share of a cycle's energy from which a saving is a warning: less is hard to show with a meter at the
/// cabinet.
const WARNING_SHARE: f64 = 0.01;

/// The severity of a finding. That of its rule counts where joules cannot be told.
pub(super) fn severity(finding: &Finding) -> Severity {
    if finding.confidence == Confidence::Low || finding.at_stake_j.is_some() {
        return Severity::Info;
    }
    match (finding.saving, finding.cycle) {
        (Some(saving), Some(cycle)) if saving.energy_j < WARNING_SHARE * cycle.energy_j => {
            Severity::Info
        }
        (Some(_), Some(_)) => Severity::Warning,
        _ => finding.rule.severity,
    }
}

/// The findings with joules that are most worth a look, at most `count`: those of which the rule is
/// sure, then the others, each by joules. Findings at one place of which the rules are equally sure are
/// alternatives: only the first counts.
#[must_use]
pub fn top(findings: &[Finding], count: usize) -> Vec<&Finding> {
    let mut ranked: Vec<&Finding> =
        findings.iter().filter(|finding| joules(finding).is_some()).collect();
    let order = |finding: &Finding| joules(finding).unwrap_or_default();
    ranked.sort_by(|a, b| b.confidence.cmp(&a.confidence).then(order(b).total_cmp(&order(a))));
    let mut places = BTreeSet::new();
    ranked.retain(|finding| places.insert((finding.confidence, finding.span)));
    ranked.truncate(count);
    ranked
}

/// The joules of a cycle that a finding saves, or else can save at most.
#[must_use]
pub fn joules(finding: &Finding) -> Option<f64> {
    let saved = finding.saving.map(|saving| saving.energy_j);
    saved.or(finding.at_stake_j).filter(|joules| joules.is_finite())
}
