//! What may be changed in a program: each lever offers some edits.

use super::lever::{Lever, Offer, Offers};
use crate::tool::lint::context::Context;
use crate::tool::lint::process::Kept;
use crate::tool::lint::rule::Finding;

/// All levers of a program, and what is wrong with its marks.
pub(super) fn levers(context: &Context<'_>, findings: &[Finding]) -> (Vec<Lever>, Vec<String>) {
    let mut all = of_findings(findings);
    all.extend(super::zones::levers(context));
    all.extend(super::lines::levers(context));
    all.extend(super::heights::levers(context));
    all.extend(super::speeds::levers(context));
    all.extend(super::points::levers(context));
    all.extend(super::configurations::levers(context));
    all.extend(super::accelerations::levers(context));
    let (orders, faults) = super::orders::levers(context);
    all.extend(orders);
    (all, faults)
}

/// The fixes of lints.
fn of_findings(findings: &[Finding]) -> Vec<Lever> {
    let lever = |finding: &Finding| {
        let fix = finding.fix.as_ref().filter(|_| finding.saving.is_some())?;
        let title = format!("{} ({} {})", finding.change, finding.rule.code, finding.rule.name);
        Some(Lever {
            span: finding.span,
            risk: "see joulepath rule for this code",
            kept: Kept::Waits,
            offers: Offers::List(vec![Offer { title, edits: fix.edits.clone() }]),
        })
    };
    findings.iter().filter_map(lever).collect()
}
