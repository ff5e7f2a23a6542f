//! A comment takes back a finding that is not there.
//!
//! ## What it does
//! Finds `! joulepath: ignore CODE reason` where no such finding is in the statement it is about.
//! Each of several codes is judged by itself.
//!
//! ## Why it wastes energy
//! It does not, but it hides the next finding of that kind.
//!
//! ## How the saving is computed
//! There is none.
//!
//! ## Example
//! ```text
//! ! joulepath: ignore EW999 no such rule
//! WaitTime 1;
//! ```
//!
//! ## Use instead
//! ```text
//! WaitTime 1;
//! ```
//!
//! ## Safety
//! Taking the comment out changes no statement.
//!
//! ## Assumptions
//! Codes of rules that need a backup are not judged, and without a robot neither are codes of rules
//! about movements: with a backup or a robot such a rule may find something.

use super::super::context::Context;
use super::super::edits::replace;
use super::super::job::Job;
use super::super::rule::{Applicability, Family, Finding, Fix, Needs, Rule};
use super::super::suppress::Suppression;

rule!("EW001", "unused-suppression", Comments, Text, Warning, "unused_suppression.rs");

/// The engine knows what was suppressed, and asks `report_unused`.
fn check(_: &Context<'_>, _: &mut Vec<Finding>) {}

/// Adds a finding for the codes of a comment that took nothing back, as far as their rules ran.
pub(crate) fn report_unused(
    job: &Job<'_>,
    rules: &[&'static Rule],
    suppression: &Suppression,
    unused: &[&str],
    findings: &mut Vec<Finding>,
) {
    let meant = |code: &str| rules.iter().filter(|rule| rule.is_meant(code)).collect::<Vec<_>>();
    let idle = |rule: &Rule| {
        !job.settings.selects(rule)
            || rule.needs == Needs::Backup
            || job.model.is_none() && depends_on_robot(rule)
    };
    let judged =
        unused.iter().copied().filter(|code| !meant(code).into_iter().any(|rule| idle(rule)));
    let (vain, unknown): (Vec<&str>, Vec<&str>) = judged.partition(|code| !meant(code).is_empty());
    let whole = vain.len() + unknown.len() == suppression.codes.len();
    let mut texts = Vec::new();
    if suppression.codes.is_empty() {
        texts.push("the comment names no rule: write ! joulepath: ignore CODE reason".to_owned());
    }
    if !unknown.is_empty() {
        texts.push(format!("there is no rule {}: joulepath rule lists them", unknown.join(", ")));
    }
    if !vain.is_empty() {
        let so = if whole { "the comment suppresses nothing" } else { "leave it out" };
        texts.push(format!("nothing here is found by {}: {so}", vain.join(", ")));
    }
    if texts.is_empty() {
        return;
    }
    let mut finding = Finding::new(&RULE, suppression.span, texts.join("; "));
    if whole {
        let edits = vec![replace(suppression.span, "")];
        finding.fix = Some(Fix { applicability: Applicability::Safe, edits });
    }
    findings.push(finding);
}

/// Whether a robot may find more: where it goes, what it gets to, whether a change saves.
fn depends_on_robot(rule: &Rule) -> bool {
    let moves = [Family::Stops, Family::Speed, Family::Dwell, Family::Path];
    rule.needs == Needs::Robot || moves.contains(&rule.family)
}
