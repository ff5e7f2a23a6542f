//! Applies fixes, and withdraws those that do not save energy.

use super::engine::{Examined, cycles, examine, lint};
use super::evaluate::Cycle;
use super::job::Job;
use super::known::Known;
use super::offer::{Places, ROUNDING};
use super::process::{Kept, same_order, same_process};
use super::report::Report;
use super::rule::{Applicability, Family, Finding};
use crate::rapid::syntax;
use crate::rapid::text::{Edit, SourceFile};

const MAX_ROUNDS: usize = 40;

/// The result of fixing.
#[derive(Debug)]
pub struct Fixed {
    /// All files with their new content.
    pub files: Vec<SourceFile>,
    /// Number of kept fixes.
    pub applied: usize,
    /// Number of withdrawn fixes.
    pub withdrawn: usize,
    /// The remaining findings.
    pub report: Report,
}

/// Applies the fixes up to an applicability until none is left that saves energy. The cycle is
/// simulated before and after each one; a fix stays only if the cycle takes less energy for the
/// same process (see `same_process`).
#[must_use]
pub fn fix(job: &Job<'_>, most: Applicability) -> Fixed {
    let mut files = job.files.to_vec();
    let (mut applied, mut withdrawn) = (0, 0);
    let known = job.model.map(Known::new);
    let known = known.as_ref();
    for _ in 0..MAX_ROUNDS {
        let now = with_files(job, &files);
        let Examined { report, cycles: mut before, .. } = examine(&now, known);
        let chosen = candidates(&report, most);
        // All at once if they are compatible, otherwise one by one.
        let mut kept: Vec<&Finding> = Vec::new();
        let mut result = attempt(job, known, &files, &before, &chosen).map(|(after, _)| after);
        if result.is_some() {
            kept.clone_from(&chosen);
        } else {
            for finding in &chosen {
                kept.push(finding);
                match attempt(job, known, &files, &before, &kept) {
                    Some((after, cycles)) => {
                        before = cycles;
                        result = Some(after);
                    }
                    None => {
                        kept.pop();
                    }
                }
            }
        }
        applied += kept.len();
        withdrawn = chosen.len() - kept.len();
        let Some(after) = result else { break };
        files = after;
    }
    let report = lint(&with_files(job, &files));
    Fixed { files, applied, withdrawn, report }
}

fn with_files<'j>(job: &Job<'j>, files: &'j [SourceFile]) -> Job<'j> {
    Job { files, groups: job.groups.clone(), options: job.options.clone(), ..*job }
}

/// Fixes that can be tried together, the largest savings first: no fix changes a statement or text
/// of another one.
fn candidates(report: &Report, most: Applicability) -> Vec<&Finding> {
    let simulated = |finding: &&Finding| {
        let comment = finding.rule.family == Family::Comments;
        let fix = finding.fix.as_ref();
        (finding.saving.is_some() || comment) && fix.is_some_and(|fix| fix.applicability <= most)
    };
    let mut list: Vec<&Finding> = report.findings.iter().filter(simulated).collect();
    let joules = |finding: &Finding| finding.saving.map_or(0.0, |saving| saving.energy_j);
    list.sort_by(|a, b| joules(b).total_cmp(&joules(a)));
    let mut taken = Places::default();
    list.retain(|finding| taken.take(finding));
    list
}

/// The fixed files and their cycles, if these take less energy for the same process.
fn attempt(
    job: &Job<'_>,
    known: Option<&Known>,
    files: &[SourceFile],
    before: &[Option<Cycle>],
    findings: &[&Finding],
) -> Option<(Vec<SourceFile>, Vec<Option<Cycle>>)> {
    if findings.is_empty() {
        return None;
    }
    let mut changed = files.to_vec();
    for (index, file) in files.iter().enumerate() {
        let edits: Vec<Edit> = findings
            .iter()
            .filter_map(|finding| finding.fix.as_ref())
            .flat_map(|fix| fix.edits.iter().filter(|edit| edit.span.file == file.id).cloned())
            .collect();
        if edits.is_empty() {
            continue;
        }
        changed[index] = file.edited(&edits).ok()?;
        let errors = |file: &SourceFile| syntax::parse(&file.bytes).errors.len();
        if errors(&changed[index]) > errors(file) {
            return None;
        }
    }
    let comments = findings.iter().all(|finding| finding.rule.family == Family::Comments);
    let after = cycles(&with_files(job, &changed), known);
    let mut better = comments;
    for (before, after) in before.iter().zip(&after) {
        match (before, after) {
            (Some(before), Some(after)) => {
                let spared = before.account.total.energy_j() - after.account.total.energy_j();
                let is_same = job.model.is_some_and(|model| {
                    same_order(&before.simulation, &after.simulation)
                        && same_process(model, &before.simulation, &after.simulation, Kept::Waits)
                });
                if spared < -ROUNDING || !is_same {
                    return None;
                }
                better |= spared > ROUNDING;
            }
            (None, None) => {}
            _ => return None,
        }
    }
    (better && before.len() == after.len()).then_some((changed, after))
}
