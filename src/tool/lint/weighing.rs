//! What would tell the joules of a finding that has none.

use std::collections::BTreeSet;

use super::context::Context;
use super::rule::{Family, Finding};
use crate::arm::robot::Model;
use crate::rapid::text::Span;

/// States what the joules of findings need. Without a robot all need one, which is said once.
pub(super) fn state_needs(context: &Context<'_>, findings: &mut [Finding]) {
    if !context.model.is_some_and(Model::has_dynamics) {
        return;
    }
    let executed: BTreeSet<Span> = context.trace.iter().map(|done| done.what.span()).collect();
    for finding in findings {
        let is_weighed = finding.saving.is_some() || finding.at_stake_j.is_some();
        let needs = match finding.rule.family {
            _ if is_weighed || finding.needs.is_some() => continue,
            Family::Comments | Family::Program | Family::System => continue,
            Family::Load => "the real mass and centre of gravity (LoadIdentify measures them)",
            _ if executed.contains(&finding.span) => continue,
            _ => "a run that comes by (--entry NAME, --input SIGNAL=0|1 or SIGNAL=SECONDS)",
        };
        finding.needs = Some(needs.to_owned());
    }
}
